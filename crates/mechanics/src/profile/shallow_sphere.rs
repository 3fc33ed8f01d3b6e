//! The exact sphere well below its equator: with s = (x/R)^2, g = R s P(s), and P = sum of s^k/(2k + 1) is a short
//! series.
//!
//! No term is negative, and differences are taken by P's divided difference, so that nothing cancels. The inverse is a
//! series too, which converges far beyond [`LIMIT`]: s = z - z^2 C(z), z = g/R.
//!
//! Of a very shallow ring the moments are closed: with v = (x_outer^2 - x^2)/R^2, h/R = sum of e_k v^k, whose terms
//! fall like s^k, and int v^k dx is a polynomial of the ring's width.

use super::{DoubleDouble, Moments};
use crate::numerics::gauss::QuadraturePanel;

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
/// The coefficients of C, by which s = z - z^2 C(z) inverts z = s P(s) (Lagrange): the twelfth is below 1e-18 of one at
/// [`LIMIT`].
const INVERSE: [f64; 11] = [
    1.0 / 3.0,
    -1.0 / 45.0,
    -1.0 / 189.0,
    -11.0 / 14_175.0,
    1.0 / 22_275.0,
    15_187.0 / 212_837_625.0,
    2_917.0 / 127_702_575.0,
    4_769.0 / 1_993_723_875.0,
    -21_959_663.0 / 17_717_861_581_875.0,
    -3_394_195_583.0 / 4_593_988_395_871_875.0,
    -1.7284538170669022e-07,
];
/// The z up to which five terms of C do: the sixth is z^6/2000 of the first.
const SHORT: f64 = 1e-3;
/// The s up to which four terms of h do: the fifth is at most s^4/20 of the first.
const CLOSED: f64 = 2e-4;
/// The s up to which Gauss's rules of eight and of twelve points integrate all terms of g^2 that count.
const RULES: [f64; 2] = [1e-3, 1e-2];

/// The terms of P that count at an s up to [`LIMIT`].
fn terms(s: f64) -> &'static [f64] {
    // s is below 2^-halvings, and so is the ratio of each term to the one before; one more for the difference, which
    // begins later.
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

/// g/R between s = `outer` and what lies `gap` below it.
pub(super) fn rise(outer: f64, gap: f64) -> f64 {
    let inner = (outer - gap).max(0.0);
    let (value, difference) = sums(outer, inner);
    gap * (value + inner * difference)
}

/// The terms of C that count at z.
fn inverse_terms(z: f64) -> &'static [f64] {
    if z <= SHORT { &INVERSE[..5] } else { &INVERSE }
}

/// z C(z) = 1 - s/z, by which the sphere is less deep than its paraboloid.
fn shortfall(z: f64) -> f64 {
    z * inverse_terms(z).iter().rev().fold(0.0, |sum, share| sum * z + share)
}

/// x^2, m^2, of a level, m, of a sphere of this radius, m, with twice the digits: those of R y times z C, a small
/// number, have one rounding.
pub(super) fn exact_square(radius: f64, level: DoubleDouble) -> DoubleDouble {
    let paraboloid = level * radius;
    paraboloid - paraboloid * shortfall(level.value() / radius)
}

/// How far below the level `z` = y/R the s is lower where the level is by `depth`, over R: by the divided difference of
/// z^2 C.
pub(super) fn gap_of(z: f64, depth: f64) -> f64 {
    let inner = (z - depth).max(0.0);
    let (mut value, mut difference) = (0.0, 0.0);
    for share in inverse_terms(z).iter().rev() {
        difference = difference * inner + value;
        value = value * z + share;
    }
    // [z^2 C] = (z + z_inner) C(z) + z_inner^2 [C].
    depth * (1.0 - ((z + inner) * value + inner * inner * difference))
}

/// The moments of a ring from x/R = `outer` inward over `width`, in units of R.
pub(super) fn moments(outer: f64, width: f64) -> Moments {
    let square = outer * outer;
    if width <= 0.0 {
        return Moments::default();
    }
    if square <= CLOSED {
        return closed_moments(outer, width);
    }
    let panel = if square <= RULES[0] {
        QuadraturePanel::coarse(width)
    } else if square <= RULES[1] {
        QuadraturePanel::middling(width)
    } else {
        QuadraturePanel::fine(width)
    };
    let (mut first, mut second) = (0.0, 0.0);
    panel.visit(|below, weight| {
        let h = rise(square, below * (2.0 * outer - below));
        first += weight * h;
        second += weight * h * h;
    });
    Moments { width, first, second }
}

/// The same for s up to [`CLOSED`], with e_k = -(-1)^k (s P)^(k)/k! and
/// int v^k dx = x^(2k+1) tau^(k+1) sum of C(k,i) 2^(k-i) (-tau)^i/(k + 1 + i), tau the width over x.
fn closed_moments(outer: f64, width: f64) -> Moments {
    let (s, tau) = (outer * outer, width / outer);
    let one = 1.0 + s * (2.0 / 3.0 + s * (3.0 / 5.0 + s * (4.0 / 7.0)));
    let two = -(1.0 / 3.0 + s * (3.0 / 5.0 + s * (6.0 / 7.0)));
    let three = 1.0 / 5.0 + s * (4.0 / 7.0);
    let four = -1.0 / 7.0;
    let powers = [
        1.0 - tau / 3.0,
        4.0 / 3.0 + tau * (-1.0 + tau / 5.0),
        2.0 + tau * (-12.0 / 5.0 + tau * (1.0 - tau / 7.0)),
        16.0 / 5.0 + tau * (-16.0 / 3.0 + tau * (24.0 / 7.0 + tau * (-1.0 + tau / 9.0))),
        16.0 / 3.0 + tau * (-80.0 / 7.0 + tau * (10.0 + tau * (-40.0 / 9.0 + tau * (1.0 - tau / 11.0)))),
    ];
    let step = s * tau;
    let sum = |[a, b, c, d]: [f64; 4], of: usize| {
        a * powers[of] + step * (b * powers[of + 1] + step * (c * powers[of + 2] + step * (d * powers[of + 3])))
    };
    let squares = [one * one, 2.0 * one * two, 2.0 * one * three + two * two, 2.0 * (one * four + two * three)];
    let area = width * width;
    Moments { width, first: area * outer * sum([one, two, three, four], 0), second: area * width * s * sum(squares, 1) }
}
