//! Where stresses are not smooth, whatever has been done to the contact, and where they are known to fall.

use super::Profile;
use super::shape::Shape;

impl Profile {
    /// Whether the kernel up to any radius falls with r, so that pressure does too. It lets the search for the peaks of the
    /// shear stress skip what can hold none; `false` is always safe.
    ///
    /// K(r, c) = int g'(x)/x dv, v = sqrt(x^2 - r^2), over 0 to sqrt(c^2 - r^2): it falls wherever g'/x does not rise.
    #[must_use]
    pub fn kernel_falls(&self) -> bool {
        match self {
            Profile::Sphere(_) | Profile::Cone(_) | Profile::RoundedCone(_) => true,
            Profile::PowerLaw(power) => power.power() <= 2.0,
            Profile::Sum(sum) => sum.parts().iter().all(Profile::kernel_falls),
            _ => false,
        }
    }

    /// The radii, m, at which pressure and shear are infinite once the contact has grown over them: the tip of a cone, a rim
    /// where the slope jumps. The vertical edge of a punch is not among them.
    #[must_use]
    pub fn singular_radii(&self) -> Vec<f64> {
        match self {
            Profile::Cone(_) => vec![0.0],
            Profile::PowerLaw(power) if power.power() <= 1.0 => vec![0.0],
            Profile::TruncatedCone(cone) => vec![cone.kink()],
            Profile::TruncatedSphere(sphere) => vec![sphere.kink()],
            Profile::Sum(sum) => {
                let mut radii: Vec<f64> = sum.parts().iter().flat_map(Profile::singular_radii).collect();
                radii.sort_by(f64::total_cmp);
                radii.dedup_by(|a, b| a.to_bits() == b.to_bits());
                radii
            }
            _ => Vec::new(),
        }
    }

    /// The radii, m, above nought and below `radius` at which g is not analytic, rising: ends of a flat, knots of a table. Stresses
    /// are log-infinite there, or their derivatives are.
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
        match self {
            Profile::Cone(_) => false,
            Profile::PowerLaw(power) => power.power().to_bits() == 2f64.to_bits(),
            Profile::Sum(sum) => sum.parts().iter().all(Profile::smooth_centre),
            _ => true,
        }
    }
}
