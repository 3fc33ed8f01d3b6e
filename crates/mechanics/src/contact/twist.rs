//! A contact that is twisted about the axis through its middle.
//!
//! At a constant load the twist is a contact of its own, pressed into the limit of friction under twist
//! ([`TwistLimit`](crate::profile::TwistLimit)): its displacement is the angle, rad, and its tangential force the
//! torque, N m. It is made by the first twist, kept beside the contact, and gone when that lifts off. Twist couples
//! with nothing, so that this is exact for any pair of isotropic bodies.

use std::sync::Arc;

use super::Contact;
use super::law::Interface;
use super::normal;
use super::state::{Move, State, Tangential};
use crate::cells::shape::Reach;
use crate::elasticity::Elasticity;
use crate::indenter::Indenter;
use crate::numerics::double_double::DoubleDouble;
use crate::path::curved_path::NormalPath;
use crate::profile::{MOST_CELLS, Profile, Twisted};
use crate::range;
use crate::range::Quantity;
use crate::range::error::Error;
use crate::slip_history::SlipHistory;
use crate::slip_history::limit::Coulomb;

/// The twist of a contact.
#[derive(Clone, Debug)]
pub(crate) struct Twist {
    /// Its springs are even over xi = x^3/(3 a^2).
    pub(crate) contact: Contact,
    /// The same levels over x: what the hoop stress is summed over.
    hoop: Arc<Indenter>,
    /// 1/G = 1/G_1 + 1/G_2, Pa.
    shear_modulus: f64,
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
    /// the present state and at the present load.
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
            Some(twist) => Ok(twist.contact.clone()),
            None => Ok(self.new_twist()?.contact),
        }
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
        let cells = self.indenter.cells(Reach::Radius(edge.radius)).filter(|_| edge.level.value() > 0.0);
        let cells = cells.ok_or(Error::NothingSlides)?;
        let upright = self.indenter.is_upright(edge);
        let twisted = Twisted {
            cells,
            edge: edge.square,
            step: if upright { (edge.level - cells.top.level).value() } else { 0.0 },
            unit: self.friction * self.elasticity.e_star() / (2.0 * std::f64::consts::PI * shear_modulus),
            ball: self.profile().ball().map(|ball| ball.curvature_radius),
        };
        if twisted.slipping().count() > MOST_CELLS {
            return Err(Error::TooManyCells);
        }
        let [hoop, even] = twisted.limits(&self.indenter.shared_profile());
        let depth = even.depth() + DoubleDouble::from(twisted.at_edge());
        let indenter = Indenter::new(Profile::Twist(even));
        // Twice this is the stiffness over xi: 16 G x^2 dx = 16 G a^2 dxi.
        let elasticity = Elasticity::of_springs(8.0 * shear_modulus * edge.square.value());
        let history = SlipHistory::new(&Coulomb(&indenter), depth);
        let normal_force = normal::force(&indenter, &elasticity, history.edge());
        let contact = Contact {
            indenter: Arc::new(indenter),
            elasticity,
            friction: 1.0,
            history,
            displacement: DoubleDouble::ZERO,
            normal_force,
            dissipated: self.dissipated,
            preload: (depth, normal_force),
            indentation_error: 0.0,
            path_error: 0.0,
            path_kernel: 0.0,
            work_error: 0.0,
            inverse_scale: DoubleDouble::from(1.0),
            law: None,
            viscoelastic: None,
        };
        Ok(Twist { contact, hoop: Arc::new(Indenter::new(Profile::Twist(hoop))), shear_modulus })
    }

    /// As [`Contact::apply_while`], where the contact is twisted or has been: by an angle or a torque at a constant
    /// load, or off.
    pub(super) fn apply_twist(&mut self, step: &Move) -> Result<(), Error> {
        let normal = self.normal_path(step)?;
        let to = match normal {
            NormalPath::Indentation { from, to } => (from != to).then_some(to),
            NormalPath::Force { to, .. } => Some(self.indentation_for(to)),
        };
        let target = match step.tangential {
            Some(Tangential::Twist(angle)) => Some(Tangential::Displacement(angle)),
            Some(Tangential::Torque(torque)) => Some(Tangential::Force(torque)),
            Some(_) => return Err(Error::TwistWithShift),
            None => None,
        };
        let Some(target) = target else {
            let Some(to) = to else { return Ok(()) };
            let twist = self.twist().map(|twist| &twist.contact);
            // Whatever way the contact opens, what the twist has stored is lost by slip.
            let lost = twist.map_or(0.0, |contact| contact.state().elastic_energy);
            let carries = twist.is_some_and(|contact| !contact.history.is_virgin());
            if carries && to.value() > 0.0 {
                return Err(Error::LoadMustBeConstant);
            }
            self.law = None;
            self.dissipated = self.dissipated + DoubleDouble::from(lost);
            return self.apply_visited(step, 1.0, &|| true, &mut |_, _| ());
        };
        if to.is_some() {
            return Err(Error::LoadMustBeConstant);
        }
        if self.history.edge().level.value() <= 0.0 {
            return match target {
                Tangential::Force(target) if target.abs() > 0.0 => {
                    Err(Error::TorqueExceedsFriction { target, limit: 0.0 })
                }
                // Apart, the indenter turns without anything to count from.
                _ => Ok(()),
            };
        }
        let mut twist = match self.twist() {
            Some(twist) => twist.clone(),
            None => self.new_twist()?,
        };
        let absolute = |from: f64, target: f64| if step.relative { from + target } else { target };
        match target {
            Tangential::Displacement(angle) => range::TWIST.check(absolute(twist.contact.displacement(), angle))?,
            Tangential::Force(torque) => range::TORQUE.check(absolute(twist.contact.force(), torque))?,
            _ => 0.0,
        };
        let done = twist.contact.apply(&Move { tangential: Some(target), relative: step.relative, ..Move::default() });
        done.map_err(|error| match error {
            Error::ForceExceedsFriction { target, limit, .. } => Error::TorqueExceedsFriction { target, limit },
            other => other,
        })?;
        self.dissipated = twist.contact.dissipated;
        self.law = Some(Box::new(Interface::of_twist(twist)));
        Ok(())
    }

    /// The same twisted, with this history of it; `None` if it cannot be.
    pub(super) fn with_twist_of(mut self, history: SlipHistory) -> Option<Contact> {
        let mut twist = self.new_twist().ok()?;
        twist.contact.displacement = history.position();
        twist.contact.history = history;
        self.law = Some(Box::new(Interface::of_twist(twist)));
        Some(self)
    }

    /// The state of a contact that is twisted, by that of it without its twist.
    pub(super) fn with_twist(&self, state: State) -> State {
        let Some(Twist { contact, .. }) = self.twist() else { return state };
        let own = contact.state();
        // xi = x^3/(3 a^2), that of the edge a/3.
        let share = (own.stick_radius / own.contact_radius).cbrt();
        State {
            twist: Some(own.displacement),
            torque: Some(own.force),
            stick_radius: share * state.contact_radius,
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
        let Some(Twist { contact, hoop, shear_modulus }) = self.twist() else { return vec![0.0; radii.len()] };
        let over_x = Contact {
            indenter: Arc::clone(hoop),
            elasticity: Elasticity::of_springs(*shear_modulus),
            history: contact.history.moved_to(|level| hoop.point(level)),
            ..contact.clone_without_history()
        };
        over_x.shears(radii).into_iter().zip(radii).map(|(shear, radius)| 4.0 * radius.abs() * shear).collect()
    }
}
