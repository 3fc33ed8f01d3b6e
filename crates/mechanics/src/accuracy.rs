//! How far off a result may be: estimates that scale with what has cost the accuracy.

use super::contact::Contact;
use super::normal::mean_pressure;

/// Beyond this, steepness of g is the edge of a punch, which no rounding moves.
const STEEPEST: f64 = 1e4;

/// Estimates of what rounding, an interpolation or a coarse model has cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorEstimate {
    /// Error of the tangential force over mu F_N.
    pub force_error: f64,
    /// What curved paths have of it.
    pub path_error: f64,
    /// Error of the shear stress over mu p_max, or over mu times the mean pressure where the former is infinite.
    pub stress_error: f64,
}

impl Contact {
    /// What rounding, curved paths and the interpolation of a table have cost. The force is a sum over pieces, each good to some units in the last place of
    /// itself, so its rounding scales with the magnitudes that went into the sum; a stress likewise, whose terms are
    /// bounded by mu p. A table's g is off by what the points leave open: at a given w over y the force changes by
    /// 2 G* m int |error of g| dx at most, and so by as much again where the load is given. A stress has cusps: the estimate
    /// holds for a radius moved by some units in its last place, or by as much as a table's g is off.
    ///
    /// ```
    #[doc = include_str!("example.txt")]
    /// contact.apply(&slide(0.001))?;
    /// let estimate = contact.accuracy();
    /// assert!(estimate.force_error < 1e-13 && estimate.stress_error < 1e-13);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn accuracy(&self) -> ErrorEstimate {
        let carried = self.friction * self.normal_force();
        let summed = self.force_unit() * self.history.force_size();
        let terms = if carried > 0.0 { summed / carried } else { 0.0 };
        let (radius, indentation) = (self.contact_radius(), self.indentation());
        // Where g is steep, a rounded radius moves the indentation by this many units.
        let steepness = radius * self.profile.slope(radius) / indentation;
        let steepness = if steepness.is_finite() { steepness.clamp(0.0, STEEPEST) } else { 0.0 };
        let mean_pressure = mean_pressure(self.normal_force(), radius);
        let doubt = self.profile.doubt(radius);
        let bend =
            self.elasticity.e_star() / std::f64::consts::PI * (self.path_kernel + 2.0 * doubt.kernel) / mean_pressure;
        let bend = if bend.is_finite() { bend } else { 0.0 };
        let open = 2.0 * self.elasticity.e_star() * doubt.load / self.normal_force();
        let open = if open.is_finite() { open } else { 0.0 };
        let unit = f64::EPSILON * self.profile.cancellation(radius);
        ErrorEstimate {
            path_error: self.path_error,
            force_error: unit * (2.0 + 6.0 * terms + steepness) + self.path_error + open,
            stress_error: unit * (4.0 + 12.0 * terms + 2.0 * steepness) + self.path_error + open + bend,
        }
    }
}
