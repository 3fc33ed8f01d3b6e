//! Polynomials through Chebyshev's points of an interval, both ends among them, x = cos(pi j/n) from 1 down to -1.

use std::f64::consts::PI;
use std::sync::LazyLock;

/// The numbers of steps between the points: each has the points of the one before it.
pub(super) const STEPS: [usize; 4] = [4, 8, 16, 32];

/// The weights of the values at the points of `STEPS[level]`, one row for each of the points half a step between them.
pub(super) fn between(level: usize) -> &'static [Vec<f64>] {
    static ROWS: LazyLock<[Vec<Vec<f64>>; 4]> =
        LazyLock::new(|| STEPS.map(|n| (0..n).map(|j| weights(n, (PI * (j as f64 + 0.5) / n as f64).cos())).collect()));
    &ROWS[level]
}

/// The weights of the values at the points of `STEPS[level]` pairwise in the integral of the first function times the
/// derivative of the second, in x: exact for the polynomials.
pub(super) fn works(level: usize) -> &'static [Vec<f64>] {
    static ROWS: LazyLock<[Vec<Vec<f64>>; 4]> = LazyLock::new(|| STEPS.map(work_weights));
    &ROWS[level]
}

/// The points.
pub(super) fn point(n: usize, j: usize) -> f64 {
    (PI * j as f64 / n as f64).cos()
}

/// The weights of the values at the points in the polynomial at x (Salzer 1972).
pub(super) fn weights(n: usize, x: f64) -> Vec<f64> {
    let mut found: Vec<f64> = Vec::with_capacity(n + 1);
    for j in 0..=n {
        let off = x - point(n, j);
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
fn work_weights(n: usize) -> Vec<Vec<f64>> {
    let cosines: Vec<f64> = (0..2 * n).map(|index| point(n, index)).collect();
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
    fn polynomials_are_met_between_their_points_and_integrated_exactly() {
        for (level, n) in STEPS.into_iter().enumerate() {
            let (f, g) = (|x: f64| 1.0 + x - 0.5 * x.powi(3), |x: f64| 0.3 * x + x.powi(4));
            let values = |of: &dyn Fn(f64) -> f64| (0..=n).map(|j| of(point(n, j))).collect::<Vec<f64>>();
            let (first, second) = (values(&f), values(&g));
            for (j, row) in between(level).iter().enumerate() {
                let found: f64 = row.iter().zip(&second).map(|(weight, value)| weight * value).sum();
                assert!((found - g((PI * (j as f64 + 0.5) / n as f64).cos())).abs() < 1e-14);
            }
            let work: f64 =
                (0..=n).map(|i| (0..=n).map(|j| works(level)[i][j] * first[i] * second[j]).sum::<f64>()).sum();
            // int (1 + x - x^3/2)(0.3 + 4 x^3) dx over -1 to 1.
            assert!((work - (0.6 + 8.0 / 5.0 - 4.0 / 7.0)).abs() < 1e-13, "{n}: {work}");
        }
    }
}
