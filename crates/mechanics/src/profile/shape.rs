//! The functions that a family must provide, and those that follow for all families.

use super::celled;
use super::smooth_interval::{Node, SmoothInterval};
use super::{DoubleDouble, Moments, Ring, Span, StressRadius};
use crate::cells::Cells;
use crate::cells::grid::Kink;
use crate::cells::kernel::Kernel;
use crate::numerics::roots::increasing;

/// Where contacts end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct End {
    /// The radius, m, that every contact must stay below.
    pub(super) radius: f64,
    /// Whether it is there because g falls from there on, rather than because the profile ends.
    pub(super) falls: bool,
}

/// What holds for all of a shape.
#[derive(Clone, Copy, Debug)]
pub(super) struct ShapeFacts {
    /// Where contacts end, if they do before a vertical edge.
    pub(super) limit: Option<End>,
    /// Up to where g is known, though it may fall before.
    pub(super) known_to: Option<End>,
    /// The radius at which g ceases to be analytic, never reached by a contact, m.
    pub(super) ceiling: f64,
    /// The radius of a vertical edge, which the contact keeps under every higher load, m.
    pub(super) rim: Option<f64>,
    /// Where f' jumps by a finite amount, so that stresses are log-infinite, m: of a sum, one of these radii.
    pub(super) singular: Option<f64>,
    /// g changes no faster than x to this power.
    pub(super) power: f64,
    /// The radius of curvature, where the shape is given by one, m.
    pub(super) curvature_radius: Option<f64>,
    /// Whether g'(x)/x does not rise anywhere; `false` is always safe.
    pub(super) kernel_falls: bool,
    /// The radius, m, from which on it does not rise, where there is one.
    pub(super) falls_from: Option<f64>,
    /// Whether g is analytic in x at the tip.
    pub(super) analytic_tip: bool,
    /// Whether stresses are analytic in r^2 at the centre.
    pub(super) smooth_centre: bool,
    /// Whether g'/x is analytic in x^2 at the tip.
    pub(super) smooth_tip: bool,
    /// Whether short series resolve g between few kinks; a family without must have its own [`Shape::kernel`].
    pub(super) by_series: bool,
}

impl Default for ShapeFacts {
    fn default() -> ShapeFacts {
        ShapeFacts {
            limit: None,
            known_to: None,
            ceiling: f64::INFINITY,
            rim: None,
            singular: None,
            power: 2.0,
            curvature_radius: None,
            kernel_falls: false,
            falls_from: None,
            analytic_tip: true,
            smooth_centre: true,
            smooth_tip: true,
            by_series: true,
        }
    }
}

impl ShapeFacts {
    /// The same of a shape that ends before a vertical edge.
    pub(super) fn ending(self, end: Option<End>) -> ShapeFacts {
        ShapeFacts { limit: end, known_to: end, ..self }
    }

    /// Whether g falls somewhere before the end.
    pub(super) fn falls_within(&self) -> bool {
        self.limit.zip(self.known_to).is_some_and(|(limit, end)| limit.radius < end.radius)
    }
}

/// Cells reach down to this share of the least radius, whose square has digits that it has lost itself, and at a tip
/// that is not smooth to this share of the outer one.
pub(super) const CLEAR: f64 = 0.9;
const TIP: f64 = 1e-12;

/// What is asked of a kernel.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum KernelOrder {
    Value,
    /// The derivative with respect to r^2, from the right.
    Slope,
}

/// What is known of the sign of dK(r, c)/d(r^2), the kernel up to c: see [`Profile::falls`](super::Profile).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Falls {
    /// A lower bound, 1/m, of -2 v dK/d(r^2); minus infinity where nothing is known.
    pub(crate) least: f64,
    /// Whether q neither falls nor bends upward from the inner radius on.
    pub(crate) concavely: bool,
}

/// The functions of one family, of which the first three are its own. Radii in m, levels in m; the caller adds what a
/// span crosses at a vertical edge. What is not closed follows from g and g' by quadratures, roots and series.
pub(super) trait Shape: Sized {
    /// The cells that reach beyond a radius, m, where the family is made of them.
    fn celled(&self, _radius: f64) -> Option<&Cells> {
        None
    }

    /// g(x).
    fn level(&self, radius: f64) -> f64;

    /// g'(x).
    fn slope(&self, radius: f64) -> f64;

    /// f'(r), the slope of the undeformed surface.
    fn surface_slope(&self, r: f64) -> f64;

    /// What holds for all of it.
    fn facts(&self) -> ShapeFacts {
        ShapeFacts::default()
    }

    /// Where g is not analytic, from the innermost on, where the surface leaves the plane.
    fn kinks(&self) -> Vec<Kink> {
        Vec::new()
    }

    /// The largest kink below `radius`; zero, the tip, if there is none.
    fn kink_below(&self, _radius: f64) -> f64 {
        0.0
    }

    /// dg/dt (pure number) at several t = sqrt(x^2 - b^2) side by side, m, above `base` = b, m: a kink of the family or
    /// of a sum that it is part of, or zero.
    fn slopes<const N: usize>(&self, base: f64, t: [f64; N]) -> [f64; N] {
        t.map(|t| {
            let x = if base > 0.0 { (base * base + t * t).sqrt() } else { t };
            if x > 0.0 { self.slope(x) * (t / x) } else { 0.0 }
        })
    }

    /// X(y)^2, as exact as can be.
    fn square(&self, level: DoubleDouble) -> DoubleDouble {
        let y = level.value();
        DoubleDouble::square_of(if y > 0.0 { increasing(y, |x| (self.level(x) - y, self.slope(x))) } else { 0.0 })
    }

    /// int_0^x t g'(t) dt = F_N/(2 E*), m^2.
    fn load(&self, radius: f64) -> f64 {
        // By parts.
        self.moments(&Span::from_centre(radius), self.level(radius)).first
    }

    /// The level at which [`Shape::load`] has this value.
    fn indentation_for(&self, load: f64) -> f64 {
        if load <= 0.0 {
            return 0.0;
        }
        self.level(increasing(load.sqrt(), |x| (self.load(x) - load, x * self.slope(x))))
    }

    /// g(x_outer) - g(x_inner), to round-off of itself.
    fn rise(&self, span: &Span) -> f64 {
        rise(self, span)
    }

    /// Difference of the squares of the radii of a ring of this depth. [`Shape::rise`] undone, by Newton's steps.
    fn gap(&self, ring: &Ring, depth: f64) -> f64 {
        gap(self, ring, depth)
    }

    /// The moments of h = g(x_outer) - g(x); `top` = g(x_outer).
    fn moments(&self, span: &Span, _top: f64) -> Moments {
        moments(self, span)
    }

    /// int g'(x) dx / sqrt(x^2 - r^2) over the radii of the span above r, or its slope.
    fn kernel(&self, order: KernelOrder, at: &StressRadius, span: &Span) -> f64 {
        kernel(self, order, at, span)
    }

    /// See [`Falls`].
    fn falls(&self, inner: f64, outer: f64) -> Falls {
        let facts = self.facts();
        let falls = facts.kernel_falls || facts.falls_from.is_some_and(|from| inner >= from);
        let least = if falls { self.slope(outer) / outer } else { f64::NEG_INFINITY };
        Falls { least, concavely: false }
    }
}

/// The largest kink below the outer end of a span, m; zero, the tip, if there is none. By the square of the end, since
/// a radius just beyond a kink may be rounded onto it.
pub(super) fn kink_under<S: Shape>(shape: &S, square: DoubleDouble, radius: f64) -> f64 {
    let kink = shape.kink_below(radius.next_up());
    if DoubleDouble::square_of(kink) < square { kink } else { shape.kink_below(kink) }
}

/// The outermost interval of a span without a kink, as such and as a span, and what is left inside it.
pub(super) fn outermost_interval<S: Shape>(shape: &S, span: &Span) -> (SmoothInterval, Span, Option<Span>) {
    let ShapeFacts { ceiling, power, analytic_tip, .. } = shape.facts();
    let base = kink_under(shape, span.outer, span.outer_radius);
    let square = DoubleDouble::square_of(base);
    let (Some(outer), rest) = (span.above(square, base), span.below(square, base)) else {
        return (SmoothInterval::new(span, 0.0, 0.0, ceiling, power), *span, None);
    };
    let singularity = if base > 0.0 {
        let next = shape.kink_below(base);
        ((base - next) * (base + next)).sqrt()
    } else if analytic_tip {
        f64::INFINITY
    } else {
        0.0
    };
    (SmoothInterval::new(&outer, base, singularity, ceiling, power), outer, rest)
}

/// The stretch from a node of an interval up to the interval's outer end.
pub(super) fn under(top: &Span, interval: &SmoothInterval, node: Node) -> Span {
    if node.dt < 0.5 * interval.high {
        return Span::under(top.outer, top.outer_radius, node.dt * (interval.high + node.t));
    }
    // Near the inner end its own square must be exact, not the difference from the outer one.
    let inner = DoubleDouble::square_of(interval.base) + DoubleDouble::square_of(node.t);
    Span { inner, inner_radius: inner.value().sqrt(), gap: (top.outer - inner).value(), edge: 0.0, ..*top }
}

/// The span of a ring.
pub(super) fn span<S: Shape>(shape: &S, ring: &Ring) -> Span {
    let (mut depth, mut edge) = (ring.depth, 0.0);
    if let Some(rim) = shape.facts().rim.filter(|rim| ring.outer.radius >= *rim) {
        let top = DoubleDouble::from(shape.level(rim));
        if ring.inner.level >= top {
            (depth, edge) = (0.0, depth);
        } else if ring.outer.level > top {
            edge = (ring.outer.level - top).value();
            depth = (top - ring.inner.level).value();
        }
    }
    Span::of(ring, if depth > 0.0 { shape.gap(ring, depth) } else { 0.0 }, edge)
}

/// The moments of a ring, with what it crosses at a vertical edge.
pub(super) fn ring_moments<S: Shape>(shape: &S, ring: &Ring) -> Moments {
    let span = span(shape, ring);
    let face = shape.moments(&span, ring.outer.level.value() - span.edge);
    if span.edge > 0.0 { Moments::stack(face, Moments::default(), span.edge) } else { face }
}

/// [`Shape::rise`] by quadratures of dg/dt between kink and kink.
fn rise<S: Shape>(shape: &S, span: &Span) -> f64 {
    between_kinks(shape, span).map(|(interval, _)| interval.rise(|t| shape.slopes(interval.base, [t])[0])).sum()
}

/// The parts of a span without a kink, from its outer end inward, as such and as spans.
fn between_kinks<S: Shape>(shape: &S, span: &Span) -> impl Iterator<Item = (SmoothInterval, Span)> {
    let mut rest = Some(*span);
    std::iter::from_fn(move || {
        let (interval, outer, inner) = outermost_interval(shape, &rest.filter(|span| span.gap > 0.0)?);
        rest = inner;
        Some((interval, outer))
    })
}

/// int h dx / sqrt(r^2 - x^2) below r, with h = g(x_outer) - g(x).
pub(super) fn displacement_integral<S: Shape>(shape: &S, at: &StressRadius, span: &Span) -> f64 {
    let (mut sum, mut above) = (0.0, 0.0);
    for (interval, outer) in between_kinks(shape, span) {
        sum += interval.displacement_integral(&outer, at, above, |node| shape.rise(&under(&outer, &interval, node)));
        above += shape.rise(&outer);
    }
    sum
}

/// [`Shape::kernel`] by cells of its own.
fn kernel<S: Shape>(shape: &S, order: KernelOrder, at: &StressRadius, span: &Span) -> f64 {
    let start = if shape.facts().smooth_tip { 0.0 } else { (CLEAR * at.radius).max(TIP * span.outer_radius) };
    let start = if span.inner_radius > start { 0.5 * span.inner_radius } else { start };
    let cells = celled::between(shape, start, (span.outer, span.outer_radius));
    let kernel = if order == KernelOrder::Value { Kernel::Root } else { Kernel::RootSlope };
    cells.map_or(f64::NAN, |cells| cells.sum(kernel, at, span))
}

/// [`Shape::gap`] by Newton's steps.
pub(super) fn gap<S: Shape>(shape: &S, ring: &Ring, depth: f64) -> f64 {
    let outer = ring.outer;
    let plain = (outer.square - ring.inner.square).value();
    if plain > 0.3 * outer.square.value() || ring.inner.level <= DoubleDouble::ZERO {
        return plain;
    }
    // No ring reaches into a flat core, where g is constant.
    let square = (outer.square - shape.square(DoubleDouble::ZERO)).value();
    let steepness = |radius: f64| shape.slope(radius) / (2.0 * radius);
    let start = depth / steepness(outer.radius);
    let start = if plain > 1e-6 * square { plain } else { start.min(0.5 * square) };
    increasing(start, |gap| {
        let span = Span::under(outer.square, outer.radius, gap.min(square));
        let (rise, steepness) = (shape.rise(&span), steepness(span.inner_radius.max(f64::MIN_POSITIVE)));
        // Where f' jumps the slope is infinite, and beyond the centre it is undefined: a Newton step would fail.
        (rise - depth, if steepness.is_finite() && gap < square { steepness } else { rise / gap })
    })
    .min(square)
}

/// [`Shape::moments`] between kink and kink.
pub(super) fn moments<S: Shape>(shape: &S, span: &Span) -> Moments {
    let (mut sum, mut above) = (Moments::default(), 0.0);
    for (interval, outer) in between_kinks(shape, span) {
        let part = interval.moments(|node| shape.rise(&under(&outer, &interval, node)));
        sum = Moments::stack(part, sum, above);
        above += shape.rise(&outer);
    }
    sum
}

#[cfg(test)]
mod tests;
