//! The force of a motion in the plane between the ends of moves, for pictures: each move is made in parts.

use stickslip_mechanics::Normal;
use stickslip_mechanics::rings::{EllipseArc, PlanarMove, PlanarTarget};
use stickslip_wire::plane::{PlanarReply, SimulationReply};

use super::plane::simulate_any;
use super::trace::Point;
use crate::prelude::*;

/// Points of a picture, if a path has fewer moves.
const POINTS: usize = 1024;
/// Parts of a move at most.
const MOST_PARTS: usize = 64;

/// Where a move begins.
#[derive(Clone, Copy)]
struct Begin {
    displacement: [f64; 2],
    force: [f64; 2],
    indentation: f64,
    normal_force: f64,
}

/// The forces along x and y, N, through which a simulation in the plane leads, of which the reply has all states.
///
/// Moves along one line have the chord as their curve; the others are made in parts, which changes their ends by less
/// than the error that the reply states.
///
/// # Errors
/// [`Failure`] as of the simulation itself.
pub fn trace_in_plane(simulation: &Simulation, reply: &PlanarReply, stop: &dyn Stop) -> Result<Vec<Point>, Failure> {
    let origin = Begin {
        displacement: [0.0; 2],
        force: [0.0; 2],
        indentation: reply.contact.indentation,
        normal_force: reply.contact.normal_force,
    };
    let start = (0.0, 0.0);
    let ends = || reply.steps.iter().map(|state| (state.force[0], state.force[1]));
    let Plan::Plane(plane) = &simulation.plan else { return Ok(ends().collect()) };
    let parts = (POINTS / plane.moves.len().max(1)).min(MOST_PARTS);
    if plane.line.is_some() || parts < 2 {
        return Ok(std::iter::once(start).chain(ends()).collect());
    }
    let begins = std::iter::once(origin).chain(reply.steps.iter().map(|state| Begin {
        displacement: state.displacement,
        force: state.force,
        indentation: state.indentation,
        normal_force: state.normal_force,
    }));
    let moves = plane.moves.iter().zip(begins).flat_map(|(step, begin)| in_parts(step, begin, parts)).collect();
    let mut followed = plane.clone();
    followed.moves = moves;
    let finer = Simulation { plan: Plan::Plane(followed), steps: Steps::All, stress: None, ..simulation.clone() };
    match simulate_any(&finer, stop)? {
        SimulationReply::Plane(finer) => {
            let points = finer.steps.iter().map(|state| (state.force[0], state.force[1]));
            Ok(std::iter::once(start).chain(points).collect())
        }
        SimulationReply::Line(_) => Ok(ends().collect()),
    }
}

/// A move as moves that end on its way.
fn in_parts(step: &PlanarMove, begin: Begin, parts: usize) -> impl Iterator<Item = PlanarMove> {
    let step = *step;
    (1..=parts).map(move |index| {
        let (part, each) = (index as f64 / parts as f64, 1.0 / parts as f64);
        let towards = |from: f64, to: f64| if step.relative { each * to } else { from + part * (to - from) };
        let both = |from: [f64; 2], to: [f64; 2]| [towards(from[0], to[0]), towards(from[1], to[1])];
        let tangential = step.tangential.map(|target| match target {
            PlanarTarget::Displacement(to) => PlanarTarget::Displacement(both(begin.displacement, to)),
            PlanarTarget::Force(to) => PlanarTarget::Force(both(begin.force, to)),
            PlanarTarget::Arc(arc) => {
                let [first, last] = arc.turns;
                let at = |part: f64| first + part * (last - first);
                PlanarTarget::Arc(EllipseArc { turns: [at(part - each), at(part)], ..arc })
            }
        });
        let normal = step.normal.map(|target| match target {
            Normal::Indentation(to) => Normal::Indentation(towards(begin.indentation, to)),
            Normal::NormalForce(to) => Normal::NormalForce(towards(begin.normal_force, to)),
        });
        PlanarMove { tangential, normal, relative: step.relative }
    })
}
