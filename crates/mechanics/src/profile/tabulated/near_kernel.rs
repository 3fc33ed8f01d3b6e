//! The kernel of a panel, or of a part of one, in closed form, for radii below or within it.
//!
//! With kappa = r^2 - k^2 and v = sqrt(x^2 - r^2) = sqrt(t^2 - kappa), t dt = v dv turns K = int t q dt/v into int q
//! dv. For q = sum of c_n t^n that is the sum of c_n J_n, J_n = int t^n dv, and by parts
//!
//! J_0 = v, J_1 = (t v + kappa ln(t + v))/2, (n + 1) J_n = t^n v + n kappa J_(n-2), all between the two ends.
//!
//! For r within the panel no term is negative: the sum is as good as that of the c_n. Below it kappa may be negative,
//! and an error grows by less than |kappa|/high^2 in a step from n - 2 to n: up to twice the width of the panel,
//! [`LEAST_KAPPA`], by no more than 2^(n/2), while c_n falls like 2.2^-n at least. The c_n are those of the Chebyshev
//! series of the panel ([`panel_powers`](super::panel_powers)), so that rounding leaves some 1e-14 of the share of one
//! panel at the worst. Other panels, and thin parts of one, are integrated
//! numerically ([`smooth_coordinate`](super::smooth_coordinate)).

use super::panel::KernelPanel;
use super::panel_powers::SHARES;
use super::{DoubleDouble, Span, StressRadius};

/// The least kappa over the square of the upper end.
const LEAST_KAPPA: f64 = -2.0;

/// The least part of a panel above r, in the square of the radius, whose integrals are differences without loss.
const LEAST_PART: f64 = 0.1;

/// K of what lies beyond r in a part of a panel, by the powers of its q; `None` if they do not serve.
pub(super) fn kernel(panel: &KernelPanel, at: &StressRadius, span: &Span) -> Option<f64> {
    let powers = panel.powers();
    if powers.is_empty() {
        return None;
    }
    let (below, above) = span.excess(at.square);
    if above <= 0.0 {
        return Some(0.0);
    }
    let inverse = panel.high.recip();
    let share = inverse * inverse;
    let kappa = (at.square - DoubleDouble::square_of(panel.base)).value() * share;
    let low = panel.low * inverse;
    if kappa < LEAST_KAPPA || (below > 0.0 && span.gap * share < LEAST_PART * (1.0 - low * low)) {
        return None;
    }
    let (v_high, high) = (above.sqrt() * inverse, panel.t_of(span.outer) * inverse);
    let (low, v_low, gap) = if below > 0.0 {
        (panel.t_of(span.inner) * inverse, below.sqrt() * inverse, span.gap * share)
    } else {
        (kappa.max(0.0).sqrt(), 0.0, above * share)
    };
    let rise = gap / (v_high + v_low);
    let start = low + v_low;
    let logarithm = if start > 0.0 { ((rise + gap / (high + low)) / start).ln_1p() } else { 0.0 };
    let mut last = [rise, 0.5 * (high * v_high - low * v_low + kappa * logarithm)];
    let mut sum = powers[0] * last[0] + powers.get(1).map_or(0.0, |c| c * last[1]);
    let (mut upper, mut lower) = (high * high * v_high, low * low * v_low);
    let mut order = 2.0;
    for (&c, share) in powers.iter().zip(SHARES).skip(2) {
        let next = (upper - lower + order * kappa * last[0]) * share;
        last = [last[1], next];
        sum += c * next;
        upper *= high;
        lower *= low;
        order += 1.0;
    }
    Some(panel.high * sum)
}
