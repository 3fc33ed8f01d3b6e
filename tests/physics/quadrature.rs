//! Gauss-Legendre quadrature, and the same halved until it agrees with itself.

use std::sync::LazyLock;

/// Nodes in (0, 1) and weights, by Newton's method on the Legendre polynomial.
pub fn gauss(count: usize) -> Vec<(f64, f64)> {
    (0..count)
        .map(|index| {
            let n = count as f64;
            let mut x = (std::f64::consts::PI * (index as f64 + 0.75) / (n + 0.5)).cos();
            let mut slope = 1.0;
            for _ in 0..20 {
                let (mut last, mut value) = (1.0, x);
                for k in 2..=count {
                    let k = k as f64;
                    (last, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * last) / k);
                }
                slope = n * (x * value - last) / (x * x - 1.0);
                x -= value / slope;
            }
            (0.5 * (1.0 + x), 1.0 / ((1.0 - x * x) * slope * slope))
        })
        .collect()
}

static TEN: LazyLock<Vec<(f64, f64)>> = LazyLock::new(|| gauss(10));

fn once(f: &dyn Fn(f64) -> f64, low: f64, high: f64) -> f64 {
    (high - low) * TEN.iter().map(|(x, weight)| weight * f(low + x * (high - low))).sum::<f64>()
}

/// int f over [low, high]; every part is halved until both halves agree with the whole within `tolerance`.
pub fn integral(f: &dyn Fn(f64) -> f64, low: f64, high: f64, tolerance: f64) -> f64 {
    fn halve(f: &dyn Fn(f64) -> f64, low: f64, high: f64, whole: f64, tolerance: f64, left: usize) -> f64 {
        let middle = 0.5 * (low + high);
        let (inner, outer) = (once(f, low, middle), once(f, middle, high));
        if left == 0 || (inner + outer - whole).abs() <= tolerance {
            return inner + outer;
        }
        halve(f, low, middle, inner, tolerance, left - 1) + halve(f, middle, high, outer, tolerance, left - 1)
    }
    halve(f, low, high, once(f, low, high), tolerance, 40)
}
