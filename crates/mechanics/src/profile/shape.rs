//! The functions that a family must provide, and those that follow for all families.

use super::ring_nodes::RingNodes;
use super::smooth_interval::{Node, SmoothInterval};
use super::{DoubleDouble, InterpolationError, Moments, Ring, Span, StressRadius};
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
    /// g changes no faster than x to this power.
    pub(super) power: f64,
    /// The radius of curvature, where the shape is given by one, m.
    pub(super) curvature_radius: Option<f64>,
    /// Whether g'(x)/x does not rise anywhere; `false` is always safe.
    pub(super) kernel_falls: bool,
    /// Whether g is analytic in x at the tip.
    pub(super) analytic_tip: bool,
    /// Whether stresses are analytic in r^2 at the centre.
    pub(super) smooth_centre: bool,
    /// Whether g'/x is a polynomial in x^2 below all kinks.
    pub(super) smooth_tip: bool,
    /// Whether short series resolve g between few kinks.
    pub(super) by_series: bool,
}

impl Default for ShapeFacts {
    fn default() -> ShapeFacts {
        ShapeFacts {
            limit: None,
            known_to: None,
            ceiling: f64::INFINITY,
            power: 2.0,
            curvature_radius: None,
            kernel_falls: false,
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

/// The functions of one family. Radii in m, levels in m; the caller adds what a span crosses at a vertical edge.
pub(super) trait Shape {
    /// g(x).
    fn level(&self, radius: f64) -> f64;

    /// g'(x).
    fn slope(&self, radius: f64) -> f64;

    /// dg/dt (pure number) at several t = sqrt(x^2 - b^2) side by side, m, above `base` = b, m: a kink of the family or
    /// of a sum that it is part of, or zero.
    fn slopes<const N: usize>(&self, base: f64, t: [f64; N]) -> [f64; N] {
        t.map(|t| {
            let x = if base > 0.0 { (base * base + t * t).sqrt() } else { t };
            self.slope(x) * (t / x)
        })
    }

    /// X(y).
    fn radius(&self, level: f64) -> f64;

    /// X(y)^2, as exact as can be.
    fn square(&self, level: DoubleDouble) -> DoubleDouble {
        DoubleDouble::square_of(self.radius(level.value()))
    }

    /// int_0^x t g'(t) dt = F_N/(2 E*), m^2.
    fn load(&self, radius: f64) -> f64;

    /// The level at which [`Shape::load`] has this value.
    fn indentation_for(&self, load: f64) -> f64;

    /// g(x_outer) - g(x_inner), to round-off of itself.
    fn rise(&self, span: &Span) -> f64;

    /// Difference of the squares of the radii of a ring of this depth. [`Shape::rise`] undone, by Newton's steps.
    fn gap(&self, ring: &Ring, depth: f64) -> f64 {
        gap(self, ring, depth)
    }

    /// What holds for all of it.
    fn facts(&self) -> ShapeFacts {
        ShapeFacts::default()
    }

    /// Radius and level at which the profile ends in a vertical edge.
    fn rim(&self) -> Option<(f64, f64)> {
        None
    }

    /// The radius of [`Shape::rim`].
    fn rim_radius(&self) -> Option<f64> {
        self.rim().map(|(radius, _)| radius)
    }

    /// The largest kink below `radius`; zero, the tip, if there is none.
    fn kink_below(&self, _radius: f64) -> f64 {
        0.0
    }

    /// The span of a ring.
    fn span(&self, ring: &Ring) -> Span {
        span(ring, self.rim().map(|(_, top)| top), |depth| self.gap(ring, depth))
    }

    /// The moments of h = g(x_outer) - g(x).
    fn moments(&self, span: &Span) -> Moments {
        moments(self, span)
    }

    /// The moments of a ring, with the levels that it crosses at a vertical edge.
    fn ring_moments(&self, ring: &Ring) -> Moments {
        let span = self.span(ring);
        Moments::stack(self.moments(&span), Moments::default(), span.edge)
    }

    /// The nodes of a quadrature over the radii of a ring for waves up to cos(`turns` th), by a family that has no g;
    /// `None` where they follow from the intervals between kinks.
    fn ring_nodes(&self, _ring: &Ring, _turns: usize) -> Option<RingNodes> {
        None
    }

    /// The rise from a node of an interval up to the outer end of its span.
    fn rise_to(&self, outer: &Span, interval: &SmoothInterval, node: Node) -> f64 {
        self.rise(&under(outer, interval, node))
    }

    /// The rises up to the outer end of a span from radii that lie below it by these distances, which increase.
    fn rises(&self, span: &Span, below: &[f64]) -> Vec<f64> {
        let gap = |&below: &f64| below * (2.0 * span.outer_radius - below);
        below.iter().map(|below| self.rise(&Span::under(span.outer, span.outer_radius, gap(below)))).collect()
    }

    /// int h dx / sqrt(r^2 - x^2) below r, with h = g(x_outer) - g(x).
    fn displacement_integral(&self, at: &StressRadius, span: &Span) -> f64 {
        let (mut sum, mut above) = (0.0, 0.0);
        let mut rest = Some(*span);
        while let Some(span) = rest.filter(|span| span.gap > 0.0) {
            let (interval, outer, inner) = outermost_interval(self, &span);
            sum += interval.displacement_integral(&outer, at, above, |node| self.rise(&under(&outer, &interval, node)));
            above += self.rise(&outer);
            rest = inner;
        }
        sum
    }

    /// int g'(x) dx / sqrt(x^2 - r^2) over the radii of the span above r.
    fn kernel(&self, at: &StressRadius, span: &Span) -> f64;

    /// Its derivative with respect to r^2, from the right.
    fn kernel_slope(&self, at: &StressRadius, span: &Span) -> f64;

    /// The coefficients of g'(a xi) = sum of c_k xi^k, `a` being a radius, m, none of them negative; `None` where that
    /// is no series of at most [`MOST_POWERS`](super::slope_series::MOST_POWERS).
    fn slope_series(&self, _a: f64) -> Option<Vec<f64>> {
        None
    }

    /// The weighted sums of [`Profile::kernel`](super::Profile::kernel_sums), by a family that has a faster way than
    /// ring by ring.
    fn kernel_sums(&self, _rings: &[(Ring, f64)], _radii: &[StressRadius]) -> Option<Vec<f64>> {
        None
    }

    /// See [`Profile::displacements`](super::Profile); `None` of a family that has no faster way than ring by ring.
    fn displacements(&self, _rings: &[(Ring, f64)], _ends: (f64, f64), _radii: &[StressRadius]) -> Option<Vec<f64>> {
        None
    }

    /// f'(r), the slope of the undeformed surface.
    fn surface_slope(&self, r: f64) -> f64;

    /// How many times larger than g the parts are that it is the sum of.
    fn cancellation(&self, _x: f64) -> f64 {
        1.0
    }

    /// See [`Profile::least_fall`](super::Profile).
    fn least_fall(&self, _inner: f64, outer: f64) -> f64 {
        if self.facts().kernel_falls { self.slope(outer) / outer } else { f64::NEG_INFINITY }
    }

    /// See [`Profile::rises_concavely`](super::Profile).
    fn rises_concavely(&self, _inner: f64) -> bool {
        false
    }

    /// Radii at which f' jumps by a finite amount, so that stresses are log-infinite, increasing.
    fn singular_radii(&self) -> Vec<f64> {
        Vec::new()
    }

    /// The interpolation error in a contact of this radius.
    fn interpolation_error(&self, _radius: f64) -> InterpolationError {
        InterpolationError::default()
    }

    /// Noise of g, and how many times that of the heights it is.
    fn noise(&self, _radius: f64) -> Option<(f64, f64)> {
        None
    }
}

/// The outermost interval of a span without a kink, as such and as a span, and what is left inside it.
pub(super) fn outermost_interval<S: Shape + ?Sized>(shape: &S, span: &Span) -> (SmoothInterval, Span, Option<Span>) {
    let ShapeFacts { ceiling, power, analytic_tip, .. } = shape.facts();
    let base = shape.kink_below(span.outer_radius);
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

/// The span of a ring of a profile that rises vertically from the level `top` on, if it does, by what [`Shape::gap`]
/// gives.
pub(super) fn span(ring: &Ring, top: Option<f64>, gap: impl Fn(f64) -> f64) -> Span {
    let (mut depth, mut edge) = (ring.depth, 0.0);
    if let Some(top) = top.map(DoubleDouble::from) {
        if ring.inner.level >= top {
            (depth, edge) = (0.0, depth);
        } else if ring.outer.level > top {
            edge = (ring.outer.level - top).value();
            depth = (top - ring.inner.level).value();
        }
    }
    Span::of(ring, if depth > 0.0 { gap(depth) } else { 0.0 }, edge)
}

/// [`Shape::gap`] by Newton's steps.
pub(super) fn gap<S: Shape + ?Sized>(shape: &S, ring: &Ring, depth: f64) -> f64 {
    let outer = ring.outer;
    let plain = (outer.square - ring.inner.square).value();
    if plain > 0.3 * outer.square.value() || ring.inner.level <= DoubleDouble::ZERO {
        return plain;
    }
    // No ring reaches into a flat core, where g is constant.
    let square = (outer.square - DoubleDouble::square_of(shape.radius(0.0))).value();
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
pub(super) fn moments<S: Shape + ?Sized>(shape: &S, span: &Span) -> Moments {
    let (mut sum, mut above) = (Moments::default(), 0.0);
    let mut rest = Some(*span);
    while let Some(span) = rest.filter(|span| span.gap > 0.0) {
        let (interval, outer, inner) = outermost_interval(shape, &span);
        let part = interval.moments(|node| shape.rise_to(&outer, &interval, node));
        sum = Moments::stack(part, sum, above);
        above += shape.rise(&outer);
        rest = inner;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::super::{PowerLaw, Profile, RoundedPunch, Sphere, Sum, TruncatedCone, TruncatedSphere};

    #[test]
    fn what_is_said_to_rise_concavely_does() {
        let power = |exponent| Profile::PowerLaw(PowerLaw::new(exponent, 0.2).unwrap());
        let punch = || Profile::RoundedPunch(RoundedPunch::new(0.2, 1.0).unwrap());
        let sum = |parts: Vec<Profile>| Profile::Sum(Sum::new(parts).unwrap());
        let sphere = || Profile::Sphere(Sphere::new(1.0).unwrap());
        let mut profiles: Vec<Profile> = [1.3, 1.9, 2.0, 2.1, 2.7, 3.0, 3.9, 4.0, 4.1, 6.0].map(power).into();
        profiles.extend([sphere(), punch(), sum(vec![punch(), power(3.0), sphere()]), sum(vec![punch(), power(6.0)])]);
        profiles.push(Profile::TruncatedCone(TruncatedCone::new(0.1, 0.1).unwrap()));
        profiles.push(Profile::TruncatedSphere(TruncatedSphere::new(1.0, 0.1).unwrap()));
        let mut claims = 0;
        for profile in profiles {
            for inner in [0.0, 0.1, 0.2, 0.3] {
                if !profile.rises_concavely(inner) {
                    continue;
                }
                claims += 1;
                let ratio = |index: u32| {
                    let x = (inner * inner + 1e-3 * f64::from(index)).sqrt();
                    profile.slope(x) / x
                };
                for index in 1..1000 {
                    let [low, middle, high] = [index, index + 1, index + 2].map(ratio);
                    let noise = 1e-13 * high;
                    assert!(middle - low >= -noise, "{profile:?} falls beyond {inner} at {index}");
                    assert!(
                        high - middle <= middle - low + noise,
                        "{profile:?} bends upward beyond {inner} at {index}"
                    );
                }
            }
        }
        // The six powers from two to four and the sphere; the punch and its sum with a cubic and a sphere from their
        // flat on.
        assert_eq!(claims, 7 * 4 + 2 * 2);
    }
}
