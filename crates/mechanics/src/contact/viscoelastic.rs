//! A contact whose bodies have memory: its springs ([`crate::viscoelastic`]) answer for its forces, radius and
//! energies.

use std::sync::Arc;

use super::Contact;
use super::state::{Move, Normal, Regime, State, Tangential};
use crate::numerics::double_double::DoubleDouble;
use crate::range;
use crate::range::error::Error;
use crate::slip_history::SlipHistory;
use crate::slip_history::limit::Coulomb;
use crate::springs::law::{CoulombLaw, SpringLaw};
use crate::springs::rows::{Course, Rows};
use crate::viscoelastic::{Leg, Prony, SPRINGS, Viscoelastic};

/// The least tolerance of springs, of the size of the error that their number leaves.
pub(super) const LEAST_TOLERANCE: f64 = 1e-6;

/// ```
/// use std::sync::Arc;
///
/// use stickslip_mechanics::{Contact, Elasticity, Friction, Law, Move, Normal, Preload, Profile, Prony, PronyTerm};
/// use stickslip_mechanics::{Setup, Sphere};
///
/// let memory = Prony::new(&[PronyTerm { ratio: 0.6, time: 1.0 }])?;
/// let mut contact = Contact::new(Setup {
///     profile: Profile::Sphere(Sphere::new(0.01)?),
///     elasticity: Elasticity::effective(1e6, 8e5)?,
///     friction: Law { limit: Friction::from(0.5), memory: Some(Arc::new(memory)) },
///     preload: Preload::Indentation(1e-4),
/// })?;
/// // Relaxed at a constant indentation, the force is that of the instant times R(t).
/// let at_once = contact.normal_force();
/// contact.apply(&Move { duration: 1.0, ..Move::default() })?;
/// assert!((contact.normal_force() / at_once - (0.4 + 0.6 * (-1.0_f64).exp())).abs() < 1e-6);
/// assert_eq!((contact.has_memory(), contact.state().time), (true, Some(1.0)));
/// assert!(contact.check_elastic("wear").is_err() && !contact.beyond_annulus());
/// assert!(contact.count_and_steps().is_some_and(|(count, steps)| count > 0 && steps > 0));
/// // Let go, the surface of the contact is a dent that the indenter has left.
/// contact.apply(&Move { normal: Some(Normal::Indentation(1e-5)), ..Move::default() })?;
/// assert_eq!(contact.normal_force(), 0.0);
/// # Ok::<(), stickslip_mechanics::Error>(())
/// ```
impl Contact {
    /// Whether its bodies have memory, so that moves take time.
    #[must_use]
    pub fn has_memory(&self) -> bool {
        self.viscoelastic.is_some()
    }

    /// Whether the contact has been other than a disc, or slip other than an outer annulus of one sign: from then on
    /// the results are those of the springs alone, not of the half-space. Never of elastic bodies.
    #[must_use]
    pub fn beyond_annulus(&self) -> bool {
        self.viscoelastic.as_ref().is_some_and(|bodies| bodies.rows.beyond)
    }

    /// Springs across the radius, and steps so far, if the bodies have memory or the load has changed under a twist.
    #[must_use]
    pub fn count_and_steps(&self) -> Option<(usize, usize)> {
        let twisted = self.twist().and_then(|twist| twist.springs.as_ref()).map(|rows| (rows.count(), rows.steps));
        self.viscoelastic.as_ref().map(|bodies| (bodies.rows.count(), bodies.rows.steps)).or(twisted)
    }

    /// The tolerance of a move for one that was asked for: springs of memory or twist are not finer than 1e-6.
    #[must_use]
    pub fn tolerance(&self, asked: f64) -> f64 {
        if self.count_and_steps().is_some() { asked.max(LEAST_TOLERANCE) } else { asked }
    }

    /// Refuses what is defined for elastic bodies alone, by its name.
    ///
    /// # Errors
    /// [`Error::Viscoelastic`].
    pub fn check_elastic(&self, what: &'static str) -> Result<(), Error> {
        if self.has_memory() { Err(Error::Viscoelastic(what)) } else { Ok(()) }
    }

    /// Gives a virgin contact bodies with memory.
    pub(super) fn with_memory(mut self, memory: Option<Arc<Prony>>) -> Result<Contact, Error> {
        let Some(prony) = memory else { return Ok(self) };
        self.profile().check_round("`prony`")?;
        self.profile().check_stress_field()?;
        if self.law.is_some() {
            return Err(Error::Viscoelastic("`shear_strength`"));
        }
        self.viscoelastic = Some(Box::new(self.pressed_with_memory(prony)));
        Ok(self)
    }

    /// Springs anew at the present load, as if it had been put on at once.
    pub(super) fn renew_memory(&mut self) {
        let prony = self.viscoelastic.as_ref().map(|bodies| Arc::clone(&bodies.prony));
        self.viscoelastic = prony.map(|prony| Box::new(self.pressed_with_memory(prony)));
    }

    fn pressed_with_memory(&self, prony: Arc<Prony>) -> Viscoelastic {
        let start = [self.indentation(), self.indenter.edge_radius(self.history.edge())];
        let rows = Rows::pressed(&self.material(&prony), SPRINGS, start);
        Viscoelastic { prony, rows }
    }

    /// What its springs obey.
    pub(super) fn material<'a>(&'a self, prony: &'a Prony) -> CoulombLaw<'a> {
        let stiffness = [2.0 * self.elasticity.e_star(), 2.0 * self.elasticity.g_star()];
        CoulombLaw { indenter: &self.indenter, prony, stiffness, friction: self.friction }
    }

    /// The contact radius, m, of its springs.
    pub(super) fn radius_with_memory(&self, bodies: &Viscoelastic) -> f64 {
        bodies.rows.fine.radius(&SpringLaw::Coulomb(self.material(&bodies.prony)))
    }

    /// As [`Contact::apply_while`], with springs.
    pub(crate) fn apply_with_memory(
        &mut self,
        step: &Move,
        tolerance: f64,
        keep_going: &dyn Fn() -> bool,
    ) -> Result<(), Error> {
        range::DURATION.check(step.duration)?;
        let here = self.indentation();
        let add = |from: f64, target: f64| if step.relative { from + target } else { target };
        let normal = match step.normal {
            None => Course::Place { from: here, to: here },
            Some(Normal::Indentation(target)) => {
                let to = add(here, target);
                self.check_indentation(to)?;
                Course::Place { from: here, to }
            }
            Some(Normal::NormalForce(target)) => {
                let Some(bodies) = &self.viscoelastic else { return Ok(()) };
                if bodies.prony.is_fluid() && step.duration > 0.0 {
                    return Err(Error::FluidUnderLoad);
                }
                let to = range::check_normal_force(add(self.normal_force, target))?;
                self.check_indentation(self.indentation_for(to).value())?;
                Course::Force { from: self.normal_force, to }
            }
        };
        let displacement = self.displacement.value();
        let tangential = match step.tangential {
            None => Course::Place { from: displacement, to: displacement },
            Some(Tangential::Displacement(target)) => {
                let to = range::DISPLACEMENT.check(add(displacement, target))?;
                Course::Place { from: displacement, to }
            }
            Some(Tangential::Twist(_) | Tangential::Torque(_)) => return Err(Error::Viscoelastic("twist")),
            Some(Tangential::Force(target)) => {
                let from = self.force();
                Course::Force { from, to: range::FORCE.check(add(from, target))? }
            }
        };
        let Some(mut bodies) = self.viscoelastic.take() else { return Ok(()) };
        let leg = Leg { normal, tangential, duration: step.duration };
        let Viscoelastic { prony, rows } = &mut *bodies;
        let followed = rows.follow(&self.material(prony), &leg, tolerance.max(LEAST_TOLERANCE), keep_going);
        self.viscoelastic = Some(bodies);
        followed?;
        self.take_up_memory();
        if let Course::Force { to, .. } = normal {
            self.normal_force = to;
        }
        Ok(())
    }

    /// Takes indentation, displacement, load and work from the springs.
    pub(super) fn take_up_memory(&mut self) {
        let Some(bodies) = &self.viscoelastic else { return };
        let [indentation, displacement, normal_force, _] = bodies.rows.fine.state();
        let (dissipated, path_error) = (bodies.rows.fine.works[0], bodies.rows.path_error);
        self.history = SlipHistory::new(&Coulomb(&self.indenter), DoubleDouble::from(indentation));
        self.displacement = DoubleDouble::from(displacement);
        self.dissipated = DoubleDouble::from(dissipated);
        self.normal_force = normal_force;
        self.path_error = path_error;
    }

    pub(super) fn state_with_memory(&self, bodies: &Viscoelastic) -> State {
        let (contact_radius, rows) = (self.contact_radius(), &bodies.rows);
        let [dissipated_energy, work] = rows.fine.works;
        let elastic_energy = rows.fine.energy(&SpringLaw::Coulomb(self.material(&bodies.prony)));
        let edge = |from: f64| from < contact_radius;
        let (stick_radius, regime) = match rows.slip_from {
            _ if self.normal_force <= 0.0 && contact_radius <= 0.0 && self.indentation().abs() > 0.0 => {
                (0.0, Regime::Separated)
            }
            _ if self.friction <= 0.0 => (0.0, Regime::GrossSlip),
            Some(from) if from <= 0.0 => (0.0, Regime::GrossSlip),
            Some(from) if edge(from) => (from, Regime::PartialSlip),
            _ => (contact_radius, Regime::Stick),
        };
        let conductance = self.elasticity.conductance(|| contact_radius);
        State {
            displacement: self.displacement(),
            force: self.force() + 0.0,
            indentation: self.indentation(),
            normal_force: self.normal_force,
            contact_radius,
            stick_radius,
            stick_centre: None,
            regime,
            dissipated_energy,
            elastic_energy,
            memory_depth: rows.count(),
            electrical_conductance: conductance.electrical,
            thermal_conductance: conductance.thermal,
            time: Some(rows.time),
            viscous_work: Some((work - elastic_energy - dissipated_energy).max(0.0) + 0.0),
            surface_energy: None,
            adhesion_loss: None,
            twist: None,
            torque: None,
        }
    }
}
