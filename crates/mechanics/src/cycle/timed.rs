//! Steady cycles of bodies with memory: a cosine in time, at a load that has been held for long.
//!
//! Then the bodies have relaxed under the load, and the springs of the contact are clamped to constant bounds, mu times
//! the relaxed pressure, each for itself. So each has the steady loop of its bound alone ([`crate::viscoelastic`]), the
//! springs inside the stick radius that of the complex modulus, and the contact is the sum over x of [0, a]: by panels
//! of a Gauss rule from the stick radius on, divided where the profile is not analytic. Of the steady motions of a
//! contact, which differ by a mean force of the springs that never slip, it is the one whose mean force is zero.

use std::f64::consts::PI;

use super::lap::OscillatingCycle;
use crate::contact::Contact;
use crate::contact::normal::Preload;
use crate::contact::state::{Regime, Setup, State};
use crate::numerics::gauss::TWENTY_POINTS;
use crate::range::error::Error;
use crate::viscoelastic::steady::{Loop, Wave};

/// Panels between two kinks of a profile, and phases of half a turn.
const PANELS: usize = 8;
const PHASES: usize = 256;
/// A bound that carries nothing, over the stiffness.
const NO_BOUND: f64 = 1e-10;
/// A change of phases above this asks for smaller steps to the next bound.
const UNSETTLED: f64 = 1e-10;

/// A cosine of the displacement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimedCycle {
    /// Amplitude of the displacement, m.
    pub amplitude: f64,
    /// Frequency, Hz.
    pub frequency: f64,
}

/// Sums over springs: forces over 2 G* and twice the energies over 2 G* at phases from 0 to half a turn, both works of
/// a turn, and how well the loops have been found.
struct Sums {
    forces: Vec<f64>,
    energies: Vec<f64>,
    works: [f64; 2],
    change: f64,
}

impl Contact {
    /// The elastic contact with the relaxed moduli that one of bodies with memory becomes for long under a load that is
    /// held: the normal force of a preload, or its indentation.
    ///
    /// # Errors
    /// [`Error::FluidUnderLoad`] for a fluid, which keeps no load, [`Error::NoMemory`] for elastic bodies, and as
    /// [`Contact::new`].
    pub fn relaxed(&self, held: Preload) -> Result<Contact, Error> {
        let prony = &self.viscoelastic.as_ref().ok_or(Error::NoMemory)?.prony;
        if prony.is_fluid() {
            return Err(Error::FluidUnderLoad);
        }
        let [e_star, g_star] = [self.elasticity.e_star(), self.elasticity.g_star()].map(|of| prony.relaxed() * of);
        let elasticity = self.elasticity.with_moduli(e_star, g_star)?;
        let profile = self.indenter.shared_profile();
        Contact::new(Setup { profile, elasticity, friction: self.friction, preload: held })
    }
}

impl TimedCycle {
    /// The steady cycle of a contact of bodies with memory, whose load has become that of `relaxed`
    /// ([`Contact::relaxed`]), with harmonics up to the order `count`.
    ///
    /// # Errors
    /// [`Error::NoMemory`] for elastic bodies; [`Error::Interrupted`] if `keep_going` returned false.
    ///
    /// ```
    /// use std::sync::Arc;
    ///
    /// use stickslip_mechanics::cycle::TimedCycle;
    /// use stickslip_mechanics::{Contact, Elasticity, Friction, Law, Preload, Profile, Prony, PronyTerm, Setup};
    /// use stickslip_mechanics::Sphere;
    ///
    /// let memory = Prony::new(&[PronyTerm { ratio: 0.6, time: 1.0 }])?;
    /// let contact = Contact::new(Setup {
    ///     profile: Profile::Sphere(Sphere::new(0.01)?),
    ///     elasticity: Elasticity::effective(1e6, 8e5)?,
    ///     friction: Law { limit: Friction::from(0.5), memory: Some(Arc::new(memory)) },
    ///     preload: Preload::Indentation(1e-4),
    /// })?;
    /// let relaxed = contact.relaxed(Preload::Indentation(1e-4))?;
    /// assert!((relaxed.normal_force() / contact.normal_force() - 0.4).abs() < 1e-12);
    /// let swing = |frequency| TimedCycle { amplitude: 2e-5, frequency };
    /// let [slow, near] = [1e-4, 0.1].map(|frequency| swing(frequency).steady(&contact, &relaxed, 0, &|| true));
    /// // Bodies dissipate most near their relaxation time.
    /// assert!(near?.viscous_work > slow?.viscous_work);
    /// # Ok::<(), stickslip_mechanics::Error>(())
    /// ```
    pub fn steady(
        &self,
        contact: &Contact,
        relaxed: &Contact,
        count: usize,
        keep_going: &dyn Fn() -> bool,
    ) -> Result<OscillatingCycle, Error> {
        let prony = &contact.viscoelastic.as_ref().ok_or(Error::NoMemory)?.prony;
        let wave = Wave::new(prony, 2.0 * PI * self.frequency);
        let cycle = |panels, phases| {
            let (states, sums) = self.states(contact, relaxed, &wave, (panels, phases), keep_going)?;
            let answers: Vec<f64> = states[1..].iter().map(|state| state.force).collect();
            let found = OscillatingCycle::through(contact, &states, sums.works[1], (&answers, count), 0.0);
            let viscous_work = Some((sums.works[0] - sums.works[1]).max(0.0));
            Ok(OscillatingCycle { viscous_work, steps: 2 * phases, error: sums.change, ..found })
        };
        let coarse = cycle(PANELS / 2, PHASES / 2)?;
        let mut fine = cycle(PANELS, PHASES)?;
        let limit = relaxed.friction * relaxed.normal_force;
        if limit > 0.0 && self.amplitude > 0.0 {
            let apart = |of: &dyn Fn(&OscillatingCycle) -> f64| (of(&fine) - of(&coarse)).abs();
            let works = [
                apart(&|cycle| cycle.dissipated_energy),
                apart(&|cycle| cycle.dissipated_energy + cycle.viscous_work.unwrap_or(0.0)),
            ];
            let work = works[0].max(works[1]) / (4.0 * limit * self.amplitude);
            fine.error = fine.error.max(work).max(apart(&|cycle| cycle.force_amplitude) / limit);
        }
        Ok(fine)
    }

    /// Displacement, m, and force, N, once around the steady loop.
    ///
    /// # Errors
    /// As [`TimedCycle::steady`].
    pub fn points(&self, contact: &Contact, relaxed: &Contact) -> Result<Vec<(f64, f64)>, Error> {
        let prony = &contact.viscoelastic.as_ref().ok_or(Error::NoMemory)?.prony;
        let wave = Wave::new(prony, 2.0 * PI * self.frequency);
        let (states, _) = self.states(contact, relaxed, &wave, (PANELS / 2, PHASES), &|| true)?;
        Ok(states.iter().map(|state| (state.displacement, state.force)).collect())
    }

    /// The states from the largest displacement on, once around, and the sums with the works in J.
    fn states(
        &self,
        contact: &Contact,
        relaxed: &Contact,
        wave: &Wave<'_>,
        (panels, phases): (usize, usize),
        keep_going: &dyn Fn() -> bool,
    ) -> Result<(Vec<State>, Sums), Error> {
        let indentation = relaxed.indentation();
        let slips = relaxed.friction > 0.0 && relaxed.normal_force > 0.0;
        let contact_radius = if slips { relaxed.contact_radius() } else { 0.0 };
        // Where the bound is what a spring carries that never slips.
        let level = indentation - self.amplitude * wave.stiffness() / (relaxed.scale() * wave.relaxed());
        let stick_radius = if slips && level >= 0.0 { relaxed.indenter.radius(level).min(contact_radius) } else { 0.0 };
        let mut sums = self.sums(relaxed, wave, [stick_radius, contact_radius], (panels, phases), keep_going)?;
        let unit = 2.0 * contact.elasticity.g_star();
        let regime = match stick_radius {
            _ if self.amplitude <= 0.0 || stick_radius >= contact_radius && slips => Regime::Stick,
            radius if radius <= 0.0 => Regime::GrossSlip,
            _ => Regime::PartialSlip,
        };
        let state = |index: usize| {
            let (place, sign) = if index <= phases { (index, 1.0) } else { (index - phases, -1.0) };
            State {
                displacement: self.amplitude * (PI * index as f64 / phases as f64).cos(),
                force: sign * self.amplitude * unit * sums.forces[place],
                indentation,
                contact_radius,
                stick_radius,
                regime,
                elastic_energy: 0.5 * self.amplitude * self.amplitude * unit * sums.energies[place],
                ..State::default()
            }
        };
        let states: Vec<State> = (0..=2 * phases).map(state).collect();
        sums.works = sums.works.map(|work| work * unit * self.amplitude * self.amplitude);
        Ok((states, sums))
    }

    /// The sums over the springs of a contact that slips between two radii, m.
    fn sums(
        &self,
        relaxed: &Contact,
        wave: &Wave<'_>,
        [stick_radius, contact_radius]: [f64; 2],
        (panels, phases): (usize, usize),
        keep_going: &dyn Fn() -> bool,
    ) -> Result<Sums, Error> {
        let mut sums =
            Sums { forces: vec![0.0; phases + 1], energies: vec![0.0; phases + 1], works: [0.0; 2], change: 0.0 };
        let mut add = |spring: &Loop, weight: f64| {
            for index in 0..=phases {
                let [force, energy] = wave.at(spring, PI * index as f64 / phases as f64);
                sums.forces[index] += weight * force;
                sums.energies[index] += weight * energy;
            }
            let works = wave.works(spring);
            (0..2).for_each(|of| sums.works[of] += weight * works[of]);
            sums.change = sums.change.max(spring.change);
        };
        let mut spring = wave.stuck();
        if stick_radius > 0.0 {
            add(&spring, stick_radius);
        }
        let knots = relaxed.indenter.knots_below(contact_radius);
        let mut ends: Vec<f64> = knots.into_iter().filter(|knot| *knot > stick_radius).collect();
        ends.push(contact_radius);
        let mut begin = stick_radius;
        for end in ends {
            let width = (end - begin) / panels as f64;
            for panel in (0..panels).filter(|_| width > 0.0) {
                if !keep_going() {
                    return Err(Error::Interrupted);
                }
                for (at, weight) in TWENTY_POINTS {
                    let radius = begin + width * (panel as f64 + at);
                    let depth = relaxed.indentation() - relaxed.indenter.level(radius);
                    let bound = relaxed.scale() * wave.relaxed() * depth / self.amplitude;
                    if bound <= NO_BOUND * wave.stiffness() {
                        continue;
                    }
                    spring = wave.near(bound.min(wave.stiffness()), &spring, UNSETTLED);
                    add(&spring, width * weight);
                }
            }
            begin = end;
        }
        Ok(sums)
    }
}
