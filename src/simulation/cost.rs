//! Estimates of the time that a request takes.
//!
//! Passing work to another thread and back costs some 10 to 20 microseconds, and half the throughput of the cheapest
//! calls. Work below [`INLINE`](crate::admission::INLINE) is therefore done on the thread that serves the connection,
//! where it delays others by no more than that; everything above goes to the [`Pool`](crate::admission::Pool). The
//! estimates need only be right to a factor of a few: `cargo bench --bench request` and `--bench growth` show
//! what they come from.

use std::time::Duration;

use crate::admission::Nanoseconds;
use stickslip_mechanics::Profile;
use stickslip_wire::cycle::CycleTask;
use stickslip_wire::fit::FitTask;
use stickslip_wire::fretting::FrettingTask;
use stickslip_wire::profile_fit::ProfileFitTask;
use stickslip_wire::protocol::{Aim, ProtocolTask};
use stickslip_wire::simulate::Simulation;
use stickslip_wire::subsurface::SubsurfaceTask;
use stickslip_wire::{Comparison, Solver, limits};

/// A body longer than this (bytes) is parsed on the pool: it may hold a table, and a point of that costs some 50
/// microseconds.
pub const INLINE_BODY: usize = 1024;

/// Time of a fit, and for each of its points.
const SCAN_COST: Nanoseconds = 100_000_000;
const SCAN_POINT_COST: Nanoseconds = 4_000;
/// Time of a fit to loops, and for each of their points.
const FIT_COST: Nanoseconds = 100_000_000;
const FIT_POINT_COST: Nanoseconds = 100_000;
/// Time of a fit of the friction to a cycle, and for each of its points.
const FRICTION_COST: Nanoseconds = 500_000;
const FRICTION_POINT_COST: Nanoseconds = 10_000;
/// One move of the exact solver, with its state, and the state written as JSON.
const MOVE_COST: u64 = 1_000;
/// One curved move, which is followed in many small steps.
const CURVED_MOVE_COST: u64 = 3_000_000;
/// The contribution of one piece of the slip history of a sphere to the stress at one of many radii.
const PIECE_COST: u64 = 2;
/// The contribution of one piece to the search for extrema at another on a sphere.
const PAIR_COST: u64 = 1;
/// One radius, apart from the slip history, and its numbers written as JSON.
const RADIUS_COST: u64 = 200;
/// The search for extrema on another shape, at the least.
const SEARCH_COST: u64 = 100_000;
/// One steady cycle with its row as JSON.
const CYCLE_COST: u64 = 2_000;
/// One kink of the slip history of a sphere in the stress at one place below the surface.
const KINK_COST: u64 = 50;
/// The stress at one place below the surface of another profile.
const PLACE_COST: u64 = 20_000;
/// One instant of a curved move, with the mesh of the many pieces that it leaves.
const CURVED_INSTANT_COST: u64 = 20_000_000;
/// Instants of each move that a cycle is assumed to need.
pub(super) const ASSUMED_INSTANTS: usize = 64;
/// One stress in one criterion without planes.
const CRITERION_COST: u64 = 1_000;
/// One stress in the search for a critical plane.
const PLANES_COST: u64 = 20_000;
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
        let moves = (self.moves as u64 * MOVE_COST).saturating_mul(relative_cost_of_moves(profile));
        moves.saturating_add(on_profile(profile, self.stresses(), self.residual))
    }

    /// The cost on a sphere of what takes stresses.
    fn stresses(&self) -> Nanoseconds {
        let radii = self.radii as u64;
        (self.curved as u64 * CURVED_MOVE_COST)
            .saturating_add(radii * RADIUS_COST)
            .saturating_add(radii.saturating_mul(self.pieces() * PIECE_COST))
            .saturating_add(self.searched())
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

/// The cost on a shape of stresses that cost `sphere` on a sphere; the search for extrema is cheap there alone.
fn on_profile(profile: &Profile, sphere: Nanoseconds, residual: bool) -> Nanoseconds {
    let searched = if residual && !matches!(profile, Profile::Sphere(_)) { SEARCH_COST } else { 0 };
    sphere.saturating_mul(relative_cost_of_stresses(profile)).saturating_add(searched)
}

/// What stresses on a profile cost relative to a sphere: `cargo bench -p stickslip-mechanics --bench shapes`.
fn relative_cost_of_stresses(profile: &Profile) -> u64 {
    match profile {
        Profile::Sphere(_) | Profile::Ellipsoid(_) => 1,
        Profile::ExactSphere(_) => 3,
        Profile::Tabulated(_) => 20,
        Profile::Asperities(_) => 40,
        Profile::Sum(sum) => sum.parts().iter().map(relative_cost_of_stresses).sum(),
        _ => 8,
    }
}

/// What moves on a profile cost relative to a sphere, each with its state as JSON.
fn relative_cost_of_moves(profile: &Profile) -> u64 {
    match profile {
        Profile::Tabulated(_) | Profile::Asperities(_) => 2,
        Profile::Sum(sum) => sum.parts().iter().map(relative_cost_of_moves).sum(),
        _ => 1,
    }
}

/// Reversals that a protocol has at the most.
pub(super) fn reversals(task: &ProtocolTask, sought: usize) -> usize {
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
    let once = MOVE_COST.saturating_mul(once.moves as u64).saturating_add(once.stresses());
    let pairs = (reversals * (reversals + depth.min(ASSUMED_REVERSALS))) as u64;
    on_profile(profile, PROTOCOL_COST + pairs * KINK_PAIR_COST + 3 * tried.saturating_mul(once), true)
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

/// The cost of stresses below the surface, with a slip history of this many pieces.
#[must_use]
pub fn of_subsurface(profile: &Profile, task: &SubsurfaceTask, depth: usize) -> Nanoseconds {
    let each = match profile {
        Profile::Sphere(_) => KINK_COST.saturating_mul(depth as u64 + 1),
        _ => PLACE_COST,
    };
    (task.places.count() as u64).saturating_mul(each + 15 * NUMBER_COST)
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

/// The cost of fitting a profile to a scan.
#[must_use]
pub fn of_profile_fit(task: &ProfileFitTask) -> Nanoseconds {
    SCAN_COST + SCAN_POINT_COST * task.points.len() as u64
}

/// The cost of a fit to measured loops.
#[must_use]
pub fn of_fit(task: &FitTask) -> Nanoseconds {
    FIT_COST + FIT_POINT_COST * task.points() as u64
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
