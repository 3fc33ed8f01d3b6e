//! Chebyshev series on an interval: from values at the Chebyshev points, and their values (Clenshaw
//! 1955; Mason & Handscomb 2003).
//!
//! A series through n points of a function that is analytic within the ellipse of foci at the ends of the interval,
//! whose half-axes add up to rho half-widths, errs like rho^-n; so do its last coefficients, by which
//! [`Points::resolve`] tells whether the points suffice.

use std::sync::LazyLock;

/// The part of the largest coefficient below which a last one is the rounding of the values.
pub(crate) const ROUNDED: f64 = 5e-16;

/// The Chebyshev points of -1..1, and what turns values there into coefficients.
///
/// Mirrored points agree in the polynomials of even order and differ in sign in those of odd order: a row for each pair
/// of points has first its shares in the even orders, then those in the odd ones.
pub(crate) struct Points<const N: usize> {
    cosines: [f64; N],
    transform: [[f64; N]; N],
}

pub(crate) static EIGHT: LazyLock<Points<8>> = LazyLock::new(Points::new);
pub(crate) static TWELVE: LazyLock<Points<12>> = LazyLock::new(Points::new);
pub(crate) static SIXTEEN: LazyLock<Points<16>> = LazyLock::new(Points::new);
pub(crate) static TWENTY: LazyLock<Points<20>> = LazyLock::new(Points::new);
pub(crate) static TWENTY_FOUR: LazyLock<Points<24>> = LazyLock::new(Points::new);

impl<const N: usize> Points<N> {
    pub(crate) fn new() -> Points<N> {
        let cosine = |index: usize| (std::f64::consts::PI * (index % (4 * N)) as f64 / (2 * N) as f64).cos();
        let share = |order: usize| if order == 0 { 1.0 } else { 2.0 } / N as f64;
        Points {
            cosines: std::array::from_fn(|index| cosine(2 * index + 1)),
            transform: std::array::from_fn(|index| {
                std::array::from_fn(|column| {
                    let order = if column < N / 2 { 2 * column } else { 2 * (column - N / 2) + 1 };
                    share(order) * cosine(order * (2 * index + 1))
                })
            }),
        }
    }

    /// The points of the interval low..high.
    pub(crate) fn places(&self, low: f64, high: f64) -> [f64; N] {
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        let mut places = self.cosines;
        for place in &mut places {
            *place = middle + half * *place;
        }
        places
    }

    /// The coefficients of the series with these values.
    pub(crate) fn terms(&self, values: &[f64; N]) -> [f64; N] {
        let mut sums = [0.0; N];
        for (index, row) in self.transform[..N / 2].iter().enumerate() {
            let (this, mirrored) = (values[index], values[N - 1 - index]);
            let (sum, difference) = (this + mirrored, this - mirrored);
            for column in 0..N / 2 {
                sums[column] += sum * row[column];
                sums[N / 2 + column] += difference * row[N / 2 + column];
            }
        }
        let mut terms = [0.0; N];
        for column in 0..N / 2 {
            (terms[2 * column], terms[2 * column + 1]) = (sums[column], sums[N / 2 + column]);
        }
        terms
    }

    /// The coefficients without the last ones that are rounding.
    pub(crate) fn series(&self, values: &[f64; N]) -> Vec<f64> {
        counted(&self.terms(values), ROUNDED).to_vec()
    }

    /// The weights at the points of -1..1 that stand for sources with these sums of weighted polynomials: those of the
    /// series of any values at the points.
    pub(crate) fn weights(&self, sums: &[f64; N]) -> [f64; N] {
        let mut weights = [0.0; N];
        for (index, row) in self.transform[..N / 2].iter().enumerate() {
            let part = |first: usize| (0..N / 2).map(|k| row[first * N / 2 + k] * sums[2 * k + first]).sum::<f64>();
            let (even, odd) = (part(0), part(1));
            (weights[index], weights[N - 1 - index]) = (even + odd, even - odd);
        }
        weights
    }

    /// Whether a series of these points has no terms beyond it: its last two are rounding.
    pub(crate) fn resolve(series: &[f64]) -> bool {
        series.len() + 2 <= N
    }
}

/// The terms of a series up to the last that is more than this share of the largest, or no number.
pub(crate) fn counted(terms: &[f64], share: f64) -> &[f64] {
    // By comparisons: `f64::max` also asks whether one of them is no number, which takes time in a loop this hot.
    let size = terms.iter().fold(0.0, |size, a| if a.abs() > size { a.abs() } else { size });
    let last = terms.iter().rposition(|a| a.abs() > share * size || a.is_nan());
    &terms[..last.map_or(0, |last| last + 1)]
}

/// Adds to sums over sources, of their weights times the Chebyshev polynomials of each order, that of one at u.
pub(crate) fn add_polynomials<const N: usize>(sums: &mut [f64; N], u: f64, weight: f64) {
    let (mut this, mut before) = (weight, weight * u);
    for sum in sums {
        *sum += this;
        (this, before) = (2.0 * u * this - before, this);
    }
}

/// The values of a series at places u from -1 to 1, side by side.
pub(crate) fn values<const N: usize>(series: &[f64], u: [f64; N]) -> [f64; N] {
    let (mut b1, mut b2) = ([0.0; N], [0.0; N]);
    let (first, rest) = series.split_first().map_or((0.0, series), |(first, rest)| (*first, rest));
    for &a in rest.iter().rev() {
        for lane in 0..N {
            (b1[lane], b2[lane]) = ((a - b2[lane]) + 2.0 * u[lane] * b1[lane], b1[lane]);
        }
    }
    for lane in 0..N {
        b1[lane] = (first - b2[lane]) + u[lane] * b1[lane];
    }
    b1
}

#[cfg(test)]
mod tests {
    use super::{EIGHT, Points, TWENTY_FOUR, values};

    #[test]
    fn a_series_follows_an_exponential() {
        let points = &*TWENTY_FOUR;
        let series = points.series(&points.places(-1.0, 1.0).map(f64::exp));
        assert!(Points::<24>::resolve(&series));
        for u in [-1.0, 0.3, 0.99] {
            let [value] = values(&series, [u]);
            assert!((value - f64::exp(u)).abs() < 2e-15);
        }
        assert!(!Points::<8>::resolve(&EIGHT.series(&EIGHT.places(-1.0, 1.0).map(f64::exp))));
    }
}
