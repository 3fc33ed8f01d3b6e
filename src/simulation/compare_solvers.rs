//! The same path with several solvers, each compared with a reference.
//!
//! Every solver runs exactly as in [`super::simulate`], so that its numbers are those of a simulation. Where all moves
//! of the path have an exact solution, the reference is the exact solver. Where some are curved, it is the exact solver
//! again, held to a smaller tolerance.

use std::time::{Duration, Instant};

use stickslip_mechanics::{Contact, ErrorEstimate};
use stickslip_wire::reply::finite;
use stickslip_wire::{
    AccuracyReply, AccuracyRow, Comparison, Fault, Fields, Points, Protocol, Reference, Sampling, Solver as Named,
    SolverKind, limits,
};

use super::run::{contact, equal_peaks, follow, spring_foundation, stresses};
use super::{Failure, Solver};
use crate::admission::Stop;

/// The reference is held to this part of the tolerance: some two and a half times the chords, with a
/// sixteenth of the error of their forces and a quarter of that of their stresses.
const REFERENCE_TOLERANCE: f64 = 1.0 / 16.0;
/// A solver runs again, for the median of the times, until its runs together have taken this long.
const REPEAT_UNTIL: Duration = Duration::from_millis(5);
/// The most runs of one solver.
const MAX_RUNS: usize = 9;

/// Why the reference is exact enough.
const REASON_EXACT: &str =
    "every move of this path has an exact solution: what is left is rounding, or the points of a table";
const REASON_REFINED: &str = "the exact solver, held to a sixteenth of the tolerance where moves are curved";
const REASON_UNREFINED: &str =
    "the exact solver, held to the tolerance where moves are curved: a smaller one needs too long a slip history";

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
    sampling: &'a Sampling,
    stop: &'a Stop,
}

/// Runs every solver of a comparison.
///
/// # Errors
/// [`Failure`] if the reference has no answer, or the client hung up. A solver that cannot follow the path is refused
/// in its row.
pub fn compare_solvers(comparison: &Comparison, stop: &Stop) -> Result<AccuracyReply, Failure> {
    let Comparison { setup, plan, tolerance, .. } = comparison;
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
            Err(Failure::MemoryFull { .. }) => (follows(*tolerance), REASON_UNREFINED),
            refined => (refined, REASON_REFINED),
        }
    };
    let (truth, forces, unit) = followed?;
    let radii = comparison.sampling.radii(truth.contact_radius());
    let fields = Fields { pressure: false, shear: true, slip: false, displacement: false };
    let sampling = Sampling { points: Points::Radii(radii), fields };
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
        Named::Springs(springs) => answer(|| spring_foundation(setup, plan, springs.count), task),
    };
    let found = match found {
        Ok(found) => found,
        Err(Failure::Refused { pointer, error }) => {
            return Ok(AccuracyRow {
                solver,
                force_error: None,
                stress_error: None,
                estimated_force_error: None,
                estimated_stress_error: None,
                compute_time: begin.elapsed().as_secs_f64(),
                refused: Some(Fault { pointer, detail: error.to_string() }),
            });
        }
        Err(failure) => return Err(failure),
    };
    let forces = found.forces.iter().zip(&truth.forces).map(|(found, truth)| (found - truth).abs());
    // Where the reference is infinite, nothing is a finite error.
    let stresses = found
        .shears
        .iter()
        .zip(&truth.shears)
        .filter_map(|(found, truth)| truth.map(|truth| found.map_or(f64::INFINITY, |found| (found - truth).abs())));
    Ok(AccuracyRow {
        solver,
        force_error: relative(forces, reference.force_unit),
        stress_error: relative(stresses, reference.stress_unit),
        estimated_force_error: finite(found.estimate.force_error),
        estimated_stress_error: finite(found.estimate.stress_error),
        compute_time: found.time,
        refused: None,
    })
}

/// The largest of the differences over a unit; zero where all are, whatever the unit.
fn relative(differences: impl Iterator<Item = f64>, unit: f64) -> Option<f64> {
    let largest = differences.fold(0.0, f64::max);
    finite(if largest > 0.0 { largest / unit } else { 0.0 })
}

fn answer<S: Solver>(start: impl Fn() -> Result<S, Failure>, task: &Task<'_>) -> Result<Answer, Failure> {
    let (begin, mut times) = (Instant::now(), Vec::with_capacity(MAX_RUNS));
    loop {
        let mut found = once(&start, task)?;
        times.push(found.time);
        if times.len() == MAX_RUNS || begin.elapsed() >= REPEAT_UNTIL {
            times.sort_by(f64::total_cmp);
            found.time = times[times.len() / 2];
            return Ok(found);
        }
    }
}

fn once<S: Solver>(start: impl Fn() -> Result<S, Failure>, task: &Task<'_>) -> Result<Answer, Failure> {
    let Comparison { plan, tolerance, .. } = task.comparison;
    let begin = Instant::now();
    let mut solver = start()?;
    let mut forces = Vec::with_capacity(plan.length());
    follow(&mut solver, plan, task.protocol, *tolerance, task.stop, |_, solver: &S| forces.push(solver.state().force))?;
    let shears = stresses(&solver, task.sampling, task.stop)?.shear.unwrap_or_default();
    let estimate = solver.accuracy();
    Ok(Answer { forces, shears, estimate, time: begin.elapsed().as_secs_f64() })
}
