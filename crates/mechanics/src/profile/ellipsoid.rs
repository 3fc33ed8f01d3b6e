//! Two bodies whose gap is x^2/(2 R_x) + y^2/(2 R_y): Hertz's ellipse of contact, pressed along z and moved along x or
//! y.
//!
//! With q = b/a the ratio of the semi-axes, e^2 = 1 - q^2 and kappa = (K - E)/(e^2 K) of the complete elliptic
//! integrals of e, his solution (Johnson 1985, eqs 4.26) reads R_b/R_a = q^2 kappa/(1 - kappa), a^2 = 2 R_a kappa d and
//! F_N = (4/3) E* sqrt(R) d^(3/2), R = 2 R_a kappa (pi/2K)^2. So the load curve is that of a ball of the radius R.
//!
//! The stuck ellipse has 1 + nu/(1 - nu) kappa times the normal compliance along its major axis, 1 - kappa instead of
//! kappa along its minor one (Mindlin 1949), body by body:
//! [`Elasticity::along_ellipse`](crate::Elasticity::along_ellipse). Partial slip follows from the load curve by
//! Ciavarella (1998) and Jäger (1998), which is exact for a circle alone.

use crate::cells::parabola::Parabola;
use crate::numerics::roots::turning;
use crate::range;
use crate::range::error::Error;

/// The axis of the tangential motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Along x.
    X,
    /// Along y.
    Y,
}

/// An ellipsoid on a plane, or two bodies crossed.
#[derive(Clone, Debug, PartialEq)]
pub struct Ellipsoid {
    /// The ball with the same load curve.
    pub(super) ball: Parabola,
    /// Squares of the semi-axes along x and y over the indentation, m.
    squares: [f64; 2],
    /// kappa along the major axis and 1 - kappa along the minor one, for the direction of the motion.
    shear_share: f64,
}

impl Ellipsoid {
    /// The gap of the principal radii of curvature R_x and R_y, m, moved in this direction.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] by [`range::RADIUS`], and for radii whose ratio exceeds [`range::RADIUS_RATIO`].
    pub fn new(radii: [f64; 2], direction: Direction) -> Result<Ellipsoid, Error> {
        let [x, y] = radii;
        range::RADIUS.check(x)?;
        range::RADIUS.check(y)?;
        let (major, minor) = (x.max(y), x.min(y));
        range::RADIUS_RATIO.check(major / minor)?;
        let axis_ratio = axis_ratio(minor / major);
        let (kappa, mean) = integrals(axis_ratio);
        let square = 2.0 * major * kappa;
        let shares = [square, square * axis_ratio * axis_ratio];
        let along_major = (direction == Direction::X) == (x >= y);
        Ok(Ellipsoid {
            ball: Parabola { curvature_radius: square * mean * mean },
            squares: if x >= y { shares } else { [shares[1], shares[0]] },
            shear_share: if along_major { kappa } else { 1.0 - kappa },
        })
    }

    /// The semi-axes of the contact along x and y, m, at an indentation, m.
    ///
    /// ```
    /// use stickslip_mechanics::profile::{Direction, Ellipsoid};
    ///
    /// // Equal radii: the circle of a ball, a^2 = R d.
    /// let [x, y] = Ellipsoid::new([0.01, 0.01], Direction::X)?.semi_axes(1e-6);
    /// assert!((x - 1e-4).abs() < 1e-18 && (y - 1e-4).abs() < 1e-18);
    /// # Ok::<(), stickslip_mechanics::Error>(())
    /// ```
    #[must_use]
    pub fn semi_axes(&self, indentation: f64) -> [f64; 2] {
        self.squares.map(|square| (square * indentation.max(0.0)).sqrt())
    }

    /// What the tangential compliance of a body exceeds its normal one by, over nu/(1 - nu): one half for a circle.
    #[must_use]
    pub fn shear_share(&self) -> f64 {
        self.shear_share
    }
}

/// kappa and pi/(2 K) of an ellipse of this ratio of the semi-axes, by the arithmetic-geometric mean: pi/(2 K) = M(1,
/// q), kappa = 1/2 + sum over n > 0 of 2^(n-1) (c_n/e)^2.
fn integrals(ratio: f64) -> (f64, f64) {
    let (mut arithmetic, mut geometric) = (0.5 * (1.0 + ratio), ratio.sqrt());
    let (mut share, mut weight) = ((1.0 - ratio) / (4.0 * (1.0 + ratio)), 1.0);
    // c_1^2 over its share is e^2, and each c is the square of the one before over four means.
    let eccentricity = (1.0 - ratio) * (1.0 + ratio);
    let mut kappa = 0.5;
    while weight * share > 1e-17 * kappa {
        kappa += weight * share;
        let next = 0.5 * (arithmetic + geometric);
        share = share * share * eccentricity / (16.0 * next * next);
        geometric = (arithmetic * geometric).sqrt();
        arithmetic = next;
        weight *= 2.0;
    }
    (kappa, arithmetic)
}

/// The ratio of the semi-axes for a ratio of the radii of curvature up to one.
fn axis_ratio(radii: f64) -> f64 {
    let of = |ratio: f64| {
        let (kappa, _) = integrals(ratio);
        ratio * ratio * kappa / (1.0 - kappa)
    };
    // It lies between the ratio of the radii, which is that of a flat ellipse but for a logarithm, and its root.
    turning([radii, radii.sqrt()], |ratio| of(ratio) >= radii)[1]
}
