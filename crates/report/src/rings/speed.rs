//! Speed against error of rings: of a whole path to a tolerance, and of steps one by one.

use std::f64::consts::{PI, TAU};
use std::fmt::Write as _;

use stickslip_mechanics::rings::{PlanarBuffers, PlanarLaw, Solution};
use stickslip_mechanics::{Contact, Error, Move, Normal, Preload, Tangential};

use super::{LIMIT, sphere, turn_losses, two_turns};
use crate::benchmark::processor_time;

/// Radius of the circle over the displacement of gross slip.
const RADIUS: f64 = 0.6;
/// Losses of both turns by an independent prototype in NumPy.
const KNOWN: [f64; 2] = [0.4337, 0.5556];
/// States of a turn that are compared.
const PER_TURN: usize = 256;
const RINGS: [usize; 5] = [10, 20, 40, 80, 160];
const TOLERANCES: [f64; 3] = [1e-2, 1e-3, 1e-4];
/// Those of the reference.
const FINEST: (usize, f64) = (160, 1e-5);
const STEPS: [usize; 4] = [16, 32, 64, 256];
const STEPS_OF_IMPACT: [usize; 3] = [50, 200, 800];
/// The rings from which on steps one by one take too long for a particle code.
const FEW: usize = 80;
const RUNS: usize = 3;

pub(super) fn report() -> Result<String, Error> {
    let reference = two_turns([RADIUS; 2], 0.0, PER_TURN, Some(FINEST.0), FINEST.1)?;
    let [first, second] = turn_losses(&reference, PER_TURN);
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        "# Speed against error of rings\n\nTwo turns of a circle of {RADIUS} u_max on a sphere. Errors are relative to \
         μ F_N for forces, the largest along the path, and to μ F_N u_max for the friction work of a turn. The \
         reference has {} rings and a tolerance of {:e}; its turns lose {first:.5} and {second:.5} ({} and {} by an \
         independent prototype). Times are processor times of one thread: read the ratios, not the seconds.\n\n\
         ## Whole paths\n\n`rings::follow`, in 16 moves a turn; the tolerance chooses the steps.\n\n\
         | rings | tolerance | steps | force error | stated | work of turn 1 | work of turn 2 | stated | time, ms |\n\
         |---|---|---|---|---|---|---|---|---|",
        FINEST.0, FINEST.1, KNOWN[0], KNOWN[1]
    );
    for (count, tolerance) in RINGS.into_iter().flat_map(|count| TOLERANCES.map(|tolerance| (count, tolerance))) {
        whole_path(&mut text, &reference, count, tolerance)?;
    }
    let _ = writeln!(
        text,
        "\n## Steps one by one\n\n`rings::PlanarLaw`, which `stickslip.PlanarContacts` has of its own.\n\n| rings | \
         steps a turn | force error | work of turn 1 | work of turn 2 | a step, µs |\n|---|---|---|---|---|---|"
    );
    for (count, steps) in few_rings().flat_map(|count| STEPS.map(|steps| (count, steps))) {
        circle(&mut text, &reference, count, steps)?;
    }
    let _ = writeln!(
        text,
        "\n## Impacts\n\nThe same steps where the contact grows from nothing, shrinks and parts, along a line: \
         indentation d sin(π t), displacement u_max/2 sin(3.4 π t). The reference is the exact law, and forces are \
         relative to μ F_N at d.\n\n| rings | steps | force error | work, relative | a step, µs |\n\
         |---|---|---|---|---|"
    );
    for (count, steps) in few_rings().flat_map(|count| STEPS_OF_IMPACT.map(|steps| (count, steps))) {
        impact(&mut text, count, steps)?;
    }
    Ok(text)
}

fn few_rings() -> impl Iterator<Item = usize> {
    RINGS.into_iter().filter(|count| *count <= FEW)
}

fn whole_path(text: &mut String, reference: &Solution, count: usize, tolerance: f64) -> Result<(), Error> {
    let per_turn = STEPS[0];
    let (solution, time) = timed(|| two_turns([RADIUS; 2], 0.0, per_turn, Some(count), tolerance))?;
    let states = solution.states.iter().zip(reference.states.iter().step_by(PER_TURN / per_turn));
    let error = states.map(|(state, known)| distance(state.force, known.force) / LIMIT).fold(0.0, f64::max);
    let [first, second] = work_errors(turn_losses(&solution, per_turn), reference);
    let (steps, stated, work) = (solution.steps, solution.force_error(), solution.work_error);
    let _ = writeln!(
        text,
        "| {count} | {tolerance:e} | {steps} | {error:.1e} | {stated:.1e} | {first:.1e} | {second:.1e} | {work:.1e} | \
         {:.2} |",
        1e3 * time
    );
    Ok(())
}

fn circle(text: &mut String, reference: &Solution, count: usize, per_turn: usize) -> Result<(), Error> {
    let law = PlanarLaw::new(sphere(Preload::Indentation(1.0))?, count)?;
    let place = |index: usize| {
        let angle = TAU * index as f64 / per_turn as f64;
        [RADIUS * angle.cos(), RADIUS * angle.sin()]
    };
    let (states, time) = timed(|| {
        let (mut contact, mut buffers) = (law.start(), PlanarBuffers::default());
        let step = |index| {
            law.step(&mut contact, Normal::Indentation(1.0), place(index), &mut buffers)?;
            Ok(contact.state())
        };
        (0..=2 * per_turn).map(step).collect::<Result<Vec<_>, Error>>()
    })?;
    let pairs = states.iter().zip(reference.states.iter().step_by(PER_TURN / per_turn));
    let error = pairs.map(|(state, known)| distance(state.force, known.force) / LIMIT).fold(0.0, f64::max);
    let lost =
        |turn: usize| states[(turn + 1) * per_turn].dissipated_energy - states[turn * per_turn].dissipated_energy;
    let [first, second] = work_errors([0, 1].map(|turn| lost(turn) / LIMIT), reference);
    let time = 1e6 * time / states.len() as f64;
    let _ = writeln!(text, "| {count} | {per_turn} | {error:.1e} | {first:.1e} | {second:.1e} | {time:.0} |");
    Ok(())
}

fn impact(text: &mut String, count: usize, steps: usize) -> Result<(), Error> {
    let setup = sphere(Preload::Indentation(0.0))?;
    let law = PlanarLaw::new(setup.clone(), count)?;
    let path = |index: usize| {
        let part = index as f64 / steps as f64;
        let depth = if index == steps { -0.01 } else { (PI * part).sin() };
        (depth, 0.5 * (1.7 * TAU * part).sin())
    };
    let (states, time) = timed(|| {
        let (mut contact, mut buffers) = (law.start(), PlanarBuffers::default());
        let step = |index| {
            let (depth, along) = path(index);
            law.step(&mut contact, Normal::Indentation(depth), [0.6 * along, 0.8 * along], &mut buffers)?;
            Ok(contact.state())
        };
        (1..=steps).map(step).collect::<Result<Vec<_>, Error>>()
    })?;
    let mut exact = Contact::new(setup)?;
    let (mut error, mut work) = (0.0_f64, 0.0);
    for (index, state) in (1..).zip(states) {
        let (depth, along) = path(index);
        let tangential = Some(Tangential::Displacement(along));
        exact.apply(&Move { tangential, normal: Some(Normal::Indentation(depth)), relative: false })?;
        error = error.max(distance(state.force, [0.6 * exact.force(), 0.8 * exact.force()]) / LIMIT);
        work = state.dissipated_energy / exact.state().dissipated_energy - 1.0;
    }
    let _ = writeln!(text, "| {count} | {steps} | {error:.1e} | {work:.1e} | {:.0} |", 1e6 * time / steps as f64);
    Ok(())
}

/// How far both turns are off.
fn work_errors(found: [f64; 2], reference: &Solution) -> [f64; 2] {
    let known = turn_losses(reference, PER_TURN);
    [0, 1].map(|turn| found[turn] - known[turn])
}

/// A result, and the least processor time of a few runs, s.
fn timed<T>(run: impl Fn() -> Result<T, Error>) -> Result<(T, f64), Error> {
    let timed = || {
        let begin = processor_time();
        Ok((run()?, processor_time() - begin))
    };
    let (found, mut least) = timed()?;
    for _ in 1..RUNS {
        least = least.min(timed()?.1);
    }
    Ok((found, least))
}

fn distance(one: [f64; 2], other: [f64; 2]) -> f64 {
    (one[0] - other[0]).hypot(one[1] - other[1])
}
