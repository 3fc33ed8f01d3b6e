//! One contact of a law, with rings that are halved and doubled as it shrinks and grows.

use super::super::step::RingState;
use super::super::stiffness::Vector;
use super::PlanarState;
use crate::contact::state::Regime;

/// The part of its area by which a contact may exceed its rings: rounding.
const SAME_AREA: f64 = 1e-12;

/// One contact with the history of its rings.
#[derive(Clone, Debug)]
pub struct PlanarContact {
    pub(super) indentation: f64,
    pub(super) normal_force: f64,
    pub(super) radius: f64,
    pub(super) displacement: Vector,
    pub(super) force: Vector,
    pub(super) stick_radius: f64,
    pub(super) dissipated: f64,
    pub(super) elastic: f64,
    pub(super) unsettled: f64,
    /// The area of a ring over pi, m^2; zero without a contact.
    pub(super) area: f64,
    /// Those that touch, from the centre outwards.
    pub(super) rings: Vec<RingState>,
}

impl PlanarContact {
    /// Normal force F_N, N.
    #[must_use]
    pub fn normal_force(&self) -> f64 {
        self.normal_force
    }

    /// Tangential force, N.
    #[must_use]
    pub fn force(&self) -> [f64; 2] {
        self.force
    }

    /// The largest force of a ring that the search for its slip has left in the last step, N: rounding, unless the
    /// search did not end.
    #[must_use]
    pub fn unsettled_force(&self) -> f64 {
        self.unsettled
    }

    /// The state after the last step.
    #[must_use]
    pub fn state(&self) -> PlanarState {
        PlanarState {
            displacement: self.displacement,
            force: self.force,
            indentation: self.indentation,
            normal_force: self.normal_force,
            contact_radius: self.radius,
            stick_radius: self.stick_radius,
            regime: match self.stick_radius {
                _ if self.indentation < 0.0 => Regime::Separated,
                radius if radius <= 0.0 && !self.rings.is_empty() => Regime::GrossSlip,
                radius if radius < self.radius => Regime::PartialSlip,
                _ => Regime::Stick,
            },
            dissipated_energy: self.dissipated,
            elastic_energy: self.elastic,
            work: self.dissipated + self.elastic,
        }
    }

    /// Bytes of RAM that it takes.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        size_of::<PlanarContact>() + self.rings.capacity() * size_of::<RingState>()
    }

    /// Whether this load, of an indentation, m, and a normal force, N, is not the present one.
    pub(super) fn carries_another(&self, [indentation, normal_force]: [f64; 2]) -> bool {
        indentation.to_bits() != self.indentation.to_bits() || normal_force.to_bits() != self.normal_force.to_bits()
    }

    /// Twice what two half steps have led to less what the `whole` step has, within the friction of each ring;
    /// `dissipated` is the friction work before, J.
    pub(super) fn extrapolate(&mut self, whole: &PlanarContact, dissipated: f64) {
        self.stick_radius = whole.stick_radius;
        if self.area.to_bits() != whole.area.to_bits() || self.rings.len() != whole.rings.len() {
            return;
        }
        self.force = [0.0; 2];
        for (ring, whole) in self.rings.iter_mut().zip(&whole.rings) {
            let [x, y] = [0, 1].map(|axis| 2.0 * ring.traction[axis] - whole.traction[axis]);
            let share = (ring.bound / x.hypot(y)).min(1.0);
            ring.traction = if share < 1.0 { [x * share, y * share] } else { [x, y] };
            self.force = [0, 1].map(|axis| self.force[axis] + ring.traction[axis]);
        }
        self.dissipated = (2.0 * self.dissipated - whole.dissipated).max(dissipated);
        self.elastic = (2.0 * self.elastic - whole.elastic).max(0.0);
    }

    /// How many rings the contact takes.
    pub(super) fn touching(&self) -> f64 {
        (self.radius * self.radius * (1.0 - SAME_AREA) / self.area).ceil().max(1.0)
    }

    /// Makes one ring of two: the force on both stays.
    pub(super) fn merge(&mut self) {
        self.area *= 2.0;
        let merged = |pair: &[RingState]| RingState {
            bound: pair.iter().map(|ring| ring.bound).sum(),
            traction: [0, 1].map(|axis| pair.iter().map(|ring| ring.traction[axis]).sum()),
            slip: [0.0; 2],
        };
        self.rings = self.rings.chunks(2).map(merged).collect();
    }

    /// Makes two rings of one: the force on it is shared as the bounds are.
    pub(super) fn split(&mut self, bounds: &[f64]) {
        let halves = self.rings.iter().zip(bounds.chunks(2));
        let of_ring = |(ring, pair): (&RingState, &[f64])| {
            let (traction, whole) = (ring.traction, pair.iter().sum::<f64>());
            let half = move |bound: &f64| {
                let share = if whole > 0.0 { bound / whole } else { 0.0 };
                RingState { bound: *bound, traction: traction.map(|component| component * share), slip: [0.0; 2] }
            };
            pair.iter().map(half).collect::<Vec<_>>()
        };
        self.rings = halves.flat_map(of_ring).collect();
    }
}
