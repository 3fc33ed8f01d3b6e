//! Motion in the plane: what rings cost and how wrong they are, and what a turn of an ellipse loses.

mod losses;

use std::f64::consts::{PI, TAU};
use std::fs;
use std::path::Path;

use stickslip_mechanics::rings::{
    EllipseArc, Options, PlanarBuffers, PlanarLaw, PlanarMove, PlanarState, PlanarTarget, Solution, follow,
};
use stickslip_mechanics::{Contact, Elasticity, Error, Move, Normal, Preload, Profile, Setup, Sphere, Tangential};

use crate::report::{Failure, table, timed};

/// Depth and displacement of gross slip are 1, mu F_N is 4/3: results hold for every sphere in these units.
pub const LIMIT: f64 = 4.0 / 3.0;
/// Radius of the circle over the displacement of gross slip.
const RADIUS: f64 = 0.6;
/// Losses of both turns by an independent prototype in NumPy.
const KNOWN: [f64; 2] = [0.4337, 0.5556];
/// States of a turn that are compared, and those of a turn that is followed as a whole.
const PER_TURN: usize = 256;
const FEW_PER_TURN: usize = 16;
const RINGS: [usize; 5] = [10, 20, 40, 80, 160];
const TOLERANCES: [f64; 3] = [1e-2, 1e-3, 1e-4];
/// Those of the reference.
const FINEST: (usize, f64) = (160, 1e-5);
const STEPS: [usize; 4] = [16, 32, 64, 256];
const STEPS_OF_IMPACT: [usize; 3] = [50, 200, 800];
/// The rings from which on steps one by one take too long for a particle code.
const FEW: usize = 80;
const RUNS: usize = 3;
/// The columns of the tables.
const WHOLE: &str =
    "rings | tolerance | steps | force error | stated | work of turn 1 | work of turn 2 | stated | time, ms";
const ONE_BY_ONE: &str = "rings | steps a turn | force error | work of turn 1 | work of turn 2 | a step, µs";
const IMPACTS: &str = "rings | steps | force error | work, relative | a step, µs";

/// Writes `rings.md` into `dir`, which is created if it does not exist.
pub fn write(dir: &Path) -> Result<(), Failure> {
    let reference = two_turns([RADIUS; 2], 0.0, PER_TURN, Some(FINEST.0), FINEST.1)?;
    let [first, second] = turn_losses(&reference.states, PER_TURN);
    let few = || RINGS.into_iter().filter(|count| *count <= FEW);
    let whole = RINGS.into_iter().flat_map(|count| TOLERANCES.map(|tolerance| (count, tolerance)));
    let whole = whole.map(|(count, tolerance)| whole_path(&reference, count, tolerance));
    let steps = few().flat_map(|count| STEPS.map(|steps| circle(&reference, count, steps)));
    let impacts = few().flat_map(|count| STEPS_OF_IMPACT.map(|steps| impact(count, steps)));
    let page = format!(
        "# Speed against error of rings\n\nTwo turns of a circle of {RADIUS} u_max on a sphere. Errors are relative to \
         μ F_N for forces, the largest along the path, and to μ F_N u_max for the friction work of a turn. The \
         reference has {} rings and a tolerance of {:e}; its turns lose {first:.5} and {second:.5} ({} and {} by an \
         independent prototype). Times are processor times of one thread: read the ratios, not the seconds.\n\n\
         ## Whole paths\n\n`rings::follow`, in {FEW_PER_TURN} moves a turn; the tolerance chooses the steps.\n\n{}\n\
         ## Steps one by one\n\n`rings::PlanarLaw`, which `stickslip.PlanarContacts` has of its own.\n\n{}\n\
         ## Impacts\n\nThe same steps where the contact grows from nothing, shrinks and parts, along a line: \
         indentation d sin(π t), displacement u_max/2 sin(3.4 π t). The reference is the exact law, and forces are \
         relative to μ F_N at d.\n\n{}\n\
         ## Ellipses\n\nThe friction work of a steady turn, over μ F_N u_max, by the amplitude a, the ratio of the \
         radii and the phase, to {:e}.\n\n{}",
        FINEST.0,
        FINEST.1,
        KNOWN[0],
        KNOWN[1],
        table(WHOLE, whole.collect::<Result<Vec<_>, _>>()?),
        table(ONE_BY_ONE, steps.collect::<Result<Vec<_>, _>>()?),
        table(IMPACTS, impacts.collect::<Result<Vec<_>, _>>()?),
        losses::TOLERANCE,
        losses::losses()?
    );
    fs::create_dir_all(dir)?;
    Ok(fs::write(dir.join("rings.md"), page)?)
}

fn sphere(preload: Preload) -> Result<Setup, Error> {
    Ok(Setup {
        profile: Profile::Sphere(Sphere::new(1.0)?),
        elasticity: Elasticity::effective(1.0, 1.0)?,
        friction: 1.0,
        preload,
    })
}

/// Two turns round x = a cos t, y = b sin(t + phase), in so many moves each, after a move to their beginning.
pub fn two_turns(
    radii: [f64; 2],
    phase: f64,
    per_turn: usize,
    count: Option<usize>,
    tolerance: f64,
) -> Result<Solution, Error> {
    let to = |target| PlanarMove { tangential: Some(target), ..PlanarMove::default() };
    let turn = |index: usize| index as f64 / per_turn as f64;
    let arc = |index: usize| EllipseArc { radii, phase, turns: [turn(index), turn(index + 1)] };
    let begin = to(PlanarTarget::Displacement(EllipseArc { radii, phase, turns: [0.0; 2] }.at(0.0)));
    let arcs = (0..2 * per_turn).map(|index| to(PlanarTarget::Arc(arc(index))));
    let moves: Vec<PlanarMove> = std::iter::once(begin).chain(arcs).collect();
    let solution = follow(sphere(Preload::Indentation(1.0))?, &moves, &Options { count, tolerance }, &|| true);
    solution.map_err(|refusal| refusal.error)
}

/// The friction work of both turns over mu F_N u_max.
fn turn_losses(states: &[PlanarState], per_turn: usize) -> [f64; 2] {
    let at = |turn: usize| states[turn * per_turn].dissipated_energy;
    [0, 1].map(|turn| (at(turn + 1) - at(turn)) / LIMIT)
}

/// Errors of two turns: the largest of the force, and those of the friction work of each turn.
fn errors(states: &[PlanarState], per_turn: usize, reference: &Solution) -> (f64, [f64; 2]) {
    let pairs = states.iter().zip(reference.states.iter().step_by(PER_TURN / per_turn));
    let force = pairs.map(|(state, known)| distance(state.force, known.force)).fold(0.0, f64::max);
    let (found, known) = (turn_losses(states, per_turn), turn_losses(&reference.states, PER_TURN));
    (force, [0, 1].map(|turn| found[turn] - known[turn]))
}

fn whole_path(reference: &Solution, count: usize, tolerance: f64) -> Result<String, Error> {
    let (solution, time) = least(|| two_turns([RADIUS; 2], 0.0, FEW_PER_TURN, Some(count), tolerance))?;
    let (error, [first, second]) = errors(&solution.states, FEW_PER_TURN, reference);
    let (steps, stated, work) = (solution.steps, solution.force_error(), solution.work_error);
    Ok(format!(
        "| {count} | {tolerance:e} | {steps} | {error:.1e} | {stated:.1e} | {first:.1e} | {second:.1e} | {work:.1e} | \
         {:.2} |",
        1e3 * time
    ))
}

fn circle(reference: &Solution, count: usize, per_turn: usize) -> Result<String, Error> {
    let path = |index: usize| {
        let angle = TAU * index as f64 / per_turn as f64;
        (1.0, [RADIUS * angle.cos(), RADIUS * angle.sin()])
    };
    let (states, time) = step_by_step(Preload::Indentation(1.0), count, (0..=2 * per_turn).map(path))?;
    let (error, [first, second]) = errors(&states, per_turn, reference);
    Ok(format!("| {count} | {per_turn} | {error:.1e} | {first:.1e} | {second:.1e} | {time:.0} |"))
}

fn impact(count: usize, steps: usize) -> Result<String, Error> {
    let path = |index: usize| {
        let part = index as f64 / steps as f64;
        let depth = if index == steps { -0.01 } else { (PI * part).sin() };
        (depth, 0.5 * (1.7 * TAU * part).sin())
    };
    let path = (1..=steps).map(path);
    let in_plane = path.clone().map(|(depth, along)| (depth, [0.6 * along, 0.8 * along]));
    let (states, time) = step_by_step(Preload::Indentation(0.0), count, in_plane)?;
    let mut exact = Contact::new(sphere(Preload::Indentation(0.0))?)?;
    let (mut error, mut work) = (0.0_f64, 0.0);
    for ((depth, along), state) in path.zip(states) {
        let tangential = Some(Tangential::Displacement(along));
        exact.apply(&Move { tangential, normal: Some(Normal::Indentation(depth)), ..Move::default() })?;
        error = error.max(distance(state.force, [0.6 * exact.force(), 0.8 * exact.force()]));
        work = state.dissipated_energy / exact.state().dissipated_energy - 1.0;
    }
    Ok(format!("| {count} | {steps} | {error:.1e} | {work:.1e} | {time:.0} |"))
}

/// The states along a path of indentations and displacements, and the time of a step, µs.
fn step_by_step(
    preload: Preload,
    count: usize,
    path: impl Iterator<Item = (f64, [f64; 2])> + Clone,
) -> Result<(Vec<PlanarState>, f64), Error> {
    let law = PlanarLaw::new(sphere(preload)?, count)?;
    let (states, time) = least(|| {
        let (mut contact, mut buffers) = (law.start(), PlanarBuffers::default());
        let step = |(depth, place)| {
            law.step(&mut contact, Normal::Indentation(depth), place, &mut buffers)?;
            Ok(contact.state())
        };
        path.clone().map(step).collect::<Result<Vec<_>, Error>>()
    })?;
    let steps = states.len() as f64;
    Ok((states, 1e6 * time / steps))
}

/// A result, and the least processor time of a few runs, s.
fn least<T>(run: impl Fn() -> Result<T, Error>) -> Result<(T, f64), Error> {
    let (found, mut least) = timed(&run);
    for _ in 1..RUNS {
        least = least.min(timed(&run).1);
    }
    Ok((found?, least))
}

/// Between two forces, over mu F_N.
fn distance(one: [f64; 2], other: [f64; 2]) -> f64 {
    (one[0] - other[0]).hypot(one[1] - other[1]) / LIMIT
}
