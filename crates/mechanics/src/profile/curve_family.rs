//! Families that are known by their load curve alone: X(y) = F_N'(y)/(2 E*), and no surface.
//!
//! The slip history asks for X and its integrals over rings of levels, which every contact has whose tangential
//! compliance is proportional to its normal one, point by point of the load curve (Ciavarella 1998; Jäger 1998). Such
//! a family is to the rest of the mechanics the body of revolution with the same curve, g the inverse of X, but
//! without a surface: its kernels and slopes are NaN, and every function that gives a stress checks
//! [`Profile::check_stress_field`](super::Profile) first.

use super::{InterpolationError, Moments, Ring};
use crate::numerics::double_double::DoubleDouble;

/// The functions of a load curve.
pub(crate) trait CurveFamily {
    /// X(y), m.
    fn radius_at(&self, level: DoubleDouble) -> f64;

    /// X(y), m, and X'(y) (pure number).
    fn radius_and_rate(&self, level: DoubleDouble) -> [f64; 2];

    /// The level, m, from which on X is no less than `radius`, m.
    fn level_of(&self, radius: f64) -> f64;

    /// The integrals over a ring, each to round-off of itself.
    fn moments_of(&self, ring: &Ring) -> Moments;

    /// The indentation, m, at which int X dy is `load`, m^2.
    fn indentation_of(&self, load: f64) -> f64;

    /// X above every radius of the curve, m, if it ends.
    fn end(&self) -> Option<f64> {
        None
    }

    /// The interpolation error in a contact of this radius, m.
    fn curve_error(&self, _radius: f64) -> InterpolationError {
        InterpolationError::default()
    }
}
