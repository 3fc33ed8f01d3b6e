//! What is taken down while a cycle is stepped, and the figures of the cycle that follow.

use super::Harmonic;
use crate::{Regime, State};

/// From the least that slips to the most.
const REGIMES: [Regime; 4] = [Regime::Stick, Regime::PartialSlip, Regime::GrossSlip, Regime::Separated];

/// A steady cycle that was stepped.
#[derive(Clone, Debug, PartialEq)]
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
pub(super) struct Extent(f64, f64);

impl Extent {
    const NONE: Extent = Extent(f64::INFINITY, f64::NEG_INFINITY);

    fn include(&mut self, value: f64) {
        *self = Extent(self.0.min(value), self.1.max(value));
    }

    pub(super) fn half(self) -> f64 {
        0.5 * (self.1 - self.0)
    }
}

/// One stepped cycle.
#[derive(Clone, Debug)]
pub(super) struct Lap {
    pub(super) displacement: Extent,
    force: Extent,
    machine: Extent,
    /// Friction work, J.
    pub(super) work: f64,
    /// The force at the end, N.
    pub(super) end: f64,
    energy: f64,
    stiffness: f64,
    stick_radius: f64,
    /// An index of [`REGIMES`].
    regime: usize,
    /// Displacements at which the force changes its sign, m.
    crossings: Vec<f64>,
    sums: Vec<[f64; 2]>,
}

impl Lap {
    pub(super) fn new(stiffness: f64, harmonics: usize) -> Lap {
        Lap {
            displacement: Extent::NONE,
            force: Extent::NONE,
            machine: Extent::NONE,
            work: 0.0,
            end: 0.0,
            energy: 0.0,
            stiffness,
            stick_radius: f64::INFINITY,
            regime: 0,
            crossings: Vec::new(),
            sums: vec![[0.0; 2]; harmonics],
        }
    }

    /// Takes down a state, which displacement and force `before` precede.
    pub(super) fn include(&mut self, state: &State, before: (f64, f64), compliance: f64) {
        let &State { displacement, force, .. } = state;
        self.displacement.include(displacement);
        self.force.include(force);
        self.machine.include(displacement + compliance * force);
        self.energy = self.energy.max(state.elastic_energy);
        self.stick_radius = self.stick_radius.min(state.stick_radius);
        self.regime = self.regime.max(REGIMES.iter().position(|regime| *regime == state.regime).unwrap_or(0));
        if (before.1 > 0.0) != (force > 0.0) && (force - before.1).abs() > 0.0 {
            self.crossings.push(before.0 - before.1 * (displacement - before.0) / (force - before.1));
        }
    }

    /// Adds one of so many equally spaced answers to the harmonics.
    pub(super) fn transform(&mut self, answer: f64, angle: f64, steps: usize) {
        for (index, sum) in self.sums.iter_mut().enumerate() {
            let (sin, cos) = ((index + 1) as f64 * angle).sin_cos();
            let share = 2.0 / steps as f64 * answer;
            *sum = [sum[0] + share * cos, sum[1] + share * sin];
        }
    }

    /// The cycle, which differs from the one before by `error`.
    pub(super) fn finished(self, steps: usize, error: f64) -> OscillatingCycle {
        let displacement_amplitude = self.displacement.half();
        let sliding_ratio = match self.crossings[..] {
            [one, other] if displacement_amplitude > 0.0 => Some(0.5 * (one - other).abs() / displacement_amplitude),
            _ => None,
        };
        let harmonic =
            |(index, sum): (usize, [f64; 2])| Harmonic { order: index + 1, in_phase: sum[0], quadrature: sum[1] };
        OscillatingCycle {
            displacement_amplitude,
            force_amplitude: self.force.half(),
            machine_amplitude: self.machine.half(),
            dissipated_energy: self.work,
            max_elastic_energy: self.energy,
            tangent_stiffness: self.stiffness,
            sliding_ratio,
            stick_radius: self.stick_radius,
            regime: REGIMES[self.regime],
            harmonics: self.sums.into_iter().enumerate().map(harmonic).collect(),
            steps,
            error,
        }
    }
}
