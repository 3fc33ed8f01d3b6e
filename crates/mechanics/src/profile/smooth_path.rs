//! The kernels of families without a kink but at the tip, over a path on which both root singularities are gone.
//!
//! With v = sqrt(x^2 - r^2), K = int g' dx/v = int g' ds, where x + v = const e^s, so x = r cosh s: in s the integrand
//! is analytic for |Im s| < pi/2 (the substitution is elementary; for the profiles see Popov & Hess 2015, chapter 3).

use super::shape::KernelOrder;
use super::{Span, StressRadius};
use crate::numerics::gauss::along_strip;

/// A profile that is smooth in x from the tip on.
pub(super) trait SmoothTip {
    /// g'(x).
    fn slope_at(&self, x: f64) -> f64;

    /// x g'' - g' (pure number): x^2 times the slope of g'/x.
    fn bend_at(&self, x: f64) -> f64;

    /// g'(x) again, at `drop` below the outer end: for a steep g' the difference says more than x.
    fn slope_below(&self, x: f64, _outer: f64, _drop: f64) -> f64 {
        self.slope_at(x)
    }

    /// x g'' - g' again, likewise.
    fn bend_below(&self, x: f64, _outer: f64, _drop: f64) -> f64 {
        self.bend_at(x)
    }

    /// g' changes no faster than x to this power.
    fn power(&self) -> f64 {
        1.0
    }

    /// The x at which g' is singular, never reached.
    fn ceiling(&self) -> f64 {
        f64::INFINITY
    }
}

/// The path of integration of a kernel: from its outer end inward.
struct Path {
    square: f64,
    low: f64,
    high: f64,
    v_low: f64,
    v_high: f64,
    /// t + v at the inner end.
    start: f64,
    length: f64,
}

impl Path {
    /// For radii above r in a span; none if there are none.
    fn new(at: &StressRadius, span: &Span) -> Option<Path> {
        let (inner, outer) = span.excess(at.square);
        if outer <= 0.0 {
            return None;
        }
        let (v_high, high) = (outer.sqrt(), span.outer_radius);
        let (low, v_low, gap) =
            if inner > 0.0 { (span.inner_radius, inner.sqrt(), span.gap) } else { (at.radius, 0.0, outer) };
        let steps = gap / (v_low + v_high) + gap / (low + high);
        // At the tip of a profile that is smooth there, what lies this near to it adds nothing.
        let start = if low + v_low > 0.0 { low + v_low } else { 1e-17 * (high + v_high) };
        Some(Path { square: at.square.value(), low, high, v_low, v_high, start, length: (steps / start).ln_1p() })
    }

    /// int f(x, v, x_outer - x) ds for an f that changes as a power of x does; `ceiling` is the x where it is singular.
    fn integrate(&self, power: f64, ceiling: f64, f: impl Fn(f64, f64, f64) -> f64) -> f64 {
        let end = self.high + self.v_high;
        let room = if ceiling < f64::INFINITY {
            ((ceiling + (ceiling * ceiling - self.square).sqrt()) / end).ln()
        } else {
            ceiling
        };
        along_strip(self.length, power.max(1.0).recip(), room, |s| {
            let (x, drop) = self.place(s.exp_m1(), (self.length - s).exp_m1());
            let here = end * (-s).exp();
            f(x, (0.5 * (here - self.square / here)).max(self.v_low), drop)
        })
    }

    /// x, and how far that is below the outer end, where x + v is 1/(1 + `shrunk`) of its value at the outer end and 1
    /// + `grown` times that at the inner one.
    fn place(&self, shrunk: f64, grown: f64) -> (f64, f64) {
        let end = self.high + self.v_high;
        let here = end / (1.0 + shrunk);
        let other = self.square / here;
        let drop = 0.5 * shrunk / (1.0 + shrunk) * (end - other);
        // Far below the outer end the difference has lost its digits, and what x has gained on the inner one has not.
        let x = if drop < 0.5 * self.high { self.high - drop } else { self.low + 0.5 * grown * (self.start - other) };
        (x.max(self.low), drop)
    }
}

/// K over a span, or its slope.
pub(super) fn kernel(family: &impl SmoothTip, order: KernelOrder, at: &StressRadius, span: &Span) -> f64 {
    let Some(path) = Path::new(at, span) else { return 0.0 };
    if order == KernelOrder::Slope {
        return kernel_slope(family, &path);
    }
    path.integrate(family.power(), family.ceiling(), |x, _, drop| family.slope_below(x, path.high, drop))
}

/// dK/d(r^2) over a path: (1/2) int g' dx/v^3, by parts where v starts from zero or nearly so.
fn kernel_slope(family: &impl SmoothTip, path: &Path) -> f64 {
    let (low, high, v_low, v_high) = (path.low, path.high, path.v_low, path.v_high);
    if v_low > 0.0 && (path.square <= 0.0 || v_high < 2.0 * v_low) {
        let integrand = |x, v, drop| family.slope_below(x, high, drop) / (v * v);
        return 0.5 * path.integrate(family.power(), family.ceiling(), integrand);
    }
    let bend =
        path.integrate(family.power(), family.ceiling(), |x, _, drop| family.bend_below(x, high, drop) / (x * x));
    let start = if v_low > 0.0 { family.slope_at(low) / (low * v_low) } else { 0.0 };
    0.5 * (bend + start - family.slope_at(high) / (high * v_high))
}
