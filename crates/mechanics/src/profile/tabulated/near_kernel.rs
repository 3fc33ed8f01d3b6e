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
//! series of the panel, at most [`CONDITION`] times q in the sum of what they are added up from, so that rounding
//! leaves some 1e-14 of the share of one panel at the worst. Other panels, and thin parts of one, are integrated
//! numerically ([`smooth_coordinate`](super::smooth_coordinate)).

use std::sync::LazyLock;

use super::panel::{KernelPanel, POINTS};
use super::{DoubleDouble, Span, StressRadius};

/// The sum of the magnitudes of the terms of a series in powers, over the size of the series.
const CONDITION: f64 = 3.0;

/// What may be dropped of q, over its size: the rounding of the twenty-four values that fix its series.
const DROPPED: f64 = 4e-15;

/// The least kappa over the square of the upper end.
const LEAST_KAPPA: f64 = -2.0;

/// The least part of a panel above r, in the square of the radius, whose integrals are differences without loss.
const LEAST_PART: f64 = 0.1;

/// 1/(n + 1).
const SHARES: [f64; POINTS + 1] = {
    let mut shares = [0.0; POINTS + 1];
    let mut order = 0;
    while order <= POINTS {
        shares[order] = 1.0 / (order as f64 + 1.0);
        order += 1;
    }
    shares
};

/// The coefficients in powers of t/high of a Chebyshev series over low..high; none if they are too large to be added
/// up. The last terms of the series, which rounding alone has left, are dropped first.
pub(super) fn powers(series: &[f64], low: f64, high: f64) -> Box<[f64]> {
    let (scale, offset) = (2.0 * high / (high - low), -(high + low) / (high - low));
    let furthest = scale - offset;
    // |T_k| of the furthest place of the sum of magnitudes: cosh(k arcosh x) <= (x + sqrt(x^2 - 1))^k.
    let growth = furthest + (furthest * furthest - 1.0).sqrt();
    let size = series.iter().fold(0.0_f64, |size, a| size.max(a.abs()));
    let (mut sum, mut factor, mut terms) = (0.0, 1.0, 0);
    for a in series {
        sum += a.abs() * factor;
        // Also where one of them is no number.
        let small = sum <= 2.0 * CONDITION * size;
        if !small {
            break;
        }
        factor *= growth;
        terms += 1;
    }
    let (series, dropped) = series.split_at(terms);
    if series.is_empty() || dropped.iter().map(|a| a.abs()).sum::<f64>() > DROPPED * size {
        return Box::default();
    }
    let own = (low > 0.0).then(|| polynomials(scale, offset));
    let mut sum = [0.0; POINTS];
    for (order, (a, row)) in series.iter().zip(own.as_ref().unwrap_or(&FROM_KNOT)).enumerate() {
        for (sum, c) in sum[..=order].iter_mut().zip(&row[..=order]) {
            *sum += a * c;
        }
    }
    sum[..series.len()].into()
}

/// The coefficients of the Chebyshev polynomials of scale x + offset in powers of x, a row for each order.
fn polynomials(scale: f64, offset: f64) -> [[f64; POINTS]; POINTS] {
    let mut rows = [[0.0; POINTS]; POINTS];
    (rows[0][0], rows[1][0], rows[1][1]) = (1.0, offset, scale);
    for order in 2..POINTS {
        for power in 0..=order {
            let below = if power > 0 { rows[order - 1][power - 1] } else { 0.0 };
            rows[order][power] = 2.0 * (scale * below + offset * rows[order - 1][power]) - rows[order - 2][power];
        }
    }
    rows
}

/// Those of a panel that begins at its knot.
static FROM_KNOT: LazyLock<[[f64; POINTS]; POINTS]> = LazyLock::new(|| polynomials(2.0, -1.0));

/// The rise of g, m, from where a panel begins up to t, `s` further in the square of the radius, by the powers of its
/// q: s times a mean of q/2. With l the t where it begins, int t^(n+1) dt is s E_n/(n + 2), E_n = t^2 E_(n-2) + l^n,
/// and no term is a difference.
pub(super) fn rise(panel: &KernelPanel, t: f64, s: f64) -> f64 {
    let (t, low) = (t / panel.high, panel.low / panel.high);
    let square = t * t;
    let (mut before, mut this) = (1.0, if t > 0.0 { (square + t * low + low * low) / (t + low) } else { 0.0 });
    let (mut sum, mut lower) = (0.0, low * low);
    for (c, share) in panel.powers().iter().zip(&SHARES[1..]) {
        sum += c * before * share;
        (before, this) = (this, square * before + lower);
        lower *= low;
    }
    s * sum
}

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
