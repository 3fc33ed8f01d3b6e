//! The definition of a contact, its moves and its state: plain values.

use std::sync::Arc;

use super::normal::Preload;
use crate::elasticity::Elasticity;
use crate::profile::Profile;
use crate::range::error::Error;
use crate::viscoelastic::Prony;

/// The definition of a contact. Its profile is a [`Profile`], or an `Arc` of one that others share, because a table is
/// large.
#[derive(Clone, Debug, PartialEq)]
pub struct Setup<P = Profile, F = f64> {
    /// The shape of the indenter.
    pub profile: P,
    /// The reduced moduli.
    pub elasticity: Elasticity,
    /// Coulomb's coefficient of friction mu, a [`Friction`], or a [`Law`].
    pub friction: F,
    /// The normal load that the virgin contact starts with.
    pub preload: Preload,
}

/// What an interface carries: shear stresses up to tau_0 + mu p, and tension up to the work of adhesion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    /// Coulomb's coefficient mu.
    pub coefficient: f64,
    /// The shear strength tau_0 of the interface, Pa; zero for Coulomb's law.
    pub shear_strength: f64,
    /// The work of adhesion w, J/m^2; zero for bodies that do not adhere.
    pub adhesion: f64,
}

/// What a contact obeys beside linear elasticity: the limit of its shear stress, and the memory of its bodies.
#[derive(Clone, Debug, PartialEq)]
pub struct Law {
    /// The limit of the shear stress.
    pub limit: Friction,
    /// How the moduli of the bodies relax; none for elastic bodies.
    pub memory: Option<Arc<Prony>>,
}

impl From<Friction> for Law {
    fn from(friction: Friction) -> Law {
        Law { limit: friction, memory: None }
    }
}

impl From<f64> for Law {
    fn from(coefficient: f64) -> Law {
        Friction::from(coefficient).into()
    }
}

impl From<f64> for Friction {
    fn from(coefficient: f64) -> Friction {
        Friction { coefficient, shear_strength: 0.0, adhesion: 0.0 }
    }
}

impl<P> Setup<P, Law> {
    /// The same with elastic bodies and Coulomb's law alone, for what knows no other; `what` names it.
    ///
    /// # Errors
    /// [`Error::ShearStrength`] if there is a shear strength, [`Error::Adhesive`] if the bodies adhere,
    /// [`Error::Viscoelastic`] if they have memory.
    ///
    /// ```
    /// use stickslip_mechanics::{Elasticity, Friction, Law, Preload, Setup, Sphere};
    ///
    /// let elasticity = Elasticity::effective(1.15e11, 8.5e10)?;
    /// let friction = Law::from(Friction { shear_strength: 1e6, ..Friction::from(0.3) });
    /// let setup = Setup { profile: Sphere::new(0.01)?, elasticity, friction, preload: Preload::NormalForce(10.0) };
    /// let refused = setup.clone().coulomb("wear").unwrap_err();
    /// assert_eq!(refused.to_string(), "wear is not available with a shear strength");
    /// assert!(Setup { friction: Law::from(0.3), ..setup }.coulomb("wear").is_ok());
    /// # Ok::<(), stickslip_mechanics::Error>(())
    /// ```
    pub fn coulomb(self, what: &'static str) -> Result<Setup<P>, Error> {
        let Setup { profile, elasticity, friction: Law { limit: friction, memory }, preload } = self;
        if memory.is_some() {
            return Err(Error::Viscoelastic(what));
        }
        if friction.adhesion > 0.0 {
            return Err(Error::Adhesive(what));
        }
        if friction.shear_strength > 0.0 {
            return Err(Error::ShearStrength(what));
        }
        Ok(Setup { profile, elasticity, friction: friction.coefficient, preload })
    }
}

impl<P: Into<Arc<Profile>>, F> Setup<P, F> {
    /// The same, whose copies share the profile.
    #[must_use]
    pub fn shared(self) -> Setup<Arc<Profile>, F> {
        let Setup { profile, elasticity, friction, preload } = self;
        Setup { profile: profile.into(), elasticity, friction, preload }
    }
}

/// The end of a move, which is straight in the quantities named.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Move {
    /// The tangential target; without one the displacement stays.
    pub tangential: Option<Tangential>,
    /// The normal target; without one the indentation stays.
    pub normal: Option<Normal>,
    /// Whether the numbers are increments.
    pub relative: bool,
    /// How long it takes, s, at an even pace. Zero is at once, as all that is elastic is.
    pub duration: f64,
}

/// A tangential target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tangential {
    /// Displacement U of the indenter, m.
    Displacement(f64),
    /// Tangential force F_x, N.
    Force(f64),
    /// Angle of twist, rad, since the contact last touched.
    Twist(f64),
    /// Torque, N m.
    Torque(f64),
}

impl Move {
    /// Whether it has an angle or a torque for its target.
    pub(crate) fn twists(&self) -> bool {
        matches!(self.tangential, Some(Tangential::Twist(_) | Tangential::Torque(_)))
    }
}

/// A normal target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Normal {
    /// Indentation d, m; below zero the bodies part.
    Indentation(f64),
    /// Normal force F_N, N.
    NormalForce(f64),
}

/// Which parts of the contact slipped in the last move, from the least that slips to the most.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Regime {
    /// Nothing slipped.
    #[default]
    Stick,
    /// An outer ring slipped.
    PartialSlip,
    /// All of it slipped.
    GrossSlip,
    /// There is no contact.
    Separated,
    /// There is none any more: an adhesive contact has been pulled off.
    PulledOff,
}

/// The state after a move. Positive displacement gives positive force.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct State {
    /// Tangential displacement U of the indenter, m.
    pub displacement: f64,
    /// Tangential force F_x, N.
    pub force: f64,
    /// Indentation d, m.
    pub indentation: f64,
    /// Normal force F_N, N.
    pub normal_force: f64,
    /// Contact radius a, m.
    pub contact_radius: f64,
    /// Radius of the part that did not slip in the last move, m; half-width of a line contact.
    pub stick_radius: f64,
    /// Where the middle of that part is, m, if a bulk stress comes with the force.
    pub stick_centre: Option<f64>,
    /// Which parts the last move made slip.
    pub regime: Regime,
    /// Friction work since the start, J.
    pub dissipated_energy: f64,
    /// Elastic energy of the tangential deformation, J.
    pub elastic_energy: f64,
    /// Number of straight pieces that the slip history consists of.
    pub memory_depth: usize,
    /// Electrical conductance, S, if the resistivity of both bodies is known.
    pub electrical_conductance: Option<f64>,
    /// Thermal conductance, W/K, if the conductivity of both bodies is known.
    pub thermal_conductance: Option<f64>,
    /// Time since the preload, s, if the bodies have memory.
    pub time: Option<f64>,
    /// Work of the tangential force that the bodies have dissipated since the start, J, if they have memory.
    pub viscous_work: Option<f64>,
    /// -w pi a^2, J, if the bodies adhere: what the surfaces have given since they were apart.
    pub surface_energy: Option<f64>,
    /// What pulling off and jumping into contact have lost since the start, J, if the bodies adhere.
    pub adhesion_loss: Option<f64>,
    /// Angle of twist, rad, from the first twist until the contact lifts off.
    pub twist: Option<f64>,
    /// Torque, N m, from then on.
    pub torque: Option<f64>,
}
