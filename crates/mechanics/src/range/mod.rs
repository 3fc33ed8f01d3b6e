//! The checks of the ranges of the numbers that the mechanics accepts, and limits that are no quantity of their own.

pub(crate) mod error;
mod quantity;
pub(crate) mod unit_prefix;

use std::fmt;

use error::Error;
pub use quantity::*;
use unit_prefix::short;

/// The smallest coefficient of friction above zero: below it, displacements relative to that of gross slip overflow.
pub const MIN_POSITIVE_FRICTION: f64 = 1e-9;
/// The smallest normal force above zero, N: below it, quantities that follow from the force underflow.
pub const MIN_POSITIVE_NORMAL_FORCE: f64 = 1e-250;
/// The indentation that a preload may ask for.
pub const PRELOAD_INDENTATION: Range = Range { quantity: Quantity::Indentation, unit: "m", min: 0.0, max: 1e9 };

/// ```
/// use stickslip_mechanics::range;
///
/// assert!(range::FRICTION.contains(0.0) && !range::FRICTION.contains(f64::NAN));
/// assert_eq!(range::POISSON_RATIO.check(0.3), Ok(0.3));
/// assert_eq!(
///     range::POISSON_RATIO.check(0.6).unwrap_err().to_string(),
///     "poisson_ratio = 0.6 is out of range: allowed is -0.99 to 0.5",
/// );
/// ```
impl Range {
    /// Whether `value` lies inside, bounds included; never for a NaN.
    #[must_use]
    pub fn contains(&self, value: f64) -> bool {
        (self.min..=self.max).contains(&value)
    }

    /// Gives `value` back.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if it lies outside or is not a number.
    pub fn check(&self, value: f64) -> Result<f64, Error> {
        if self.contains(value) {
            Ok(value)
        } else {
            Err(Error::OutOfRange { quantity: self.quantity, value, allowed: self.to_string() })
        }
    }
}

/// Gives a coefficient of friction back: zero, or from [`MIN_POSITIVE_FRICTION`] on.
///
/// # Errors
/// [`Error::OutOfRange`] otherwise.
///
/// ```
/// use stickslip_mechanics::range::check_friction;
///
/// assert!(check_friction(0.0).is_ok() && check_friction(0.3).is_ok() && check_friction(1e-12).is_err());
/// ```
pub fn check_friction(friction: f64) -> Result<f64, Error> {
    zero_or_from(MIN_POSITIVE_FRICTION, &FRICTION, friction)
}

/// Gives a normal force back: zero, or from [`MIN_POSITIVE_NORMAL_FORCE`] on.
///
/// # Errors
/// [`Error::OutOfRange`] otherwise.
///
/// ```
/// use stickslip_mechanics::range::check_normal_force;
///
/// assert!(check_normal_force(0.0).is_ok() && check_normal_force(-1.0).is_err());
/// ```
pub fn check_normal_force(force: f64) -> Result<f64, Error> {
    zero_or_from(MIN_POSITIVE_NORMAL_FORCE, &NORMAL_FORCE, force)
}

/// Gives `value` back if it is zero, or from `least` on in the range.
fn zero_or_from(least: f64, range: &Range, value: f64) -> Result<f64, Error> {
    if value > 0.0 && value < least {
        let allowed = format!("0, or {}", Range { min: least, ..*range });
        return Err(Error::OutOfRange { quantity: range.quantity, value, allowed });
    }
    range.check(value)
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} to {}", short(self.min), short(self.max))?;
        if !self.unit.is_empty() {
            write!(f, " {}", self.unit)?;
        }
        Ok(())
    }
}
