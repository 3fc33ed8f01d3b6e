//! Worn sphere, f' = r/R for r > b: g = x t/R, t = sqrt(x^2 - b^2).
//!
//! gamma = dg/dt = (b^2 + 2 t^2)/(R x), int x dg = t (3 b^2 + 2 t^2)/(3R), and X follows from a quadratic in t^2 (Ejike
//! 1981; Popov & Hess 2015). f' jumps at b: pressure and shear are log-infinite there.
//!
//! The moments are closed. With p = x + t, u = p/p_outer from r to one and e = (b/p_outer)^2:
//! h = p_outer^2 (1 - u^2)(1 + e^2/u^2)/(4R) and dx = p_outer (1 - e/u^2) du/2. Split as
//! 1 - e/u^2 = 2 t_inner/p_inner + e (u^2 - r^2)/(r u)^2, every integral is a power of 1 - r times a polynomial of r
//! without a negative coefficient, so that nothing cancels.

use super::shape::{Falls, KernelOrder, ShapeFacts};
use super::smooth_coordinate::{self, SmoothCoordinate, flat_core};
use super::{DoubleDouble, Error, Moments, Ring, Span, SpanEnds, StressRadius, range};

/// Squares of t have twice the digits: their differences, over the larger one, are good down to this.
const RESOLVED: f64 = 1e-12;

/// A paraboloid with a flat end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TruncatedSphere {
    curvature_radius: f64,
    flat_radius: f64,
}

impl TruncatedSphere {
    /// The paraboloid of curvature radius R, m, worn flat up to the radius b, m.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] by [`range::RADIUS`] and [`range::FLAT_RADIUS`].
    pub fn new(radius: f64, flat_radius: f64) -> Result<TruncatedSphere, Error> {
        Ok(TruncatedSphere {
            curvature_radius: range::RADIUS.check(radius)?,
            flat_radius: range::FLAT_RADIUS.check(flat_radius)?,
        })
    }

    fn load_at(&self, t: f64) -> f64 {
        let b = self.flat_radius;
        t * (3.0 * b * b + 2.0 * t * t) / (3.0 * self.curvature_radius)
    }
}

impl SmoothCoordinate for TruncatedSphere {
    fn kink_radius(&self) -> f64 {
        self.flat_radius
    }

    fn level_at(&self, t: f64) -> f64 {
        self.radius_at(t) * t / self.curvature_radius
    }

    fn slope_at(&self, t: f64) -> f64 {
        let b = self.flat_radius;
        (b * b + 2.0 * t * t) / (self.radius_at(t) * self.curvature_radius)
    }

    fn slopes_at<const N: usize>(&self, t: [f64; N]) -> Option<[f64; N]> {
        Some(t.map(|t| self.slope_at(t)))
    }

    fn bend_at(&self, t: f64) -> f64 {
        let (b, x) = (self.flat_radius, self.radius_at(t));
        -b * b * b * b / (x * x * x * self.curvature_radius)
    }

    fn rise_at(&self, t: f64, top: f64, dt: f64) -> f64 {
        let (x, x_top) = (self.radius_at(t), self.radius_at(top));
        dt * (x_top + t * (t + top) / (x + x_top)) / self.curvature_radius
    }

    fn upper_bound(&self, level: f64) -> f64 {
        self.square_above(level.into()).value().sqrt()
    }

    fn solve(&self, level: f64) -> f64 {
        self.upper_bound(level)
    }

    fn square_above(&self, level: DoubleDouble) -> DoubleDouble {
        let product = level * self.curvature_radius;
        let (b, p) = (DoubleDouble::square_of(self.flat_radius), product.value());
        if p * p <= 0.0 {
            return DoubleDouble::ZERO;
        }
        // t^2 = q from q (q + b^2) = (R y)^2 with one rounding, and what that has lost by one step of Newton's.
        let half = 0.5 * b.value();
        let plain = p * p / (half.hypot(p) + half);
        let rest = product * product - (b + DoubleDouble::from(plain)) * plain;
        DoubleDouble::from(plain) + DoubleDouble::from(rest.value() / (2.0 * (half + plain)))
    }

    fn gap_by_squares(&self, low: f64, high: f64) -> bool {
        high - low > RESOLVED * high
    }

    fn moments_over(&self, span: &Span, &SpanEnds { low, high, drop: dt }: &SpanEnds) -> Option<Moments> {
        let (b, width, radii) = (self.flat_radius, span.width(), span.inner_radius + span.outer_radius);
        let both = high + low;
        let first = dt * dt / (3.0 * self.curvature_radius * radii)
            * (both * (both * both - high * low) / radii + span.outer_radius * (both + low));
        let (inner, outer) = (span.inner_radius + low, span.outer_radius + high);
        let (r, missing) = (inner / outer, (dt + width) / outer);
        let (flat, flat_inner) = ((b / outer) * (b / outer), (b / inner) * (b / inner));
        // e^2/r and e^4/r^3, e/r^2 being at most one.
        let (once, twice) = (flat * flat_inner * r, flat * flat_inner * flat_inner * flat * r);
        let steady = (8.0 + r * (9.0 + 3.0 * r)) / 15.0 + once * (2.0 + 2.0 / 3.0 * r) + twice * (1.0 / 3.0 + r);
        let rising = (8.0 + 2.0 * r) / 15.0 + 4.0 / 3.0 * once + twice * (2.0 + 8.0 * r) / 15.0;
        let share = 2.0 * low / inner * steady + flat_inner * missing * rising;
        let step = outer * missing;
        let second =
            step * step * step * (outer / self.curvature_radius) * (outer / self.curvature_radius) / 32.0 * share;
        Some(Moments { width, first, second })
    }
}

flat_core!(TruncatedSphere {
    fn falls(&self, inner: f64, outer: f64) -> Falls {
        // g'/x falls from the rim on.
        let least = if inner >= self.flat_radius { self.slope(outer) / outer } else { f64::NEG_INFINITY };
        Falls { least, concavely: false }
    }

    fn surface_slope(&self, r: f64) -> f64 {
        if r > self.flat_radius { r / self.curvature_radius } else { 0.0 }
    }

    fn facts(&self) -> ShapeFacts {
        ShapeFacts {
            curvature_radius: Some(self.curvature_radius),
            singular: Some(self.flat_radius),
            ..ShapeFacts::default()
        }
    }
});
