//! `accuracy` in the plane: rings of each number, compared with more of them in smaller steps.

use std::time::Instant;

use stickslip_mechanics::range::RING_COUNT;
use stickslip_mechanics::rings::{self, Options, Solution};
use stickslip_wire::plane::PlanarPlan;
use stickslip_wire::simulate::{LEAST_RINGS_TOLERANCE, Rings};
use stickslip_wire::{AccuracyReply, AccuracyRow, Comparison, Reference, Solver as Named};

use super::accuracy::{relative, repeated};
use crate::computations::prelude::*;
use crate::simulation::follow_in_plane;

/// The rings of the reference over the most of the rows, within [`RING_COUNT`].
const MORE_RINGS: usize = 2;
/// The tolerance of the reference over that of the rows, at least [`LEAST_RINGS_TOLERANCE`].
const REFERENCE_TOLERANCE: f64 = 0.25;

const REASON: &str = "twice as many rings as the most of the rows (at most 160), held to a quarter of the tolerance: \
                      `force_error` is what it states itself";

/// How the reference follows the path, and each of the rows.
pub(super) fn every(task: &Comparison) -> impl Iterator<Item = Options> + '_ {
    std::iter::once(reference_of(task)).chain(task.rings().map(|count| of_row(count, task)))
}

fn reference_of(task: &Comparison) -> Options {
    let most = RING_COUNT.max as usize;
    let count = MORE_RINGS * task.rings().max().unwrap_or(most);
    let tolerance = (REFERENCE_TOLERANCE * task.tolerance).max(LEAST_RINGS_TOLERANCE);
    Options { count: Some(count.min(most)), tolerance }
}

fn of_row(count: usize, task: &Comparison) -> Options {
    Options { count: Some(count), tolerance: task.tolerance }
}

/// Follows the path by the rings of each row.
pub(super) fn compare(task: &Comparison, plane: &PlanarPlan, stop: &dyn Stop) -> Result<AccuracyReply, Failure> {
    let begin = Instant::now();
    let solve = |options: &Options| follow_in_plane(&task.setup, &task.plan, plane, options, stop);
    let truth = solve(&reference_of(task))?;
    let time = begin.elapsed().as_secs_f64();
    let pressed = truth.pressed();
    let radii = task.sampling.places(false, if pressed.indentation() > 0.0 { pressed.contact_radius() } else { 0.0 });
    let (friction, table) = (task.setup.friction, pressed.accuracy());
    let largest = |of: fn(&rings::PlanarState) -> f64, first: f64| truth.states.iter().map(of).fold(first, f64::max);
    let start = pressed.initial_summary();
    let load = largest(|state| state.normal_force, start.normal_force);
    let depth = largest(|state| state.indentation, start.indentation);
    let full = friction * pressed.elasticity().e_star() / pressed.elasticity().g_star() * depth;
    let unit_pressure = pressed.summary().unit_pressure();
    let shears = truth.shears(&radii);
    let compared: Vec<usize> = (0..radii.len()).filter(|index| is_finite(shears[*index])).collect();
    let reference = Reference {
        solver: SolverKind::Rings,
        reason: REASON.to_owned(),
        force_error: truth.force_error() + table.force_error,
        stress_error: truth.stress_error() + table.stress_error,
        compute_time: time,
        force_unit: friction * load,
        stress_unit: friction * if unit_pressure.is_finite() { unit_pressure } else { 0.0 },
        radii: compared.len(),
    };
    let work = |solution: &Solution| solution.states.last().map_or(0.0, |state| state.dissipated_energy);
    let row = |count: usize| -> Result<AccuracyRow, Failure> {
        let (found, time) = repeated(|| solve(&of_row(count, task)))?;
        let forces = found.states.iter().zip(&truth.states).map(|(one, other)| distance(one.force, other.force));
        let own = found.shears(&radii);
        let stresses = compared.iter().map(|index| distance(own[*index], shears[*index]));
        let work_error = relative(std::iter::once((work(&found) - work(&truth)).abs()), reference.force_unit * full);
        Ok(AccuracyRow {
            solver: Named::Rings(Rings { count }),
            force_error: relative(forces, reference.force_unit),
            stress_error: relative(stresses, reference.stress_unit),
            estimated_force_error: finite(found.force_error() + table.force_error),
            estimated_stress_error: finite(found.stress_error() + table.stress_error),
            steps: Some(found.steps),
            work_error,
            compute_time: time,
            refused: None,
        })
    };
    let rows: Result<_, Failure> = task.rings().map(row).collect();
    Ok(AccuracyReply { rows: rows?, reference })
}

fn distance(one: [f64; 2], other: [f64; 2]) -> f64 {
    (one[0] - other[0]).hypot(one[1] - other[1])
}

fn is_finite(vector: [f64; 2]) -> bool {
    vector.iter().all(|component| component.is_finite())
}
