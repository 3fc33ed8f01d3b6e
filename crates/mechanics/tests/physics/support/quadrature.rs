//! Gauss-Lobatto quadrature, halved until it agrees with itself.

use std::sync::LazyLock;

const POINTS: usize = 10;

/// Nodes in [0, 1] and weights. Both ends are nodes, so that a kink hard by an end is not overlooked.
static LOBATTO: LazyLock<[(f64, f64); POINTS]> = LazyLock::new(|| {
    let degree = (POINTS - 1) as f64;
    std::array::from_fn(|index| {
        let mut x = (std::f64::consts::PI * index as f64 / degree).cos();
        let mut value = 1.0;
        // The interior nodes are the extrema of the Legendre polynomial of that degree.
        for _ in 0..20 {
            let mut last = 1.0;
            value = x;
            for k in 2..POINTS {
                let k = k as f64;
                (last, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * last) / k);
            }
            x -= (x * value - last) / ((degree + 1.0) * value);
        }
        (0.5 * (1.0 + x), 1.0 / (degree * (degree + 1.0) * value * value))
    })
});

fn once(f: &dyn Fn(f64) -> f64, low: f64, high: f64) -> f64 {
    (high - low) * LOBATTO.iter().map(|(x, weight)| weight * f(low + x * (high - low))).sum::<f64>()
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
