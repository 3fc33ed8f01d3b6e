//! The statistics of trials.

/// What the largest stresses of some trials have in common, Pa.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// Their mean.
    pub mean: f64,
    /// The standard error of that.
    pub standard_error: f64,
    /// What 95 % of them do not exceed: the nearest rank.
    pub percentile_95: Option<f64>,
}

impl Spread {
    /// Of the results of [`trials`](super::trials), the smallest first.
    #[must_use]
    pub fn of(found: &[f64]) -> Spread {
        let count = found.len() as f64;
        let mean = found.iter().sum::<f64>() / count;
        let variance = found.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1.0).max(1.0);
        let rank = (0.95 * count).ceil() as usize;
        let percentile_95 = found.get(rank.max(1) - 1).copied();
        Spread { mean, standard_error: (variance / count).sqrt(), percentile_95 }
    }
}
