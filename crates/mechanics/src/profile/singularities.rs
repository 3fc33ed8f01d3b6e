//! Radii where stresses are not smooth, whatever the history of the contact, and where they are known to fall.

use super::Profile;
use super::shape::Shape;

impl Profile {
    /// Whether the kernel up to any radius falls with r, so that pressure does too. It lets the search for the peaks of the
    /// shear stress skip intervals without any; `false` is always safe.
    ///
    /// K(r, c) = int g'(x)/x dv, v = sqrt(x^2 - r^2), over 0 to sqrt(c^2 - r^2): it falls wherever g'/x does not rise.
    #[must_use]
    pub fn kernel_falls(&self) -> bool {
        Shape::kernel_falls(self)
    }

    /// The radii, m, increasing, at which pressure and shear are infinite once the contact has grown over them: the tip of a
    /// cone, a rim where the slope jumps. The vertical edge of a punch is not among them.
    ///
    /// ```
    /// use stickslip_mechanics::profile::{Profile, TruncatedCone};
    ///
    /// let cone = Profile::TruncatedCone(TruncatedCone::new(0.1, 5e-5)?);
    /// assert_eq!(cone.singular_radii(), [5e-5]);
    /// # Ok::<(), stickslip_mechanics::Error>(())
    /// ```
    #[must_use]
    pub fn singular_radii(&self) -> Vec<f64> {
        Shape::singular_radii(self)
    }

    /// The radii, m, above zero and below `radius` at which g is not analytic, increasing: ends of a flat, knots of a table.
    /// Stresses are log-infinite there, or their derivatives are.
    #[must_use]
    pub fn knots_below(&self, radius: f64) -> Vec<f64> {
        let below = |knot: f64| Some(Shape::kink_below(self, knot)).filter(|&next| next > 0.0 && next < knot);
        let mut knots: Vec<f64> = std::iter::successors(below(radius), |&knot| below(knot)).collect();
        knots.reverse();
        knots
    }

    /// Whether stresses are analytic in r^2 at the centre if the surface slips there.
    #[must_use]
    pub fn smooth_centre(&self) -> bool {
        Shape::smooth_centre(self)
    }
}
