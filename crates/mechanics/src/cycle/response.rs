//! A mass on a contact, driven by a force: its steady oscillation at a frequency.
//!
//! M U'' + F(U) = P cos(w t), F with the exact slip history. A contact at constant load is a row of springs with
//! sliders, and two motions of a mass on such a row never draw apart: with the difference of the speeds dV and of the
//! forces of the springs df_i, d/dt (M dV^2/2 + sum df_i^2/(2 k_i)) = -sum df_i (slip_1 - slip_2)_i/k_i <= 0. Where
//! springs slip in each period they draw together: there is one steady oscillation at each frequency, whatever the
//! start, and half a period later it is its own mirror image. (Caughey 1960 found this of bilinear hysteresis: the
//! curve leans to lower frequencies and does not fold.) Where nothing slips, under a flat face that sticks, the mass
//! swings without damping and keeps any free oscillation; the motion with the period of the force is given.
//!
//! It is found by `steady_motion` from the balance of the first harmonic alone, which takes U for a cosine.

use std::cell::Cell;
use std::f64::consts::TAU;

use super::masing_loop::LoadingSeries;
use super::mass_motion::{DrivenMass, Unfinished};
use super::{Drive, Harmonic, SteadyCycle};
use crate::contact::Contact;
use crate::numerics::roots::between;

/// Digits, as a logarithm, to which the balance of the first harmonic is solved: it is a start.
const START: f64 = 1e-3;
/// Where the free oscillation is this many times as fast as the drive, the mass follows the force.
const QUASI_STATIC: f64 = 100.0;

/// A mass that hangs on the contact alone, and the force that drives it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resonator {
    /// The mass, kg.
    pub mass: f64,
    /// Amplitude of the force on it, N.
    pub drive_force: f64,
}

/// A steady oscillation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response {
    /// Frequency, Hz.
    pub frequency: f64,
    /// Amplitude of the first harmonic of the displacement, m.
    pub amplitude: f64,
    /// By how much the first harmonic lags behind the force, rad.
    pub phase: f64,
    /// Half the range of the displacement, m.
    pub peak: f64,
    /// The third harmonic of the contact's force over the first.
    pub third_harmonic: f64,
    /// Error of the amplitude, m, and as part of it that of the phase, rad: an estimate; infinite where the steady
    /// oscillation was not found, and the amplitude is that of the balance of the first harmonic.
    pub amplitude_error: f64,
    /// Error of the peak, m: an estimate, or infinite.
    pub peak_error: f64,
}

impl Resonator {
    /// The frequency of small oscillations, Hz: of the stiffness 2 G* a.
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
    /// use stickslip_mechanics::cycle::{Resonator, SteadyCycle};
    ///
    /// let body = Resonator { mass: 1.0, drive_force: 1.0 };
    /// let stiffness = SteadyCycle::of(&contact, 0.0).tangent_stiffness();
    /// assert!((body.natural_frequency(&contact) - stiffness.sqrt() / std::f64::consts::TAU).abs() < 1e-9);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn natural_frequency(&self, contact: &Contact) -> f64 {
        (SteadyCycle::of(contact, 0.0).tangent_stiffness() / self.mass).sqrt() / TAU
    }

    /// The steady oscillation at each of `frequencies`, Hz, above zero, to `tolerance`, of the amplitude; the errors
    /// say where it was not met. `None` if `keep_going` returned false: it is asked at every frequency and on the way.
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
    /// use stickslip_mechanics::cycle::Resonator;
    ///
    /// let body = Resonator { mass: 1.0, drive_force: 1e-3 };
    /// let low = 0.1 * body.natural_frequency(&contact);
    /// // So little a force is carried by the stiffness, 1 - 0.01 of it being left.
    /// let found = body.respond(&contact, &[low], 1e-7, &|| true).unwrap();
    /// let expected = 1e-3 / (2.0 * 2e6 * 0.1 * 0.99);
    /// assert_eq!(found.len(), 1);
    /// assert!((found[0].amplitude / expected - 1.0).abs() < 1e-6);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn respond(
        &self,
        contact: &Contact,
        frequencies: &[f64],
        tolerance: f64,
        keep_going: &dyn Fn() -> bool,
    ) -> Option<Vec<Response>> {
        let natural = self.natural_frequency(contact);
        // Who has said no is not asked again.
        let stopped = Cell::new(false);
        let keep_going = &|| {
            stopped.set(stopped.get() || !keep_going());
            !stopped.get()
        };
        let loading = LoadingSeries::new(contact);
        let respond = |&frequency: &f64| {
            keep_going().then_some(())?;
            let mass = DrivenMass {
                loading: &loading,
                frequency,
                drive_force: self.drive_force,
                inertia: self.mass * (TAU * frequency).powi(2),
                ratio: natural / frequency,
                keep_going,
            };
            let start = mass.balance_of_first(contact);
            keep_going().then_some(())?;
            if mass.ratio > QUASI_STATIC {
                return Some(mass.quasi_static(contact).unwrap_or(start));
            }
            match mass.steady([start.amplitude, start.phase], tolerance) {
                Err(Unfinished::Interrupted) => None,
                found => Some(found.unwrap_or(start)),
            }
        };
        frequencies.iter().map(respond).collect()
    }
}

impl DrivenMass<'_> {
    /// The balance of the first harmonic alone: (a - M w^2 U0)^2 + b^2 = P^2 with the first harmonic a cos(th) + b
    /// sin(th) of the force in a cycle of the amplitude U0. Its error is not known. Of no use once `keep_going` has
    /// returned false.
    fn balance_of_first(&self, contact: &Contact) -> Response {
        let first = |amplitude: f64| SteadyCycle::of(contact, amplitude).rough_harmonics(1)[0];
        let lag = |amplitude: f64, force: Harmonic| [force.in_phase - self.inertia * amplitude, -force.quadrature];
        let lack = |logarithm: f64| {
            // Ends the search at once: the result is of no use any more.
            if !(self.keep_going)() {
                return 0.0;
            }
            let [carried, lost] = lag(logarithm.exp(), first(logarithm.exp()));
            carried.hypot(lost) - self.drive_force
        };
        // The first harmonic of F lies below the stiffness times U0, and below 4/pi of the limit.
        let small = 0.5 * self.drive_force / (self.inertia * (1.0 + self.ratio * self.ratio));
        let large = 2.0 * (self.drive_force + 1.3 * self.loading.limit) / self.inertia;
        let ends = [small, large].map(f64::ln).map(|logarithm| (logarithm, lack(logarithm)));
        let amplitude = between(ends, START, lack).exp();
        let [carried, lost] = lag(amplitude, first(amplitude));
        Response {
            frequency: self.frequency,
            amplitude,
            phase: lost.atan2(carried),
            peak: amplitude,
            third_harmonic: third_over_first(&SteadyCycle::of(contact, amplitude)),
            amplitude_error: f64::INFINITY,
            peak_error: f64::INFINITY,
        }
    }

    /// The oscillation of a drive so slow that the contact's force is the drive's, but for the inertia of the mass,
    /// which may add to the force what its acceleration does at the softest point of the cycle, and swing to twice
    /// that. `None` where the contact might slide.
    fn quasi_static(&self, contact: &Contact) -> Option<Response> {
        let driven = |force| SteadyCycle::driven(contact, Drive::Force(force), 0.0).ok();
        let cycle = driven(self.drive_force)?;
        let softest = 2.0 * contact.elasticity.g_star() * cycle.ring.inner.radius;
        let swing = 2.0 * self.drive_force * self.inertia / softest;
        let peak = cycle.displacement_amplitude();
        let farther = driven(self.drive_force + swing)?.displacement_amplitude();
        let Harmonic { in_phase, quadrature, .. } = cycle.harmonics(1).harmonics[0];
        // The other way as well, and the ringing of the mass.
        let error = 2.0 * (farther - peak);
        Some(Response {
            frequency: self.frequency,
            amplitude: in_phase.hypot(quadrature),
            phase: quadrature.atan2(in_phase),
            peak,
            third_harmonic: 0.0,
            amplitude_error: error,
            peak_error: error,
        })
    }
}

/// The third harmonic of a cycle over the first.
fn third_over_first(cycle: &SteadyCycle<'_>) -> f64 {
    let harmonics = cycle.rough_harmonics(3);
    let size = |order: usize| harmonics[order - 1].in_phase.hypot(harmonics[order - 1].quadrature);
    if size(1) > 0.0 { size(3) / size(1) } else { 0.0 }
}
