//! Hertz's parabola f = r^2/(2R), the paper's sphere: g(x) = x^2/R, K(r, c) = (2/R) sqrt(c^2 - r^2).
//!
//! Everything follows from one difference, x_outer^2 - x_inner^2 = R (y_outer - y_inner), which is never taken between
//! rounded radii (Hertz 1881; Popov & Hess 2015).

use super::shape::{Falls, KernelOrder, Shape, ShapeFacts};
use super::{DoubleDouble, Error, Kink, Moments, Ring, Span, StressRadius, range};
use crate::cells::Powers;

/// A paraboloid of revolution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    curvature_radius: f64,
}

impl Sphere {
    /// The paraboloid with curvature radius R, m, at its tip.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] by [`range::RADIUS`].
    pub fn new(radius: f64) -> Result<Sphere, Error> {
        Ok(Sphere { curvature_radius: range::RADIUS.check(radius)? })
    }

    /// Curvature radius R, m.
    #[must_use]
    pub fn curvature_radius(&self) -> f64 {
        self.curvature_radius
    }

    /// The moments of a ring, of which its depth and its two radii say all.
    #[inline]
    pub(super) fn moments_between(&self, ring: &Ring) -> Moments {
        let gap = if ring.depth > 0.0 { self.curvature_radius * ring.depth } else { 0.0 };
        let outer = ring.outer.radius;
        self.moments_by_width(outer, if gap > 0.0 { gap / (ring.inner.radius + outer) } else { 0.0 })
    }

    #[inline]
    fn moments_by_width(&self, outer: f64, width: f64) -> Moments {
        let area = width * width / self.curvature_radius;
        Moments {
            width,
            first: area * (outer - width / 3.0),
            second: area
                * (width / self.curvature_radius)
                * ((4.0 / 3.0 * outer - width) * outer + width * width / 5.0),
        }
    }

    /// The same where R follows from other, checked numbers.
    pub(super) fn of_curvature(radius: f64) -> Sphere {
        Sphere { curvature_radius: radius }
    }
}

impl Shape for Sphere {
    fn level(&self, radius: f64) -> f64 {
        radius * radius / self.curvature_radius
    }

    fn slope(&self, radius: f64) -> f64 {
        2.0 * radius / self.curvature_radius
    }

    fn slopes<const N: usize>(&self, _base: f64, t: [f64; N]) -> [f64; N] {
        // g'/x is the same everywhere.
        t.map(|t| self.slope(t))
    }

    fn square(&self, level: DoubleDouble) -> DoubleDouble {
        level * self.curvature_radius
    }

    fn load(&self, radius: f64) -> f64 {
        2.0 * radius * radius * radius / (3.0 * self.curvature_radius)
    }

    fn indentation_for(&self, load: f64) -> f64 {
        let radius = (1.5 * load * self.curvature_radius).cbrt();
        self.level(radius)
    }

    fn rise(&self, span: &Span) -> f64 {
        span.gap / self.curvature_radius
    }

    fn gap(&self, _ring: &Ring, depth: f64) -> f64 {
        self.curvature_radius * depth
    }

    fn moments(&self, span: &Span, _top: f64) -> Moments {
        self.moments_by_width(span.outer_radius, span.width())
    }

    fn kernel(&self, order: KernelOrder, at: &StressRadius, span: &Span) -> f64 {
        let (inner, outer) = span.excess(at.square);
        if outer <= 0.0 {
            return 0.0;
        }
        let outer = outer.sqrt();
        let share = match (order, inner > 0.0) {
            (KernelOrder::Value, true) => 2.0 * span.gap / (outer + inner.sqrt()),
            (KernelOrder::Value, false) => 2.0 * outer,
            (KernelOrder::Slope, true) => span.gap / (outer * inner.sqrt() * (outer + inner.sqrt())),
            (KernelOrder::Slope, false) => -1.0 / outer,
        };
        share / self.curvature_radius
    }

    fn surface_slope(&self, r: f64) -> f64 {
        r / self.curvature_radius
    }

    fn facts(&self) -> ShapeFacts {
        let curvature_radius = Some(self.curvature_radius);
        ShapeFacts { curvature_radius, kernel_falls: true, ..ShapeFacts::default() }
    }

    fn kinks(&self) -> Vec<Kink> {
        vec![Kink { radius: 0.0, powers: Powers::Odd }]
    }

    fn falls(&self, _inner: f64, _outer: f64) -> Falls {
        Falls { least: 2.0 / self.curvature_radius, concavely: true }
    }
}
