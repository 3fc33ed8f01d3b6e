//! A Chebyshev series in powers of t, and the rise of g by them.
//!
//! The sum of what a coefficient is added up from is at most [`CONDITION`] times the series, so that rounding stays
//! that of the series.

use std::sync::LazyLock;

/// The most terms of a series.
const POINTS: usize = 24;

/// The sum of the magnitudes of the terms of a series in powers, over the size of the series.
const CONDITION: f64 = 3.0;

/// What may be dropped of q, over its size: the rounding of the twenty-four values that fix its series.
const DROPPED: f64 = 4e-15;

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

/// The coefficients in powers of t/high of (t/high) q, q being a Chebyshev series over low..high; none if they are too
/// large to be added up. The last terms of the series, which rounding alone has left, are dropped first.
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
    let mut sum = [0.0; POINTS + 1];
    for (order, (a, row)) in series.iter().zip(own.as_ref().unwrap_or(&FROM_KNOT)).enumerate() {
        for (sum, c) in sum[1..].iter_mut().zip(&row[..=order]) {
            *sum += a * c;
        }
    }
    sum[..=series.len()].into()
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

/// The rises of g, m, from the knot where a panel begins up to several t.
pub(super) fn rises_from_knot<const N: usize>(powers: &[f64], high: f64, t: [f64; N]) -> [f64; N] {
    let inverse = high.recip();
    let t = t.map(|t| t * inverse);
    let squares = t.map(|t| t * t);
    // Even and odd powers apart: neither chain of sums waits for the other.
    let (mut even, mut odd) = ([0.0; N], [0.0; N]);
    let (terms, last) = powers[1..].as_chunks::<2>();
    let (shares, _) = SHARES[1..].as_chunks::<2>();
    if let [c] = last {
        even = [c * shares[terms.len()][0]; N];
    }
    for (terms, shares) in terms.iter().zip(shares).rev() {
        let (one, other) = (terms[0] * shares[0], terms[1] * shares[1]);
        for lane in 0..N {
            even[lane] = even[lane] * squares[lane] + one;
            odd[lane] = odd[lane] * squares[lane] + other;
        }
    }
    let square = high * high;
    std::array::from_fn(|lane| square * squares[lane] * (even[lane] + t[lane] * odd[lane]))
}

/// The rise of g, m, from where a panel begins up to t, `s` further in the square of the radius, by the powers of its q
/// on low..high: s times a mean of q/2. With l the t where it begins, int t^(n+1) dt is s E_n/(n + 2), E_n = t^2
/// E_(n-2) + l^n, and no term is a difference.
pub(super) fn rise(powers: &[f64], (low, high): (f64, f64), t: f64, s: f64) -> f64 {
    let (t, low) = (t / high, low / high);
    let square = t * t;
    let (mut before, mut this) = (1.0, if t > 0.0 { (square + t * low + low * low) / (t + low) } else { 0.0 });
    let (mut sum, mut lower) = (0.0, low * low);
    for (c, share) in powers.iter().zip(&SHARES).skip(1) {
        sum += c * before * share;
        (before, this) = (this, square * before + lower);
        lower *= low;
    }
    s * sum
}
