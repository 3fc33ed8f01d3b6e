//! What the residual says about the noise: its size, its correlation, its outliers.

use super::curve::{Curve, interval};

/// Blocks that an estimate of the variance of means needs.
const FEWEST_BLOCKS: usize = 6;
/// Lags of the autocorrelation, at most.
const MOST_LAGS: usize = 500;

/// One residual: its radius, the side of the axis (+1, -1), and its value.
pub(super) struct Residual {
    pub(super) radius: f64,
    pub(super) side: f64,
    pub(super) value: f64,
}

/// How many times the variance of a mean over radii exceeds that of independent noise of this `variance`.
///
/// What differs between the two sides of the axis is noise, whatever the shape: its sums over ever wider rings, in
/// which correlated noise does not average out, are compared with what independent noise would leave (batch means). The
/// largest ratio counts. Without two sides the residual itself is taken.
pub(super) fn inflation(residuals: &[Residual], curve: &Curve, variance: f64) -> f64 {
    let rings = curve.curvatures.len();
    let mut sums = vec![[0.0; 4]; rings];
    for residual in residuals {
        let ring = &mut sums[interval(&curve.breaks, residual.radius)];
        let side = usize::from(residual.side > 0.0);
        ring[side] += residual.value;
        ring[2 + side] += 1.0;
    }
    let two_sided = sums.iter().filter(|ring| ring[2] > 0.0 && ring[3] > 0.0).count() > rings / 2;
    let mut blocks: Vec<[f64; 2]> =
        sums.iter()
            .map(|ring| {
                if two_sided { [ring[1] - ring[0], ring[2] + ring[3]] } else { [ring[1] + ring[0], ring[2] + ring[3]] }
            })
            .collect();
    let mut largest = 1.0f64;
    while blocks.len() >= FEWEST_BLOCKS {
        let filled = blocks.iter().filter(|block| block[1] > 0.0);
        let (sum, count) = filled.fold((0.0, 0.0), |(sum, count), [d, n]| (sum + d * d / n, count + 1.0));
        largest = largest.max(sum / (variance * f64::max(count, 1.0)));
        blocks = blocks.chunks(2).map(|pair| pair.iter().fold([0.0; 2], |a, b| [a[0] + b[0], a[1] + b[1]])).collect();
    }
    largest
}

/// The lag, in points, at which the autocorrelation of a series falls below 1/e.
pub(super) fn correlation_lag(values: &[f64]) -> f64 {
    let mean = |lag: usize| {
        let pairs = values.iter().zip(&values[lag..]);
        pairs.map(|(a, b)| a * b).sum::<f64>() / (values.len() - lag) as f64
    };
    let threshold = mean(0) / std::f64::consts::E;
    let mut before = mean(0);
    for lag in 1..(values.len() / 4).min(MOST_LAGS) {
        let now = mean(lag);
        if now <= threshold {
            return (lag - 1) as f64 + (before - threshold) / (before - now).max(f64::MIN_POSITIVE);
        }
        before = now;
    }
    (values.len() / 4).min(MOST_LAGS) as f64
}
