//! One discrete contact: rings of one number, moved step by step.

use std::sync::Arc;

use super::NO_SLIP;
use super::mesh::{Mesh, Vector, times};
use super::slip::{Workspace, solve};

/// The end of a step.
#[derive(Clone, Copy, Debug)]
pub(super) enum Target {
    Displacement(Vector),
    Force(Vector),
}

/// Rings with their history. Displacements are relative to that of gross slip at the deepest indentation of the path,
/// forces to G* times the outermost radius times it.
#[derive(Clone, Debug)]
pub(super) struct Level {
    pub(super) mesh: Arc<Mesh>,
    /// Friction times the load of each ring.
    pub(super) bounds: Vec<f64>,
    /// Mean displacement of each ring less that of the indenter: minus the slip so far. Kept outside the contact too,
    /// so that a ring sticks where it is met.
    pub(super) memory: Vec<Vector>,
    pub(super) traction: Vec<Vector>,
    pub(super) displacement: Vector,
    pub(super) force: Vector,
    /// Work of the tangential force.
    pub(super) work: f64,
    pub(super) elastic: f64,
    /// The largest force that the search for a slip has left, in any step.
    pub(super) unsettled: f64,
    /// Friction work of each ring.
    pub(super) dissipated: Vec<f64>,
    /// Which rings have slipped in the present move.
    pub(super) slipped: Vec<bool>,
    /// Slip of the last step and of the one before, from which the next one begins its search.
    slip: Vec<Vector>,
    earlier: Vec<Vector>,
    before: Vec<Vector>,
    forces: Vec<Vector>,
    workspace: Workspace,
}

impl Level {
    pub(super) fn new(mesh: Arc<Mesh>, bounds: Vec<f64>) -> Level {
        let still = vec![[0.0; 2]; mesh.count];
        Level {
            bounds,
            memory: still.clone(),
            traction: still.clone(),
            displacement: [0.0; 2],
            force: [0.0; 2],
            work: 0.0,
            elastic: 0.0,
            unsettled: 0.0,
            dissipated: vec![0.0; mesh.count],
            slipped: vec![false; mesh.count],
            slip: still.clone(),
            earlier: still.clone(),
            before: still.clone(),
            forces: still,
            workspace: Workspace::default(),
            mesh,
        }
    }

    /// A step in which all changes at once: of first order in its length.
    pub(super) fn step(&mut self, target: Target) {
        let mesh = &self.mesh;
        self.before.copy_from_slice(&self.traction);
        let (stiffness, begin, total) =
            (mesh.stiffness(matches!(target, Target::Force(_))), self.displacement, mesh.total);
        match target {
            Target::Displacement(to) => {
                self.displacement = to;
                self.memory.iter_mut().for_each(|ring| *ring = [ring[0] + to[0], ring[1] + to[1]]);
                times(stiffness, &self.memory, &mut self.forces);
            }
            Target::Force(force) => {
                times(stiffness, &self.memory, &mut self.forces);
                for (ring, share) in self.forces.iter_mut().zip(mesh.together()) {
                    *ring = [ring[0] + share / total * force[0], ring[1] + share / total * force[1]];
                }
            }
        }
        // The guess of this slip: that of the last two steps drawn straight on, where it does not turn round.
        for (slip, earlier) in self.slip.iter_mut().zip(&mut self.earlier) {
            let before = std::mem::replace(earlier, *slip);
            let ahead = [2.0 * slip[0] - before[0], 2.0 * slip[1] - before[1]];
            if ahead[0] * slip[0] + ahead[1] * slip[1] > 0.0 {
                *slip = ahead;
            }
        }
        let left =
            solve(stiffness, &self.bounds, &self.forces, &mut self.traction, &mut self.slip, &mut self.workspace);
        self.unsettled = self.unsettled.max(left);
        // From here on `memory` is the displacement of the rings, without that of the indenter where a force is given.
        for (ring, slip) in self.memory.iter_mut().zip(&self.slip) {
            *ring = [ring[0] - slip[0], ring[1] - slip[1]];
        }
        let force = sum(&self.traction);
        if let Target::Force(wanted) = target {
            let carried = self.memory.iter().zip(mesh.together());
            let carried =
                carried.fold([0.0; 2], |sum, (ring, share)| [sum[0] + share * ring[0], sum[1] + share * ring[1]]);
            self.displacement = [(wanted[0] - carried[0]) / total, (wanted[1] - carried[1]) / total];
        }
        let [x, y] = self.displacement;
        let moved = if matches!(target, Target::Force(_)) { [x, y] } else { [0.0; 2] };
        self.elastic = 0.5
            * self
                .memory
                .iter()
                .zip(&self.traction)
                .map(|(ring, traction)| traction[0] * (ring[0] + moved[0]) + traction[1] * (ring[1] + moved[1]))
                .sum::<f64>();
        if let Target::Displacement(to) = target {
            self.memory.iter_mut().for_each(|ring| *ring = [ring[0] - to[0], ring[1] - to[1]]);
        }
        self.work += 0.5 * ((self.force[0] + force[0]) * (x - begin[0]) + (self.force[1] + force[1]) * (y - begin[1]));
        self.force = force;
        for (index, slip) in self.slip.iter().enumerate() {
            let mean = [0, 1].map(|axis| 0.5 * (self.before[index][axis] + self.traction[index][axis]));
            self.dissipated[index] += mean[0] * slip[0] + mean[1] * slip[1];
            self.slipped[index] |= self.bounds[index] > 0.0 && slip[0].hypot(slip[1]) > NO_SLIP;
        }
    }
}

fn sum(vectors: &[Vector]) -> Vector {
    vectors.iter().fold([0.0; 2], |sum, vector| [sum[0] + vector[0], sum[1] + vector[1]])
}
