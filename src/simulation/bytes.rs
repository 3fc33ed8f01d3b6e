//! Estimates of the memory that a request takes; rather too many bytes than too few.

use stickslip_mechanics as mechanics;
use stickslip_wire::cycle::CycleTask;
use stickslip_wire::fit::FitTask;
use stickslip_wire::fretting::FrettingTask;
use stickslip_wire::profile_fit::ProfileFitTask;
use stickslip_wire::protocol::ProtocolTask;
use stickslip_wire::session::Advance;
use stickslip_wire::simulate::Simulation;
use stickslip_wire::subsurface::SubsurfaceTask;
use stickslip_wire::{self as wire, Comparison, Plan, Solver, Steps, limits};

use super::cost::{ASSUMED_INSTANTS, reversals};

/// Bytes that a byte of a long body or definition may become while it is parsed: a point of a table is a few digits, and then a
/// series.
pub const EXPANSION: usize = 100;
/// Bytes of a fit with its reply, and for each of its points.
const SCAN_BYTES: usize = 4 * 1024 * 1024;
const SCAN_POINT_BYTES: usize = 256;
/// Bytes of a fit to loops with its reply, and for each of their points.
const FIT_BYTES: usize = 4 * 1024 * 1024;
const FIT_POINT_BYTES: usize = 256;
/// Bytes of such a fit for each of its points.
const FRICTION_POINT_BYTES: usize = 256;
/// Stresses that are held at once.
pub const STRESSES_HELD: usize = 500_000;
/// Bytes of the states of a cycle, which are held together.
pub const STATES_HELD: usize = 64 * 1024 * 1024;
/// Slip, shear stress and pressure at one place and instant.
const SURFACE_BYTES: usize = 32;
/// One reversal of a protocol in a reply: its displacement, and a peak for each of three laws, as JSON in a text that
/// grows by doubling.
const REVERSAL_BYTES: usize = 1_024;
/// One trial of a protocol with errors.
const SAMPLE_BYTES: usize = 16;
/// One move while it is made, and the piece of slip history that it leaves.
const MOVE_BYTES: usize = 256;
/// One state in a reply, and as JSON in a text that grows by doubling.
const STATE_BYTES: usize = 768;
/// One move on its way to the store.
const RECORD_BYTES: usize = 512;
/// One radius with all fields, likewise.
const RADIUS_BYTES: usize = 320;
/// One point of a table: its two numbers, and the series that the mechanics makes between it and the next. The process grows
/// by 2700 to 3800.
const POINT_BYTES: usize = 4_096;
/// One asperity: its numbers twice, and its share of the clusters.
const ASPERITY_BYTES: usize = 128;
/// One point of a load curve: its numbers, and two pieces of the curve with their moments.
const CURVE_POINT_BYTES: usize = 512;
/// One point of a table written as JSON, in a text that grows by doubling.
pub const WRITTEN_POINT_BYTES: usize = 128;
/// One spring.
const SPRING_BYTES: usize = 64;
/// One steady cycle as numbers, and as JSON in a text that grows by doubling.
const CYCLE_BYTES: usize = 1_536;
/// One harmonic, likewise.
const HARMONIC_BYTES: usize = 256;
/// The friction work per area at one radius, likewise.
const DENSITY_BYTES: usize = 128;
/// A number as JSON, with its comma.
const NUMBER_LENGTH: usize = 24;
/// A state as JSON.
const STATE_LENGTH: usize = 512;
/// The rest of a reply.
const REPLY_LENGTH: usize = 2_048;

/// Bytes that stresses at this many radii take, as numbers and as JSON.
#[must_use]
pub fn of_stress(radii: usize) -> usize {
    radii * RADIUS_BYTES
}

/// Bytes of moves: themselves, the slip history that they leave, and the states after them if they are requested.
fn of_moves(plan: &Plan, steps: Steps) -> usize {
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

/// Bytes of the reply to a simulation, rounded up.
#[must_use]
pub fn reply_length(simulation: &Simulation) -> usize {
    let states = if simulation.steps == Steps::All { simulation.plan.length() } else { 1 };
    let numbers = simulation.stress.as_ref().map_or(0, |stress| stress.length() * (1 + stress.fields.count()));
    let below = simulation.subsurface.as_ref().map_or(0, |task| task.places.count() * task.columns());
    REPLY_LENGTH + states * STATE_LENGTH + (numbers + below) * NUMBER_LENGTH
}

/// Bytes that moves of a session take, with their records and the reply; rather too many than too few.
#[must_use]
pub fn of_advance(advance: &Advance) -> usize {
    let radii = advance.stress.as_ref().map_or(0, |stress| stress.length());
    advance.relax.map_or(0, |relax| of_protocol(&relax.task))
        + of_moves(&advance.plan, advance.steps)
        + advance.plan.length() * RECORD_BYTES
        + of_stress(radii)
}

/// Bytes that a protocol takes, with its reply and, in a session, its moves.
#[must_use]
pub fn of_protocol(task: &ProtocolTask) -> usize {
    let most = reversals(task, *limits::PROTOCOL_REVERSALS.end());
    let tried = task.robustness.map_or(0, |robustness| robustness.samples);
    (most + 2) * (REVERSAL_BYTES + MOVE_BYTES + STATE_BYTES + RECORD_BYTES) + tried * SAMPLE_BYTES
}

/// Bytes that a comparison takes: one solver at a time, and a force a move of the reference and of that.
#[must_use]
pub fn of_comparison(comparison: &Comparison) -> usize {
    of_moves(&comparison.plan, Steps::Last)
        + 2 * size_of::<f64>() * comparison.plan.length()
        + 2 * of_stress(comparison.sampling.length())
        + of_shape(&comparison.definition.profile)
        + comparison.springs().max().unwrap_or(0) * SPRING_BYTES
}

/// Bytes that they take, with their reply.
#[must_use]
pub fn of_subsurface(task: &SubsurfaceTask) -> usize {
    task.places.count() * task.columns() * (size_of::<Option<f64>>() + 2 * NUMBER_LENGTH)
}

/// Bytes that they take, with their reply: a part of the stresses at once.
#[must_use]
pub fn of_fretting(task: &FrettingTask) -> usize {
    let columns = 3 + task.criteria.iter().flatten().count() + 3;
    let states = task.plan.length() * ASSUMED_INSTANTS;
    let path = size_of::<mechanics::Stress>() + 8 * 2 * NUMBER_LENGTH;
    task.places.count() * columns * (size_of::<mechanics::fatigue::Value>() + 2 * NUMBER_LENGTH)
        + (task.places.count() * states).min(STRESSES_HELD) * (size_of::<mechanics::Stress>() + SURFACE_BYTES)
        + task.stress_paths.len() * states * path
        + STATES_HELD
}

/// Bytes that steady cycles take, with their reply.
#[must_use]
pub fn of_cycle(task: &CycleTask) -> usize {
    let curve = task.best_load.map_or(0, |study| study.points.unwrap_or(0));
    let swept = task.response.as_ref().map_or(0, |asked| asked.frequencies.as_ref().map_or(200, Vec::len));
    task.rows() * (CYCLE_BYTES + task.harmonics * HARMONIC_BYTES + (task.radii() + curve) * DENSITY_BYTES)
        + swept * CYCLE_BYTES
}

/// Bytes of a row of a table of steady cycles in the longest of the formats.
#[must_use]
pub fn cycle_row(task: &CycleTask) -> usize {
    STATE_LENGTH + 2 * task.harmonics * 2 * NUMBER_LENGTH
}

/// Bytes that it takes, with its reply.
#[must_use]
pub fn of_profile_fit(task: &ProfileFitTask) -> usize {
    SCAN_BYTES + SCAN_POINT_BYTES * task.points.len()
}

/// Bytes that it takes, with its reply.
#[must_use]
pub fn of_fit(task: &FitTask) -> usize {
    FIT_BYTES + FIT_POINT_BYTES * task.points() + of_shape(&task.definition.profile)
}

/// Bytes that it takes.
#[must_use]
pub fn of_friction(moves: usize) -> usize {
    FRICTION_POINT_BYTES * moves
}
