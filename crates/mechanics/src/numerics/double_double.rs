//! Double-double arithmetic: a number as the unevaluated sum of two `f64`.
//!
//! Differences of levels are far smaller than the levels: a turning point 1e-14 of the indentation away from the edge
//! must keep all its digits. The error-free sum and product below are Dekker's (1971) and Knuth's; a result is good to
//! about 1e-31 of its operands.

use std::ops::{Add, Mul, Neg, Sub};

/// `hi + lo`, with `lo` at most half a unit in the last place of `hi`.
///
/// ```
/// use stickslip_mechanics::DoubleDouble;
///
/// let third = DoubleDouble::from(1.0).over(DoubleDouble::from(3.0));
/// assert!((third * 3.0 - DoubleDouble::from(1.0)).value().abs() < 1e-31);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub struct DoubleDouble {
    hi: f64,
    lo: f64,
}

/// The rounded sum and what the rounding lost.
fn two_sum(a: f64, b: f64) -> DoubleDouble {
    let hi = a + b;
    let b_part = hi - a;
    let lo = (a - (hi - b_part)) + (b - b_part);
    DoubleDouble { hi, lo }
}

/// As [`two_sum`], for `|a| >= |b|`.
fn quick_two_sum(a: f64, b: f64) -> DoubleDouble {
    let hi = a + b;
    DoubleDouble { hi, lo: b - (hi - a) }
}

/// The two 26-bit halves of `a`. Splitting beats a fused multiply-add here: it needs no instruction set beyond the
/// baseline.
fn split(a: f64) -> (f64, f64) {
    const SPLITTER: f64 = 134_217_729.0;
    let t = SPLITTER * a;
    let hi = t - (t - a);
    (hi, a - hi)
}

/// The rounded product and what the rounding lost.
fn two_product(a: f64, b: f64) -> DoubleDouble {
    let hi = a * b;
    let (a_hi, a_lo) = split(a);
    let (b_hi, b_lo) = split(b);
    let lo = ((a_hi * b_hi - hi) + a_hi * b_lo + a_lo * b_hi) + a_lo * b_lo;
    DoubleDouble { hi, lo }
}

impl DoubleDouble {
    /// Zero.
    pub const ZERO: DoubleDouble = DoubleDouble { hi: 0.0, lo: 0.0 };

    /// The sum `hi + lo` of two numbers of any size.
    #[must_use]
    pub fn sum(hi: f64, lo: f64) -> DoubleDouble {
        two_sum(hi, lo)
    }

    /// The exact square of `a`.
    #[must_use]
    pub fn square_of(a: f64) -> DoubleDouble {
        two_product(a, a)
    }

    /// The nearest `f64`.
    #[must_use]
    pub fn value(self) -> f64 {
        self.hi
    }

    /// The nearest `f64` of the difference, or its neighbour: without what rounding lost of a difference that is not
    /// small, so that lanes of it run side by side.
    #[must_use]
    pub(crate) fn less(self, other: DoubleDouble) -> f64 {
        (self.hi - other.hi) + (self.lo - other.lo)
    }

    /// The leading and the trailing part.
    #[must_use]
    pub fn parts(self) -> (f64, f64) {
        (self.hi, self.lo)
    }

    /// The inverse of [`DoubleDouble::parts`], bit for bit: nothing is added, so that even the sign of zero is kept.
    pub(crate) fn from_parts(hi: f64, lo: f64) -> DoubleDouble {
        DoubleDouble { hi, lo }
    }

    /// The magnitude.
    #[must_use]
    pub fn abs(self) -> DoubleDouble {
        if self.hi < 0.0 { -self } else { self }
    }

    /// Itself, or its negative if `sign` is negative.
    #[must_use]
    pub fn signed(self, sign: f64) -> DoubleDouble {
        if sign < 0.0 { -self } else { self }
    }

    /// Half of it, exact unless it underflows.
    #[must_use]
    pub fn halved(self) -> DoubleDouble {
        DoubleDouble { hi: 0.5 * self.hi, lo: 0.5 * self.lo }
    }

    /// The quotient; `divisor` must not be zero.
    #[must_use]
    pub fn over(self, divisor: DoubleDouble) -> DoubleDouble {
        let first = self.hi / divisor.hi;
        let rest = self - divisor * first;
        let second = rest.hi / divisor.hi;
        let rest = rest - divisor * second;
        quick_two_sum(first, second) + DoubleDouble::from(rest.hi / divisor.hi)
    }

    /// The square root; zero for what is not positive.
    #[must_use]
    pub fn sqrt(self) -> DoubleDouble {
        if self.hi <= 0.0 {
            return DoubleDouble::ZERO;
        }
        let root = self.hi.sqrt();
        let rest = self - DoubleDouble::square_of(root);
        quick_two_sum(root, rest.hi / (2.0 * root))
    }
}

impl From<f64> for DoubleDouble {
    fn from(hi: f64) -> DoubleDouble {
        DoubleDouble { hi, lo: 0.0 }
    }
}

impl Add for DoubleDouble {
    type Output = DoubleDouble;
    fn add(self, other: DoubleDouble) -> DoubleDouble {
        let high = two_sum(self.hi, other.hi);
        quick_two_sum(high.hi, high.lo + (self.lo + other.lo))
    }
}

impl Neg for DoubleDouble {
    type Output = DoubleDouble;
    fn neg(self) -> DoubleDouble {
        DoubleDouble { hi: -self.hi, lo: -self.lo }
    }
}

impl Sub for DoubleDouble {
    type Output = DoubleDouble;
    fn sub(self, other: DoubleDouble) -> DoubleDouble {
        self + (-other)
    }
}

impl Mul<f64> for DoubleDouble {
    type Output = DoubleDouble;
    fn mul(self, factor: f64) -> DoubleDouble {
        let product = two_product(self.hi, factor);
        quick_two_sum(product.hi, product.lo + self.lo * factor)
    }
}

impl Mul for DoubleDouble {
    type Output = DoubleDouble;
    fn mul(self, other: DoubleDouble) -> DoubleDouble {
        let product = two_product(self.hi, other.hi);
        quick_two_sum(product.hi, product.lo + (self.hi * other.lo + self.lo * other.hi))
    }
}
