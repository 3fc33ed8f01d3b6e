//! Estimates of the memory that a request takes; rather too many bytes than too few.
//!
//! All of them are sums of a few classes. `cargo test --test service largest_requests -- --nocapture` prints what the
//! largest request of each endpoint takes.

use stickslip_wire::Solver;
use stickslip_wire::subsurface::SubsurfaceTask;

use crate::prelude::*;

/// Bytes that a byte of a file or of a JSON value takes once it is read: a short number with its separator, as a cell,
/// in a column and as JSON. That of a body is [`PARSED`](stickslip_wire::Document::PARSED).
pub const READ: usize = 32;
/// A number of a reply: itself, perhaps in two documents, and its text, which grows by doubling.
pub const NUMBER: usize = 64;
/// A row of a few numbers that are computed with: a move and the slip history that it leaves, a point of a measurement
/// and its row in a fit, an asperity and its share of the clusters.
pub const ROW: usize = 256;
/// A spring.
pub const SPRING: usize = 2 * NUMBER;
/// An object of a reply, such as a state: itself, and its text, which grows by doubling.
pub const OBJECT: usize = 1_024;
/// A place in depth with all its stresses as a row of a table.
pub const PLACE_ROW: usize = 10 * NUMBER;
/// A point of a table, with the series that the mechanics makes between it and the next. The process grows by 2700 to
/// 3800.
pub const SERIES: usize = 4_096;
/// What an optimisation takes, whatever its size.
pub const WORKSPACE: usize = 4 * 1024 * 1024;

/// A number as JSON, with its comma.
pub const NUMBER_LENGTH: usize = 24;
/// Springs with memory, and each term of theirs.
const MEMORY_SPRINGS: usize = 1_536 * 2 * 8;
/// A state as JSON.
pub const STATE_LENGTH: usize = 512;

/// Bytes that stresses at this many radii take, as numbers and as JSON.
pub fn of_stress(radii: usize) -> usize {
    // The radius, and four fields.
    radii * 5 * NUMBER
}

/// Bytes of moves: themselves, the slip history that they leave, and the states after them if they are requested.
pub fn of_moves(plan: &Plan, steps: Steps) -> usize {
    let shown = if steps == Steps::All { OBJECT } else { 0 };
    plan.length() * (ROW + shown)
}

/// Bytes of moves on their way to the store.
pub fn of_records(moves: usize) -> usize {
    moves * 2 * ROW
}

/// Bytes that a shape takes: the series that the mechanics makes of tables, the clusters of asperities.
pub fn of_shape(profile: &wire::Profile) -> usize {
    match profile {
        wire::Profile::Tabulated(table) => table.r.len() * SERIES,
        wire::Profile::Sum(sum) => sum.parts.iter().map(of_shape).sum(),
        wire::Profile::Asperities(asperities) => asperities.gaps.len() * ROW,
        // Two pieces of the curve with their moments.
        wire::Profile::LoadCurve(curve) => curve.indentation.len() * 2 * ROW,
        _ => 0,
    }
}

/// Bytes of the definition of a contact as JSON, of which the profile has so many points.
pub fn of_definition(points: usize) -> usize {
    points * 2 * NUMBER
}

/// Bytes that a simulation takes, with its reply; rather too many than too few.
pub fn of_simulation(simulation: &Simulation) -> usize {
    let radii = simulation.stress.as_ref().map_or(0, |stress| stress.length());
    let springs = match simulation.solver {
        Some(Solver::Springs(springs)) => springs.count * SPRING,
        _ => 0,
    };
    // A contact, the one that a step begins with, and the one that a move begins with.
    let memory = simulation.definition.prony.as_ref().map_or(0, |terms| 3 * MEMORY_SPRINGS * (1 + terms.len()));
    of_moves(&simulation.plan, simulation.steps)
        + memory
        + of_stress(radii)
        + of_shape(&simulation.definition.profile)
        + simulation.subsurface.as_ref().map_or(0, of_subsurface)
        + springs
}

/// Bytes that stresses below the surface take, with their reply.
pub fn of_subsurface(task: &SubsurfaceTask) -> usize {
    task.places.count() * task.columns() * NUMBER
}
