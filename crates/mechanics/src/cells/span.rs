//! A ring as an interval of radii, over which the families integrate.
//!
//! Differences of squares decide everything: x^2 - r^2 under the roots of the kernels, x^2 - b^2 beside a kink at b. So
//! a span carries the squares with twice the digits and their difference on its own, since that comes from the depth of
//! the ring.

use super::ring::{Moments, Ring, StressRadius};
use crate::numerics::double_double::DoubleDouble;

/// The radii of a ring, and the levels it crosses at a vertical edge.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Span {
    /// Square of the inner radius, m^2.
    pub(crate) inner: DoubleDouble,
    /// Square of the outer radius, m^2.
    pub(crate) outer: DoubleDouble,
    /// The inner radius, m.
    pub(crate) inner_radius: f64,
    /// The outer radius, m.
    pub(crate) outer_radius: f64,
    /// Difference of the squares, m^2, to round-off of itself.
    pub(crate) gap: f64,
    /// Levels crossed at the outer radius, where the profile rises vertically, m.
    pub(crate) edge: f64,
}

impl Span {
    /// The ring's radii, given the difference of their squares and the levels that a vertical edge takes.
    pub(crate) fn of(ring: &Ring, gap: f64, edge: f64) -> Span {
        Span {
            inner: ring.inner.square,
            outer: ring.outer.square,
            inner_radius: ring.inner.radius,
            outer_radius: ring.outer.radius,
            gap,
            edge,
        }
    }

    /// Difference of the radii, m.
    pub(crate) fn width(&self) -> f64 {
        if self.gap > 0.0 { self.gap / (self.inner_radius + self.outer_radius) } else { 0.0 }
    }

    /// Both squares less `square`. The two sides agree to round-off, and the difference is small where it ought to be.
    pub(crate) fn excess(&self, square: DoubleDouble) -> (f64, f64) {
        let inner = self.inner.less(square);
        (inner, if inner > -0.5 * self.gap { inner + self.gap } else { self.outer.less(square) })
    }

    /// The part inside the radius whose square is given.
    pub(crate) fn below(&self, square: DoubleDouble, radius: f64) -> Option<Span> {
        let (inner, outer) = self.excess(square);
        if inner >= 0.0 {
            None
        } else if outer <= 0.0 {
            Some(Span { edge: 0.0, ..*self })
        } else {
            Some(Span { outer: square, outer_radius: radius, gap: -inner, edge: 0.0, ..*self })
        }
    }

    /// The part outside the radius whose square is given.
    pub(crate) fn above(&self, square: DoubleDouble, radius: f64) -> Option<Span> {
        let (inner, outer) = self.excess(square);
        if outer <= 0.0 {
            None
        } else if inner >= 0.0 {
            Some(*self)
        } else {
            Some(Span { inner: square, inner_radius: radius, gap: outer, ..*self })
        }
    }

    /// int dx/sqrt(r^2 - x^2) over the radii of the span below r (pure number).
    pub(crate) fn arc(&self, at: &StressRadius) -> f64 {
        let (inner, outer) = self.excess(at.square);
        if inner >= 0.0 {
            return 0.0;
        }
        let (low, high) = ((-inner).sqrt(), (-outer).max(0.0).sqrt());
        let top = self.outer_radius.min(at.radius);
        let gap = if outer < 0.0 { self.gap } else { -inner };
        // Sine and cosine of the difference of the two angles asin(x/r).
        let sine = gap * at.square.value() / (top * low + self.inner_radius * high);
        sine.atan2(low * high + self.inner_radius * top)
    }
}

impl Moments {
    /// The moments of two adjacent rings together; `depth` is that of the outer one, which lifts all of the inner.
    pub(crate) fn stack(inner: Moments, outer: Moments, depth: f64) -> Moments {
        Moments {
            width: inner.width + outer.width,
            first: inner.first + depth * inner.width + outer.first,
            second: inner.second + depth * (2.0 * inner.first + depth * inner.width) + outer.second,
        }
    }
}
