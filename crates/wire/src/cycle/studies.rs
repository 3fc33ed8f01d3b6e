//! Studies of steady cycles: a mass on the contact, and the load that damps most.

use crate::prelude::*;

requests! {
/// A mass that only the contact holds, and a force on it that is a cosine of time.
#[schema(example = json!({"mass": 0.1, "drive_force": 0.5}))]
pub struct FrequencyResponse {
    /// The mass, kg.
    pub mass: f64 = Range { quantity: Quantity::Number, unit: "kg", min: 1e-15, max: 1e15 },
    /// Amplitude of the force on it, N.
    pub drive_force: f64 = Range { min: 1e-15, max: 1e15, ..range::FORCE },
    /// Frequencies, Hz; if left out, 200 from 0.3 to 1.5 times the frequency of small oscillations.
    pub frequencies: Option<Vec<f64>> = Array(1..=1_000, FREQUENCY),
}

/// A search for the load that damps most.
#[schema(example = json!({"points": 50}))]
pub struct BestLoadStudy: Copy, Default {
    /// Also ask for the work at this many loads, evenly spaced up to three times the best one.
    pub points: Option<usize> = 2..=1_000_usize,
}
}

/// A frequency.
pub(super) const FREQUENCY: Range = Range { quantity: Quantity::Number, unit: "Hz", min: 1e-6, max: 1e12 };

replies! {
/// Steady oscillations of a mass on the contact.
pub struct Resonance {
    /// Frequency of small oscillations, Hz.
    pub natural_frequency: f64,
    /// The steady oscillation at each frequency, in the order of the frequencies. It is unique if something slips in
    /// each period, as under every face that is not flat: friction draws any two motions of the mass together. A flat
    /// face that sticks throughout adds no damping; the oscillation given is then the one with the period of the force,
    /// beside which a free oscillation may persist.
    pub points: Vec<ResonancePoint>,
}

/// One steady oscillation.
pub struct ResonancePoint: Copy {
    /// Frequency, Hz.
    pub frequency: f64,
    /// Amplitude of the first harmonic of the displacement, m.
    pub amplitude: f64,
    /// Estimated error of the amplitude, m; over the amplitude it is that of the phase in rad. `null` where the steady
    /// oscillation was not found: the other numbers then follow from the first harmonic of the force alone, and may be
    /// far off.
    pub amplitude_error: Option<f64>,
    /// By how much the first harmonic of the displacement lags behind the force, degrees.
    pub phase: f64,
    /// Half the range of the displacement, m: it differs from the amplitude by the higher harmonics.
    pub peak: f64,
    /// Estimated error of the peak, m; `null` as for `amplitude_error`.
    pub peak_error: Option<f64>,
    /// Third harmonic of the force of the contact over the first, a pure number.
    pub third_harmonic: f64,
}

/// The load under which a drive does the most friction work.
pub struct BestLoad omits Option {
    /// Normal force, N.
    pub normal_force: f64,
    /// Friction work of a cycle under this load, J.
    pub dissipated_energy: f64,
    /// The work at other loads, if asked for.
    pub curve: Option<LoadCurve>,
}

/// Friction work over the load.
pub struct LoadCurve {
    /// Normal forces, N.
    pub normal_force: Vec<f64>,
    /// Friction work of a cycle, J; `null` under loads at which friction cannot hold the driven force, and under those
    /// that the profile does not allow.
    pub dissipated_energy: Vec<Option<f64>>,
}
}
