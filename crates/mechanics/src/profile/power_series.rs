//! Short power series in Y, -1 <= Y <= 1, of functions of x^2 = X + h Y: what a family says about g'/x for
//! [`super::smooth_pieces`].
//!
//! They follow from their differential equations, each coefficient from those before it. Of the two solutions of each
//! the one that grows faster is wanted, so that errors of rounding do not grow.

use super::DoubleDouble;

/// The most terms of a series: 5^-28 is less than rounding.
pub(super) const TERMS: usize = 28;

/// One over 1, 2 and so on.
const RECIPROCALS: [f64; TERMS] = {
    let mut recips = [1.0; TERMS];
    let mut k = 1;
    while k < TERMS {
        recips[k] = 1.0 / (k + 1) as f64;
        k += 1;
    }
    recips
};

/// Where a series is wanted.
#[derive(Clone, Copy)]
pub(super) struct Place {
    /// X, m^2, with twice the digits.
    pub(super) middle: DoubleDouble,
    /// h, m^2.
    pub(super) half: f64,
    /// How many terms count.
    pub(super) terms: usize,
}

/// The coefficients of a series; those that do not count are zero.
#[derive(Clone, Copy)]
pub(super) struct Series {
    pub(super) coefficients: [f64; TERMS],
}

/// What the functions of a family with a kink at b are made of beyond it, t^2 = x^2 - b^2.
pub(super) struct BeyondKink<'a> {
    place: &'a Place,
    b: f64,
    x: f64,
    t: f64,
    /// 1/(x t).
    pub(super) inverse: Series,
}

impl Place {
    /// A multiple of (x^2)^power.
    pub(super) fn power(&self, factor: f64, power: f64) -> Series {
        let middle = self.middle.value();
        let share = self.half / middle;
        self.by(factor * middle.powf(power), |k, [last, _]| (power - k) * share * last)
    }

    /// A constant.
    pub(super) fn constant(&self, value: f64) -> Series {
        self.by(value, |_, _| 0.0)
    }

    /// The sum of coefficients times the powers of x^2/`unit`, m^2.
    pub(super) fn polynomial(&self, coefficients: &[f64], unit: f64) -> Series {
        let mut series = Series { coefficients: [0.0; TERMS] };
        let count = coefficients.len().min(TERMS);
        let terms = &mut series.coefficients[..count];
        terms.copy_from_slice(&coefficients[..count]);
        let (middle, half) = (self.middle.value() / unit, self.half / unit);
        // Horner's scheme, once for each term of Taylor's series.
        for first in 0..count {
            for k in (first + 1..count).rev() {
                terms[k - 1] += middle * terms[k];
            }
        }
        let mut power = 1.0;
        for (k, term) in terms.iter_mut().enumerate() {
            *term *= if k < self.terms { power } else { 0.0 };
            power *= half;
        }
        series
    }

    /// The functions beyond a kink at b, m; `None` below it.
    pub(super) fn beyond(&self, b: f64) -> Option<BeyondKink<'_>> {
        let above = (self.middle - DoubleDouble::square_of(b)).value();
        if above <= 0.0 {
            return None;
        }
        let middle = self.middle.value();
        let (x, t) = (middle.sqrt(), above.sqrt());
        let (share, share_above) = (self.half / middle, self.half / above);
        let (sum, product) = (share + share_above, share * share_above);
        let inverse = self.by((x * t).recip(), |k, [last, before]| -(k + 0.5) * sum * last - k * product * before);
        Some(BeyondKink { place: self, b, x, t, inverse })
    }

    /// The series of this constant term, of which each next one, k + 1, is `next` of k and the two terms before it,
    /// over k + 1.
    fn by(&self, first: f64, next: impl Fn(f64, [f64; 2]) -> f64) -> Series {
        let mut series = Series { coefficients: [0.0; TERMS] };
        let (mut last, mut before) = (first, 0.0);
        for (k, coefficient) in series.coefficients[..self.terms.min(TERMS)].iter_mut().enumerate() {
            *coefficient = last;
            (last, before) = (next(k as f64, [last, before]) * RECIPROCALS[k], last);
        }
        series
    }
}

impl BeyondKink<'_> {
    /// phi/x, phi = atan(t/b).
    pub(super) fn angle(&self) -> Series {
        self.following((self.t / self.b).atan() / self.x, 0.5, 0.5 * self.b)
    }

    /// 1 - t/x.
    pub(super) fn lacking(&self) -> Series {
        let square = self.b * self.b;
        self.following(square / (self.x * (self.x + self.t)), 0.0, -0.5 * square)
    }

    /// y of x^2 dy/d(x^2) + rate y = factor/(x t), by its constant term.
    fn following(&self, first: f64, rate: f64, factor: f64) -> Series {
        let share = self.place.half / (self.x * self.x);
        let source = &self.inverse.coefficients;
        self.place.by(first, |k, [last, _]| factor * share * source[k as usize] - (k + rate) * share * last)
    }
}

impl Series {
    /// The sum of two series.
    pub(super) fn plus(&self, other: &Series) -> Series {
        let mut sum = *self;
        sum.coefficients.iter_mut().zip(&other.coefficients).for_each(|(sum, b)| *sum += b);
        sum
    }

    /// A constant and multiples of series.
    pub(super) fn sum<const N: usize>(constant: f64, parts: [(f64, &Series); N]) -> Series {
        let term = |k| parts.iter().map(|(factor, series)| factor * series.coefficients[k]).sum();
        let mut sum = Series { coefficients: std::array::from_fn(term) };
        sum.coefficients[0] += constant;
        sum
    }
}

/// gamma = dg/dt beside a kink, as a power series in t: the coefficients of even and of odd powers, each times that
/// power of the largest t.
#[derive(Clone, Copy, Default)]
pub(super) struct KinkSeries {
    pub(super) even: [f64; KINK_TERMS],
    pub(super) odd: [f64; KINK_TERMS],
}

/// Terms of either parity beside a kink: 16^-16 is less than rounding.
pub(super) const KINK_TERMS: usize = 16;

impl KinkSeries {
    /// (`constant` + `square` t^2 + `angle` t atan(t/b))/x for t up to `top`, x^2 = b^2 + t^2.
    pub(super) fn over_radius(b: f64, top: f64, constant: f64, square: f64, angle: f64) -> KinkSeries {
        let (share, ratio) = ((top / b) * (top / b), -(top / b) * (top / b));
        let mut numerator = [0.0; KINK_TERMS];
        let mut power = angle * b * share;
        for (j, term) in numerator.iter_mut().enumerate().skip(1) {
            *term = power / (2 * j - 1) as f64;
            power *= ratio;
        }
        numerator[0] = constant;
        numerator[1] += square * top * top;
        let mut inverse = [0.0; KINK_TERMS];
        let mut term = b.recip();
        for (j, coefficient) in inverse.iter_mut().enumerate() {
            *coefficient = term;
            term *= ratio * (0.5 + j as f64) / (j + 1) as f64;
        }
        let mut even = [0.0; KINK_TERMS];
        for (j, a) in numerator.iter().enumerate() {
            for (sum, c) in even[j..].iter_mut().zip(&inverse) {
                *sum += a * c;
            }
        }
        KinkSeries { even, odd: [0.0; KINK_TERMS] }
    }

    /// t q for a q that is smooth at the kink, by its series there over t up to `top`.
    pub(super) fn smooth(series: &Series, top: f64) -> KinkSeries {
        KinkSeries { odd: std::array::from_fn(|k| top * series.coefficients[k]), ..KinkSeries::default() }
    }

    /// The sum of two.
    pub(super) fn plus(&self, other: &KinkSeries) -> KinkSeries {
        KinkSeries {
            even: std::array::from_fn(|k| self.even[k] + other.even[k]),
            odd: std::array::from_fn(|k| self.odd[k] + other.odd[k]),
        }
    }
}
