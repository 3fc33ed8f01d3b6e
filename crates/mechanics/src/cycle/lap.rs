//! The characteristic values of a cycle that was stepped, from its states.

use std::f64::consts::TAU;

use super::Harmonic;
use crate::contact::Contact;
use crate::contact::state::{Regime, State};

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
    /// Work of the tangential force that the bodies dissipate in a cycle, J, if they have memory.
    pub viscous_work: Option<f64>,
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

impl OscillatingCycle {
    /// The cycle through these states of a contact, the first of which is its start, with this friction work, J,
    /// through a machine of this compliance, m/N. Harmonics up to the order `count` follow from an answer at every
    /// second step.
    pub(super) fn through(
        contact: &Contact,
        states: &[State],
        dissipated_energy: f64,
        (answers, count): (&[f64], usize),
        compliance: f64,
    ) -> OscillatingCycle {
        let after = &states[1..];
        let amplitude = |of: &dyn Fn(&State) -> f64| {
            let largest = |sign: f64| after.iter().map(|state| sign * of(state)).fold(f64::NEG_INFINITY, f64::max);
            0.5 * (largest(1.0) + largest(-1.0))
        };
        let displacement_amplitude = amplitude(&|state| state.displacement);
        // Where the force changes its sign.
        let crossing = |pair: &[State]| {
            let change = pair[1].force - pair[0].force;
            let crosses = (pair[0].force > 0.0) != (pair[1].force > 0.0) && change.abs() > 0.0;
            let way = pair[1].displacement - pair[0].displacement;
            crosses.then(|| pair[0].displacement - pair[0].force * way / change)
        };
        let sliding_ratio = match states.windows(2).filter_map(crossing).collect::<Vec<f64>>()[..] {
            [one, other] if displacement_amplitude > 0.0 => Some(0.5 * (one - other).abs() / displacement_amplitude),
            _ => None,
        };
        OscillatingCycle {
            displacement_amplitude,
            force_amplitude: amplitude(&|state| state.force),
            machine_amplitude: amplitude(&|state| state.displacement + compliance * state.force),
            dissipated_energy,
            viscous_work: None,
            max_elastic_energy: after.iter().map(|state| state.elastic_energy).fold(0.0, f64::max),
            tangent_stiffness: 2.0
                * contact.elasticity.g_star()
                * contact
                    .indenter
                    .line()
                    .map_or(states[0].contact_radius, |_| contact.indenter.radius(states[0].indentation)),
            sliding_ratio,
            stick_radius: after.iter().map(|state| state.stick_radius).fold(f64::INFINITY, f64::min),
            regime: after.iter().map(|state| state.regime).fold(Regime::Stick, Regime::max),
            harmonics: (1..=count).map(|order| Harmonic::of(answers, order)).collect(),
            steps: 2 * answers.len(),
            error: 0.0,
        }
    }
}

impl Harmonic {
    /// The harmonic of answers at equal steps over a cycle, up to its end.
    fn of(answers: &[f64], order: usize) -> Harmonic {
        let mut harmonic = Harmonic { order, in_phase: 0.0, quadrature: 0.0 };
        let share = 2.0 / answers.len() as f64;
        for (step, answer) in answers.iter().enumerate() {
            let (sin, cos) = (order as f64 * (TAU * (step + 1) as f64 / answers.len() as f64)).sin_cos();
            harmonic.in_phase += share * answer * cos;
            harmonic.quadrature += share * answer * sin;
        }
        harmonic
    }
}
