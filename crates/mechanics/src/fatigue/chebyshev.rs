//! Polynomials through Chebyshev's points of an interval, both ends among them, x = cos(pi j/n) from 1 down to -1.

use std::f64::consts::PI;
use std::sync::LazyLock;

use crate::numerics::gauss::QuadraturePanel;

/// The numbers of steps between the points: each has the points of the one before it.
pub(super) const STEPS: [usize; 4] = [4, 8, 16, 32];

/// Panels of twenty points that integrate the polynomials of twice the most steps to round-off.
const PANELS: u32 = 8;

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

fn work_weights(n: usize) -> Vec<Vec<f64>> {
    let mut works = vec![vec![0.0; n + 1]; n + 1];
    let cosines: Vec<f64> = (0..2 * n).map(|index| point(n, index)).collect();
    for panel in 0..PANELS {
        let width = 2.0 / f64::from(PANELS);
        QuadraturePanel::fine(width).visit(|offset, share| {
            let x = width * f64::from(panel) - 1.0 + offset;
            let slope = slopes(n, &cosines, x.acos());
            for (row, value) in works.iter_mut().zip(weights(n, x)) {
                row.iter_mut().zip(&slope).for_each(|(entry, rise)| *entry += share * value * rise);
            }
        });
    }
    works
}

/// The weights of the values at the points in the derivative of the polynomial at x = cos(angle), between the ends, by
/// the cosines of all multiples of the angle between points.
fn slopes(n: usize, cosines: &[f64], angle: f64) -> Vec<f64> {
    let half = |m: usize| if m == 0 || m == n { 0.5 } else { 1.0 };
    // dT_m/dx = m sin(m angle)/sin(angle).
    let rise = |m: usize| half(m) * m as f64 * (m as f64 * angle).sin() / angle.sin();
    let rises: Vec<f64> = (0..=n).map(rise).collect();
    let slope = |j: usize| {
        let sum: f64 = rises.iter().enumerate().map(|(m, rise)| cosines[m * j % (2 * n)] * rise).sum();
        2.0 / n as f64 * half(j) * sum
    };
    (0..=n).map(slope).collect()
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
