//! The kernels of families with a kink, over the path of [`smooth_coordinate`](super::smooth_coordinate).
//!
//! A short path, that of most rings of a slip history, takes one panel of Gauss's rule, as [`along_strip`] would give
//! it, with all of its points side by side.

use super::shape::KernelOrder;
use super::smooth_coordinate::{SmoothCoordinate, ends};
use super::{DoubleDouble, Span, SpanEnds, StressRadius};
use crate::numerics::gauss::{EIGHT_POINTS, TWELVE_POINTS, along_strip};
use crate::numerics::logarithm::exp_m1;

/// The lengths up to which the rules of eight and of twelve points serve.
const SHORT: (f64, f64) = (0.6, 1.4);

/// The path of integration of a kernel: from its outer end inward.
struct Path {
    kappa: f64,
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
    fn new(family: &impl SmoothCoordinate, at: &StressRadius, span: &Span) -> Option<Path> {
        let square = DoubleDouble::square_of(family.kink_radius());
        let span = span.above(square, family.kink_radius())?;
        let (inner, outer) = span.excess(at.square);
        if outer <= 0.0 {
            return None;
        }
        let SpanEnds { mut low, high, .. } = ends(family, &span);
        let kappa = (at.square - square).value();
        let (mut v_low, v_high) = (inner.max(0.0).sqrt(), outer.sqrt());
        let mut gap = span.gap;
        if inner <= 0.0 {
            (low, v_low, gap) = (kappa.max(0.0).sqrt(), 0.0, outer);
        }
        let steps = gap / (v_low + v_high) + gap / (low + high);
        // At r = b in a profile that is smooth there, what lies this near to b adds nothing.
        let start = if low + v_low > 0.0 { low + v_low } else { 1e-17 * (high + v_high) };
        Some(Path { kappa, low, high, v_low, v_high, start, length: (steps / start).ln_1p() })
    }

    /// K by one panel over a short path, the family's gamma side by side.
    fn short(&self, family: &impl SmoothCoordinate) -> Option<f64> {
        if self.length <= SHORT.0 {
            self.by_rule(family, &EIGHT_POINTS)
        } else if self.length <= SHORT.1 {
            self.by_rule(family, &TWELVE_POINTS)
        } else {
            None
        }
    }

    fn by_rule<const N: usize>(&self, family: &impl SmoothCoordinate, rule: &[(f64, f64); N]) -> Option<f64> {
        let growth = exp_m1(rule.map(|(u, _)| self.length * u));
        // The points of a rule are the same from either end.
        let t: [_; N] = std::array::from_fn(|index| self.place(growth[index], growth[N - 1 - index]).0);
        let slopes = family.slopes_at(t)?;
        Some(self.length * slopes.iter().zip(rule).map(|(slope, (_, weight))| slope * weight).sum::<f64>())
    }

    /// int f(t, v, t_outer - t) ds for an f that changes as a power of t does; `ceiling` is the t where it is singular.
    fn integrate(&self, power: f64, ceiling: f64, f: impl Fn(f64, f64, f64) -> f64) -> f64 {
        let end = self.high + self.v_high;
        let room = if ceiling < f64::INFINITY {
            ((ceiling + (ceiling * ceiling - self.kappa).sqrt()) / end).ln()
        } else {
            ceiling
        };
        along_strip(self.length, power.max(1.0).recip(), room, |s| {
            let (t, drop) = self.place(s.exp_m1(), (self.length - s).exp_m1());
            let here = end * (-s).exp();
            f(t, (0.5 * (here - self.kappa / here)).max(self.v_low), drop)
        })
    }

    /// t, and how far that is below the outer end, where t + v is 1/(1 + `shrunk`) of its value at the outer end and 1
    /// + `grown` times that at the inner one.
    fn place(&self, shrunk: f64, grown: f64) -> (f64, f64) {
        let end = self.high + self.v_high;
        let here = end / (1.0 + shrunk);
        let other = self.kappa / here;
        let drop = 0.5 * shrunk / (1.0 + shrunk) * (end - other);
        // Far below the outer end the difference has lost its digits, and what t has gained on the inner one has not.
        let t = if drop < 0.5 * self.high { self.high - drop } else { self.low + 0.5 * grown * (self.start - other) };
        (t.max(self.low), drop)
    }
}

/// K over a span, or its slope.
pub(super) fn kernel(family: &impl SmoothCoordinate, order: KernelOrder, at: &StressRadius, span: &Span) -> f64 {
    let Some(path) = Path::new(family, at, span) else { return 0.0 };
    if order == KernelOrder::Slope {
        return kernel_slope(family, &path);
    }
    if path.low + path.v_low <= 0.0 && family.jumps() {
        return f64::INFINITY;
    }
    if let Some(kernel) = path.short(family) {
        return kernel;
    }
    path.integrate(family.power(), family.ceiling(), |t, _, drop| family.slope_below(t, path.high, drop))
}

/// dK/d(r^2) over a path: (1/2) int gamma dt/v^3, by parts where v starts from zero or nearly so.
fn kernel_slope(family: &impl SmoothCoordinate, path: &Path) -> f64 {
    let (low, high, v_low, v_high) = (path.low, path.high, path.v_low, path.v_high);
    if v_low > 0.0 && (path.kappa <= 0.0 || v_high < 2.0 * v_low) {
        let integrand = |t, v, drop| family.slope_below(t, high, drop) / (v * v);
        return 0.5 * path.integrate(family.power(), family.ceiling(), integrand);
    }
    if low <= 0.0 && family.jumps() {
        return f64::NEG_INFINITY;
    }
    let bend =
        path.integrate(family.power(), family.ceiling(), |t, _, drop| family.bend_below(t, high, drop) / (t * t));
    let start = if v_low > 0.0 { family.slope_at(low) / (low * v_low) } else { 0.0 };
    0.5 * (bend + start - family.slope_at(high) / (high * v_high))
}
