//! One discretisation of a path: rings of one number, moved step by step.

use std::sync::Arc;

use super::step::{Increment, PlanarBuffers, RingState, Stepped, Units, dot};
use super::stiffness::{RingStiffness, Vector};

/// The end of a step, m or N.
#[derive(Clone, Copy, Debug)]
pub(super) enum Target {
    Displacement(Vector),
    Force(Vector),
}

/// Rings with what a path asks of their history.
#[derive(Clone, Debug)]
pub(super) struct Discretisation {
    pub(super) matrix: Arc<RingStiffness>,
    units: Units,
    pub(super) rings: Vec<RingState>,
    /// With the limits of the next step.
    pub(super) buffers: PlanarBuffers,
    pub(super) displacement: Vector,
    pub(super) force: Vector,
    /// Work of the tangential force, and elastic energy, J.
    pub(super) work: f64,
    pub(super) elastic: f64,
    /// The largest forces of a ring that the searches for slips have left, in all steps, N.
    pub(super) unsettled: f64,
    /// Slip of each ring so far, m. Kept outside the contact too, so that a ring sticks where it is met.
    pub(super) slipped: Vec<Vector>,
    /// Friction work of each ring, J.
    pub(super) dissipated: Vec<f64>,
    /// The innermost ring that has slipped in the present move.
    pub(super) first_slip: usize,
    /// Slip of the step before the last.
    earlier: Vec<Vector>,
}

impl Discretisation {
    /// At rest under the limits of these buffers.
    pub(super) fn new(matrix: Arc<RingStiffness>, units: Units, buffers: PlanarBuffers) -> Discretisation {
        let still = vec![[0.0; 2]; matrix.count];
        Discretisation {
            units,
            rings: buffers.limits.iter().map(|&bound| RingState { bound, ..RingState::default() }).collect(),
            buffers,
            displacement: [0.0; 2],
            force: [0.0; 2],
            work: 0.0,
            elastic: 0.0,
            unsettled: 0.0,
            slipped: still.clone(),
            dissipated: vec![0.0; matrix.count],
            first_slip: matrix.count,
            earlier: still,
            matrix,
        }
    }

    /// A step in which all changes at once: of first order in its length.
    pub(super) fn step(&mut self, target: Target) {
        // The guess of this slip: that of the last two steps drawn straight on, where it does not turn round.
        for (ring, earlier) in self.rings.iter_mut().zip(&mut self.earlier) {
            let before = std::mem::replace(earlier, ring.slip);
            let ahead = [0, 1].map(|axis| 2.0 * ring.slip[axis] - before[axis]);
            if dot(ahead, ring.slip) > 0.0 {
                ring.slip = ahead;
            }
        }
        let by = |to: Vector, from: Vector| [to[0] - from[0], to[1] - from[1]];
        let increment = match target {
            Target::Displacement(to) => Increment::Displacement(by(to, self.displacement)),
            Target::Force(to) => Increment::Force(by(to, self.force)),
        };
        let (slipped, dissipated) = (&mut self.slipped, &mut self.dissipated);
        let visit = &mut |index: usize, before: &RingState, ring: &RingState| {
            dissipated[index] += 0.5 * (dot(before.traction, ring.slip) + dot(ring.traction, ring.slip));
            slipped[index] = [0, 1].map(|axis| slipped[index][axis] + ring.slip[axis]);
        };
        let Stepped { by, force, elastic, first_slip, unsettled } =
            self.buffers.step(&mut self.rings, &self.matrix, self.units, increment, visit);
        self.displacement = match target {
            Target::Displacement(to) => to,
            Target::Force(_) => [0, 1].map(|axis| self.displacement[axis] + by[axis]),
        };
        self.work += 0.5 * (dot(self.force, by) + dot(force, by));
        self.force = force;
        self.elastic += elastic;
        self.unsettled += unsettled;
        self.first_slip = self.first_slip.min(first_slip.unwrap_or(self.first_slip));
    }

    /// The friction limit of all rings at the end of the next step, N.
    pub(super) fn limit(&self) -> f64 {
        self.buffers.limits.iter().sum()
    }

    /// How many rings are in contact.
    pub(super) fn touching(&self) -> usize {
        self.rings.iter().take_while(|ring| ring.bound > 0.0).count()
    }
}
