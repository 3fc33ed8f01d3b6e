//! The definition of a contact, its moves and its state: plain values.

use std::sync::Arc;

use super::normal::Preload;
use crate::elasticity::Elasticity;
use crate::profile::Profile;

/// The definition of a contact. Its profile is a [`Profile`], or an `Arc` of one that others share, because a table is
/// large.
#[derive(Clone, Debug, PartialEq)]
pub struct Setup<P = Profile> {
    /// The shape of the indenter.
    pub profile: P,
    /// The reduced moduli.
    pub elasticity: Elasticity,
    /// Coulomb's coefficient of friction mu.
    pub friction: f64,
    /// The normal load that the virgin contact starts with.
    pub preload: Preload,
}

impl<P: Into<Arc<Profile>>> Setup<P> {
    /// The same, whose copies share the profile.
    #[must_use]
    pub fn shared(self) -> Setup<Arc<Profile>> {
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
}

/// A tangential target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tangential {
    /// Displacement U of the indenter, m.
    Displacement(f64),
    /// Tangential force F_x, N.
    Force(f64),
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
}

/// The state after a move. Positive displacement gives positive force.
#[derive(Clone, Copy, Debug, PartialEq)]
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
}
