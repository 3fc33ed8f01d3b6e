//! Short power series in Y, -1 <= Y <= 1, of functions of x^2 = X + h Y: what a family says about g'/x for [`super::smooth_pieces`].
//!
//! Each coefficient is as exact as its own size: products and integrals of binomial series lose nothing that counts.

use super::DoubleDouble;

/// The most terms of a series: 5^-28 is less than rounding.
pub(super) const TERMS: usize = 28;

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
    terms: usize,
}

impl Place {
    /// (x^2 - s)^power, s being the square of a radius, m, inside the place.
    pub(super) fn power(&self, inside: f64, power: f64) -> Series {
        let middle = (self.middle - DoubleDouble::square_of(inside)).value();
        let share = self.half / middle;
        let mut term = if power.to_bits() == 0.5f64.to_bits() { middle.sqrt() } else { middle.powf(power) };
        self.by(|k| {
            let this = term;
            term *= (power - k) / (k + 1.0) * share;
            this
        })
    }

    /// A constant.
    pub(super) fn constant(&self, value: f64) -> Series {
        self.by(|k| if k > 0.0 { 0.0 } else { value })
    }

    /// The angle atan(t/b), t^2 = x^2 - b^2: its derivative with respect to x^2 is b/(2 x^2 t). `over_t` is the series of 1/t.
    pub(super) fn angle(&self, b: f64, over_t: &Series) -> Series {
        let t = (self.middle - DoubleDouble::square_of(b)).value().sqrt();
        let slope = self.power(0.0, -1.0).times(over_t).scaled(0.5 * b * self.half);
        let mut before = t.atan2(b);
        self.by(|k| {
            let this = before;
            before = slope.coefficients[k as usize] / (k + 1.0);
            this
        })
    }

    fn by(&self, mut term: impl FnMut(f64) -> f64) -> Series {
        let mut series = Series { coefficients: [0.0; TERMS], terms: self.terms.min(TERMS) };
        for (k, coefficient) in series.coefficients[..series.terms].iter_mut().enumerate() {
            *coefficient = term(k as f64);
        }
        series
    }
}

impl Series {
    /// The product of two series.
    pub(super) fn times(&self, other: &Series) -> Series {
        let mut product = Series { coefficients: [0.0; TERMS], terms: self.terms };
        for (k, &a) in self.coefficients[..self.terms].iter().enumerate() {
            for (sum, b) in product.coefficients[k..self.terms].iter_mut().zip(&other.coefficients) {
                *sum += a * b;
            }
        }
        product
    }

    /// The sum of two series.
    pub(super) fn plus(&self, other: &Series) -> Series {
        let mut sum = *self;
        sum.coefficients.iter_mut().zip(&other.coefficients).for_each(|(sum, b)| *sum += b);
        sum
    }

    /// A multiple.
    pub(super) fn scaled(&self, factor: f64) -> Series {
        Series { coefficients: self.coefficients.map(|a| factor * a), terms: self.terms }
    }

    /// One over it.
    pub(super) fn inverse(&self) -> Series {
        let first = self.coefficients[0].recip();
        let mut inverse = Series { coefficients: [0.0; TERMS], terms: self.terms };
        inverse.coefficients[0] = first;
        for k in 1..self.terms {
            let sum: f64 = (1..=k).map(|j| self.coefficients[j] * inverse.coefficients[k - j]).sum();
            inverse.coefficients[k] = -first * sum;
        }
        inverse
    }
}

/// gamma = dg/dt beside a kink, as a power series in t: the coefficients of even and of odd powers, each times that power of the largest t.
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
