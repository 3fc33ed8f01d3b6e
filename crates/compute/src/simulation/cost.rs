//! Estimates of the time that a request takes.
//!
//! The service does the cheapest calls on the thread that serves the connection, as passing work to another thread and
//! back costs some 10 to 20 microseconds, and half their throughput. The estimates need only be right to a factor of a
//! few: `cargo bench --bench request` and `--bench growth` show what they come from.

use std::time::Duration;

use stickslip_mechanics::rings;
use stickslip_wire::Solver;
use stickslip_wire::subsurface::SubsurfaceTask;

use crate::prelude::*;

/// A body longer than this (bytes) is parsed on the pool.
pub const INLINE_BODY: usize = 1024;

/// One move of the exact solver, with its state, and the state written as JSON.
pub const MOVE_COST: u64 = 1_000;
/// What the limit of friction under twist takes.
const TWIST_COST: u64 = 20_000_000;
/// What a move takes that changes the load of a contact that is twisted.
const TWISTED_MOVE_COST: u64 = 50_000_000;
/// One curved move, which is followed in many small steps.
const CURVED_MOVE_COST: u64 = 3_000_000;
/// The contribution of one piece of the slip history of a sphere to the stress at one of many radii.
const PIECE_COST: u64 = 2;
/// The contribution of one piece to the search for extrema at another on a sphere.
const PAIR_COST: u64 = 1;
/// One move of a contact with memory, whose springs make some steps.
pub const MEMORY_MOVE_COST: u64 = 2_000_000;
/// One radius, apart from the slip history, and its numbers written as JSON.
pub const RADIUS_COST: u64 = 200;
/// The search for extrema on another shape, at the least.
const SEARCH_COST: u64 = 100_000;
/// One kink of the slip history of a sphere in the stress at one place below the surface.
pub const KINK_COST: u64 = 50;
/// The stress at one place below the surface of another profile.
pub const PLACE_COST: u64 = 20_000;
/// One number of a reply, written as JSON.
pub const NUMBER_COST: u64 = 60;
/// One step of rings, over the square of their number.
const RING_STEP_COST: u64 = 60;
/// Steps of all rings, and of half of them, for each of the coarsest steps; and all of it again for a refinement.
const STEPS_OF_RINGS: u64 = 2 * 3;
/// One spring in one move, or its contribution at one radius.
const SPRING_COST: u64 = 3;

/// One point of a table, while it is prepared.
const TABLE_POINT_COST: u64 = 10_000;
/// One point of a load curve, while it is prepared.
const CURVE_POINT_COST: u64 = 3_000;
/// One asperity, while it is prepared.
const ASPERITY_COST: u64 = 1_500;
/// One point of a table in each part of a sum: whether the sum falls there, and its moments up to the next.
const SUM_POINT_COST: u64 = 2_000;
/// What a move on a sum with a table costs, over [`MOVE_COST`].
const MOVE_ON_SUM: u64 = 13;

/// The cost of preparing a profile.
pub fn of_preparation(profile: &wire::Profile) -> Nanoseconds {
    let points = profile.points() as u64;
    match profile {
        wire::Profile::Tabulated(_) => points * TABLE_POINT_COST,
        wire::Profile::LoadCurve(_) => points * CURVE_POINT_COST,
        wire::Profile::Asperities(_) => points * ASPERITY_COST,
        wire::Profile::Sum(sum) => {
            let compared = (points * SUM_POINT_COST).saturating_mul(sum.parts.len() as u64);
            sum.parts.iter().map(of_preparation).fold(compared, Nanoseconds::saturating_add)
        }
        _ => 0,
    }
}

/// The cost of preparing the profile of a body that is still JSON: as if all its numbers were of tables.
pub fn of_profile_in(body: &Value) -> Nanoseconds {
    fn numbers(value: &Value) -> u64 {
        match value {
            Value::Array(items) => items.iter().map(numbers).sum(),
            Value::Object(members) => members.values().map(numbers).sum(),
            _ => 1,
        }
    }
    body.pointer("/contact/profile").map_or(0, numbers).saturating_mul(TABLE_POINT_COST / 2)
}

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
    pub fn cost(&self, profile: &Profile) -> Nanoseconds {
        let moves = (self.moves as u64 * MOVE_COST).saturating_mul(relative_cost_of_moves(profile));
        moves.saturating_add(on_profile(profile, self.stresses(), self.residual))
    }

    /// The cost on a sphere of what takes stresses.
    pub fn stresses(&self) -> Nanoseconds {
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

/// By how much an estimate may be wrong: work that is estimated to take longer than this many times what is allowed is
/// refused before it begins.
pub const MARGIN: u32 = 4;

/// Refuses work that cannot end in time, unless it has all the time in the world.
///
/// # Errors
/// [`Cause::Work`] with the estimate.
pub fn check(cost: Nanoseconds, stop: &dyn Stop) -> Result<(), Failure> {
    let estimate = Duration::from_nanos(cost);
    match stop.flag().time_limit() {
        Some(allowed) if estimate > allowed.saturating_mul(MARGIN) => {
            Err(Failure::at("", Cause::Work { estimate, allowed }))
        }
        _ => Ok(()),
    }
}

/// The cost of the search for extrema with a slip history of this many pieces.
pub fn of_search(profile: &Profile, depth: usize) -> Nanoseconds {
    Work { depth, residual: true, ..Work::default() }.cost(profile)
}

/// The longest slip history whose search for extrema is not refused before it begins.
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
pub fn writing_table(points: usize) -> Nanoseconds {
    points as u64 * RADIUS_COST
}

/// The cost on a shape of stresses that cost `sphere` on a sphere; the search for extrema is cheap there alone.
pub fn on_profile(profile: &Profile, sphere: Nanoseconds, residual: bool) -> Nanoseconds {
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
        Profile::Sum(sum) if sum.parts().iter().any(|part| matches!(part, Profile::Tabulated(_))) => MOVE_ON_SUM,
        Profile::Sum(sum) => sum.parts().len() as u64,
        _ => 1,
    }
}

/// The cost of a simulation of motion in the plane.
fn in_plane(simulation: &Simulation) -> Option<Nanoseconds> {
    let Plan::Plane(plane) = &simulation.plan else { return None };
    if plane.line.is_some() {
        return None;
    }
    let count = if let Some(Solver::Rings(rings)) = simulation.solver { Some(rings.count) } else { None };
    let options = rings::Options { count, tolerance: simulation.tolerance };
    let radii = simulation.stress.as_ref().map_or(0, |stress| stress.length());
    // With a shear strength it is refused at once.
    let setup = simulation.setup.clone().coulomb("motion in the plane");
    Some(setup.map_or(0, |setup| of_rings(&setup, &plane.moves, &options, radii)))
}

/// The cost of moves that twist a contact, so many of them under a load that changes.
pub fn of_twist(curved: usize) -> Nanoseconds {
    TWIST_COST.saturating_add((curved as u64).saturating_mul(TWISTED_MOVE_COST))
}

/// The cost of a simulation.
pub fn of_simulation(simulation: &Simulation) -> Nanoseconds {
    if let Some(cost) = in_plane(simulation) {
        return cost;
    }
    let moves = simulation.plan.length();
    let radii = simulation.stress.as_ref().map_or(0, |stress| stress.length());
    let curved = simulation.plan.curved();
    let twisted = if simulation.plan.twists() { of_twist(curved) } else { 0 };
    let exact = Work { moves, curved, depth: 0, radii, residual: simulation.residual }.cost(&simulation.setup.profile);
    let below = |task| of_subsurface(&simulation.setup.profile, task, moves);
    let steps = simulation.setup.friction.memory.as_ref().map_or(0, |_| moves as u64 * MEMORY_MOVE_COST);
    let exact = exact.saturating_add(steps).saturating_add(twisted);
    let exact = exact.saturating_add(simulation.subsurface.as_ref().map_or(0, below));
    match simulation.solver {
        None | Some(Solver::Exact | Solver::Rings(_)) => exact,
        Some(Solver::Springs(springs)) => {
            let search = if simulation.residual { limits::SPRING_SEARCH } else { 0 };
            exact.saturating_add(of_springs(springs.count, moves + radii + search))
        }
    }
}

/// The cost of a path by rings, whose steps follow from its length.
pub fn of_rings(
    setup: &SharedSetup,
    moves: &[rings::PlanarMove],
    options: &rings::Options,
    radii: usize,
) -> Nanoseconds {
    let (count, steps) = rings::first_choice(setup, moves, options);
    (steps as u64)
        .saturating_mul(STEPS_OF_RINGS * RING_STEP_COST)
        .saturating_mul((count as u64).pow(2))
        .saturating_add(moves.len() as u64 * MOVE_COST)
        .saturating_add(on_profile(&setup.profile, radii as u64 * RADIUS_COST, false))
}

/// The cost of this many springs, each evaluated this many times.
pub fn of_springs(springs: usize, passes: usize) -> Nanoseconds {
    (springs as u64).saturating_mul(passes as u64 * SPRING_COST)
}

/// The cost of stresses below the surface, with a slip history of this many pieces.
pub fn of_subsurface(profile: &Profile, task: &SubsurfaceTask, depth: usize) -> Nanoseconds {
    let each = match profile {
        Profile::Sphere(_) => KINK_COST.saturating_mul(depth as u64 + 1),
        _ => PLACE_COST,
    };
    (task.places.count() as u64).saturating_mul(each + 15 * NUMBER_COST)
}
