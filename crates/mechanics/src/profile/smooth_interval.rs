//! Integrals over an interval of radii without a kink inside.
//!
//! Beside a kink at k, g is smooth not in x but in t = sqrt(x^2 - k^2), so every integral here runs over t (k = 0: t =
//! x). The one thing asked of a profile is its rise from a radius up to the interval's outer end, to round-off of
//! itself: then h = y_outer - g is a sum of positive terms and nothing cancels, however thin the ring.

use super::{DoubleDouble, Profile, Span};
use crate::cells::shape::Powers;
use crate::numerics::gauss::Singular;

/// A stretch of radii in the coordinate t of the kink beneath it.
#[derive(Clone, Copy)]
pub(super) struct SmoothInterval {
    /// The kink's radius k, m.
    pub(super) base: f64,
    /// t at the outer end, m.
    pub(super) high: f64,
    /// Difference of t over the interval, m, exact.
    pub(super) drop: f64,
    /// Where g, as a function of t, is singular.
    pub(super) singular: Singular,
    /// g changes no faster than x to this power.
    pub(super) power: f64,
    /// t at the inner end, m.
    pub(super) low: f64,
    /// Sum of the radii at both ends, m.
    radii: f64,
    /// Difference of their squares, m^2.
    gap: f64,
}

/// A point of an interval, t below its top by `dt`.
#[derive(Clone, Copy)]
pub(super) struct Node {
    pub(super) t: f64,
    pub(super) dt: f64,
}

impl SmoothInterval {
    /// `span` above a kink at `base`. `singularity` is the distance in t to the next singularity beneath the kink,
    /// along the imaginary axis; g is analytic up to the radius `ceiling`.
    pub(super) fn new(span: &Span, base: f64, singularity: f64, power: f64) -> SmoothInterval {
        let (low, high) = span.excess(DoubleDouble::square_of(base));
        let (low, high) = (low.max(0.0).sqrt(), high.max(0.0).sqrt());
        let drop = if span.gap > 0.0 { span.gap / (low + high) } else { 0.0 };
        let singular = Singular { below: singularity, above: f64::INFINITY };
        SmoothInterval {
            base,
            high,
            drop,
            singular,
            power,
            low,
            radii: span.inner_radius + span.outer_radius,
            gap: span.gap,
        }
    }

    /// dx/dt = t/x.
    fn stretch(&self, t: f64) -> f64 {
        if self.base > 0.0 { t / (self.base * self.base + t * t).sqrt() } else { 1.0 }
    }

    /// The node at `dt` below the top, and the share of the radii, m, of a share of t.
    pub(super) fn node(&self, dt: f64, share: f64) -> (Node, f64) {
        let t = (self.high - dt).max(0.0);
        (Node { t, dt }, share * self.stretch(t))
    }
}

/// The outermost interval of a span without a kink, as such and as a span, and what is left inside it.
pub(super) fn outermost_interval(profile: &Profile, span: &Span) -> (SmoothInterval, Span, Option<Span>) {
    let base = profile.kink_under(span);
    let power = profile.growth(span.outer_radius);
    let square = DoubleDouble::square_of(base);
    let (Some(outer), rest) = (span.above(square, base), span.below(square, base)) else {
        return (SmoothInterval::new(span, 0.0, 0.0, power), *span, None);
    };
    let singularity = if base > 0.0 {
        let next = profile.kink_below(base);
        ((base - next) * (base + next)).sqrt()
    } else if profile.analytic_tip() {
        f64::INFINITY
    } else {
        0.0
    };
    (SmoothInterval::new(&outer, base, singularity, power), outer, rest)
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

impl Profile {
    /// x g'/g at a radius, m: g changes about as x to this power.
    pub(super) fn growth(&self, radius: f64) -> f64 {
        let level = self.level(radius);
        if level > 0.0 { (radius * self.slope(radius) / level).clamp(1.0, 1e3) } else { 1.0 }
    }

    /// Whether g is analytic in x at the tip.
    pub(super) fn analytic_tip(&self) -> bool {
        let uneven = |powers| matches!(powers, Powers::Uneven(_));
        self.shape().is_none_or(|shape| shape.kinks().first().is_none_or(|kink| !uneven(kink.powers)))
    }
}
