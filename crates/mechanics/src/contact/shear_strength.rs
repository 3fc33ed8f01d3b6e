//! A contact whose interface has a shear strength: |tau| <= tau_0 + mu p (Bowden & Tabor).
//!
//! At a constant load its tangential problem is that of a contact with mu = 1 and E* = G*, pressed into the limit of
//! friction itself ([`LimitShape`]). That contact is kept beside the one under the normal load, which knows nothing of
//! tangential moves then, and whatever is tangential is asked of it: moves, forces, energies, shear stress, slip.
//!
//! Under a load that grows after partial slip most of the room comes at the old edge, slip begins again inside the
//! ring that has slipped, and the law is no longer local in x. So the load must stay as it is from the first tangential
//! move on.

use std::sync::Arc;

use super::Contact;
use super::normal;
use super::state::Move;
use crate::cells::shape::Reach;
use crate::indenter::Indenter;
use crate::numerics::double_double::DoubleDouble;
use crate::path::curved_path::{NormalPath, TangentialPath};
use crate::profile::{LimitShape, Profile};
use crate::range;
use crate::range::Quantity;
use crate::range::error::Error;
use crate::range::unit_prefix::short;
use crate::slip_history::SlipHistory;
use crate::slip_history::limit::Coulomb;

/// The shear strength of a contact, and its tangential problem.
#[derive(Clone, Debug)]
pub(crate) struct ShearStrength {
    /// tau_0, Pa.
    pub(crate) value: f64,
    /// None without a contact.
    pub(crate) tangential: Option<Box<Contact>>,
}

impl Contact {
    /// The contact that answers for what is tangential.
    pub(crate) fn tangential(&self) -> Option<&Contact> {
        self.strength.as_ref()?.tangential.as_deref()
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
        self.strength.as_ref().map_or(0.0, |strength| strength.value)
    }

    /// Refuses what is defined for elastic bodies and Coulomb's law alone, by its name.
    ///
    /// # Errors
    /// [`Error::ShearStrength`] and [`Error::Viscoelastic`].
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
    /// assert!(contact.check_coulomb("wear").is_ok());
    /// # Ok::<(), Error>(())
    /// ```
    pub fn check_coulomb(&self, what: &'static str) -> Result<(), Error> {
        self.check_elastic(what)?;
        if self.strength.is_some() { Err(Error::ShearStrength(what)) } else { Ok(()) }
    }

    /// Gives a virgin contact its shear strength, Pa.
    pub(super) fn with_shear_strength(mut self, value: f64) -> Result<Contact, Error> {
        range::SHEAR_STRENGTH.check(value)?;
        if value <= 0.0 {
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
        self.strength = Some(ShearStrength { value, tangential: None });
        self.renew_tangential();
        Ok(self)
    }

    /// The tangential problem anew, for the present load and displacement, without shear.
    pub(super) fn renew_tangential(&mut self) {
        let Some(strength) = &self.strength else { return };
        let edge = *self.history.edge();
        let cells = self.indenter.cells(Reach::Radius(edge.radius)).filter(|_| edge.level.value() > 0.0);
        let tangential = cells.map(|cells| {
            let (scale, root) = (self.scale(), 2.0 * strength.value / self.elasticity.g_star());
            let upright = self.indenter.is_upright(&edge);
            let limit = LimitShape::new(self.indenter.shared_profile(), cells, (edge.square, upright), (scale, root));
            let step = if upright { (edge.level - cells.top.level) * scale } else { DoubleDouble::ZERO };
            let depth = limit.depth() + step;
            let (indenter, elasticity) = (Indenter::new(Profile::Limit(limit)), self.elasticity.tangential());
            let history = SlipHistory::new(&Coulomb(&indenter), depth).at_position(self.displacement);
            let normal_force = normal::force(&indenter, &elasticity, history.edge());
            Box::new(Contact {
                indenter: Arc::new(indenter),
                elasticity,
                friction: 1.0,
                history,
                displacement: self.displacement,
                normal_force,
                dissipated: self.dissipated,
                preload: (depth, normal_force),
                indentation_error: scale * self.indentation_error,
                path_error: 0.0,
                path_kernel: 0.0,
                inverse_scale: DoubleDouble::from(1.0),
                strength: None,
                viscoelastic: None,
            })
        });
        self.strength = Some(ShearStrength { tangential, ..*strength });
    }

    /// As [`Contact::apply_while`]: along the surface at a constant load, or to another load before the first shear.
    pub(crate) fn apply_with_strength(&mut self, step: &Move, normal: &NormalPath) -> Result<(), Error> {
        let tangential = self.tangential_path(step)?;
        let moved = match tangential {
            TangentialPath::Displacement { from, to } => from != to,
            TangentialPath::Force { .. } => true,
        };
        let to = match *normal {
            NormalPath::Indentation { from, to } => (from != to).then(|| (to, self.normal_force_at(to))),
            NormalPath::Force { to, .. } => Some((self.indentation_for(to), to)),
        };
        let Some((indentation, normal_force)) = to else { return self.apply_along(step, &tangential) };
        let carries = self.tangential().is_some_and(|contact| !contact.history.is_virgin());
        let apart = self.tangential().is_none() && indentation.value() <= 0.0;
        if carries || (moved && !apart) {
            return Err(Error::LoadMustBeConstant);
        }
        if let TangentialPath::Displacement { to: displacement, .. } = tangential {
            self.displacement = displacement;
        } else {
            return Err(Error::LoadMustBeConstant);
        }
        self.history = SlipHistory::new(&Coulomb(&self.indenter), indentation);
        self.normal_force = normal_force;
        self.renew_tangential();
        Ok(())
    }

    /// Moves along the surface.
    fn apply_along(&mut self, step: &Move, path: &TangentialPath) -> Result<(), Error> {
        let contact = self.strength.as_mut().and_then(|strength| strength.tangential.as_deref_mut());
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
