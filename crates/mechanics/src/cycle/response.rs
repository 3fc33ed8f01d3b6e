//! A mass on a contact, driven by a force: amplitude and phase over the frequency, by harmonic balance.
//!
//! M U'' + F(U) = P cos(w t) with U = U0 cos(th), th = w t - psi, and the first harmonic of F, a cos(th) + b sin(th):
//! (a - M w^2 U0)^2 + b^2 = P^2, tan(psi) = -b/(a - M w^2 U0). The loop gets softer as it grows, so that the curve leans
//! over and up to three amplitudes belong to a frequency. The third harmonic, which the balance leaves out, says how far
//! it may be off.

use std::f64::consts::TAU;

use super::{Harmonic, SteadyCycle};
use crate::Contact;

/// Amplitudes, evenly spaced in their logarithm, between which roots are sought.
const AMPLITUDES: usize = 1_024;
/// Halvings of the bracket of a root.
const HALVINGS: usize = 50;

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
    /// Amplitude of the displacement, m.
    pub amplitude: f64,
    /// By how much it lags behind the force, rad.
    pub phase: f64,
    /// The third harmonic of the contact's force over the first.
    pub third_harmonic: f64,
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

    /// All steady oscillations at each of `frequencies`, Hz, above zero; one frequency after the other, the smallest
    /// amplitude first. `None` if `keep_going` returned false: it is asked at every amplitude and frequency.
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
    /// use stickslip_mechanics::cycle::Resonator;
    ///
    /// let body = Resonator { mass: 1.0, drive_force: 1e-3 };
    /// let low = 0.1 * body.natural_frequency(&contact);
    /// // So little a force is carried by the stiffness, 1 - 0.01 of it being left.
    /// let found = body.respond(&contact, &[low], &|| true).unwrap();
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
        keep_going: &dyn Fn() -> bool,
    ) -> Option<Vec<Response>> {
        let stiffness = SteadyCycle::of(contact, 0.0).tangent_stiffness();
        let limit = contact.friction * contact.normal_force;
        let inertia = |frequency: f64| self.mass * (TAU * frequency).powi(2);
        let (least, most) = frequencies.iter().fold((f64::INFINITY, 0.0_f64), |(least, most), &frequency| {
            // The first harmonic of F lies below the stiffness times U0, and below 4/pi of the limit.
            let small = 0.5 * self.drive_force / (stiffness + inertia(frequency));
            let large = 2.0 * (self.drive_force + 1.3 * limit) / inertia(frequency);
            (least.min(small), most.max(large))
        });
        let first = |amplitude: f64| SteadyCycle::of(contact, amplitude).harmonics(1).harmonics[0];
        let mut table: Vec<(f64, Harmonic)> = Vec::with_capacity(AMPLITUDES + 1);
        for index in 0..=AMPLITUDES {
            let amplitude = least * (most / least).powf(index as f64 / AMPLITUDES as f64);
            keep_going().then(|| table.push((amplitude, first(amplitude))))?;
        }
        let mut found = Vec::new();
        for &frequency in frequencies {
            keep_going().then_some(())?;
            let lack = |amplitude: f64, force: &Harmonic| {
                (force.in_phase - inertia(frequency) * amplitude).hypot(force.quadrature) - self.drive_force
            };
            for pair in table.windows(2) {
                let [(mut low, _), (mut high, _)] = [pair[0], pair[1]];
                let below = lack(low, &pair[0].1) < 0.0;
                if below == (lack(high, &pair[1].1) < 0.0) {
                    continue;
                }
                for _ in 0..HALVINGS {
                    let middle = 0.5 * (low + high);
                    if (lack(middle, &first(middle)) < 0.0) == below { low = middle } else { high = middle }
                }
                let harmonics = SteadyCycle::of(contact, high).harmonics(3).harmonics;
                let size = |order: usize| harmonics[order - 1].in_phase.hypot(harmonics[order - 1].quadrature);
                found.push(Response {
                    frequency,
                    amplitude: high,
                    phase: (-harmonics[0].quadrature).atan2(harmonics[0].in_phase - inertia(frequency) * high),
                    third_harmonic: if size(1) > 0.0 { size(3) / size(1) } else { 0.0 },
                });
            }
        }
        Some(found)
    }
}
