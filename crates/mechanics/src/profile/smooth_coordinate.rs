//! Integrals of families with a kink at b, in the coordinate t = sqrt(x^2 - b^2) where they are smooth.
//!
//! A truncated cone or sphere, a rounded punch, the flank of a rounded cone: each is analytic in t but at t = +-ib, and
//! its gamma(t) = dg/dt does not fall. With kappa = r^2 - b^2 and v = sqrt(x^2 - r^2), so t^2 - v^2 = kappa,
//! K = int gamma dt/v = int gamma ds, where t + v = const e^s: t = tau cosh s for r > b, t = delta sinh s for r < b. In
//! s the integrand is analytic for |Im s| < pi/2 and both root singularities are gone (the substitutions are
//! elementary; for the profiles see Popov & Hess 2015, chapter 3).

use super::smooth_interval::SmoothInterval;
pub(super) use super::smooth_path::kernel;
use super::{DoubleDouble, Moments, Ring, Span, SpanEnds, StressRadius};
use crate::numerics::gauss::{EIGHT_POINTS, QuadraturePanel, Singular, TWELVE_POINTS, TWENTY_POINTS};
use crate::numerics::roots::{descend, distance_below, increasing};

/// A difference of two t^2 above this, over the larger one, is good to five digits.
const NEARLY: f64 = 1e-10;

/// A profile for x >= b, given as a function of the coordinate t = sqrt(x^2 - b^2) in which it is smooth.
pub(super) trait SmoothCoordinate {
    /// b, m.
    fn kink_radius(&self) -> f64;

    /// The distance in t, along the imaginary axis, at which g is singular, m.
    fn singularity(&self) -> f64 {
        self.kink_radius()
    }

    /// g, m.
    fn level_at(&self, t: f64) -> f64;

    /// gamma = dg/dt (pure number), positive and not falling.
    fn slope_at(&self, t: f64) -> f64;

    /// gamma at several t side by side, if it is singular nowhere above the kink and changes no faster than t.
    fn slopes_at<const N: usize>(&self, _t: [f64; N]) -> Option<[f64; N]> {
        None
    }

    /// t gamma' - gamma (pure number): t^2 times the slope of gamma/t.
    fn bend_at(&self, t: f64) -> f64;

    /// g(top) - g(t), m, to round-off of itself; `dt` = top - t. A family has this of its own, or the next.
    fn rise_at(&self, t: f64, top: f64, dt: f64) -> f64 {
        let dx = dt * (t + top) / (self.radius_at(t) + self.radius_at(top));
        let [rise] = self.rises_at(&Nodes { t: [t], dt: [dt], dx: [dx] }, top);
        rise
    }

    /// The same at several t side by side.
    fn rises_at<const N: usize>(&self, nodes: &Nodes<N>, top: f64) -> [f64; N] {
        std::array::from_fn(|index| self.rise_at(nodes.t[index], top, nodes.dt[index]))
    }

    /// A t at which g less g(b) is not below `level`.
    fn upper_bound(&self, level: f64) -> f64;

    /// The t of a level.
    fn solve(&self, level: f64) -> f64 {
        solve(self, level)
    }

    /// t^2 of a level, m^2, as exact as can be.
    fn square_above(&self, level: DoubleDouble) -> DoubleDouble {
        DoubleDouble::square_of(self.solve(level.value()))
    }

    /// Whether the difference of two t^2 is that of their levels to round-off.
    fn gap_by_squares(&self, low: f64, high: f64) -> bool {
        low < 0.8 * high
    }

    /// The moments over a span above the kink, where they are closed.
    fn moments_over(&self, _span: &Span, _ends: &SpanEnds) -> Option<Moments> {
        None
    }

    /// x, m.
    fn radius_at(&self, t: f64) -> f64 {
        (self.kink_radius() * self.kink_radius() + t * t).sqrt()
    }

    /// gamma(t) again, at `drop` below the outer end: for a steep gamma the difference says more than t.
    fn slope_below(&self, t: f64, _outer: f64, _drop: f64) -> f64 {
        self.slope_at(t)
    }

    /// t gamma' - gamma again, likewise.
    fn bend_below(&self, t: f64, _outer: f64, _drop: f64) -> f64 {
        self.bend_at(t)
    }

    /// gamma changes no faster than t to this power.
    fn power(&self) -> f64 {
        1.0
    }

    /// The t at which gamma is singular, never reached.
    fn ceiling(&self) -> f64 {
        f64::INFINITY
    }

    /// Whether gamma > 0 at t = 0, so that f' jumps at b and stresses are infinite there.
    fn jumps(&self) -> bool {
        self.slope_at(0.0) > 0.0
    }
}

/// Several places of one span.
pub(super) struct Nodes<const N: usize> {
    /// t, m.
    pub(super) t: [f64; N],
    /// How far below the outer end they are, m.
    pub(super) dt: [f64; N],
    /// The same of their radii, m.
    pub(super) dx: [f64; N],
}

impl<const N: usize> Nodes<N> {
    /// The tangents of the angles that atan(t/b) is below that of the outer end `top`.
    pub(super) fn tangents(&self, b: f64, top: f64) -> [f64; N] {
        std::array::from_fn(|index| b * self.dt[index] / (b * b + self.t[index] * top))
    }

    /// The rises of a g = x s up to an outer end, where x and s have these values, by those of s.
    pub(super) fn rises(&self, (x, s): (f64, f64), steps: &[f64; N]) -> [f64; N] {
        // What the difference of the two s loses near the rim counts only beside the first term.
        std::array::from_fn(|index| x * steps[index] + (s - steps[index]) * self.dx[index])
    }
}

/// The t of a level, from above.
pub(super) fn solve<F: SmoothCoordinate + ?Sized>(family: &F, level: f64) -> f64 {
    descend(family.upper_bound(level), |t| (family.level_at(t) - level, family.slope_at(t)))
}

/// The root of an increasing function from a `guess` that is good to some thousandths: `f` gives value, slope and
/// second derivative.
///
/// Halley's steps cube the error, so that what is left after one of 3e-6 is below round-off. `None` if four do not get
/// there.
pub(super) fn near_root(guess: f64, f: impl Fn(f64) -> [f64; 3]) -> Option<f64> {
    let mut x = guess;
    for _ in 0..4 {
        let [value, slope, bend] = f(x);
        let newton = value / slope;
        let step = newton / (1.0 - 0.5 * newton * bend / slope);
        x -= step;
        if step.abs() <= 3e-6 * x {
            return Some(x);
        }
    }
    None
}

/// t at a radius.
pub(super) fn t_of(family: &impl SmoothCoordinate, radius: f64) -> f64 {
    ((radius - family.kink_radius()) * (radius + family.kink_radius())).max(0.0).sqrt()
}

/// g'(x).
pub(super) fn slope(family: &impl SmoothCoordinate, radius: f64) -> f64 {
    let t = t_of(family, radius);
    if t > 0.0 {
        family.slope_at(t) * radius / t
    } else if radius < family.kink_radius() {
        0.0
    } else if family.jumps() {
        f64::INFINITY
    } else {
        // gamma is of the first order in t where a parabola turns into a slope, of the second where a flat turns into a
        // parabola.
        let t = 1e-9 * radius;
        family.slope_at(t) * radius / t
    }
}

/// dg/dt at several t above a kink, that of the family or another one, and zero of what lies below its own.
pub(super) fn slopes<const N: usize>(family: &impl SmoothCoordinate, base: f64, t: [f64; N]) -> [f64; N] {
    let own = |t: [f64; N]| family.slopes_at(t).unwrap_or_else(|| t.map(|t| family.slope_at(t)));
    let b = family.kink_radius();
    let further = (base - b) * (base + b);
    if further < 0.0 {
        return [0.0; N];
    }
    if further <= 0.0 {
        return own(t);
    }
    let above = t.map(|t| (t * t + further).sqrt());
    let slopes = own(above);
    std::array::from_fn(|index| slopes[index] * (t[index] / above[index]))
}

/// Both ends in t of what a span has above the kink.
pub(super) fn ends(family: &impl SmoothCoordinate, span: &Span) -> SpanEnds {
    let kink = family.kink_radius();
    if let Some((_, ends)) = span.above.filter(|(base, _)| base.to_bits() == kink.to_bits()) {
        return ends;
    }
    let (below, above) = span.excess(DoubleDouble::square_of(kink));
    if above <= 0.0 {
        return SpanEnds { low: 0.0, high: 0.0, drop: 0.0 };
    }
    let (low, high, gap) =
        if below < 0.0 { (0.0, above.sqrt(), above) } else { (below.sqrt(), above.sqrt(), span.gap) };
    SpanEnds { low, high, drop: gap / (low + high) }
}

/// g over a span, to round-off of itself.
pub(super) fn rise(family: &impl SmoothCoordinate, span: &Span) -> f64 {
    let SpanEnds { low, high, drop } = ends(family, span);
    if high > 0.0 { family.rise_at(low, high, drop) } else { 0.0 }
}

/// Difference of the squares over a ring of this depth.
pub(super) fn gap(family: &impl SmoothCoordinate, ring: &Ring, depth: f64) -> f64 {
    let square = DoubleDouble::square_of(family.kink_radius());
    let low = (ring.inner.square - square).value().max(0.0);
    let high = (ring.outer.square - square).value().max(0.0);
    if family.gap_by_squares(low, high) {
        return (ring.outer.square - if low > 0.0 { ring.inner.square } else { square }).value();
    }
    let top = high.sqrt();
    let start = if high - low > NEARLY * high {
        // One step of Newton's does from here.
        (high - low) / (top + low.sqrt())
    } else {
        let steep = family.slope_at(top);
        // Where g is flat by rounding, its levels do not tell radii apart.
        if steep <= 0.0 {
            return high - low;
        }
        (depth / steep).min(0.5 * top)
    };
    let mut flat = false;
    let dt = distance_below(start, top, depth, |dt| {
        let steep = family.slope_at(top - dt);
        flat |= steep <= 0.0;
        (family.rise_at(top - dt, top, dt), steep)
    });
    if flat { high - low } else { dt * (top + top - dt) }
}

/// The moments over a span above the core.
pub(super) fn moments(family: &impl SmoothCoordinate, span: &Span) -> Moments {
    if span.gap <= 0.0 {
        return Moments::default();
    }
    let ends = ends(family, span);
    if let Some(moments) = family.moments_over(span, &ends) {
        return moments;
    }
    let SpanEnds { high, drop, .. } = ends;
    let singular = Singular { below: family.singularity(), above: f64::INFINITY };
    let mut sum = [0.0; 2];
    let mut done = 0.0;
    while done < drop {
        let (top, left) = (high - done, drop - done);
        // So low that any rule will do; `done` would soon stop growing.
        let panel = if top <= 1e-14 * high { QuadraturePanel::coarse(left) } else { singular.panel(top, left) };
        let stretch = (high, done, panel.width);
        match panel.points() {
            8 => add_panel(family, stretch, &EIGHT_POINTS, &mut sum),
            12 => add_panel(family, stretch, &TWELVE_POINTS, &mut sum),
            _ => add_panel(family, stretch, &TWENTY_POINTS, &mut sum),
        }
        if top <= 1e-14 * high {
            break;
        }
        done += panel.width;
    }
    let [first, second] = sum;
    Moments { width: span.width(), first, second }
}

/// Adds int h dx and int h^2 dx over a panel of t, which begins `done` below the outer end `high` and is `width` wide.
fn add_panel<const N: usize>(
    family: &impl SmoothCoordinate,
    (high, done, width): (f64, f64, f64),
    rule: &[(f64, f64); N],
    [first, second]: &mut [f64; 2],
) {
    let (square, x_high) = (family.kink_radius() * family.kink_radius(), family.radius_at(high));
    let dt = rule.map(|(u, _)| done + width * u);
    let t = dt.map(|dt| (high - dt).max(0.0));
    // One division for both t/x and the difference of the radii.
    let (mut stretch, mut dx) = ([0.0; N], [0.0; N]);
    for index in 0..N {
        let x = (square + t[index] * t[index]).sqrt();
        let inverse = (x * (x + x_high)).recip();
        stretch[index] = t[index] * (x + x_high) * inverse;
        dx[index] = dt[index] * (t[index] + high) * x * inverse;
    }
    let h = family.rises_at(&Nodes { t, dt, dx }, high);
    for (index, (_, weight)) in rule.iter().enumerate() {
        let area = width * weight * h[index] * stretch[index];
        *first += area;
        *second += area * h[index];
    }
}

/// The displacement integral of a span above the core.
pub(super) fn displacement_integral(family: &impl SmoothCoordinate, at: &StressRadius, span: &Span) -> f64 {
    let interval = SmoothInterval::new(span, family.kink_radius(), family.singularity(), f64::INFINITY, 2.0);
    interval.displacement_integral(span, at, 0.0, |node| family.rise_at(node.t, interval.high, node.dt))
}

/// Implements `Shape` for a family with a flat core through its [`SmoothCoordinate`]: all but its loads and the given
/// methods.
macro_rules! flat_core {
    ($family:ty { $($methods:item)* }) => {
        impl $crate::profile::shape::Shape for $family {
            fn level(&self, radius: f64) -> f64 {
                self.level_at(smooth_coordinate::t_of(self, radius))
            }
            fn slope(&self, radius: f64) -> f64 {
                smooth_coordinate::slope(self, radius)
            }
            fn slopes<const N: usize>(&self, base: f64, t: [f64; N]) -> [f64; N] {
                smooth_coordinate::slopes(self, base, t)
            }
            fn square(&self, level: DoubleDouble) -> DoubleDouble {
                DoubleDouble::square_of(self.kink_radius()) + self.square_above(level)
            }
            fn load(&self, radius: f64) -> f64 {
                self.load_at(smooth_coordinate::t_of(self, radius))
            }
            fn indentation_for(&self, load: f64) -> f64 {
                smooth_coordinate::indentation_for(self, load, |t| self.load_at(t))
            }
            fn rise(&self, span: &Span) -> f64 {
                smooth_coordinate::rise(self, span)
            }
            fn gap(&self, ring: &Ring, depth: f64) -> f64 {
                smooth_coordinate::gap(self, ring, depth)
            }
            fn kink_below(&self, radius: f64) -> f64 {
                if radius > self.kink_radius() { self.kink_radius() } else { 0.0 }
            }
            fn moments(&self, span: &Span, _top: f64) -> Moments {
                smooth_coordinate::moments(self, span)
            }
            fn kernel(&self, order: KernelOrder, at: &StressRadius, span: &Span) -> f64 {
                smooth_coordinate::kernel(self, order, at, span)
            }
            $($methods)*
        }
    };
}
pub(super) use flat_core;

/// The level that carries a load, given the load as a function of t.
pub(super) fn indentation_for(family: &impl SmoothCoordinate, load: f64, load_at: impl Fn(f64) -> f64) -> f64 {
    if load <= 0.0 {
        return 0.0;
    }
    let guess = family.kink_radius();
    let t = increasing(guess, |t| (load_at(t) - load, family.radius_at(t) * family.slope_at(t)));
    family.level_at(t)
}
