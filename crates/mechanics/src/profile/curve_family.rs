//! Families that are known by their load curve alone: X(y) = F_N'(y)/(2 E*), and no surface.
//!
//! The slip history asks for X and its integrals over rings of levels, which every contact has whose tangential
//! compliance is proportional to its normal one, point by point of the load curve (Ciavarella 1998; Jaeger 1998). Such
//! a family is to the rest of the mechanics the body of revolution with the same curve, g the inverse of X, but for
//! what needs a surface: its kernels and slopes are NaN, and whoever asks for a stress checks
//! [`Profile::check_stress_field`](super::Profile) first.

use super::shape::{End, KernelOrder, Shape, ShapeFacts};
use super::{DoubleDouble, InterpolationError, Moments, Point, Ring, Span, StressRadius};

/// The functions of a load curve.
pub(super) trait CurveFamily {
    /// X(y), m.
    fn radius_at(&self, level: DoubleDouble) -> f64;

    /// X'(y) (pure number).
    fn rate(&self, level: f64) -> f64;

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

    /// The level with X.
    fn point_at(&self, level: DoubleDouble) -> Point {
        let radius = self.radius_at(level);
        Point { level, radius, square: DoubleDouble::square_of(radius) }
    }
}

impl<C: CurveFamily> Shape for C {
    fn level(&self, radius: f64) -> f64 {
        self.level_of(radius)
    }

    fn slope(&self, radius: f64) -> f64 {
        self.rate(self.level_of(radius)).recip()
    }

    fn square(&self, level: DoubleDouble) -> DoubleDouble {
        DoubleDouble::square_of(self.radius_at(level))
    }

    fn load(&self, radius: f64) -> f64 {
        let (zero, edge) = (DoubleDouble::ZERO, DoubleDouble::from(self.level_of(radius)));
        let ring = Ring::between(self.point_at(zero), self.point_at(edge));
        ring.inner.radius * ring.depth + self.moments_of(&ring).first
    }

    fn indentation_for(&self, load: f64) -> f64 {
        self.indentation_of(load)
    }

    fn rise(&self, span: &Span) -> f64 {
        self.level_of(span.outer_radius) - self.level_of(span.inner_radius)
    }

    fn gap(&self, ring: &Ring, _depth: f64) -> f64 {
        (ring.outer.square - ring.inner.square).value()
    }

    fn kernel(&self, _order: KernelOrder, _at: &StressRadius, _span: &Span) -> f64 {
        f64::NAN
    }

    fn surface_slope(&self, _r: f64) -> f64 {
        f64::NAN
    }

    fn facts(&self) -> ShapeFacts {
        ShapeFacts { by_series: false, ..ShapeFacts::default() }
            .ending(self.end().map(|radius| End { radius, falls: false }))
    }
}
