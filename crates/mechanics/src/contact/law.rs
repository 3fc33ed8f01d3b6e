//! What a contact has beyond Coulomb's law and a history over its own levels: a shear strength of its interface, |tau|
//! <= tau_0 + mu p (Bowden & Tabor), and adhesion.
//!
//! At a constant load the tangential problem is that of a contact with mu = 1 and E* = G*, pressed into the limit of
//! slip itself ([`LimitShape`]). That contact is kept beside the one under the normal load, which knows nothing of
//! tangential moves then, and whatever is tangential is asked of it: moves, forces, energies, shear stress, slip.
//!
//! Under a load that grows after partial slip most of the room comes at the old edge, slip begins again inside the
//! ring that has slipped, and the law is no longer local in x. So the load must stay as it is from the first tangential
//! move on.

use std::sync::Arc;

use super::Contact;
use super::adhesion::{Adhesion, Bond, Branch, Control, tension};
use super::normal;
use super::state::{Move, Normal, State};
use super::twist::Twist;
use super::viscoelastic::LEAST_TOLERANCE;
use crate::cells::shape::Reach;
use crate::elasticity::Elasticity;
use crate::indenter::Indenter;
use crate::numerics::double_double::DoubleDouble;
use crate::path::curved_path::{NormalPath, TangentialPath};
use crate::profile::{LimitShape, Profile, Strength};
use crate::range;
use crate::range::Quantity;
use crate::range::error::Error;
use crate::range::unit_prefix::short;
use crate::slip_history::SlipHistory;
use crate::slip_history::limit::Coulomb;

/// The law of a contact, and its tangential problem.
#[derive(Clone, Debug)]
pub(crate) struct Interface {
    /// tau_0, Pa.
    pub(crate) strength: f64,
    pub(crate) adhesion: Option<Adhesion>,
    /// None without a contact, and without a shear strength.
    pub(crate) tangential: Option<Box<Contact>>,
    /// Since the first twist, at the load of that.
    pub(crate) twist: Option<Twist>,
}

impl Interface {
    /// Coulomb's law, of a contact that is twisted.
    pub(super) fn of_twist(twist: Twist) -> Interface {
        Interface { strength: 0.0, adhesion: None, tangential: None, twist: Some(twist) }
    }
}

/// Two levels of indentation nearer than this are one, relative: the rounding of d = g(a) - l.
const SAME: f64 = 8.0 * f64::EPSILON;

impl Contact {
    /// The contact that answers for what is tangential.
    pub(crate) fn tangential(&self) -> Option<&Contact> {
        self.law.as_ref()?.tangential.as_deref()
    }

    /// The shear strength tau_0, Pa; zero for Coulomb's law.
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
    /// assert_eq!(contact.shear_strength(), 0.0);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn shear_strength(&self) -> f64 {
        self.law.as_ref().map_or(0.0, |law| law.strength)
    }

    /// Refuses what is defined for elastic bodies and Coulomb's law alone, by its name.
    ///
    /// # Errors
    /// [`Error::ShearStrength`], [`Error::Adhesive`], [`Error::Twisted`].
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
    /// assert!(contact.check_coulomb("wear").is_ok());
    /// # Ok::<(), Error>(())
    /// ```
    pub fn check_coulomb(&self, what: &'static str) -> Result<(), Error> {
        self.check_elastic(what)?;
        match self.law.as_deref() {
            None => Ok(()),
            Some(Interface { adhesion: Some(_), .. }) => Err(Error::Adhesive(what)),
            Some(Interface { twist: Some(_), .. }) => Err(Error::Twisted(what)),
            Some(_) => Err(Error::ShearStrength(what)),
        }
    }

    /// Its adhesion.
    pub(crate) fn adhesion(&self) -> Option<&Adhesion> {
        self.law.as_ref()?.adhesion.as_ref()
    }

    /// The work of adhesion w, J/m^2; zero for bodies that do not adhere.
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
    /// assert_eq!(contact.work_of_adhesion(), 0.0);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn work_of_adhesion(&self) -> f64 {
        self.adhesion().map_or(0.0, |adhesion| adhesion.work)
    }

    /// Where it hangs together at its edge.
    pub(crate) fn held(&self) -> Option<(&Adhesion, Branch<'_>)> {
        let adhesion = self.adhesion().filter(|adhesion| adhesion.bond == Bond::Held)?;
        Some((adhesion, adhesion.branch(&self.indenter, &self.elasticity)))
    }

    /// What adhesion adds to a state.
    pub(super) fn with_surfaces(&self, state: State) -> State {
        let Some(adhesion) = self.adhesion() else { return state };
        let area = std::f64::consts::PI * state.contact_radius * state.contact_radius;
        State { surface_energy: Some(0.0 - adhesion.work * area), adhesion_loss: Some(adhesion.loss), ..state }
    }

    /// Gives a virgin contact its shear strength, Pa, and its adhesion.
    pub(super) fn with_law(mut self, value: f64, adhesion: Option<Adhesion>) -> Result<Contact, Error> {
        range::SHEAR_STRENGTH.check(value)?;
        if value <= 0.0 && adhesion.is_none() {
            return Ok(self);
        }
        if value <= 0.0 {
            self.law = Some(Box::new(Interface { strength: 0.0, adhesion, tangential: None, twist: None }));
            return Ok(self);
        }
        self.profile().check_round("`shear_strength`")?;
        self.profile().check_stress_field()?;
        // Below this, displacements relative to that of gross slip overflow, as for a coefficient of friction.
        let least = range::MIN_POSITIVE_FRICTION * self.elasticity.g_star();
        if value < least {
            let allowed = format!("0, or from {} Pa on, 1e-9 of G*", short(least));
            return Err(Error::OutOfRange { quantity: Quantity::ShearStrength, value, allowed });
        }
        self.law = Some(Box::new(Interface { strength: value, adhesion, tangential: None, twist: None }));
        self.renew_tangential();
        Ok(self)
    }

    /// The law anew, for a contact at rest at its present level.
    pub(super) fn renew_law(&mut self) {
        let apart = self.history.edge().level.value() < 0.0;
        if self.is_twisted() {
            self.law = None;
        }
        if let Some(adhesion) = self.law.as_mut().and_then(|law| law.adhesion.as_mut()) {
            (adhesion.bond, adhesion.loss) = (if apart { Bond::Apart } else { Bond::Held }, 0.0);
        }
        self.renew_tangential();
    }

    /// The tangential problem anew, for the present load and displacement, without shear.
    pub(super) fn renew_tangential(&mut self) {
        let Some(strength) = self.law.as_ref().map(|law| law.strength).filter(|strength| *strength > 0.0) else {
            return;
        };
        let edge = *self.history.edge();
        let cells = self.indenter.cells(Reach::Radius(edge.radius)).filter(|_| edge.level.value() > 0.0);
        let tangential = cells.map(|cells| {
            let (scale, root) = (self.scale(), 2.0 * strength / self.elasticity.g_star());
            let upright = self.indenter.is_upright(&edge);
            let limit = Strength { cells, edge: edge.square, upright, scale, root };
            let limit = limit.limit(&self.indenter.shared_profile());
            let step = if upright { (edge.level - cells.top.level) * scale } else { DoubleDouble::ZERO };
            let mut contact = self.pressed_into(limit, step, self.elasticity.tangential());
            contact.history = contact.history.at_position(self.displacement);
            contact.displacement = self.displacement;
            contact.indentation_error = scale * self.indentation_error;
            Box::new(contact)
        });
        if let Some(law) = self.law.as_mut() {
            law.tangential = tangential;
        }
    }

    /// The virgin contact with mu = 1 that is pressed into the limit of this one, and by `step` beyond a vertical edge.
    pub(super) fn pressed_into(&self, limit: LimitShape, step: DoubleDouble, elasticity: Elasticity) -> Contact {
        let depth = limit.depth() + step;
        let indenter = Indenter::new(Profile::Limit(limit));
        let history = SlipHistory::new(&Coulomb(&indenter), depth);
        let normal_force = normal::force(&indenter, &elasticity, history.edge());
        Contact {
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
        }
    }

    /// As [`Contact::apply_while`]: along the surface at a constant load, or to another load before the first shear.
    pub(crate) fn apply_by_law(
        &mut self,
        step: &Move,
        tolerance: f64,
        keep_going: &dyn Fn() -> bool,
    ) -> Result<(), Error> {
        if step.twists() || self.is_twisted() {
            return self.apply_twist(step, tolerance.max(LEAST_TOLERANCE), keep_going);
        }
        let tangential = self.tangential_path(step)?;
        let moved = match tangential {
            TangentialPath::Displacement { from, to } => from != to,
            TangentialPath::Force { .. } => true,
        };
        let (mut adhesion, frictionless) = (self.adhesion().copied(), self.shear_strength() <= 0.0);
        let to = match &mut adhesion {
            Some(adhesion) => self.adhesive_target(step, adhesion)?,
            None => match self.normal_path(step)? {
                NormalPath::Indentation { from, to } => (from != to).then(|| (to, self.normal_force_at(to))),
                NormalPath::Force { to, .. } => Some((self.indentation_for(to), to)),
            },
        };
        let Some((indentation, normal_force)) = to else { return self.apply_along(step, &tangential) };
        let carries = self.tangential().is_some_and(|contact| !contact.history.is_virgin());
        let apart = self.tangential().is_none() && indentation.value() <= 0.0;
        if carries || (moved && !apart && !frictionless) {
            return Err(Error::LoadMustBeConstant);
        }
        if let TangentialPath::Displacement { to: displacement, .. } = tangential {
            self.displacement = displacement;
        } else {
            return Err(Error::LoadMustBeConstant);
        }
        self.history = SlipHistory::new(&Coulomb(&self.indenter), indentation);
        self.normal_force = normal_force;
        if let Some(law) = self.law.as_mut() {
            law.adhesion = adhesion;
        }
        self.renew_tangential();
        Ok(())
    }

    /// The level, m, below zero a gap, and the normal force, N, that an adhesive contact comes to, if a move changes
    /// its load.
    fn adhesive_target(&self, step: &Move, adhesion: &mut Adhesion) -> Result<Option<(DoubleDouble, f64)>, Error> {
        let (depth, load) = (self.indentation(), self.normal_force);
        let absolute = |from: f64, target: f64| if step.relative { from + target } else { target };
        let (control, target, same) = match step.normal {
            None => return Ok(None),
            Some(Normal::NormalForce(force)) => {
                let target = tension(absolute(load, force))?;
                (Control::Load, target, target.to_bits() == load.to_bits() && adhesion.bond == Bond::Held)
            }
            Some(Normal::Indentation(to)) => {
                let target = range::INDENTATION.check(absolute(depth, to))?;
                let rounding = SAME * (depth.abs() + self.history.edge().level.value().abs());
                (Control::Indentation, target, (target - depth).abs() <= rounding)
            }
        };
        if same {
            return Ok(None);
        }
        let indenter = Arc::clone(&self.indenter);
        let branch = adhesion.branch(&indenter, &self.elasticity);
        let level = adhesion.moved(&branch, self.history.edge().level.value(), control, target)?;
        if level > 0.0 {
            range::CONTACT_RADIUS.check(self.indenter.check_radius(self.indenter.contact_radius(level))?)?;
        }
        let load = match (adhesion.bond, control) {
            (Bond::Held, Control::Load) => target,
            (Bond::Held, Control::Indentation) => branch.force(level),
            _ => 0.0,
        };
        Ok(Some((DoubleDouble::from(level), load)))
    }

    /// Moves along the surface.
    fn apply_along(&mut self, step: &Move, path: &TangentialPath) -> Result<(), Error> {
        let contact = self.law.as_mut().and_then(|law| law.tangential.as_deref_mut());
        match (contact, *path) {
            (Some(contact), _) => {
                contact.apply(&Move { normal: None, ..*step })?;
                (self.displacement, self.dissipated) = (contact.displacement, contact.dissipated);
            }
            (None, TangentialPath::Displacement { to, .. }) => self.displacement = to,
            (None, TangentialPath::Force { to, .. }) if to.abs() > 0.0 => {
                return Err(Error::ForceExceedsFriction { target: to, limit: 0.0, part: 0.0 });
            }
            (None, TangentialPath::Force { .. }) => {}
        }
        Ok(())
    }
}
