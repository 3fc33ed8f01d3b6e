//! Chebyshev series on an interval: from values at the Chebyshev points, and their values (Clenshaw
//! 1955; Mason & Handscomb 2003).
//!
//! A series through n points of a function that is analytic within the ellipse of foci at the ends of the interval,
//! whose half-axes add up to rho half-widths, errs like rho^-n; so do its last coefficients, by which
//! [`Points::resolve`] tells whether the points suffice.

use std::f64::consts::PI;
use std::sync::LazyLock;

/// The part of the largest coefficient below which a last one is the rounding of the values.
pub(crate) const NEGLIGIBLE_TERM: f64 = 5e-16;

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
        let cosine = |index: usize| (PI * (index % (4 * N)) as f64 / (2 * N) as f64).cos();
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
        counted(&self.terms(values), NEGLIGIBLE_TERM).to_vec()
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

/// The integral of a series from -1 on, times `scale`, as a series: `start` at -1.
///
/// int T_0 = T_1, int T_1 = (T_0 + T_2)/4, and int T_n = T_(n + 1)/(2(n + 1)) - T_(n - 1)/(2(n - 1)).
pub(crate) fn integral(series: &[f64], scale: f64, start: f64) -> Vec<f64> {
    let term = |order: usize| series.get(order).copied().unwrap_or(0.0);
    let rise = |order: usize| if order == 1 { 2.0 * term(0) - term(2) } else { term(order - 1) - term(order + 1) };
    let mut terms: Vec<f64> = (1..=series.len()).map(|order| 0.5 * scale * rise(order) / order as f64).collect();
    let here: f64 = terms.iter().enumerate().map(|(index, term)| if index % 2 == 0 { -term } else { *term }).sum();
    terms.insert(0, start - here);
    terms
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

/// The numbers of steps between nested points, both ends among them, x = cos(pi j/n) from 1 down to -1: each has the
/// points of the one before it.
pub(crate) const NESTED_STEPS: [usize; 4] = [4, 8, 16, 32];
const MOST_STEPS: usize = 64;

/// The weights of the values at the points of `NESTED_STEPS[level]`, one row for each of the points half a step between
/// them.
pub(crate) fn nested_midpoints(level: usize) -> &'static [Vec<f64>] {
    static ROWS: LazyLock<[Vec<Vec<f64>>; 4]> = LazyLock::new(|| {
        NESTED_STEPS.map(|n| (0..n).map(|j| nested_weights(n, (PI * (j as f64 + 0.5) / n as f64).cos())).collect())
    });
    &ROWS[level]
}

/// The weights of the values at the points of `NESTED_STEPS[level]` pairwise in the integral of the first function
/// times the derivative of the second, in x: exact for the polynomials.
pub(crate) fn nested_products(level: usize) -> &'static [Vec<f64>] {
    static ROWS: LazyLock<[Vec<Vec<f64>>; 4]> = LazyLock::new(|| NESTED_STEPS.map(product_weights));
    &ROWS[level]
}

/// The nested point `j` of `n`, or of the points half a step between those of the most steps as well, all the way
/// round.
pub(crate) fn nested_point(n: usize, j: usize) -> f64 {
    static POINTS: LazyLock<[f64; 2 * MOST_STEPS]> =
        LazyLock::new(|| std::array::from_fn(|index| (PI * index as f64 / MOST_STEPS as f64).cos()));
    POINTS[j * (MOST_STEPS / n)]
}

/// The weights of the values at the points in the polynomial at x (Salzer 1972).
pub(crate) fn nested_weights(n: usize, x: f64) -> Vec<f64> {
    let mut found: Vec<f64> = Vec::with_capacity(n + 1);
    for j in 0..=n {
        let off = x - nested_point(n, j);
        if off == 0.0 {
            return (0..=n).map(|i| if i == j { 1.0 } else { 0.0 }).collect();
        }
        let sign = if j % 2 == 0 { 1.0 } else { -1.0 };
        let share = if j == 0 || j == n { 0.5 } else { 1.0 };
        found.push(sign * share / off);
    }
    let sum: f64 = found.iter().sum();
    found.into_iter().map(|weight| weight / sum).collect()
}

/// By the coefficients of both polynomials: int T_m dT_k is 2 k^2/(k^2 - m^2) where m + k is odd, else zero.
fn product_weights(n: usize) -> Vec<Vec<f64>> {
    let cosines: Vec<f64> = (0..2 * n).map(|index| nested_point(n, index)).collect();
    let half = |m: usize| if m == 0 || m == n { 0.5 } else { 1.0 };
    let share = |m: usize, j: usize| 2.0 / n as f64 * half(m) * half(j) * cosines[m * j % (2 * n)];
    let work = |m: usize, k: usize| {
        let [m, k] = [m, k].map(|order| (order * order) as f64);
        if (m + k) % 2.0 > 0.0 { 2.0 * k / (k - m) } else { 0.0 }
    };
    let sum = |term: &dyn Fn(usize) -> f64| (0..=n).map(term).sum::<f64>();
    let rows = (0..=n).map(|m| (0..=n).map(|j| sum(&|k| work(m, k) * share(k, j))).collect());
    let by_order: Vec<Vec<f64>> = rows.collect();
    (0..=n).map(|i| (0..=n).map(|j| sum(&|m| share(m, i) * by_order[m][j])).collect()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

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

    #[test]
    fn the_integral_of_a_series_is_that_of_its_function() {
        let points = &*TWENTY_FOUR;
        let series = integral(&points.series(&points.places(-1.0, 1.0).map(f64::exp)), 3.0, 0.5);
        for u in [-1.0, 0.3, 1.0] {
            let [value] = values(&series, [u]);
            assert!((value - (0.5 + 3.0 * (f64::exp(u) - f64::exp(-1.0)))).abs() < 1e-14);
        }
    }

    #[test]
    fn polynomials_are_met_between_their_points_and_integrated_exactly() {
        for (level, n) in NESTED_STEPS.into_iter().enumerate() {
            let (f, g) = (|x: f64| 1.0 + x - 0.5 * x.powi(3), |x: f64| 0.3 * x + x.powi(4));
            let values = |of: &dyn Fn(f64) -> f64| (0..=n).map(|j| of(nested_point(n, j))).collect::<Vec<f64>>();
            let (first, second) = (values(&f), values(&g));
            for (j, row) in nested_midpoints(level).iter().enumerate() {
                let found: f64 = row.iter().zip(&second).map(|(weight, value)| weight * value).sum();
                assert!((found - g((PI * (j as f64 + 0.5) / n as f64).cos())).abs() < 1e-14);
            }
            let work: f64 = (0..=n)
                .map(|i| (0..=n).map(|j| nested_products(level)[i][j] * first[i] * second[j]).sum::<f64>())
                .sum();
            // int (1 + x - x^3/2)(0.3 + 4 x^3) dx over -1 to 1.
            assert!((work - (0.6 + 8.0 / 5.0 - 4.0 / 7.0)).abs() < 1e-13, "{n}: {work}");
        }
    }
}
