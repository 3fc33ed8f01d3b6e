//! One step of rings with their history, by which whole paths and [`super::PlanarLaw`] are stepped.
//!
//! The state is the force on each ring, which would be t + K dU if all rings stuck, and so includes the slip of all
//! steps before.

use super::NO_SLIP;
use super::load::beyond;
use super::slip::{Workspace, solve};
use super::stiffness::{RingStiffness, Vector};
use crate::indenter::Indenter;

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct RingState {
    /// Friction times the normal force on it, N.
    pub(super) bound: f64,
    /// The tangential force on it, N.
    pub(super) traction: Vector,
    /// Its slip in the last step, m, with which the next one begins its search.
    pub(super) slip: Vector,
}

/// By how much a step moves the indenter, m, or changes the force on all rings, N.
#[derive(Clone, Copy, Debug)]
pub(super) enum Increment {
    Displacement(Vector),
    Force(Vector),
}

/// The unit of stiffness of rings, G* times the outermost radius, N/m, and the displacement of gross slip, m.
#[derive(Clone, Copy, Debug)]
pub(super) struct Units {
    pub(super) stiffness: f64,
    pub(super) full: f64,
}

/// What a step has done.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Stepped {
    /// By how much the indenter has moved, m.
    pub(super) by: Vector,
    /// The force on all rings, N.
    pub(super) force: Vector,
    /// The change of the elastic energy, J.
    pub(super) elastic: f64,
    /// The innermost ring that slipped.
    pub(super) first_slip: Option<usize>,
    /// The largest force of a ring that the search for its slip has left, N.
    pub(super) unsettled: f64,
}

/// What a step needs besides its contact: one for each thread.
#[derive(Clone, Debug, Default)]
pub struct PlanarBuffers {
    /// Friction times the load of each ring at the end of the step, N, and the share of the load beyond its inner edge.
    pub(super) limits: Vec<f64>,
    outside: Vec<f64>,
    bounds: Vec<f64>,
    forces: Vec<Vector>,
    traction: Vec<Vector>,
    slip: Vec<Vector>,
    workspace: Workspace,
}

impl PlanarBuffers {
    /// Shares the friction `limit`, N, of a contact of the indentation and the contact radius given, m, out over rings
    /// of these inner radii, m: the limits of the next step.
    pub(super) fn press(
        &mut self,
        profile: &Indenter,
        [indentation, edge]: [f64; 2],
        limit: f64,
        radii: impl Iterator<Item = f64>,
    ) {
        let PlanarBuffers { limits, outside, .. } = self;
        let kinks = profile.knots_below(edge);
        outside.clear();
        outside.extend(radii.map(|radius| beyond(profile, &kinks, indentation, edge, radius)));
        outside.push(0.0);
        let unit = if outside[0] > 0.0 { limit / outside[0] } else { 0.0 };
        limits.clear();
        limits.extend(outside.windows(2).map(|ends| unit * (ends[0] - ends[1]).max(0.0)));
    }

    /// A step of rings to the limits of [`PlanarBuffers::press`] in which all changes at once: of first order in its
    /// length. `visit` is told each ring before and after it.
    pub(super) fn step(
        &mut self,
        rings: &mut [RingState],
        matrix: &RingStiffness,
        Units { stiffness: unit, full }: Units,
        increment: Increment,
        visit: &mut dyn FnMut(usize, &RingState, &RingState),
    ) -> Stepped {
        let PlanarBuffers { limits, bounds, forces, traction, slip, workspace, .. } = self;
        let (by_force, pushed) = match increment {
            Increment::Displacement(by) => (false, by),
            Increment::Force(by) => (true, by.map(|component| component / (unit * matrix.total))),
        };
        // In displacements: over the unit of stiffness.
        bounds.clear();
        bounds.extend(limits.iter().map(|limit| limit / unit));
        let held = rings.iter().zip(matrix.together());
        forces.clear();
        forces.extend(held.map(|(ring, share)| [0, 1].map(|axis| ring.traction[axis] / unit + share * pushed[axis])));
        // A long step slips by its own length, nearly.
        let long = !by_force && pushed[0].hypot(pushed[1]) > full;
        slip.clear();
        slip.extend(rings.iter().map(|ring| if long { pushed } else { ring.slip }));
        traction.clear();
        traction.resize(rings.len(), [0.0; 2]);
        let unsettled = solve(matrix.stiffness(by_force), bounds, forces, traction, slip, workspace) * unit;
        let mut done = Stepped { by: pushed, unsettled, ..Stepped::default() };
        if by_force {
            // Where the sum of the forces is given, the indenter follows what slips.
            let carried = matrix.together().iter().zip(slip.iter());
            let carried =
                carried.fold([0.0; 2], |sum, (share, slip)| [0, 1].map(|axis| sum[axis] + share * slip[axis]));
            done.by = [0, 1].map(|axis| pushed[axis] + carried[axis] / matrix.total);
        }
        for (index, ring) in rings.iter_mut().enumerate() {
            let (before, slip) = (*ring, slip[index]);
            *ring =
                RingState { bound: limits[index], traction: traction[index].map(|component| component * unit), slip };
            let moved = [done.by[0] - slip[0], done.by[1] - slip[1]];
            done.elastic += 0.5 * (dot(before.traction, moved) + dot(ring.traction, moved));
            done.force = [0, 1].map(|axis| done.force[axis] + ring.traction[axis]);
            if ring.bound > 0.0 && slip[0].hypot(slip[1]) > NO_SLIP * full {
                done.first_slip.get_or_insert(index);
            }
            visit(index, &before, ring);
        }
        done
    }
}

pub(super) fn dot(one: Vector, other: Vector) -> f64 {
    one[0] * other[0] + one[1] * other[1]
}
