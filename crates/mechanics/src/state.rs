//! What a contact is made of, what it is told, and what it answers.

use super::elasticity::Elasticity;
use super::normal::Preload;
use super::profile::Profile;

/// What a contact is made of.
#[derive(Clone, Debug, PartialEq)]
pub struct Setup {
    /// The shape of the indenter.
    pub profile: Profile,
    /// The reduced moduli.
    pub elasticity: Elasticity,
    /// Coulomb's coefficient of friction mu.
    pub friction: f64,
    /// The normal load that the virgin contact starts with.
    pub preload: Preload,
}

/// Where a move leads, along a straight line in the quantities that it names.
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
    /// Indentation d, m; below nought the bodies part.
    Indentation(f64),
    /// Normal force F_N, N.
    NormalForce(f64),
}

/// What the last move did to the contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Regime {
    /// Nothing slipped.
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
    /// Radius of the part that did not slip in the last move, m.
    pub stick_radius: f64,
    /// What the last move did.
    pub regime: Regime,
    /// Friction work since the start, J.
    pub dissipated_energy: f64,
    /// Elastic energy of the tangential deformation, J.
    pub elastic_energy: f64,
    /// Pieces held in memory.
    pub memory_depth: usize,
}
