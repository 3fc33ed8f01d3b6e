//! The ranges of the numbers that the mechanics accepts, one constant each, for checks and documents alike.

use std::fmt;

use super::error::Error;
pub use super::quantity::Quantity;
use super::unit_prefix::short;

/// A quantity's name, unit and closed interval, bounds included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// What the number measures.
    pub quantity: Quantity,
    /// SI unit, empty for a pure number.
    pub unit: &'static str,
    /// The smallest value accepted.
    pub min: f64,
    /// The largest value accepted.
    pub max: f64,
}

/// Any radius of a body or a contact.
pub const RADIUS: Range = Range { quantity: Quantity::Radius, unit: "m", min: 1e-15, max: 1e9 };
/// Radius of a flat end.
pub const FLAT_RADIUS: Range = Range { quantity: Quantity::FlatRadius, unit: "m", min: 1e-15, max: 1e9 };
/// Curvature radius of a rounded edge.
pub const EDGE_RADIUS: Range = Range { quantity: Quantity::EdgeRadius, unit: "m", min: 1e-15, max: 1e9 };
/// Radius up to which the tip of a cone is rounded.
pub const TIP_RADIUS: Range = Range { quantity: Quantity::TipRadius, unit: "m", min: 1e-15, max: 1e9 };
/// Slope dz/dr of a cone.
pub const SLOPE: Range = Range { quantity: Quantity::Slope, unit: "", min: 1e-9, max: 1e9 };
/// Exponent of a power law.
pub const EXPONENT: Range = Range { quantity: Quantity::Exponent, unit: "", min: 0.1, max: 1000.0 };
/// Coefficient of a power law; its unit, m^(1 - n), depends on the exponent.
pub const COEFFICIENT: Range = Range { quantity: Quantity::Coefficient, unit: "m^(1-n)", min: 1e-280, max: 1e280 };
/// How many points a tabulated profile may have.
pub const TABLE_POINTS: Range = Range { quantity: Quantity::TablePoints, unit: "", min: 3.0, max: 10_000.0 };
/// A radius in a table.
pub const TABLE_RADIUS: Range = Range { quantity: Quantity::TableRadius, unit: "m", min: 0.0, max: 1e9 };
/// A height in a table.
pub const TABLE_HEIGHT: Range = Range { quantity: Quantity::TableHeight, unit: "m", min: -1e9, max: 1e9 };
/// The standard error of an indentation of a table.
pub const INDENTATION_ERROR: Range = Range { quantity: Quantity::IndentationError, unit: "m", min: 0.0, max: 1e9 };
/// The standard error of a pressure of a table, over E*.
pub const PRESSURE_ERROR: Range = Range { quantity: Quantity::PressureError, unit: "", min: 0.0, max: 1e9 };
/// How many asperities a set may have.
pub const ASPERITIES: Range = Range { quantity: Quantity::Asperities, unit: "", min: 1.0, max: 1e6 };
/// The gap of an asperity above any plane.
pub const GAP: Range = Range { quantity: Quantity::Gap, unit: "m", min: -1e9, max: 1e9 };
/// How many points a load curve may have.
pub const CURVE_POINTS: Range = Range { quantity: Quantity::CurvePoints, unit: "", min: 3.0, max: 100_000.0 };
/// The larger of the two radii of curvature of an ellipsoid over the smaller.
pub const RADIUS_RATIO: Range = Range { quantity: Quantity::RadiusRatio, unit: "", min: 1.0, max: 1e6 };
/// How many profiles a sum may have, sums within it counted by their parts.
pub const PARTS: Range = Range { quantity: Quantity::Parts, unit: "", min: 1.0, max: 16.0 };
/// Young's modulus of a body.
pub const YOUNGS_MODULUS: Range = Range { quantity: Quantity::YoungsModulus, unit: "Pa", min: 1e-3, max: 1e18 };
/// Poisson's ratio of a body; auxetic bodies are allowed.
pub const POISSON_RATIO: Range = Range { quantity: Quantity::PoissonRatio, unit: "", min: -0.99, max: 0.5 };
/// The reduced modulus E*.
pub const E_STAR: Range = Range { quantity: Quantity::EStar, unit: "Pa", min: 1e-3, max: 1e18 };
/// The reduced shear modulus G*.
pub const G_STAR: Range = Range { quantity: Quantity::GStar, unit: "Pa", min: 1e-3, max: 1e18 };
/// Coulomb's coefficient of friction; zero means no tangential force at all.
pub const FRICTION: Range = Range { quantity: Quantity::Friction, unit: "", min: 0.0, max: 100.0 };
/// The smallest coefficient of friction above zero: below it, displacements relative to that of gross slip overflow.
pub const MIN_POSITIVE_FRICTION: f64 = 1e-9;
/// A normal force that presses the bodies together.
pub const NORMAL_FORCE: Range = Range { quantity: Quantity::NormalForce, unit: "N", min: 0.0, max: 1e18 };
/// The smallest normal force above zero, N: below it, quantities that follow from the force underflow.
pub const MIN_POSITIVE_NORMAL_FORCE: f64 = 1e-250;
/// The contact radius, prescribed or as it follows from a load; zero is a contact just touching.
pub const CONTACT_RADIUS: Range = Range { quantity: Quantity::ContactRadius, unit: "m", min: 0.0, max: 1e9 };
/// The indentation that a preload may ask for.
pub const PRELOAD_INDENTATION: Range = Range { quantity: Quantity::Indentation, unit: "m", min: 0.0, max: 1e9 };
/// The indentation that a move may ask for; below zero the bodies are apart.
pub const INDENTATION: Range = Range { quantity: Quantity::Indentation, unit: "m", min: -1e9, max: 1e9 };
/// The tangential displacement of the indenter.
pub const DISPLACEMENT: Range = Range { quantity: Quantity::Displacement, unit: "m", min: -1e9, max: 1e9 };
/// A tangential force.
pub const FORCE: Range = Range { quantity: Quantity::Force, unit: "N", min: -1e20, max: 1e20 };
/// A coordinate of a place below the surface.
pub const PLACE: Range = Range { quantity: Quantity::Place, unit: "m", min: -1e9, max: 1e9 };
/// A component of a uniform stress.
pub const BULK_STRESS: Range = Range { quantity: Quantity::BulkStress, unit: "Pa", min: -1e20, max: 1e20 };
/// The stiffness of a machine in series with the contact.
pub const MACHINE_STIFFNESS: Range = Range { quantity: Quantity::MachineStiffness, unit: "N/m", min: 1e-9, max: 1e30 };
/// The weight of a normal or hydrostatic stress in a fatigue criterion.
pub const FATIGUE_WEIGHT: Range = Range { quantity: Quantity::FatigueWeight, unit: "", min: 0.0, max: 100.0 };
/// The yield stress of a fatigue criterion.
pub const YIELD_STRESS: Range = Range { quantity: Quantity::YieldStress, unit: "Pa", min: 1e-3, max: 1e18 };
/// How many springs the foundation may have.
pub const SPRING_COUNT: Range = Range { quantity: Quantity::SpringCount, unit: "", min: 2.0, max: 1e6 };

impl Range {
    /// Whether `value` lies inside, bounds included; never for a NaN.
    ///
    /// ```
    /// use stickslip_mechanics::range::FRICTION;
    ///
    /// assert!(FRICTION.contains(0.0) && !FRICTION.contains(f64::NAN));
    /// ```
    #[must_use]
    pub fn contains(&self, value: f64) -> bool {
        (self.min..=self.max).contains(&value)
    }

    /// Gives `value` back.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if it lies outside or is not a number.
    ///
    /// ```
    /// use stickslip_mechanics::range;
    ///
    /// assert_eq!(range::POISSON_RATIO.check(0.3), Ok(0.3));
    /// assert_eq!(
    ///     range::POISSON_RATIO.check(0.6).unwrap_err().to_string(),
    ///     "poisson_ratio = 0.6 is out of range: allowed is -0.99 to 0.5",
    /// );
    /// ```
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
