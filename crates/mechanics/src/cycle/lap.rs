//! What is taken down while a cycle is stepped, and the figures of the cycle that follow.

use super::Harmonic;
use crate::{Contact, Regime};

/// A steady cycle that was stepped.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OscillatingCycle {
    /// Half the range of the displacement of the indenter, m.
    pub displacement_amplitude: f64,
    /// Half the range of the tangential force, N.
    pub force_amplitude: f64,
    /// Half the range of the displacement at the machine, m.
    pub machine_amplitude: f64,
    /// Friction work of a cycle, J.
    pub dissipated_energy: f64,
    /// The largest elastic energy of the tangential deformation, J.
    pub max_elastic_energy: f64,
    /// 2 G* a where the drive is largest, N/m.
    pub tangent_stiffness: f64,
    /// Half the distance of the displacements at which the force changes its sign, over the amplitude; `None` if it
    /// does not do so twice.
    pub sliding_ratio: Option<f64>,
    /// Radius of the part that never slips, m.
    pub stick_radius: f64,
    /// The most that slips at any time; separated if the bodies part.
    pub regime: Regime,
    /// As those of [`super::SteadyCycle::harmonics`], even ones too.
    pub harmonics: Vec<Harmonic>,
    /// Steps of the cycle.
    pub steps: usize,
    /// Error of the work over 4 mu F_N U0 and of the force over mu F_N, at the largest load: an estimate.
    pub error: f64,
}

/// The range of a quantity over a cycle.
#[derive(Clone, Copy, Debug)]
struct Extent(f64, f64);

impl Extent {
    const NONE: Extent = Extent(f64::INFINITY, f64::NEG_INFINITY);

    fn include(&mut self, value: f64) {
        *self = Extent(self.0.min(value), self.1.max(value));
    }

    fn half(self) -> f64 {
        0.5 * (self.1 - self.0)
    }
}

/// One stepped cycle.
#[derive(Clone, Debug)]
pub(super) struct Lap {
    /// What has been found so far, but for the ranges.
    cycle: OscillatingCycle,
    displacement: Extent,
    force: Extent,
    machine: Extent,
    /// The last displacement, m, and force, N.
    pub(super) last: [f64; 2],
    /// Displacements at which the force changes its sign, m.
    crossings: Vec<f64>,
}

impl Lap {
    /// From the present state of a contact, with harmonics up to the order `count`.
    pub(super) fn new(contact: &Contact, count: usize) -> Lap {
        let harmonic = |order| Harmonic { order, in_phase: 0.0, quadrature: 0.0 };
        let cycle = OscillatingCycle {
            tangent_stiffness: 2.0 * contact.elasticity.g_star() * contact.contact_radius(),
            stick_radius: f64::INFINITY,
            harmonics: (1..=count).map(harmonic).collect(),
            ..OscillatingCycle::default()
        };
        let last = [contact.displacement.value(), contact.force()];
        let [displacement, force, machine] = [Extent::NONE; 3];
        Lap { cycle, displacement, force, machine, last, crossings: Vec::new() }
    }

    /// Takes down the state of a contact, through a machine of this compliance, m/N.
    pub(super) fn include(&mut self, contact: &Contact, compliance: f64) {
        let state = contact.state();
        let [displacement, force] = [state.displacement, state.force];
        self.displacement.include(displacement);
        self.force.include(force);
        self.machine.include(displacement + compliance * force);
        let cycle = &mut self.cycle;
        cycle.max_elastic_energy = cycle.max_elastic_energy.max(state.elastic_energy);
        cycle.stick_radius = cycle.stick_radius.min(state.stick_radius);
        cycle.regime = cycle.regime.max(state.regime);
        let [before, carried] = self.last;
        if (carried > 0.0) != (force > 0.0) && (force - carried).abs() > 0.0 {
            self.crossings.push(before - carried * (displacement - before) / (force - carried));
        }
        self.last = [displacement, force];
    }

    /// Adds one of so many equally spaced answers to the harmonics.
    pub(super) fn transform(&mut self, answer: f64, angle: f64, steps: usize) {
        for harmonic in &mut self.cycle.harmonics {
            let (sin, cos) = (harmonic.order as f64 * angle).sin_cos();
            let share = 2.0 / steps as f64 * answer;
            harmonic.in_phase += share * cos;
            harmonic.quadrature += share * sin;
        }
    }

    /// The cycle, in which this friction work was done, J.
    pub(super) fn finished(self, steps: usize, dissipated_energy: f64) -> OscillatingCycle {
        let displacement_amplitude = self.displacement.half();
        let sliding_ratio = match self.crossings[..] {
            [one, other] if displacement_amplitude > 0.0 => Some(0.5 * (one - other).abs() / displacement_amplitude),
            _ => None,
        };
        OscillatingCycle {
            displacement_amplitude,
            force_amplitude: self.force.half(),
            machine_amplitude: self.machine.half(),
            dissipated_energy,
            sliding_ratio,
            steps,
            ..self.cycle
        }
    }
}
