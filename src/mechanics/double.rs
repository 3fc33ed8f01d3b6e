//! Twice the digits: a number kept as the unevaluated sum of two `f64`.
//!
//! Levels and positions differ by far less than they measure: a turning point 1e-14 of the indentation away from the
//! edge must keep all its digits. The error-free sum and product below are Dekker's (1971) and Knuth's; a result is
//! good to about 1e-31 of its operands.

use std::ops::{Add, Mul, Neg, Sub};

/// `hi + lo`, with `lo` at most half a unit in the last place of `hi`.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub struct Double {
    hi: f64,
    lo: f64,
}

/// The rounded sum and what the rounding lost.
fn two_sum(a: f64, b: f64) -> Double {
    let hi = a + b;
    let b_part = hi - a;
    let lo = (a - (hi - b_part)) + (b - b_part);
    Double { hi, lo }
}

/// As [`two_sum`], for `|a| >= |b|`.
fn quick_two_sum(a: f64, b: f64) -> Double {
    let hi = a + b;
    Double { hi, lo: b - (hi - a) }
}

/// The two 26-bit halves of `a`. Splitting beats a fused multiply-add here: it needs no instruction set beyond the baseline.
fn split(a: f64) -> (f64, f64) {
    const SPLITTER: f64 = 134_217_729.0;
    let t = SPLITTER * a;
    let hi = t - (t - a);
    (hi, a - hi)
}

/// The rounded product and what the rounding lost.
fn two_product(a: f64, b: f64) -> Double {
    let hi = a * b;
    let (a_hi, a_lo) = split(a);
    let (b_hi, b_lo) = split(b);
    let lo = ((a_hi * b_hi - hi) + a_hi * b_lo + a_lo * b_hi) + a_lo * b_lo;
    Double { hi, lo }
}

impl Double {
    /// Nought.
    pub const ZERO: Double = Double { hi: 0.0, lo: 0.0 };

    /// The sum `hi + lo` of two numbers of any size.
    #[must_use]
    pub fn sum(hi: f64, lo: f64) -> Double {
        two_sum(hi, lo)
    }

    /// The exact square of `a`.
    #[must_use]
    pub fn square_of(a: f64) -> Double {
        two_product(a, a)
    }

    /// The nearest `f64`.
    #[must_use]
    pub fn value(self) -> f64 {
        self.hi
    }

    /// The leading and the trailing part.
    #[must_use]
    pub fn parts(self) -> (f64, f64) {
        (self.hi, self.lo)
    }

    /// What [`Double::parts`] gave, put together again bit for bit; nothing is added up, so that not even a sign of nought
    /// is lost.
    pub(super) fn from_parts(hi: f64, lo: f64) -> Double {
        Double { hi, lo }
    }

    /// The magnitude.
    #[must_use]
    pub fn abs(self) -> Double {
        if self.hi < 0.0 { -self } else { self }
    }

    /// With the sign of `sign` put before it.
    #[must_use]
    pub fn signed(self, sign: f64) -> Double {
        if sign < 0.0 { -self } else { self }
    }

    /// Half of it, exact but for what underflows.
    #[must_use]
    pub fn halved(self) -> Double {
        Double { hi: 0.5 * self.hi, lo: 0.5 * self.lo }
    }

    /// The quotient; `divisor` must not be nought.
    #[must_use]
    pub fn over(self, divisor: Double) -> Double {
        let first = self.hi / divisor.hi;
        let rest = self - divisor * first;
        let second = rest.hi / divisor.hi;
        let rest = rest - divisor * second;
        quick_two_sum(first, second) + Double::from(rest.hi / divisor.hi)
    }

    /// The square root; nought for what is not positive.
    #[must_use]
    pub fn sqrt(self) -> Double {
        if self.hi <= 0.0 {
            return Double::ZERO;
        }
        let root = self.hi.sqrt();
        let rest = self - Double::square_of(root);
        quick_two_sum(root, rest.hi / (2.0 * root))
    }
}

impl From<f64> for Double {
    fn from(hi: f64) -> Double {
        Double { hi, lo: 0.0 }
    }
}

impl Add for Double {
    type Output = Double;
    fn add(self, other: Double) -> Double {
        let high = two_sum(self.hi, other.hi);
        quick_two_sum(high.hi, high.lo + (self.lo + other.lo))
    }
}

impl Neg for Double {
    type Output = Double;
    fn neg(self) -> Double {
        Double { hi: -self.hi, lo: -self.lo }
    }
}

impl Sub for Double {
    type Output = Double;
    fn sub(self, other: Double) -> Double {
        self + (-other)
    }
}

impl Mul<f64> for Double {
    type Output = Double;
    fn mul(self, factor: f64) -> Double {
        let product = two_product(self.hi, factor);
        quick_two_sum(product.hi, product.lo + self.lo * factor)
    }
}

impl Mul for Double {
    type Output = Double;
    fn mul(self, other: Double) -> Double {
        let product = two_product(self.hi, other.hi);
        quick_two_sum(product.hi, product.lo + (self.hi * other.lo + self.lo * other.hi))
    }
}

#[cfg(test)]
mod tests {
    use super::Double;

    #[test]
    fn a_third_times_three_is_one_to_thirty_digits() {
        let third = Double::from(1.0).over(Double::from(3.0));
        let rest = third * 3.0 - Double::from(1.0);
        assert!(rest.value().abs() < 1e-31);
        assert!((third.value() * 3.0 - 1.0 + third.parts().1 * 3.0).abs() < 1e-16);
    }

    #[test]
    fn small_differences_survive() {
        let near = Double::from(1.0) - Double::from(1e-25);
        assert!(((Double::from(1.0) - near).value() - 1e-25).abs() < 1e-40);
    }

    #[test]
    fn the_root_of_two_squares_back() {
        let root = Double::from(2.0).sqrt();
        assert!((root * root - Double::from(2.0)).value().abs() < 1e-30);
    }
}
