//! The exact sphere well below its equator: with s = (x/R)^2, g = R s P(s), and P = sum of s^k/(2k + 1) is a short
//! series.
//!
//! No term is negative, and differences are taken by P's divided difference, so that nothing cancels. The inverse is a
//! series too, which converges far beyond [`LIMIT`]: s = z - z^2 C(z), z = g/R.

use super::{DoubleDouble, Moments};
use crate::numerics::gauss::{EIGHT_POINTS, TWELVE_POINTS, TWENTY_POINTS, first_and_second};

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
    if square <= RULES[0] {
        moments_by(&EIGHT_POINTS, outer, width)
    } else if square <= RULES[1] {
        moments_by(&TWELVE_POINTS, outer, width)
    } else {
        moments_by(&TWENTY_POINTS, outer, width)
    }
}

fn moments_by<const N: usize>(rule: &[(f64, f64); N], outer: f64, width: f64) -> Moments {
    let (square, mut value, mut differences) = (outer * outer, 0.0, [0.0; N]);
    let gaps = rule.map(|(u, _)| width * u * (2.0 * outer - width * u));
    for share in terms(square).iter().rev() {
        for lane in 0..N {
            differences[lane] = differences[lane] * (square - gaps[lane]) + value;
        }
        value = value * square + share;
    }
    let rises = std::array::from_fn(|lane| gaps[lane] * (value + (square - gaps[lane]) * differences[lane]));
    let (first, second) = first_and_second(rule, rises);
    Moments { width, first: width * first, second: width * second }
}
