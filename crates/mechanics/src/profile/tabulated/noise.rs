//! The noise of the heights of a table, and how much of it g has.

use super::Tabulated;

impl Tabulated {
    /// An estimate of the noise of the heights, m, from what a local cubic leaves over. A coarse table of a smooth
    /// surface has some too.
    #[must_use]
    pub fn height_noise(&self) -> f64 {
        self.noise
    }

    /// By how much g at the radius x, m, has more noise than the heights do (pure number), if theirs is independent:
    /// the root of the sum of squares of dg/dz, taken for straight lines between the points. At n equal steps it is
    /// about sqrt(2n).
    #[must_use]
    pub fn noise_amplification(&self, x: f64) -> f64 {
        let (mut sum, mut before, mut angle) = (0.0, 0.0, 0.0);
        // Beyond x all shares are zero.
        let below = self.radii.partition_point(|r| *r < x).min(self.radii.len() - 1);
        for pair in self.radii[..=below].windows(2) {
            let next = (pair[1] / x).min(1.0).asin();
            let share = x * (next - angle) / (pair[1] - pair[0]);
            sum += (share - before) * (share - before);
            (before, angle) = (share, next);
        }
        (sum + before * before).sqrt()
    }
}

/// The noise of single heights, m, by the third divided differences.
pub(super) fn of_heights(radii: &[f64], heights: &[f64]) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for (r, z) in radii.windows(4).zip(heights.windows(4)) {
        let share = 1.0 / (r[3] - r[0]);
        let [low, middle, high] = [0, 1, 2].map(|i| share * (r[i + 1] - r[i]));
        let (inner, outer) = (low + middle, middle + high);
        let weights =
            [-1.0 / (low * inner), 1.0 / (low * middle * outer), -1.0 / (inner * middle * high), 1.0 / (outer * high)];
        let difference = (1..4).map(|i| weights[i] * (z[i] - z[0])).sum::<f64>();
        let size = weights.iter().map(|weight| weight * weight).sum::<f64>();
        sum += difference * difference / size;
        count += 1.0;
    }
    if count > 0.0 { (sum / count).sqrt() } else { 0.0 }
}
