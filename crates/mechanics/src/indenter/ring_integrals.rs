//! The integrals over one ring of a profile: what moves, stresses and displacements are sums of. Those at a vertical
//! edge are added here to those of the cells.

use super::{Indenter, StressRadius};
use crate::cells::Cells;
#[cfg(test)]
use crate::cells::call_count;
use crate::cells::kernel::Kernel;
use crate::cells::ring::{Moments, Ring};
use crate::cells::shape::Reach;
use crate::cells::span::Span;

impl Indenter {
    /// The integrals over a ring, each to round-off of itself however thin the ring is.
    #[must_use]
    #[inline]
    pub fn moments(&self, ring: &Ring) -> Moments {
        #[cfg(test)]
        call_count::add(|calls| &mut calls.moments);
        // As for a point; and the ring need not be written to memory.
        if let Some(ball) = self.ball() { ball.moments(ring) } else { self.moments_of_any(ring) }
    }

    #[inline(never)]
    fn moments_of_any(&self, ring: &Ring) -> Moments {
        if let Some(curve) = self.profile.curve() {
            return curve.moments_of(ring);
        }
        let Some(cells) = self.cells(Reach::Radius(ring.outer.radius)) else { return Moments::default() };
        let span = self.span_by(cells, ring);
        let face = cells.moments(&span);
        if span.edge > 0.0 { Moments::stack(face, Moments::default(), span.edge) } else { face }
    }

    /// The span of a ring, with what it has of a vertical edge.
    pub(crate) fn span(&self, ring: &Ring) -> Span {
        match (self.ball(), self.cells(Reach::Radius(ring.outer.radius))) {
            (Some(ball), _) => Span::of(ring, ball.gap(ring), 0.0),
            (_, Some(cells)) => self.span_by(cells, ring),
            _ => Span::of(ring, (ring.outer.square - ring.inner.square).value(), 0.0),
        }
    }

    fn span_by(&self, cells: &Cells, ring: &Ring) -> Span {
        let (mut depth, mut edge, top) = (ring.depth, 0.0, cells.top.level);
        if self.rim.is_some_and(|rim| ring.outer.square >= rim.square) {
            if ring.inner.level >= top {
                (depth, edge) = (0.0, depth);
            } else if ring.outer.level > top {
                (depth, edge) = ((top - ring.inner.level).value(), (ring.outer.level - top).value());
            }
        }
        Span::of(ring, if depth > 0.0 { cells.gap(ring, depth) } else { 0.0 }, edge)
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
        match self.ball_face() {
            Some(ball) => ball.kernel(at, ring),
            None => self.sum_over(Kernel::Root, at, ring),
        }
    }

    /// The derivative of [`Indenter::kernel`] with respect to r^2, 1/m^2, taken from the right where r is the inner
    /// radius.
    #[must_use]
    pub fn kernel_slope(&self, at: &StressRadius, ring: &Ring) -> f64 {
        #[cfg(test)]
        call_count::add(|calls| &mut calls.kernel_slope);
        match self.ball_face() {
            Some(ball) => ball.kernel_slope(at, ring),
            None => self.sum_over(Kernel::RootSlope, at, ring),
        }
    }

    fn sum_over(&self, kernel: Kernel, at: &StressRadius, ring: &Ring) -> f64 {
        let span = self.span(ring);
        let face = self.cells(Reach::Radius(span.outer_radius)).map_or(f64::NAN, |cells| cells.sum(kernel, at, &span));
        if span.edge > 0.0 { face + span.edge * kernel.of_place(span.outer, span.outer_radius, at) } else { face }
    }

    /// int (y_outer - g(x)) dx / sqrt(r^2 - x^2) over the radii x of the ring below r, m: the ring's share of the
    /// displacement of the surface at r.
    #[must_use]
    pub fn displacement_integral(&self, at: &StressRadius, ring: &Ring) -> f64 {
        #[cfg(test)]
        call_count::add(|calls| &mut calls.displacement_integral);
        let span = self.span(ring);
        let face =
            self.cells(Reach::Radius(span.outer_radius)).map_or(f64::NAN, |c| c.displacement_integral(at, &span));
        if span.edge > 0.0 { face + span.edge * span.arc(at) } else { face }
    }

    /// int dx / sqrt(r^2 - x^2) over the radii x of the ring below r (pure number). What lies inside X(0), a flat core,
    /// belongs to no ring: there it is asin(min(1, X(0)/r)).
    #[must_use]
    pub fn arc(&self, at: &StressRadius, ring: &Ring) -> f64 {
        self.span(ring).arc(at)
    }
}
