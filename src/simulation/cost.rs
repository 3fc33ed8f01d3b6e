//! Estimates of the time and memory that a request takes.
//!
//! Passing work to another thread and back costs some 10 to 20 microseconds, and half the throughput of the cheapest
//! calls. Work below [`INLINE`](crate::admission::INLINE) is therefore done on the thread that serves the connection,
//! where it delays others by no more than that; everything above goes to the [`Pool`](crate::admission::Pool). The
//! estimates need only be right to a factor of a few: `cargo bench --bench request` and `--bench growth` show
//! what they come from.

use std::time::Duration;

use crate::admission::Nanoseconds;
use stickslip_mechanics::{self as mechanics, Profile};
use stickslip_wire::cycle::CycleTask;
use stickslip_wire::fit::FitTask;
use stickslip_wire::fretting::FrettingTask;
use stickslip_wire::profile_fit::ProfileFitTask;
use stickslip_wire::protocol::{Aim, ProtocolTask};
use stickslip_wire::session::Advance;
use stickslip_wire::simulate::Simulation;
use stickslip_wire::subsurface::SubsurfaceTask;
use stickslip_wire::{self as wire, Comparison, Plan, Solver, Steps, limits};

/// A body longer than this (bytes) is parsed on the pool: it may hold a table, and a point of that costs some 50
/// microseconds.
pub const INLINE_BODY: usize = 1024;

/// Bytes that a byte of a long body or definition may become while it is parsed: a point of a table is a few digits, and then a
/// series.
pub const EXPANSION: usize = 100;

/// Time of a fit, and for each of its points.
const SCAN_COST: Nanoseconds = 100_000_000;
const SCAN_POINT_COST: Nanoseconds = 4_000;
/// Bytes of a fit with its reply, and for each of its points.
const SCAN_BYTES: usize = 4 * 1024 * 1024;
const SCAN_POINT_BYTES: usize = 256;
/// Time of a fit to loops, and for each of their points.
const FIT_COST: Nanoseconds = 100_000_000;
const FIT_POINT_COST: Nanoseconds = 100_000;
/// Bytes of a fit to loops with its reply, and for each of their points.
const FIT_BYTES: usize = 4 * 1024 * 1024;
const FIT_POINT_BYTES: usize = 256;
/// Time of a fit of the friction to a cycle, and for each of its points.
const FRICTION_COST: Nanoseconds = 500_000;
const FRICTION_POINT_COST: Nanoseconds = 10_000;
/// Bytes of such a fit for each of its points.
const FRICTION_POINT_BYTES: usize = 256;
/// One move of the exact solver, with its state, and the state written as JSON.
const MOVE_COST: u64 = 1_000;
/// One curved move, which is followed in many small steps.
const CURVED_MOVE_COST: u64 = 3_000_000;
/// The contribution of one piece of the slip history of a sphere to the stress at one of many radii.
const PIECE_COST: u64 = 2;
/// The contribution of one piece to the search for extrema at another: the sums of all shapes cost much the same, once made.
const PAIR_COST: u64 = 5;
/// One radius, apart from the slip history, and its numbers written as JSON.
const RADIUS_COST: u64 = 200;
/// The search for extrema on a shape with knots, at the least.
const SEARCH_COST: u64 = 1_000_000;
/// One steady cycle with its row as JSON.
const CYCLE_COST: u64 = 2_000;
/// One kink of the slip history of a sphere in the stress at one place below the surface.
const KINK_COST: u64 = 50;
/// The stress at one place below the surface of another profile.
const PLACE_COST: u64 = 20_000;
/// One instant of a curved move, with the mesh of the many pieces that it leaves.
const CURVED_INSTANT_COST: u64 = 20_000_000;
/// Instants of each move that a cycle is assumed to need.
const ASSUMED_INSTANTS: usize = 64;
/// One stress in one criterion without planes.
const CRITERION_COST: u64 = 1_000;
/// One stress in the search for a critical plane.
const PLANES_COST: u64 = 20_000;
/// Stresses that are held at once.
pub const STRESSES_HELD: usize = 500_000;
/// Bytes of the states of a cycle, which are held together.
pub const STATES_HELD: usize = 64 * 1024 * 1024;
/// One number of a reply, written as JSON.
const NUMBER_COST: u64 = 60;
/// The first harmonics of one cycle, and as much again for every eight orders.
const HARMONICS_COST: u64 = 3_000;
/// The same of a driven force or through a machine, where each node inverts the profile.
const INVERTED_HARMONICS_COST: u64 = 20_000;
/// One cycle under a load that oscillates, which is stepped until three results agree.
const STEPPED_CYCLE_COST: u64 = 15_000_000;
/// The same driven by a force or through a machine, where what is left falls with the square of the step alone and each
/// step searches for a force.
const SEARCHED_CYCLE_COST: u64 = 100_000_000;
/// One spring in one move, or its contribution at one radius.
const SPRING_COST: u64 = 3;

/// One pair of kinks of a protocol, over all evaluations and all three laws.
const KINK_PAIR_COST: u64 = 15_000;
/// The least that a protocol costs.
const PROTOCOL_COST: u64 = 200_000;
/// Reversals that a target is assumed to need.
const ASSUMED_REVERSALS: usize = 100;

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

/// The work for the exact solver.
#[derive(Clone, Copy, Debug, Default)]
pub struct Work {
    /// Moves.
    pub moves: usize,
    /// How many of them are curved.
    pub curved: usize,
    /// Pieces of slip history before the moves, each of which adds one at the most.
    pub depth: usize,
    /// Radii at which stresses are asked for after them.
    pub radii: usize,
    /// Whether the extrema are.
    pub residual: bool,
}

impl Work {
    /// The cost on a shape.
    #[must_use]
    pub fn cost(&self, profile: &Profile) -> Nanoseconds {
        on_profile(profile, self.followed(), self.residual).saturating_add(self.searched())
    }

    /// The cost of moves and stresses on a sphere.
    fn followed(&self) -> Nanoseconds {
        let (moves, radii) = (self.moves as u64, self.radii as u64);
        (moves * MOVE_COST)
            .saturating_add(self.curved as u64 * CURVED_MOVE_COST)
            .saturating_add(radii * RADIUS_COST)
            .saturating_add(radii.saturating_mul(self.pieces() * PIECE_COST))
    }

    /// The cost of the search for extrema, which evaluates all pieces at each piece.
    fn searched(&self) -> Nanoseconds {
        if self.residual { self.pieces().saturating_mul(self.pieces()).saturating_mul(PAIR_COST) } else { 0 }
    }

    fn pieces(&self) -> u64 {
        (self.depth + self.moves) as u64 + 1
    }
}

/// By how much an estimate may be wrong: work that is estimated to take longer than this many times what is allowed is refused
/// before it begins.
pub const MARGIN: u32 = 4;

/// The cost of the search for extrema with a slip history of this many pieces.
#[must_use]
pub fn of_search(profile: &Profile, depth: usize) -> Nanoseconds {
    Work { depth, residual: true, ..Work::default() }.cost(profile)
}

/// The longest slip history whose search for extrema is not refused before it begins.
#[must_use]
pub fn longest_search(profile: &Profile, allowed: Duration) -> usize {
    let most = allowed.saturating_mul(MARGIN);
    let (mut fits, mut not) = (0, limits::MEMORY_DEPTH + 1);
    while not - fits > 1 {
        let middle = fits.midpoint(not);
        if Duration::from_nanos(of_search(profile, middle)) <= most { fits = middle } else { not = middle }
    }
    fits
}

/// The cost of writing a table of this many points as JSON.
#[must_use]
pub fn writing_table(points: usize) -> Nanoseconds {
    points as u64 * RADIUS_COST
}

/// The cost on another shape of what costs `sphere` by the closed forms of a sphere; the search for extrema goes from
/// knot to knot there, and is never cheap.
fn on_profile(profile: &Profile, sphere: Nanoseconds, residual: bool) -> Nanoseconds {
    let searched = if residual && !matches!(profile, Profile::Sphere(_)) { SEARCH_COST } else { 0 };
    sphere.saturating_mul(relative_cost(profile)).saturating_add(searched)
}

/// The cost of a profile relative to a sphere: `cargo bench -p stickslip-mechanics --bench shapes`.
fn relative_cost(profile: &Profile) -> u64 {
    match profile {
        Profile::Sphere(_) | Profile::Ellipsoid(_) => 1,
        Profile::ExactSphere(_) | Profile::Cone(_) => 3,
        Profile::Asperities(_) | Profile::Tabulated(_) => 40,
        Profile::Sum(sum) => sum.parts().iter().map(relative_cost).sum(),
        _ => 8,
    }
}

/// Bytes that stresses at this many radii take, as numbers and as JSON.
#[must_use]
pub fn bytes_of_stress(radii: usize) -> usize {
    radii * RADIUS_BYTES
}

/// Bytes of moves: themselves, the slip history that they leave, and the states after them if they are requested.
fn bytes_of_moves(plan: &Plan, steps: Steps) -> usize {
    let shown = if steps == Steps::All { STATE_BYTES } else { 0 };
    plan.length() * (MOVE_BYTES + shown)
}

/// Bytes that a shape takes: the series that the mechanics makes of tables, the clusters of asperities.
#[must_use]
pub fn bytes_of_shape(profile: &wire::Profile) -> usize {
    match profile {
        wire::Profile::Tabulated(table) => table.r.len() * POINT_BYTES,
        wire::Profile::Sum(sum) => sum.parts.iter().map(bytes_of_shape).sum(),
        wire::Profile::Asperities(asperities) => asperities.gaps.len() * ASPERITY_BYTES,
        wire::Profile::LoadCurve(curve) => curve.indentation.len() * CURVE_POINT_BYTES,
        _ => 0,
    }
}

/// Bytes that a simulation takes, with its reply; rather too many than too few.
#[must_use]
pub fn bytes_of_simulation(simulation: &Simulation) -> usize {
    let radii = simulation.stress.as_ref().map_or(0, |stress| stress.length());
    let springs = match simulation.solver {
        Some(Solver::Springs(springs)) => springs.count * SPRING_BYTES,
        _ => 0,
    };
    bytes_of_moves(&simulation.plan, simulation.steps)
        + bytes_of_stress(radii)
        + bytes_of_shape(&simulation.definition.profile)
        + simulation.subsurface.as_ref().map_or(0, bytes_of_subsurface)
        + springs
}

/// Bytes of the reply to a simulation, rounded up.
#[must_use]
pub fn length_of_simulation(simulation: &Simulation) -> usize {
    let states = if simulation.steps == Steps::All { simulation.plan.length() } else { 1 };
    let numbers = simulation.stress.as_ref().map_or(0, |stress| stress.length() * (1 + stress.fields.count()));
    let below = simulation.subsurface.as_ref().map_or(0, |task| task.places.count() * task.columns());
    REPLY_LENGTH + states * STATE_LENGTH + (numbers + below) * NUMBER_LENGTH
}

/// Bytes that moves of a session take, with their records and the reply; rather too many than too few.
#[must_use]
pub fn bytes_of_advance(advance: &Advance) -> usize {
    let radii = advance.stress.as_ref().map_or(0, |stress| stress.length());
    advance.relax.map_or(0, |relax| bytes_of_protocol(&relax.task))
        + bytes_of_moves(&advance.plan, advance.steps)
        + advance.plan.length() * RECORD_BYTES
        + bytes_of_stress(radii)
}

/// Reversals that a protocol has at the most.
fn reversals(task: &ProtocolTask, sought: usize) -> usize {
    match task.aim {
        Aim::Reversals(reversals) => reversals,
        Aim::Target(_) => sought,
    }
}

/// The cost of finding a protocol from a slip history of this many pieces.
#[must_use]
pub fn of_protocol(profile: &Profile, task: &ProtocolTask, depth: usize) -> Nanoseconds {
    let reversals = reversals(task, ASSUMED_REVERSALS);
    let tried = task.robustness.map_or(0, |robustness| robustness.samples as u64);
    let once = Work { moves: reversals + 1, residual: true, ..Work::default() };
    let once = once.followed().saturating_add(once.searched());
    let pairs = (reversals * (reversals + depth.min(ASSUMED_REVERSALS))) as u64;
    on_profile(profile, PROTOCOL_COST + pairs * KINK_PAIR_COST + 3 * tried.saturating_mul(once), true)
}

/// Bytes that a protocol takes, with its reply and, in a session, its moves.
#[must_use]
pub fn bytes_of_protocol(task: &ProtocolTask) -> usize {
    let most = reversals(task, *limits::PROTOCOL_REVERSALS.end());
    let tried = task.robustness.map_or(0, |robustness| robustness.samples);
    (most + 2) * (REVERSAL_BYTES + MOVE_BYTES + STATE_BYTES + RECORD_BYTES) + tried * SAMPLE_BYTES
}

/// The cost of a simulation.
#[must_use]
pub fn of_simulation(simulation: &Simulation) -> Nanoseconds {
    let moves = simulation.plan.length();
    let radii = simulation.stress.as_ref().map_or(0, |stress| stress.length());
    let curved = simulation.plan.curved();
    let exact = Work { moves, curved, depth: 0, radii, residual: simulation.residual }.cost(&simulation.setup.profile);
    let below = |task| of_subsurface(&simulation.setup.profile, task, moves);
    let exact = exact.saturating_add(simulation.subsurface.as_ref().map_or(0, below));
    match simulation.solver {
        None | Some(Solver::Exact) => exact,
        Some(Solver::Springs(springs)) => {
            let search = if simulation.residual { limits::SPRING_SEARCH } else { 0 };
            exact.saturating_add(of_springs(springs.count, moves + radii + search))
        }
    }
}

/// The cost of this many springs, each evaluated this many times.
fn of_springs(springs: usize, passes: usize) -> Nanoseconds {
    (springs as u64).saturating_mul(passes as u64 * SPRING_COST)
}

/// The cost of a comparison of solvers: each of them once, and the reference.
#[must_use]
pub fn of_comparison(comparison: &Comparison) -> Nanoseconds {
    let (plan, radii) = (&comparison.plan, comparison.sampling.length());
    let exact = Work { moves: plan.length(), curved: plan.curved(), radii, ..Work::default() };
    let each = exact.cost(&comparison.setup.profile).saturating_mul(comparison.solvers.len() as u64 + 1);
    let springs = comparison.springs().map(|springs| of_springs(springs, comparison.passes()));
    springs.fold(each, Nanoseconds::saturating_add)
}

/// Bytes that a comparison takes: one solver at a time, and a force a move of the reference and of that.
#[must_use]
pub fn bytes_of_comparison(comparison: &Comparison) -> usize {
    bytes_of_moves(&comparison.plan, Steps::Last)
        + 2 * size_of::<f64>() * comparison.plan.length()
        + 2 * bytes_of_stress(comparison.sampling.length())
        + bytes_of_shape(&comparison.definition.profile)
        + comparison.springs().max().unwrap_or(0) * SPRING_BYTES
}

/// The cost of stresses below the surface, with a slip history of this many pieces.
#[must_use]
pub fn of_subsurface(profile: &Profile, task: &SubsurfaceTask, depth: usize) -> Nanoseconds {
    let each = match profile {
        Profile::Sphere(_) => KINK_COST.saturating_mul(depth as u64 + 1),
        _ => PLACE_COST,
    };
    (task.places.count() as u64).saturating_mul(each + 15 * NUMBER_COST)
}

/// Bytes that they take, with their reply.
#[must_use]
pub fn bytes_of_subsurface(task: &SubsurfaceTask) -> usize {
    task.places.count() * task.columns() * (size_of::<Option<f64>>() + 2 * NUMBER_LENGTH)
}

/// The cost of fatigue criteria.
#[must_use]
pub fn of_fretting(profile: &Profile, task: &FrettingTask) -> Nanoseconds {
    let states = (task.plan.length() * ASSUMED_INSTANTS) as u64;
    let stress = match profile {
        Profile::Sphere(_) => KINK_COST * 4,
        _ => PLACE_COST,
    };
    let planes = task.criteria[2..].iter().flatten().count() as u64;
    let each = states.saturating_mul(stress + CRITERION_COST + planes * PLANES_COST);
    let curved = (task.plan.curved() * ASSUMED_INSTANTS) as u64;
    let followed = (states * MOVE_COST).saturating_add(curved.saturating_mul(CURVED_INSTANT_COST));
    (task.places.count() as u64).saturating_mul(each).saturating_add(followed)
}

/// Bytes that they take, with their reply: a part of the stresses at once.
#[must_use]
pub fn bytes_of_fretting(task: &FrettingTask) -> usize {
    let columns = 3 + task.criteria.iter().flatten().count() + 3;
    let states = task.plan.length() * ASSUMED_INSTANTS;
    let path = size_of::<mechanics::Stress>() + 8 * 2 * NUMBER_LENGTH;
    task.places.count() * columns * (size_of::<mechanics::fatigue::Value>() + 2 * NUMBER_LENGTH)
        + (task.places.count() * states).min(STRESSES_HELD) * size_of::<mechanics::Stress>()
        + task.stress_paths.len() * states * path
        + STATES_HELD
}

/// The cost of steady cycles.
#[must_use]
pub fn of_cycle(profile: &Profile, task: &CycleTask) -> Nanoseconds {
    let inverted = task.is_force_driven() || task.stiffness.is_some();
    let once = if inverted { INVERTED_HARMONICS_COST } else { HARMONICS_COST };
    let harmonics = if task.harmonics > 0 { once * (1 + task.harmonics as u64 / 8) } else { 0 };
    let each_stepped = if inverted { SEARCHED_CYCLE_COST } else { STEPPED_CYCLE_COST };
    let stepped = if task.normal.is_some() { each_stepped } else { 0 };
    // Some four hundred loads are compared, and the harmonics of a thousand amplitudes and of each root.
    let searched = task.best_load.map_or(0, |study| 400 + study.points.unwrap_or(0) as u64) * CYCLE_COST;
    let each = CYCLE_COST + stepped + harmonics + searched + task.radii() as u64 * RADIUS_COST;
    let swept = task.response.as_ref().map_or(0, |asked| asked.frequencies.as_ref().map_or(200, Vec::len));
    let response = if swept > 0 { HARMONICS_COST.saturating_mul(1_000 + 60 * swept as u64) } else { 0 };
    on_profile(profile, each.saturating_mul(task.rows() as u64).saturating_add(response), false)
}

/// Bytes that steady cycles take, with their reply.
#[must_use]
pub fn bytes_of_cycle(task: &CycleTask) -> usize {
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

/// The cost of fitting a profile to a scan.
#[must_use]
pub fn of_profile_fit(task: &ProfileFitTask) -> Nanoseconds {
    SCAN_COST + SCAN_POINT_COST * task.points.len() as u64
}

/// Bytes that it takes, with its reply.
#[must_use]
pub fn bytes_of_profile_fit(task: &ProfileFitTask) -> usize {
    SCAN_BYTES + SCAN_POINT_BYTES * task.points.len()
}

/// The cost of a fit to measured loops.
#[must_use]
pub fn of_fit(task: &FitTask) -> Nanoseconds {
    FIT_COST + FIT_POINT_COST * task.points() as u64
}

/// Bytes that it takes, with its reply.
#[must_use]
pub fn bytes_of_fit(task: &FitTask) -> usize {
    FIT_BYTES + FIT_POINT_BYTES * task.points() + bytes_of_shape(&task.definition.profile)
}

/// The cost of writing so many observations as JSON.
#[must_use]
pub fn writing_observations(observations: usize) -> Nanoseconds {
    4 * NUMBER_COST * observations as u64
}

/// The cost of fitting the friction to a cycle of so many moves.
#[must_use]
pub fn of_friction(moves: usize) -> Nanoseconds {
    FRICTION_COST + FRICTION_POINT_COST * moves as u64
}

/// Bytes that it takes.
#[must_use]
pub fn bytes_of_friction(moves: usize) -> usize {
    FRICTION_POINT_BYTES * moves
}
