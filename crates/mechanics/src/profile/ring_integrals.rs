//! The integrals over rings of a profile: what moves, stresses and displacements are sums of. What a ring crosses at a
//! vertical edge is added here, to what a family says of the face.

use super::curve_family::CurveFamily;
use super::shape::{self, KernelOrder, Shape};
use super::{Asperities, Count, Ellipsoid, Moments, Profile, Ring, Span, StressRadius};
#[cfg(test)]
use crate::cells::call_count;

impl Profile {
    /// The load curve by which alone the contact is known, if it is.
    pub(super) fn curve(&self) -> Option<&dyn CurveFamily> {
        match self {
            Profile::Asperities(Asperities(Count::Many(curve))) => Some(curve),
            Profile::LoadCurve(curve) => Some(curve),
            _ => None,
        }
    }

    /// The integrals over a ring, each to round-off of itself however thin the ring is.
    #[must_use]
    #[inline]
    pub fn moments(&self, ring: &Ring) -> Moments {
        #[cfg(test)]
        call_count::add(|calls| &mut calls.moments);
        // As for a point; and the ring need not be written to memory.
        if let Profile::Sphere(sphere) = self { sphere.moments_between(ring) } else { self.moments_of_any(ring) }
    }

    #[inline(never)]
    fn moments_of_any(&self, ring: &Ring) -> Moments {
        if let Some(curve) = self.curve() {
            return curve.moments_of(ring);
        }
        each!(self, shape => shape::ring_moments(shape, ring))
    }

    /// The span of a ring.
    pub(super) fn span(&self, ring: &Ring) -> Span {
        each!(self, shape => shape::span(shape, ring))
    }

    /// The levels of a ring that lie on a vertical edge, m.
    pub(crate) fn edge_depth(&self, ring: &Ring) -> f64 {
        self.span(ring).edge
    }

    /// int dy / sqrt(X(y)^2 - r^2) over the levels of the ring whose radius is above r (pure number): the ring's share
    /// of a stress. For a smooth profile this is K(r, x_outer) - K(r, max(r, x_inner)), K(r, c) = int_r^c
    /// g'(x)/sqrt(x^2 - r^2) dx. Infinite at the tip of a cone, where f' jumps, and at a vertical edge; never NaN.
    #[must_use]
    pub fn kernel(&self, at: &StressRadius, ring: &Ring) -> f64 {
        #[cfg(test)]
        call_count::add(|calls| &mut calls.kernel);
        let span = self.span(ring);
        let face = Shape::kernel(self, KernelOrder::Value, at, &span);
        if span.edge > 0.0 { face + edge(at, &span) } else { face }
    }

    /// The derivative of [`Profile::kernel`] with respect to r^2, 1/m^2, taken from the right where r is the inner
    /// radius.
    #[must_use]
    pub fn kernel_slope(&self, at: &StressRadius, ring: &Ring) -> f64 {
        #[cfg(test)]
        call_count::add(|calls| &mut calls.kernel_slope);
        let span = self.span(ring);
        let face = Shape::kernel(self, KernelOrder::Slope, at, &span);
        if span.edge > 0.0 { face + edge_slope(at, &span) } else { face }
    }

    /// int (y_outer - g(x)) dx / sqrt(r^2 - x^2) over the radii x of the ring below r, m: the ring's share of the
    /// displacement of the surface at r.
    #[must_use]
    pub fn displacement_integral(&self, at: &StressRadius, ring: &Ring) -> f64 {
        #[cfg(test)]
        call_count::add(|calls| &mut calls.displacement_integral);
        let span = self.span(ring);
        let face = match Shape::celled(self, span.outer_radius) {
            Some(cells) => cells.displacement_integral(at, &span),
            None => each!(self, shape => shape::displacement_integral(shape, at, &span)),
        };
        if span.edge > 0.0 { face + span.edge * span.arc(at) } else { face }
    }

    /// int dx / sqrt(r^2 - x^2) over the radii x of the ring below r (pure number). What lies inside X(0), a flat core,
    /// belongs to no ring: there it is asin(min(1, X(0)/r)).
    #[must_use]
    pub fn arc(&self, at: &StressRadius, ring: &Ring) -> f64 {
        self.span(ring).arc(at)
    }
}

/// The contribution of the levels at a vertical edge to a kernel.
fn edge(at: &StressRadius, span: &Span) -> f64 {
    let square = (span.outer - at.square).value();
    if square < 0.0 { 0.0 } else { span.edge / square.sqrt() }
}

/// Their contribution to its slope.
fn edge_slope(at: &StressRadius, span: &Span) -> f64 {
    let square = (span.outer - at.square).value();
    if square < 0.0 { 0.0 } else { 0.5 * span.edge / square / square.sqrt() }
}
