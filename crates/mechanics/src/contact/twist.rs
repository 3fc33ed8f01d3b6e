//! A contact that is twisted about the axis through its middle.
//!
//! At a constant load the twist is a contact of its own, pressed into the limit of friction under twist
//! ([`LimitShape`](crate::profile::LimitShape)): its displacement is the angle, rad, and its tangential force the
//! torque, N m. It is made by the first twist, kept beside the contact, and gone when that lifts off. Twist couples
//! with nothing, so that this is exact for any pair of isotropic bodies. Under a load that changes springs step it from
//! then on ([`Rows`]).

use std::sync::Arc;

use super::Contact;
use super::law::Interface;
use super::state::{Move, Regime, State, Tangential};
use crate::cells::shape::Reach;
use crate::elasticity::Elasticity;
use crate::indenter::Indenter;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::packing::{Packed, Reader};
use crate::path::curved_path::NormalPath;
use crate::profile::{MOST_CELLS, Profile, Twisted};
use crate::range;
use crate::range::Quantity;
use crate::range::error::Error;
use crate::slip_history::SlipHistory;
use crate::springs::law::SpringLaw;
use crate::springs::rows::{Course, Rows};
use crate::springs::twist::{SPRINGS, TwistLaw, gross_slip_torque};

/// A contact of a smaller radius, m, carries no twist: the sixth power of the radius of its core is no number.
const LEAST_RADIUS: f64 = 1e-40;

/// The twist of a contact.
#[derive(Clone, Debug)]
pub(crate) struct Twist {
    /// Its springs are even over xi = x^3/(3 a^2).
    pub(crate) contact: Contact,
    /// The same levels over x: what the hoop stress is summed over.
    hoop: Arc<Indenter>,
    /// 1/G = 1/G_1 + 1/G_2, Pa.
    pub(crate) shear_modulus: f64,
    /// Once the load has changed: they answer in place of the contact.
    pub(crate) springs: Option<Box<Rows>>,
}

impl Twist {
    /// Whether it carries a torque anywhere.
    fn carries(&self) -> bool {
        match &self.springs {
            Some(springs) => springs.carries(),
            None => !self.contact.history.is_virgin(),
        }
    }

    /// Moves the contact; the friction work so far.
    fn at_constant_load(&mut self, path: Course) -> Result<DoubleDouble, Error> {
        let target = match path {
            Course::Place { to, .. } => Tangential::Displacement(to),
            Course::Force { to, .. } => Tangential::Force(to),
        };
        let done = self.contact.apply(&Move { tangential: Some(target), ..Move::default() });
        done.map_err(|error| match error {
            Error::ForceExceedsFriction { target, limit, .. } => Error::TorqueExceedsFriction { target, limit },
            other => other,
        })?;
        Ok(self.contact.dissipated)
    }
}

impl Contact {
    pub(crate) fn twist(&self) -> Option<&Twist> {
        self.law.as_ref()?.twist.as_ref()
    }

    /// Whether it has been twisted since it last touched.
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
    /// assert!(!contact.is_twisted());
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn is_twisted(&self) -> bool {
        self.twist().is_some()
    }

    /// The contact whose displacement is the angle of this one, rad, and whose tangential force is its torque, N m, in
    /// the present state and at the present load; without a history where the load has changed under a twist.
    ///
    /// # Errors
    /// [`Error::ShearStrength`] and [`Error::Adhesive`]; [`Error::LineContact`] and [`Error::NoStressField`] for a
    /// profile that is not round; [`Error::ShearModulusNeeded`]; [`Error::TooManyCells`]; [`Error::OutOfRange`] without
    /// friction, [`Error::NothingSlides`] without a load; [`Error::TwistWithShift`] if it carries shear along x.
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
    /// use stickslip_mechanics::Body;
    ///
    /// let bodies = Elasticity::against_rigid(Body::new(3e6, 0.5)?);
    /// let mut contact = Contact::new(Setup { elasticity: bodies, ..setup })?;
    /// // A ball slides round at 3 pi/16 of mu F_N a.
    /// let limit = 3.0 * std::f64::consts::PI / 16.0 * 0.5 * contact.normal_force() * contact.contact_radius();
    /// let twisting = contact.twisting()?.summary();
    /// assert!((twisting.gross_slip_force / limit - 1.0).abs() < 1e-13);
    /// assert!(contact.apply(&slide(0.0)).is_ok());
    /// # Ok::<(), Error>(())
    /// ```
    pub fn twisting(&self) -> Result<Contact, Error> {
        match self.twist() {
            Some(twist) if twist.springs.is_none() => Ok(twist.contact.clone()),
            Some(_) => Ok(Contact { law: None, ..self.clone() }.new_twist()?.contact),
            None => Ok(self.new_twist()?.contact),
        }
    }

    /// The torque at which the contact slides round at its present load, N m: (pi/2) mu E* int X^2 dy, which asks for
    /// the load curve alone. `None` where the contact is not round, or slides by another law.
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
    /// // A ball: 3 pi/16 of mu F_N a.
    /// let limit = 3.0 * std::f64::consts::PI / 16.0 * 0.5 * contact.normal_force() * contact.contact_radius();
    /// assert!((contact.gross_slip_torque().unwrap() / limit - 1.0).abs() < 1e-13);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn gross_slip_torque(&self) -> Option<f64> {
        let round = self.profile().has_stress_field() && self.profile().line().is_none();
        let plain = self.shear_strength() <= 0.0 && self.adhesion().is_none() && !self.has_memory();
        let known = plain && (round || matches!(self.profile(), Profile::LoadCurve(_)));
        let traction = self.friction * self.elasticity.e_star();
        known.then(|| gross_slip_torque(&self.indenter, traction, self.indentation()))
    }

    fn new_twist(&self) -> Result<Twist, Error> {
        self.check_coulomb("twist")?;
        self.profile().check_round("twist")?;
        self.profile().check_stress_field()?;
        if self.friction <= 0.0 {
            let allowed = "more than 0, as a contact without friction carries no torque".to_owned();
            return Err(Error::OutOfRange { quantity: Quantity::Friction, value: self.friction, allowed });
        }
        if !self.history.is_virgin() {
            return Err(Error::TwistWithShift);
        }
        let shear_modulus = self.elasticity.shear_modulus().ok_or(Error::ShearModulusNeeded)?;
        let edge = self.history.edge();
        let cells = self.indenter.cells(Reach::Radius(edge.radius)).filter(|_| self.holds_twist(edge.level.value()));
        let cells = cells.ok_or(Error::NothingSlides)?;
        let step = if edge.square <= self.indenter.flat().square {
            // A contact that is no wider than its flat, to the last digit, is pressed in as a punch is.
            edge.level.value()
        } else if self.indenter.is_upright(edge) {
            (edge.level - cells.top.level).value()
        } else {
            0.0
        };
        let twisted = Twisted {
            cells,
            edge: edge.square,
            step,
            unit: self.friction * self.elasticity.e_star() / (2.0 * std::f64::consts::PI * shear_modulus),
            ball: self.profile().ball().map(|ball| ball.curvature_radius),
        };
        if twisted.slipping().count() > MOST_CELLS {
            return Err(Error::TooManyCells);
        }
        let [hoop, even] = twisted.limits(&self.indenter.shared_profile());
        // Twice this is the stiffness over xi: 16 G x^2 dx = 16 G a^2 dxi.
        let elasticity = Elasticity::of_springs(8.0 * shear_modulus * edge.square.value());
        let contact = self.pressed_into(even, DoubleDouble::from(twisted.at_edge()), elasticity);
        Ok(Twist { contact, hoop: Arc::new(Indenter::new(Profile::Limit(hoop))), shear_modulus, springs: None })
    }

    /// Whether it touches at this level, m, widely enough to carry a torque.
    fn holds_twist(&self, level: f64) -> bool {
        level > 0.0 && self.indenter.radius(level) > LEAST_RADIUS
    }

    /// What its springs of twist are made of.
    pub(super) fn twist_law(&self, shear_modulus: f64) -> TwistLaw<'_> {
        let unit = self.friction * self.elasticity.e_star() / (2.0 * std::f64::consts::PI * shear_modulus);
        TwistLaw { indenter: &self.indenter, unit, shear_modulus }
    }

    /// As [`Contact::apply_while`], where the contact is twisted or has been.
    pub(super) fn apply_twist(
        &mut self,
        step: &Move,
        tolerance: f64,
        keep_going: &dyn Fn() -> bool,
    ) -> Result<(), Error> {
        let normal = self.normal_path(step)?;
        let changes = !matches!(normal, NormalPath::Indentation { from, to } if from == to);
        let [angle, torque] = self.twist().map_or([0.0; 2], |twist| self.angle_and_torque(twist));
        let absolute = |from: f64, target: f64| if step.relative { from + target } else { target };
        let path = match step.tangential {
            Some(Tangential::Twist(target)) => {
                Course::Place { from: angle, to: range::TWIST.check(absolute(angle, target))? }
            }
            Some(Tangential::Torque(target)) => {
                Course::Force { from: torque, to: range::TORQUE.check(absolute(torque, target))? }
            }
            Some(_) => return Err(Error::TwistWithShift),
            None => Course::Place { from: angle, to: angle },
        };
        if changes {
            return self.twist_under_load(step, (normal, path), tolerance, keep_going);
        }
        if step.tangential.is_none() {
            return Ok(());
        }
        let here = self.history.edge().level.value();
        if !self.holds_twist(here) {
            return match path {
                Course::Force { to: target, .. } if target.abs() > 0.0 => {
                    Err(Error::TorqueExceedsFriction { target, limit: 0.0 })
                }
                // Apart, the indenter turns without anything to count from.
                _ => Ok(()),
            };
        }
        let is_new = !self.is_twisted();
        let new = is_new.then(|| self.new_twist()).transpose()?.map(|twist| Box::new(Interface::of_twist(twist)));
        let Some(mut law) = new.or_else(|| self.law.take()) else { return Ok(()) };
        let followed = law.twist.as_mut().map_or(Ok(self.dissipated), |twist| {
            let Some(springs) = &mut twist.springs else { return twist.at_constant_load(path) };
            let law = self.twist_law(twist.shear_modulus);
            let before = springs.fine.works[0];
            springs.twist(&law, &|_| here, path, tolerance, keep_going)?;
            Ok(self.dissipated + DoubleDouble::from(springs.fine.works[0] - before))
        });
        if followed.is_ok() || !is_new {
            self.law = Some(law);
        }
        self.dissipated = followed?;
        Ok(())
    }

    fn angle_and_torque(&self, twist: &Twist) -> [f64; 2] {
        match &twist.springs {
            Some(springs) => [springs.fine.position, springs.fine.sums[1]],
            None => [twist.contact.displacement(), twist.contact.force()],
        }
    }

    /// The same with a load that changes: by springs once anything is twisted.
    fn twist_under_load(
        &mut self,
        step: &Move,
        (normal, path): (NormalPath, Course),
        tolerance: f64,
        keep_going: &dyn Fn() -> bool,
    ) -> Result<(), Error> {
        let mut after = Contact { law: None, ..self.clone() };
        after.apply_visited(&Move { tangential: None, ..*step }, 1.0, &|| true, &mut |_, _| ())?;
        let [here, end] = [&*self, &after].map(|contact| contact.history.edge().level.value());
        let twist = self.twist();
        let carries = twist.is_some_and(Twist::carries);
        let holds = self.holds_twist(end);
        if !holds
            && let Course::Force { to: target, .. } = path
            && target.abs() > 0.0
        {
            return Err(Error::TorqueExceedsFriction { target, limit: 0.0 });
        }
        let turns = !path.is_force() && !path.is_still();
        if !(holds || carries && turns) {
            // Whatever way the contact opens, what a twist that stays has stored is lost by slip.
            let stored = if carries { self.state().elastic_energy } else { 0.0 };
            after.dissipated = after.dissipated + DoubleDouble::from(stored);
            *self = after;
            return Ok(());
        }
        if !carries && step.tangential.is_none() {
            after.law = twist.map(|_| after.new_twist()).transpose()?.map(|twist| Box::new(Interface::of_twist(twist)));
            *self = after;
            return Ok(());
        }
        let mut twist = match twist {
            Some(twist) => twist.clone(),
            None => after.new_twist()?,
        };
        let law = self.twist_law(twist.shear_modulus);
        let reach = [here, end].map(|level| self.indenter.radius(level.max(0.0))).into_iter().fold(0.0, f64::max);
        let mut springs = twist.springs.take().unwrap_or_else(|| {
            let (indenter, square) = (&twist.contact.indenter, self.history.edge().square.value());
            let deflection = |x: f64| {
                if !carries {
                    return 0.0;
                }
                let level = indenter.level(x * x * x / (3.0 * square));
                twist.contact.history.deflection(DoubleDouble::from(level))
            };
            let angle = if carries { twist.contact.displacement() } else { 0.0 };
            Box::new(Rows::of_twist(&law, [here.max(0.0), reach], angle, deflection))
        });
        let before = springs.fine.works[0];
        let level = |part: f64| match normal {
            NormalPath::Indentation { to, .. } if part < 1.0 => here.max(0.0) + part * (to.value() - here.max(0.0)),
            NormalPath::Indentation { to, .. } => to.value(),
            NormalPath::Force { from, to } if part < 1.0 => self.indentation_for(from + part * (to - from)).value(),
            NormalPath::Force { .. } => end,
        };
        springs.twist(&law, &level, path, tolerance, keep_going)?;
        after.dissipated = after.dissipated + DoubleDouble::from(springs.fine.works[0] - before);
        if holds {
            after.path_error = springs.path_error;
            twist.springs = Some(springs);
            after.law = Some(Box::new(Interface::of_twist(twist)));
        }
        *self = after;
        Ok(())
    }

    /// The same twisted, with its history or its springs from packed bytes; `None` if it cannot be.
    pub(super) fn with_twist_of(mut self, reader: &mut Reader<'_>) -> Option<Contact> {
        let mut twist = self.new_twist().ok()?;
        if f64::unpack(reader)? > 0.0 {
            let springs = Rows::unpack(reader, &SpringLaw::Twist(self.twist_law(twist.shear_modulus)), SPRINGS)?;
            twist.springs = Some(Box::new(springs));
        } else {
            let history = SlipHistory::unpack(reader)?;
            twist.contact.displacement = history.position();
            twist.contact.history = history;
        }
        self.law = Some(Box::new(Interface::of_twist(twist)));
        Some(self)
    }

    /// The radius, m, of a radius of [`Contact::twisting`], m, whose springs are even over x^3/(3 a^2).
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
    /// let radius = contact.contact_radius();
    /// assert!((contact.radius_of_twist(radius / 3.0) / radius - 1.0).abs() < 1e-15);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn radius_of_twist(&self, radius: f64) -> f64 {
        let edge = self.contact_radius();
        if edge > 0.0 { edge * (3.0 * radius / edge).cbrt() } else { 0.0 }
    }

    /// The state of a contact that is twisted, by that of it without its twist.
    pub(super) fn with_twist(&self, state: State) -> State {
        let Some(Twist { contact, springs, shear_modulus, .. }) = self.twist() else { return state };
        if let Some(springs) = springs {
            let [_, angle, _, torque] = springs.fine.state();
            let elastic_energy = springs.fine.energy(&SpringLaw::Twist(self.twist_law(*shear_modulus)));
            let (stick_radius, regime) = match springs.slip_from {
                Some(from) if from <= 0.0 => (0.0, Regime::GrossSlip),
                Some(from) if from < state.contact_radius => (from, Regime::PartialSlip),
                _ => (state.contact_radius, Regime::Stick),
            };
            return State {
                twist: Some(angle),
                torque: Some(torque),
                stick_radius,
                regime,
                elastic_energy,
                memory_depth: springs.count(),
                ..state
            };
        }
        let own = contact.state();
        State {
            twist: Some(own.displacement),
            torque: Some(own.force),
            stick_radius: self.radius_of_twist(own.stick_radius),
            regime: own.regime,
            dissipated_energy: own.dissipated_energy,
            elastic_energy: own.elastic_energy,
            memory_depth: own.memory_depth,
            ..state
        }
    }

    /// The hoop stress of twist, Pa, at each of `radii`, m: positive as a positive angle causes it on the body that
    /// does not turn; zero of a contact that has not been twisted.
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
    /// assert_eq!(contact.hoops(&[0.05]), [0.0]);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn hoops(&self, radii: &[f64]) -> Vec<f64> {
        let Some(Twist { contact, hoop, shear_modulus, springs }) = self.twist() else { return vec![0.0; radii.len()] };
        if let Some(springs) = springs {
            let law = self.twist_law(*shear_modulus);
            return radii.iter().map(|radius| springs.hoop(&law, *radius)).collect();
        }
        let over_x = Contact {
            indenter: Arc::clone(hoop),
            elasticity: Elasticity::of_springs(*shear_modulus),
            history: contact.history.moved_to(|level| hoop.point(level)),
            ..contact.clone_without_history()
        };
        over_x.shears(radii).into_iter().zip(radii).map(|(shear, radius)| 4.0 * radius.abs() * shear).collect()
    }
}
