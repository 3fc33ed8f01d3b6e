//! `accuracy`: the time and the error of each solver on a path, compared with a reference.
//!
//! Every solver runs exactly as in [`simulate`](crate::simulation::simulate), so that its numbers are those of a
//! simulation. Where all moves of the path have an exact solution, the reference is the exact solver. Where some are
//! curved, it is the exact solver again, held to a smaller tolerance; in the plane, more rings and smaller steps.

use std::time::{Duration, Instant};

use stickslip_mechanics as mechanics;
use stickslip_mechanics::{ErrorEstimate, Tangential, rings};
use stickslip_wire::{AccuracyReply, AccuracyRequest, AccuracyRow, Comparison, Reference, Solver as Named};

use super::accuracy_in_plane as in_plane;
use crate::computations::prelude::*;
use crate::simulation::bytes::{SPRING, of_moves, of_stress};
use crate::simulation::cost::{of_rings, of_springs};
use crate::simulation::{cycle_moves, equal_peaks, follow, spring_foundation, stresses};

/// The reference is held to this part of the tolerance: some two and a half times the chords, with a
/// sixteenth of the error of their forces and a quarter of that of their stresses.
const REFERENCE_TOLERANCE: f64 = 1.0 / 16.0;
/// The tolerance of the steps of rings.
const RINGS_TOLERANCE: f64 = 1e-4;
/// A solver runs again, for the median of the times, until its runs together have taken this long.
const REPEAT_UNTIL: Duration = Duration::from_millis(5);
/// The most runs of one solver.
const MAX_RUNS: usize = 9;

/// Why the reference is exact enough.
const REASON_EXACT: &str =
    "every move of this path has an exact solution: the errors left are of rounding or of a table";
const REASON_REFINED: &str = "the exact solver, held to a sixteenth of the tolerance where moves are curved";
const REASON_UNREFINED: &str =
    "the exact solver, held to the tolerance where moves are curved: a smaller one would need too long a slip history";

/// The result of one solver: forces, N, after each move, and shear stresses, Pa, at the end.
struct Answer {
    forces: Vec<f64>,
    shears: Vec<Option<f64>>,
    estimate: ErrorEstimate,
    time: f64,
}

/// The input of all solvers.
struct Task<'a> {
    comparison: &'a Comparison,
    protocol: Option<&'a Protocol>,
    sampling: &'a StressRequest,
    stop: &'a dyn Stop,
}

/// The same path with several solvers, each compared with a reference.
pub struct CompareSolvers;

impl Computation for CompareSolvers {
    const ABOUT: About = About {
        name: "accuracy",
        route: Some(Route { path: "/accuracy", operation: "compare_solvers", tag: "simulation" }),
        title: "Compare solvers",
        description: "Follows a path from the preloaded contact with each of the solvers, and compares the forces \
                      along it and the shear stresses at its end with a reference: the exact solver, refined where \
                      moves are curved, or in the plane more rings in smaller steps. This shows what a coarser model \
                      would do to your own numbers. The row of a solver that cannot follow the path gives the reason. \
                      The springs of all solvers together, times moves and stress points, are limited as in one \
                      simulation. Nothing is stored.",
        reply: "The reference, and a row for each solver",
        ..About::DOCUMENT
    };

    type Request = AccuracyRequest;
    type Outcome = AccuracyReply;

    fn examples() -> Vec<Example> {
        vec![
            example(
                "as it is",
                "A contact and a path, and the usual solvers",
                json!({
                    "contact": ContactDefinition::example(),
                    "path": {"falling_amplitude": {"reversals": 20}}
                }),
            ),
            example(
                "own solvers",
                "Two spring foundations, at given radii",
                json!({
                    "contact": example_contact(json!({"type": "cone", "slope": 0.05}), json!({"contact_radius": 1e-4})),
                    "path": {"displacement": [1e-7, -1e-7, 0.0]},
                    "stress": {"radii": [2e-5, 5e-5, 8e-5], "fields": ["shear"]},
                    "solvers": ["exact", {"springs": {"count": 200}}, {"springs": {"count": 2000}}]
                }),
            ),
            example(
                "in the plane",
                "Rings on a circle",
                json!({
                    "contact": ContactDefinition::example(),
                    "path": {"ellipse": {"radii": [1e-7, 1e-7], "turns": 1, "steps_per_turn": 16}},
                    "solvers": [{"rings": {"count": 10}}, {"rings": {"count": 20}}]
                }),
            ),
        ]
    }

    /// One solver at a time, and a force a move of the reference and of that, or a state.
    fn bytes(task: &Comparison) -> usize {
        let in_plane = matches!(task.plan, Plan::Plane(_));
        let kept = if in_plane { size_of::<rings::PlanarState>() } else { size_of::<f64>() };
        of_moves(&task.plan, Steps::Last)
            + 2 * kept * task.plan.length()
            + 2 * of_stress(task.sampling.length())
            + of_shape(&task.definition.profile)
            + task.springs().max().unwrap_or(0) * SPRING
    }

    /// Each solver once, and the reference.
    fn cost(task: &Comparison) -> Nanoseconds {
        let (plan, radii) = (&task.plan, task.sampling.length());
        if let Plan::Plane(plane) = plan {
            let costs = in_plane::every(task).map(|options| of_rings(&task.setup, &plane.moves, &options, radii));
            return costs.fold(0, Nanoseconds::saturating_add);
        }
        let exact = Work { moves: plan.length(), curved: plan.curved(), radii, ..Work::default() };
        let each = exact.cost(&task.setup.profile).saturating_mul(task.solvers.len() as u64 + 1);
        let springs = task.springs().map(|springs| of_springs(springs, task.passes()));
        springs.fold(each, Nanoseconds::saturating_add)
    }

    fn run(task: Comparison, stop: &dyn Stop) -> Result<AccuracyReply, Failure> {
        compare_solvers(&task, stop)
    }
}

impl Outcome for AccuracyReply {
    type Reply = AccuracyReply;
}

/// Runs every solver of a comparison.
///
/// # Errors
/// [`Failure`] if the reference has no answer, or the client hung up. A solver that cannot follow the path is refused
/// in its row.
pub fn compare_solvers(comparison: &Comparison, stop: &dyn Stop) -> Result<AccuracyReply, Failure> {
    let Comparison { setup, plan, tolerance, .. } = comparison;
    if let Plan::Plane(plane) = plan {
        return in_plane::compare(comparison, plane, stop);
    }
    let begin = Instant::now();
    let start = contact(setup.clone(), "/contact")?;
    let protocol = equal_peaks(plan, &start)?;
    let follows = |tolerance: f64| -> Result<_, Failure> {
        let (mut truth, mut load) = (start.clone(), start.normal_force());
        let mut forces = Vec::with_capacity(plan.length());
        follow(&mut truth, plan, protocol.as_ref(), tolerance, stop, |_, truth: &Contact| {
            load = load.max(truth.normal_force());
            forces.push(truth.force());
        })?;
        Ok((truth, forces, setup.friction * load))
    };
    let (followed, reason) = if plan.curved() == 0 {
        (follows(*tolerance), REASON_EXACT)
    } else {
        match follows((REFERENCE_TOLERANCE * tolerance).max(*limits::TOLERANCE.start())) {
            // More chords leave a deeper slip history.
            Err(Failure { cause: Cause::MemoryFull { .. }, .. }) => (follows(*tolerance), REASON_UNREFINED),
            refined => (refined, REASON_REFINED),
        }
    };
    let (truth, forces, unit) = followed?;
    let radii = comparison.sampling.places(false, truth.contact_radius());
    let fields = Some(vec![Field::Shear]);
    let sampling = StressRequest { radii: Some(radii), fields, ..StressRequest::default() };
    let shears = stresses(&truth, &sampling, stop)?.shear.unwrap_or_default();
    let pressure = truth.summary().unit_pressure();
    let pressure = if pressure.is_finite() { pressure } else { 0.0 };
    let estimate = truth.accuracy();
    let reference = Reference {
        solver: SolverKind::Exact,
        reason: reason.to_owned(),
        force_error: estimate.force_error,
        stress_error: estimate.stress_error,
        compute_time: begin.elapsed().as_secs_f64(),
        force_unit: unit,
        stress_unit: setup.friction * pressure,
        radii: shears.iter().flatten().count(),
    };
    let truth = Answer { forces, shears, estimate, time: reference.compute_time };
    let task = Task { comparison, protocol: protocol.as_ref(), sampling: &sampling, stop };
    let rows = comparison.solvers.iter().map(|&solver| row(solver, &task, &truth, &reference));
    let rows: Result<_, Failure> = rows.collect();
    Ok(AccuracyReply { rows: rows?, reference })
}

fn row(solver: Named, task: &Task<'_>, truth: &Answer, reference: &Reference) -> Result<AccuracyRow, Failure> {
    let Comparison { setup, plan, .. } = task.comparison;
    let begin = Instant::now();
    let found = match solver {
        Named::Exact => answer(|| contact(setup.clone(), "/contact"), task),
        Named::Rings(rings) => by_rings(rings.count, task),
        Named::Springs(springs) => answer(|| spring_foundation(setup, plan, springs.count, task.stop), task),
    };
    let (found, refused) = match found {
        Ok(found) => (Some(found), None),
        Err(Failure { pointer, cause: Cause::Refused(error) }) => (None, Some(Fault::new(pointer, error.to_string()))),
        Err(failure) => return Err(failure),
    };
    let found = found.as_ref();
    let force_error = |found: &Answer| {
        let differences = found.forces.iter().zip(&truth.forces).map(|(found, truth)| (found - truth).abs());
        relative(differences, reference.force_unit)
    };
    let stress_error = |found: &Answer| {
        // Where the reference is infinite, nothing is a finite error.
        let known = found.shears.iter().zip(&truth.shears).filter_map(|(found, truth)| Some((found, (*truth)?)));
        let differences = known.map(|(found, truth)| found.map_or(f64::INFINITY, |found| (found - truth).abs()));
        relative(differences, reference.stress_unit)
    };
    Ok(AccuracyRow {
        solver,
        force_error: found.and_then(force_error),
        stress_error: found.and_then(stress_error),
        estimated_force_error: found.and_then(|found| finite(found.estimate.force_error)),
        estimated_stress_error: found.and_then(|found| finite(found.estimate.stress_error)),
        steps: None,
        work_error: None,
        compute_time: found.map_or_else(|| begin.elapsed().as_secs_f64(), |found| found.time),
        refused,
    })
}

/// The largest of the differences over a unit; zero where all are, whatever the unit.
pub(super) fn relative(differences: impl Iterator<Item = f64>, unit: f64) -> Option<f64> {
    let largest = differences.fold(0.0, f64::max);
    finite(if largest > 0.0 { largest / unit } else { 0.0 })
}

/// The answer of rings, as of any solver but for the repetitions.
fn by_rings(count: usize, task: &Task<'_>) -> Result<Answer, Failure> {
    let Comparison { setup, plan, .. } = task.comparison;
    let begin = Instant::now();
    let start = contact(setup.clone(), "/contact")?;
    let in_plane = |step: mechanics::Move| rings::PlanarMove {
        tangential: step.tangential.and_then(|target| match target {
            Tangential::Displacement(to) => Some(rings::PlanarTarget::Displacement([to, 0.0])),
            Tangential::Force(to) => Some(rings::PlanarTarget::Force([to, 0.0])),
            // A comparison with a twist has been refused.
            Tangential::Twist(_) | Tangential::Torque(_) => None,
        }),
        normal: step.normal,
        relative: step.relative,
    };
    let moves: Vec<_> = cycle_moves(plan, &start)?.into_iter().map(in_plane).collect();
    let options = rings::Options { count: Some(count), tolerance: RINGS_TOLERANCE };
    let solution =
        rings::follow(setup.clone(), &moves, &options, &|| task.stop.check().is_ok()).map_err(|refusal| {
            let at = refusal.index.map_or_else(|| "/contact".to_owned(), |index| plan.place_of(index, None));
            Failure::at(at, refusal.error).unless_interrupted(task.stop, "")
        })?;
    let radii = task.sampling.places(false, solution.pressed().contact_radius());
    let shears = solution.shears(&radii).into_iter().map(|shear| finite(shear[0])).collect();
    let estimate =
        ErrorEstimate { force_error: solution.force_error(), path_error: 0.0, stress_error: solution.stress_error() };
    let forces = solution.states.iter().map(|state| state.force[0]).collect();
    Ok(Answer { forces, shears, estimate, time: begin.elapsed().as_secs_f64() })
}

fn answer<S: Solver>(start: impl Fn() -> Result<S, Failure>, task: &Task<'_>) -> Result<Answer, Failure> {
    let Comparison { plan, tolerance, .. } = task.comparison;
    let run = || {
        let mut solver = start()?;
        let (mut forces, mut path_error) = (Vec::with_capacity(plan.length()), 0.0f64);
        follow(&mut solver, plan, task.protocol, *tolerance, task.stop, |_, solver: &S| {
            path_error = path_error.max(solver.path_error());
            forces.push(solver.state().force);
        })?;
        let shears = stresses(&solver, task.sampling, task.stop)?.shear.unwrap_or_default();
        let mut estimate = solver.accuracy(&|| task.stop.check().is_ok());
        estimate.force_error += path_error - estimate.path_error;
        task.stop.check()?;
        Ok((forces, shears, estimate))
    };
    let ((forces, shears, estimate), time) = repeated(run)?;
    Ok(Answer { forces, shears, estimate, time })
}

/// What a solver finds, and the median time of its runs, s.
pub(super) fn repeated<T>(run: impl Fn() -> Result<T, Failure>) -> Result<(T, f64), Failure> {
    let (begin, mut times) = (Instant::now(), Vec::with_capacity(MAX_RUNS));
    loop {
        let start = Instant::now();
        let found = run()?;
        times.push(start.elapsed().as_secs_f64());
        if times.len() == MAX_RUNS || begin.elapsed() >= REPEAT_UNTIL {
            times.sort_by(f64::total_cmp);
            return Ok((found, times[times.len() / 2]));
        }
    }
}
