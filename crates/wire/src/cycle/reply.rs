//! The reply of `POST /cycle` and `GET /contacts/{id}/cycle`.

use stickslip_mechanics::cycle;

use super::{BestLoad, Resonance};
use crate::prelude::*;

replies! {
/// Steady cycles, one for each amplitude.
pub struct CycleReply omits Option {
    /// The contact at its load; in a map, at its preload.
    pub contact: ContactSummary,
    /// The cycles, in the order of the amplitudes; in a map load by load, with frequencies one by one.
    pub cycles: Vec<SteadyCycle>,
    /// The oscillations of a mass on the contact, if asked for.
    pub frequency_response: Option<Resonance>,
    /// Solver, errors and time. `force_error` also holds for the harmonics, relative to the amplitude of the response.
    pub accuracy: Accuracy,
    /// Warnings about the result.
    pub warnings: Vec<Warning>,
}

/// One steady cycle.
pub struct SteadyCycle: Default omits Option {
    /// Frequency, Hz; only of bodies with `prony`.
    pub frequency: Option<f64>,
    /// Normal force, N; only in a map, and of bodies with `prony`, that to which they have relaxed.
    pub normal_force: Option<f64>,
    /// Displacement amplitude of the indenter at which gross slip begins under this load, m; only in a map, and of
    /// bodies with `prony`, whose slow cycles have it.
    pub gross_slip_displacement: Option<f64>,
    /// Amplitude of the displacement of the indenter, m; left out where the contact is twisted.
    pub displacement_amplitude: Option<f64>,
    /// Amplitude of the tangential force, N; left out where the contact is twisted.
    pub force_amplitude: Option<f64>,
    /// Amplitude of the angle of twist of the indenter, rad, where `twist` or `torque` is driven.
    pub twist_amplitude: Option<f64>,
    /// Amplitude of the torque, N·m, where `twist` or `torque` is driven.
    pub torque_amplitude: Option<f64>,
    /// Amplitude of the displacement at the machine, m, or of its angle, rad; only with `machine`.
    pub machine_amplitude: Option<f64>,
    /// Friction work of a cycle, J: the area of the force-displacement loop, without `viscous_work`.
    pub dissipated_energy: f64,
    /// Work of the tangential force that the bodies dissipate in a cycle by their memory, J, if they have `prony`.
    pub viscous_work: Option<f64>,
    /// The largest elastic energy of the tangential deformation in a cycle, J.
    pub max_elastic_energy: f64,
    /// Force amplitude over displacement amplitude of the indenter, N/m, or torque over angle, N·m/rad; at zero
    /// amplitude the tangent stiffness.
    pub secant_stiffness: f64,
    /// Stiffness of the contact just after a reversal, 2 G* a, N/m, under twist (16/3) G a³, N·m/rad; zero without
    /// friction.
    pub tangent_stiffness: f64,
    /// Dissipated energy, and viscous work, over 2π times the largest elastic energy, a pure number; `null` where the
    /// indenter slides and nothing is stored, as without friction and without load.
    #[serde_with(skip_apply)]
    pub loss_factor: Option<f64>,
    /// Displacement at zero force over the amplitude of the indenter, a pure number; `null` where the indenter moves
    /// without a force, as without friction and without load.
    #[serde_with(skip_apply)]
    pub sliding_ratio: Option<f64>,
    /// All energy that friction dissipates in a cycle, J, where a bulk stress does work too: the integral of
    /// `friction_work` over the contact. Otherwise it equals `dissipated_energy` and is left out.
    pub friction_energy: Option<f64>,
    /// Stick radius c of the cycle, m: inside it nothing ever slips. The contact radius if nothing slips, zero in gross
    /// slip.
    pub stick_radius: f64,
    /// How much of the contact slips.
    pub regime: Regime,
    /// The harmonics, if asked for: of the force, N, where the displacement is driven, and of the displacement of the
    /// indenter, m, where the force is driven; of torque, N·m, or angle, rad, where the contact is twisted.
    pub harmonics: Option<Vec<Harmonic>>,
    /// The friction work per area, if asked for.
    pub friction_work: Option<FrictionWork>,
    /// The load under which this amplitude does the most friction work, if asked for and if there is such a load.
    pub best_load: Option<BestLoad>,
}

/// One harmonic of the response to a drive that is a cosine.
pub struct Harmonic: Copy of cycle::Harmonic {
    /// 1 for the fundamental. Even ones vanish at constant load.
    pub order: usize,
    /// Amplitude of the cosine, in the unit of the response.
    pub in_phase: f64,
    /// Amplitude of the sine, in the unit of the response: for the fundamental not positive for a force, not negative
    /// for a displacement.
    pub quadrature: f64,
}

/// Friction work of a cycle per area, along the radius.
pub struct FrictionWork omits Option {
    /// Radii in a round contact, m.
    pub radius: Option<Vec<f64>>,
    /// Places along x in a line contact, m.
    pub x: Option<Vec<f64>>,
    /// Friction work per area, J/m²; `null` where it is infinite.
    pub density: Vec<Option<f64>>,
}
}

impl SteadyCycle {
    /// The amplitude of the displacement, m, or of the twist, rad.
    pub fn amplitude(&self) -> f64 {
        self.displacement_amplitude.or(self.twist_amplitude).unwrap_or_default()
    }
}
