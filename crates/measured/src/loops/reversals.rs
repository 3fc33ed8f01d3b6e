//! Turning points of a displacement, found in its noise.

use crate::robust::robust_deviation;

/// Swings smaller than this share of the range are no reversals.
const LEAST_SWING: f64 = 1e-9;
/// Swings of more than this share of the range are reversals, whatever the noise.
const LARGE_SWING: f64 = 0.2;
/// A reversal is a swing of this many standard deviations of the noise.
const SIGNIFICANT: f64 = 8.0;
/// The standard deviation of fourth differences of white noise, over that of the noise: the root of the sum of the
/// squares of 1, 4, 6, 4, 1.
const FOURTH_DIFFERENCE: f64 = 8.366_600_265_340_756;

/// Where a displacement turns.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Reversals {
    /// Indices of the turning points, the ends not among them.
    pub(super) at: Vec<usize>,
    /// Whether the displacement rises first.
    pub(super) rising: bool,
    /// Standard deviation of the noise of the displacement, m: as given, or the most that it may be.
    pub(super) noise: f64,
}

/// The turning points of a displacement whose noise has a standard deviation of `noise`, or an unknown one.
pub(super) fn reversals(displacement: &[f64], noise: Option<f64>) -> Reversals {
    let (low, high) = extent(displacement);
    let least = LEAST_SWING * (high - low);
    if let Some(noise) = noise {
        let (at, rising) = swings(displacement, least.max(SIGNIFICANT * noise));
        return Reversals { at, rising, noise };
    }
    // Of a smooth displacement that is sampled evenly, fourth differences show the noise alone; else they are larger.
    let mut differences: Vec<f64> = displacement
        .windows(5)
        .map(|u| (u[0] - 4.0 * u[1] + 6.0 * u[2] - 4.0 * u[3] + u[4]).abs() / FOURTH_DIFFERENCE)
        .collect();
    let noise = robust_deviation(&mut differences);
    let (mut at, mut rising) = swings(displacement, least);
    let significant = (SIGNIFICANT * noise).min(LARGE_SWING * (high - low));
    if at.windows(2).any(|pair| (displacement[pair[1]] - displacement[pair[0]]).abs() < significant) {
        (at, rising) = swings(displacement, significant.max(least));
    }
    Reversals { at, rising, noise }
}

/// The extremes between swings of more than `least`, and whether the first swing rises.
fn swings(values: &[f64], least: f64) -> (Vec<usize>, bool) {
    let (mut low, mut high) = (0, 0);
    let mut start = None;
    for (index, &value) in values.iter().enumerate() {
        if value - values[low] > least {
            start = Some((index, true));
            break;
        }
        if values[high] - value > least {
            start = Some((index, false));
            break;
        }
        if value < values[low] {
            low = index;
        }
        if value > values[high] {
            high = index;
        }
    }
    let Some((first, rising)) = start else { return (Vec::new(), true) };
    let (mut extreme, mut up) = (first, rising);
    let mut found = Vec::new();
    for (index, &value) in values.iter().enumerate().skip(first) {
        let beyond = if up { value - values[extreme] } else { values[extreme] - value };
        if beyond > 0.0 {
            extreme = index;
        } else if -beyond > least {
            found.push(extreme);
            extreme = index;
            up = !up;
        }
    }
    (found, rising)
}

/// The smallest and the largest of some numbers.
pub(super) fn extent(values: &[f64]) -> (f64, f64) {
    values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &value| (low.min(value), high.max(value)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_noisy_triangle_turns_where_it_turns() {
        let mut random = fastrand::Rng::with_seed(7);
        let triangle = |index: usize| {
            let phase = (index % 200) as f64 / 100.0;
            if phase < 1.0 { phase } else { 2.0 - phase }
        };
        let clean: Vec<f64> = (0..1001).map(triangle).collect();
        assert_eq!(reversals(&clean, None).at, (1..10).map(|turn| 100 * turn).collect::<Vec<_>>());
        let noisy: Vec<f64> = clean.iter().map(|u| u + 0.02 * (random.f64() + random.f64() - 1.0)).collect();
        let found = reversals(&noisy, None);
        assert_eq!(found.at.len(), 9);
        assert!(found.rising && found.at.iter().zip(1..).all(|(&at, turn)| at.abs_diff(100 * turn) < 6));
        // The sum of two uniform numbers of width 0.02 has the standard deviation 0.02/sqrt(6).
        assert!((found.noise / (0.02 / 6.0_f64.sqrt()) - 1.0).abs() < 0.15);
    }
}
