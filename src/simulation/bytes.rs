//! Estimates of the memory that a request takes; rather too many bytes than too few.

use stickslip_wire::simulate::Simulation;
use stickslip_wire::subsurface::SubsurfaceTask;
use stickslip_wire::{self as wire, Plan, Solver, Steps};

/// Bytes that a byte of a long body or definition may become while it is parsed: a point of a table is a few digits,
/// and then a series.
pub const EXPANSION: usize = 100;
/// One move while it is made, and the piece of slip history that it leaves.
pub(crate) const MOVE_BYTES: usize = 256;
/// One state in a reply, and as JSON in a text that grows by doubling.
pub(crate) const STATE_BYTES: usize = 768;
/// One move on its way to the store.
pub(crate) const RECORD_BYTES: usize = 512;
/// One radius with all fields, likewise.
const RADIUS_BYTES: usize = 320;
/// One point of a table: its two numbers, and the series that the mechanics makes between it and the next. The process
/// grows by 2700 to 3800.
const POINT_BYTES: usize = 4_096;
/// One asperity: its numbers twice, and its share of the clusters.
const ASPERITY_BYTES: usize = 128;
/// One point of a load curve: its numbers, and two pieces of the curve with their moments.
const CURVE_POINT_BYTES: usize = 512;
/// One point of a table written as JSON, in a text that grows by doubling.
pub const WRITTEN_POINT_BYTES: usize = 128;
/// One spring.
pub(crate) const SPRING_BYTES: usize = 64;
/// A number as JSON, with its comma.
pub(crate) const NUMBER_LENGTH: usize = 24;
/// A state as JSON.
pub(crate) const STATE_LENGTH: usize = 512;

/// Bytes that stresses at this many radii take, as numbers and as JSON.
#[must_use]
pub fn of_stress(radii: usize) -> usize {
    radii * RADIUS_BYTES
}

/// Bytes of moves: themselves, the slip history that they leave, and the states after them if they are requested.
pub(crate) fn of_moves(plan: &Plan, steps: Steps) -> usize {
    let shown = if steps == Steps::All { STATE_BYTES } else { 0 };
    plan.length() * (MOVE_BYTES + shown)
}

/// Bytes that a shape takes: the series that the mechanics makes of tables, the clusters of asperities.
#[must_use]
pub fn of_shape(profile: &wire::Profile) -> usize {
    match profile {
        wire::Profile::Tabulated(table) => table.r.len() * POINT_BYTES,
        wire::Profile::Sum(sum) => sum.parts.iter().map(of_shape).sum(),
        wire::Profile::Asperities(asperities) => asperities.gaps.len() * ASPERITY_BYTES,
        wire::Profile::LoadCurve(curve) => curve.indentation.len() * CURVE_POINT_BYTES,
        _ => 0,
    }
}

/// Bytes that a simulation takes, with its reply; rather too many than too few.
#[must_use]
pub fn of_simulation(simulation: &Simulation) -> usize {
    let radii = simulation.stress.as_ref().map_or(0, |stress| stress.length());
    let springs = match simulation.solver {
        Some(Solver::Springs(springs)) => springs.count * SPRING_BYTES,
        _ => 0,
    };
    of_moves(&simulation.plan, simulation.steps)
        + of_stress(radii)
        + of_shape(&simulation.definition.profile)
        + simulation.subsurface.as_ref().map_or(0, of_subsurface)
        + springs
}

/// Bytes that stresses below the surface take, with their reply.
#[must_use]
pub fn of_subsurface(task: &SubsurfaceTask) -> usize {
    task.places.count() * task.columns() * (size_of::<Option<f64>>() + 2 * NUMBER_LENGTH)
}
