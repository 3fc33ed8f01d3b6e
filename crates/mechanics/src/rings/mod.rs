//! Motion in the plane: a discrete solver for a contact that is moved along x and y.
//!
//! The direction of slip differs from ring to ring and turns, so that the exact history of a motion along a line does
//! not apply; nor do springs of the MDR that each slip in their own direction, which lose 24 % less work on a circle of
//! 0.6 u_max. What holds for a rigid motion under an axisymmetric pressure, with the coupling across it left out
//! as along a line, is one traction vector for each ring, and Coulomb's law is asked of each ring. Rings of equal area
//! and the steps of a move are halved to extrapolate the result and to state its error.

mod discretisation;
mod field;
mod follow;
mod law;
mod load;
mod slip;
mod solution;
mod step;
mod stiffness;
mod straight;

pub use follow::{Options, Refusal, first_choice, follow};
pub use law::{PlanarContact, PlanarLaw};
pub use solution::{PlanarState, Solution};
pub use step::PlanarBuffers;
pub use straight::straight_moves;

use std::f64::consts::TAU;

use crate::contact::Contact;
use crate::contact::state::{Normal, Setup};
use crate::profile::Profile;
use crate::range::error::Error;
use crate::range::{self, Range};

/// A slip up to this, relative to the displacement of gross slip, is rounding.
const NO_SLIP: f64 = 1e-12;
/// Length over the displacement of gross slip after which a straight move slips in its own direction all over,
/// and the radius of an arc from which on its angle counts alone.
const TURNED: f64 = 4.0;

/// The end of a move in the plane, which is straight in the quantities named, but for an [`EllipseArc`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PlanarMove {
    /// The tangential target; without one the displacement stays.
    pub tangential: Option<PlanarTarget>,
    /// The normal target; without one the indentation stays.
    pub normal: Option<Normal>,
    /// Whether the numbers are increments; those of an arc never are.
    pub relative: bool,
}

/// A tangential target along x and y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlanarTarget {
    /// Displacement of the indenter, m.
    Displacement([f64; 2]),
    /// Tangential force, N.
    Force([f64; 2]),
    /// Displacement along an ellipse.
    Arc(EllipseArc),
}

impl PlanarTarget {
    /// Refuses numbers that are no target.
    pub(crate) fn check(&self) -> Result<(), Error> {
        let both = |range: &Range, pair: &[f64; 2]| pair.iter().try_for_each(|value| range.check(*value).map(drop));
        match self {
            PlanarTarget::Displacement(to) => both(&range::DISPLACEMENT, to),
            PlanarTarget::Force(to) => both(&range::FORCE, to),
            PlanarTarget::Arc(EllipseArc { radii, phase, turns }) => {
                both(&range::DISPLACEMENT, radii)?;
                both(&range::TURNS, turns)?;
                range::PHASE.check(*phase).map(drop)
            }
        }
    }
}

/// A part of the ellipse x = a cos(2 pi t), y = b sin(2 pi t + phase).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EllipseArc {
    /// a and b, m.
    pub radii: [f64; 2],
    /// Phase, radians: an upright ellipse at zero, a line at a quarter of a turn.
    pub phase: f64,
    /// t at the beginning and at the end, turns.
    pub turns: [f64; 2],
}

impl EllipseArc {
    /// The displacement, m, at a part of the arc from 0 to 1.
    ///
    /// ```
    /// use stickslip_mechanics::rings::EllipseArc;
    ///
    /// let arc = EllipseArc { radii: [2.0, 1.0], phase: 0.0, turns: [0.0, 0.25] };
    /// assert_eq!(arc.at(0.0), [2.0, 0.0]);
    /// assert!((arc.at(1.0)[1] - 1.0).abs() < 1e-15);
    /// ```
    #[must_use]
    pub fn at(&self, part: f64) -> [f64; 2] {
        let [begin, end] = self.turns;
        let angle = TAU * (begin + part * (end - begin)).fract();
        [self.radii[0] * angle.cos(), self.radii[1] * (angle + self.phase).sin()]
    }
}

/// The contact of a definition that can be moved in the plane.
fn contact_of<P: Into<std::sync::Arc<Profile>>>(setup: Setup<P>) -> Result<Contact, Error> {
    let setup = setup.shared();
    setup.profile.check_round("motion in the plane")?;
    setup.profile.check_stress_field()?;
    Contact::new(setup)
}
