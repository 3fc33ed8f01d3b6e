//! The exact sphere well below its equator: with s = (x/R)^2, g = R s P(s), and P = sum of s^k/(2k + 1) is a short series.
//!
//! No term is negative, and differences are taken by P's divided difference, so that nothing cancels.

use super::gauss::Panel;
use super::roots::descend;
use super::{DoubleDouble, Moments};

/// The s up to which the series are shorter than other ways.
pub(super) const LIMIT: f64 = 0.09;
/// 1/(2k + 1).
const SHARES: [f64; 20] = {
    let mut shares = [1.0; 20];
    let mut k = 1;
    while k < 20 {
        shares[k] = 1.0 / (2 * k + 1) as f64;
        k += 1;
    }
    shares
};
/// The s up to which Gauss's rules of eight and of twelve points integrate all terms of g^2 that count.
const RULES: [f64; 2] = [1e-3, 1e-2];

/// The terms of P that count at an s up to [`LIMIT`].
fn terms(s: f64) -> &'static [f64] {
    // s is below 2^-halvings, and so is the ratio of each term to the one before; one more for the difference, which begins later.
    let halvings = 1022_u64.saturating_sub(s.to_bits() >> 52).max(3);
    let count = usize::try_from(56 / halvings).map_or(SHARES.len(), |count| count + 2);
    &SHARES[..count.min(SHARES.len())]
}

/// P at `outer`, and its divided difference between there and `inner`.
fn sums(outer: f64, inner: f64) -> (f64, f64) {
    let (mut value, mut difference) = (0.0, 0.0);
    for share in terms(outer).iter().rev() {
        difference = difference * inner + value;
        value = value * outer + share;
    }
    (value, difference)
}

/// d(s P)/ds.
fn steepness(s: f64) -> f64 {
    let (value, slope) = sums(s, s);
    value + s * slope
}

/// g/R between s = `outer` and what lies `gap` below it.
pub(super) fn rise(outer: f64, gap: f64) -> f64 {
    let inner = (outer - gap).max(0.0);
    let (value, difference) = sums(outer, inner);
    gap * (value + inner * difference)
}

/// The s of a level y = g, `z` = y/R.
pub(super) fn square_at(z: f64) -> f64 {
    descend(z / (1.0 + z / 3.0), |s| (s * sums(s, s).0 - z, steepness(s)))
}

/// The same with twice the digits, of which those of z times (P - 1)/P, a small number, have one rounding.
pub(super) fn exact_square_at(z: DoubleDouble) -> DoubleDouble {
    let s = square_at(z.value());
    let (value, difference) = sums(s, 0.0);
    z - z * (s * difference / value)
}

/// How far below s = `outer` the level is lower by `depth`, over R.
pub(super) fn gap_of(outer: f64, depth: f64) -> f64 {
    let mut gap = (depth / steepness(outer)).min(outer);
    for _ in 0..8 {
        let step = (depth - rise(outer, gap)) / steepness((outer - gap).max(0.0));
        gap = (gap + step).clamp(0.5 * gap, outer);
        if step.abs() <= 1e-9 * gap {
            break;
        }
    }
    gap
}

/// The moments of a ring from x/R = `outer` inward over `width`, in units of R.
pub(super) fn moments(outer: f64, width: f64) -> Moments {
    let square = outer * outer;
    let panel = if square <= RULES[0] {
        Panel::coarse(width)
    } else if square <= RULES[1] {
        Panel::middling(width)
    } else {
        Panel::fine(width)
    };
    let (mut first, mut second) = (0.0, 0.0);
    panel.visit(|below, weight| {
        let h = rise(square, below * (2.0 * outer - below));
        first += weight * h;
        second += weight * h * h;
    });
    Moments { width, first, second }
}
