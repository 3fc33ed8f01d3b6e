//! What a contact is asked in its present state, but for searches: forces, radii, pressures, the state as values.

use super::Contact;
use super::adhesion::{Bond, edge_pressure};
use super::normal::{self, ContactSummary};
use super::state::{Regime, State};
use crate::conductance::Conductance;
use crate::elasticity::Elasticity;
use crate::indenter::Indenter;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::roots::largest_of;
use crate::profile::{Profile, StressRadius};
use crate::range;
use crate::range::error::Error;

/// Radii among which the largest pressure of an adhesive contact is searched for.
const PLACES: u8 = 64;

/// The results for the present state, each at once: a straight move has no error of its path.
///
/// ```
#[doc = include_str!("../example.txt")]
/// // Hertz: a^2 = R d, F_N = 4/3 E* a d and p(0) = 2 E* a/(pi R).
/// assert!((contact.contact_radius().powi(2) - 0.01).abs() < 1e-15);
/// assert!((contact.normal_force() / (4.0 / 3.0 * 3e6 * 0.1 * 0.01) - 1.0).abs() < 1e-14);
/// assert!((contact.pressure(0.0) / (0.6e6 / std::f64::consts::PI) - 1.0).abs() < 1e-14);
/// assert_eq!(contact.pressures(&[0.11, 0.05]), [0.0, contact.pressure(0.05)]);
/// assert!((contact.gross_slip_displacement() - 0.0075).abs() < 1e-15);
/// assert!((contact.summary().gross_slip_force - 2000.0).abs() < 1e-9);
///
/// contact.apply(&slide(0.001))?;
/// // A stuck core and a ring that has slipped.
/// assert_eq!((contact.displacement(), contact.memory_depth(), contact.path_error()), (0.001, 2, 0.0));
/// assert!(contact.memory_bytes() > size_of::<Contact>());
/// contact.apply(&slide(-1.0))?;
/// // Gross slip backwards: -mu F_N.
/// assert!((contact.force() + 2000.0).abs() < 1e-9);
///
/// contact.apply(&Move { normal: Some(Normal::Indentation(0.02)), ..Move::default() })?;
/// assert_eq!((contact.initial_summary().indentation, contact.summary().indentation), (0.01, 0.02));
/// contact.apply(&Move { normal: Some(Normal::Indentation(-0.001)), ..Move::default() })?;
/// assert_eq!((contact.indentation(), contact.contact_radius()), (-0.001, 0.0));
/// # Ok::<(), Error>(())
/// ```
impl Contact {
    /// W = U/m, m.
    pub(crate) fn scaled(&self, displacement: DoubleDouble) -> DoubleDouble {
        displacement * self.inverse_scale
    }

    /// U = m W, m.
    pub(crate) fn unscaled(&self, position: DoubleDouble) -> DoubleDouble {
        if self.friction > 0.0 { position.over(self.inverse_scale) } else { DoubleDouble::ZERO }
    }

    /// Normal force, N, at an indentation, m.
    pub(crate) fn normal_force_at(&self, indentation: DoubleDouble) -> f64 {
        if indentation.value() <= 0.0 {
            return 0.0;
        }
        normal::force(&self.indenter, &self.elasticity, &self.indenter.point(indentation))
    }

    /// m = mu E*/G*: displacement of the surface where it slips, over its normal displacement.
    pub(crate) fn scale(&self) -> f64 {
        self.friction * self.elasticity.e_star() / self.elasticity.g_star()
    }

    /// Tangential force, N.
    #[must_use]
    pub fn force(&self) -> f64 {
        if let Some(contact) = self.tangential() {
            return contact.force();
        }
        if let Some(bodies) = &self.viscoelastic {
            return bodies.rows.fine.sums[1];
        }
        2.0 * self.elasticity.g_star() * self.scale() * self.history.force()
    }

    /// Indentation, m, that carries a normal force, N.
    pub(crate) fn indentation_for(&self, normal_force: f64) -> DoubleDouble {
        DoubleDouble::from(normal::indentation(&self.indenter, &self.elasticity, normal_force))
    }

    /// Indentation, m, under a normal force, N.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] or [`Error::BeyondProfile`] for a force that the profile has no contact for.
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
    /// // Hertz: d goes with F_N^(2/3).
    /// assert!((contact.indentation_under(32_000.0)? / 0.04 - 1.0).abs() < 1e-14);
    /// # Ok::<(), Error>(())
    /// ```
    pub fn indentation_under(&self, normal_force: f64) -> Result<f64, Error> {
        let indentation = self.indentation_for(range::check_normal_force(normal_force)?).value();
        self.check_indentation(indentation)?;
        Ok(indentation)
    }

    /// Normal force, N; to the bit the prescribed one, where one was prescribed.
    #[must_use]
    pub fn normal_force(&self) -> f64 {
        self.normal_force
    }

    /// Pressure, Pa, at a radius (m) of at least zero, or at the x of a line contact; zero outside the contact,
    /// infinite at a sharp edge.
    #[must_use]
    pub fn pressure(&self, radius: f64) -> f64 {
        let at = StressRadius::new(radius.abs());
        let face = self.indenter.on_face(self.history.edge());
        let pressure = face.map_or(f64::NAN, |(face, edge)| normal::pressure(face, &self.elasticity, &edge, &at));
        pressure + self.edge_pressure(&at)
    }

    /// [`Contact::pressure`] at each of `radii`, m: faster than one by one.
    #[must_use]
    pub fn pressures(&self, radii: &[f64]) -> Vec<f64> {
        let Some((face, edge)) = self.indenter.on_face(self.history.edge()) else { return vec![f64::NAN; radii.len()] };
        let distances: Vec<f64> = radii.iter().map(|radius| radius.abs()).collect();
        let mut pressures = normal::pressures(face, &self.elasticity, &edge, &distances);
        if self.held().is_some() {
            for (pressure, radius) in pressures.iter_mut().zip(&distances) {
                *pressure += self.edge_pressure(&StressRadius::new(*radius));
            }
        }
        pressures
    }

    /// What adhesion adds to the pressure, Pa.
    fn edge_pressure(&self, at: &StressRadius) -> f64 {
        self.held().map_or(0.0, |(_, branch)| edge_pressure(&branch, self.history.edge(), at))
    }

    /// The shape of the indenter.
    #[must_use]
    pub fn profile(&self) -> &Profile {
        self.indenter.profile()
    }

    /// That shape, resolved once.
    #[must_use]
    pub fn indenter(&self) -> &Indenter {
        &self.indenter
    }

    /// Coulomb's coefficient of friction mu.
    #[must_use]
    pub fn friction(&self) -> f64 {
        self.friction
    }

    /// The elastic constants.
    #[must_use]
    pub fn elasticity(&self) -> Elasticity {
        self.elasticity
    }

    /// The error that curved moves have left in the tangential force, relative to mu F_N: an estimate from above.
    #[must_use]
    pub fn path_error(&self) -> f64 {
        self.path_error
    }

    /// The error that curved moves have left in the friction work, J: an estimate from above. What slips along a chord
    /// in the place of the curve, and every move under a force that is off, adds to it.
    #[must_use]
    pub fn work_error(&self) -> f64 {
        self.work_error
    }

    /// Contact radius a, m; half-width of a line contact; of a profile without a stress field as
    /// [`Contact::stiffness_radius`].
    #[must_use]
    pub fn contact_radius(&self) -> f64 {
        match &self.viscoelastic {
            Some(bodies) => self.radius_with_memory(bodies),
            None => self.indenter.edge_radius(self.history.edge()),
        }
    }

    /// F_N'/(2 E*), m, the contact radius of the round contact that is as stiff: a where the contact is round.
    #[must_use]
    pub fn stiffness_radius(&self) -> f64 {
        self.history.edge().radius
    }

    /// Tangential displacement U of the indenter, m.
    #[must_use]
    pub fn displacement(&self) -> f64 {
        self.displacement.value()
    }

    /// Indentation d, m; below zero a gap.
    #[must_use]
    pub fn indentation(&self) -> f64 {
        let edge = self.history.edge();
        self.held().map_or(edge.level.value(), |(_, branch)| edge.level.value() - branch.stretch(edge))
    }

    /// Displacement of gross slip on first loading, m, at the present load.
    #[must_use]
    pub fn gross_slip_displacement(&self) -> f64 {
        self.tangential().map_or_else(|| self.scale() * self.indentation().max(0.0), Contact::gross_slip_displacement)
    }

    /// Number of straight pieces that the slip history consists of.
    #[must_use]
    pub fn memory_depth(&self) -> usize {
        if let Some(springs) = self.twist().and_then(|twist| twist.springs.as_ref()) {
            return springs.count();
        }
        let twist = self.twist().map(|twist| &twist.contact);
        twist.or(self.tangential()).unwrap_or(self).history.pieces().len()
    }

    /// Bytes of RAM that the contact takes, its slip history included.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        let own = size_of::<Contact>() + size_of::<Indenter>() + self.history.heap_bytes();
        let twist = self.twist().map(|twist| &twist.contact);
        let springs = self.twist().and_then(|twist| twist.springs.as_ref()).map_or(0, |springs| springs.heap_bytes());
        own + springs
            + twist.or(self.tangential()).map_or(0, Contact::memory_bytes)
            + self.viscoelastic.as_ref().map_or(0, |bodies| bodies.rows.heap_bytes())
    }

    /// The summary at the present normal load.
    #[must_use]
    pub fn summary(&self) -> ContactSummary {
        let own =
            ContactSummary::of(&self.indenter, &self.elasticity, self.friction, self.history.edge(), self.normal_force);
        let own = match self.adhesion() {
            Some(adhesion) => ContactSummary {
                indentation: self.indentation(),
                max_pressure: own.max_pressure.map(|_| self.largest_pressure()),
                pull_off_force: Some(adhesion.pull_off_force()),
                ..own
            },
            None => own,
        };
        let Some(contact) = self.tangential() else { return own };
        let (gross_slip_displacement, gross_slip_force) = (contact.gross_slip_displacement(), contact.normal_force);
        ContactSummary { gross_slip_displacement, gross_slip_force, ..own }
    }

    /// The largest pressure of an adhesive contact, Pa, which may be below zero.
    fn largest_pressure(&self) -> f64 {
        let radius = self.contact_radius();
        let places: Vec<f64> = (0..PLACES).map(|place| radius * f64::from(place) / f64::from(PLACES)).collect();
        largest_of(&places, 1, 1e-7, |place| self.pressure(place)).1
    }

    /// What stresses along the surface are related to, Pa: [`ContactSummary::unit_shear`] with the shear strength.
    #[must_use]
    pub fn unit_shear(&self) -> f64 {
        self.tangential().unwrap_or(self).summary().unit_shear()
    }

    /// The summary at the preload of the definition.
    #[must_use]
    pub fn initial_summary(&self) -> ContactSummary {
        if self.law.is_some() {
            return self.virgin().summary();
        }
        let (indentation, normal_force) = self.preload;
        let edge = self.indenter.point(indentation);
        ContactSummary::of(&self.indenter, &self.elasticity, self.friction, &edge, normal_force)
    }
}

impl Contact {
    /// The state after the last move.
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
    /// contact.apply(&slide(0.00375))?;
    /// let state = contact.state();
    /// // The stuck core ends where W = d - g(c): c^2 = R d/2.
    /// assert!((state.stick_radius - 0.005_f64.sqrt()).abs() < 1e-15);
    /// assert!(state.force > 0.0 && state.dissipated_energy > 0.0);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn state(&self) -> State {
        #[cfg(test)]
        crate::cells::call_count::add(|calls| &mut calls.states);
        if let Some(bodies) = &self.viscoelastic {
            return self.state_with_memory(bodies);
        }
        let edge = self.history.edge();
        let scale = self.scale();
        let (stick_radius, regime) = self.stick();
        let conductance = self.conductance(edge.level.value());
        if let Some(contact) = self.tangential() {
            let (normal_force, contact_radius) = (self.normal_force(), self.contact_radius());
            return self.with_surfaces(State {
                indentation: self.indentation(),
                normal_force,
                contact_radius,
                electrical_conductance: conductance.electrical,
                thermal_conductance: conductance.thermal,
                ..contact.state()
            });
        }
        let state = State {
            displacement: self.displacement.value(),
            // The -0 of a virgin contact is 0.
            force: self.force() + 0.0,
            indentation: self.indentation(),
            normal_force: self.normal_force(),
            contact_radius: self.contact_radius(),
            stick_radius,
            regime,
            dissipated_energy: self.dissipated.value(),
            elastic_energy: (2.0 * self.elasticity.g_star() * scale * scale * self.history.energy()).max(0.0),
            memory_depth: self.memory_depth(),
            electrical_conductance: conductance.electrical,
            thermal_conductance: conductance.thermal,
            ..State::default()
        };
        self.with_twist(self.with_surfaces(State { stick_centre: self.stick_centre(&state), ..state }))
    }

    /// The conductances at an indentation, m; zero if the bodies are apart.
    ///
    /// ```
    /// use stickslip_mechanics::{Body, Conduction, Contact, Elasticity, Preload, Profile, Setup, Sphere};
    ///
    /// let tin = Body::new(5e10, 0.36)?.conducting(Conduction::new(Some(1e-7), None)?);
    /// let contact = Contact::new(Setup {
    ///     profile: Profile::Sphere(Sphere::new(0.01)?),
    ///     elasticity: Elasticity::of_bodies(tin, tin),
    ///     friction: 0.3,
    ///     preload: Preload::ContactRadius(1e-4),
    /// })?;
    /// // Holm: R = rho/(2 a).
    /// let conductance = contact.conductance(contact.indentation());
    /// assert!((conductance.electrical.unwrap() - 2000.0).abs() < 1e-9);
    /// assert_eq!(conductance.thermal, None);
    /// # Ok::<(), stickslip_mechanics::Error>(())
    /// ```
    #[must_use]
    pub fn conductance(&self, indentation: f64) -> Conductance {
        let level = DoubleDouble::from(indentation);
        self.elasticity.conductance(|| if indentation < 0.0 { 0.0 } else { self.indenter.point(level).radius })
    }

    /// A state of this contact with what follows from the rest of it.
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
    /// assert_eq!(contact.completed(contact.state()), contact.state());
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn completed(&self, state: State) -> State {
        let conductance = match self.adhesion() {
            Some(_) => self.elasticity.conductance(|| state.contact_radius),
            None => self.conductance(state.indentation),
        };
        self.with_surfaces(State {
            stick_centre: self.stick_centre(&state),
            electrical_conductance: conductance.electrical,
            thermal_conductance: conductance.thermal,
            ..state
        })
    }

    fn stick(&self) -> (f64, Regime) {
        let edge = self.history.edge();
        if edge.level.value() < 0.0 {
            let pulled_off = self.adhesion().is_some_and(|adhesion| adhesion.bond == Bond::PulledOff);
            return (0.0, if pulled_off { Regime::PulledOff } else { Regime::Separated });
        }
        if self.friction <= 0.0 {
            return (0.0, Regime::GrossSlip);
        }
        match self.history.slip_from() {
            None => (self.contact_radius(), Regime::Stick),
            Some(start) if start.level.value() <= 0.0 => (0.0, Regime::GrossSlip),
            // A ring that is narrower than the last digit of its radii is none that a reader could see.
            Some(start) => {
                let (inner, outer) = (self.indenter.edge_radius(start), self.contact_radius());
                if inner < outer { (inner, Regime::PartialSlip) } else { (outer, Regime::Stick) }
            }
        }
    }
}
