//! The noise of the heights of a table, and how much of it g has.

use super::Tabulated;

impl Tabulated {
    /// An estimate of the noise of the heights, m, from what a local cubic leaves over. A coarse table of a smooth surface has some too.
    #[must_use]
    pub fn height_noise(&self) -> f64 {
        self.noise
    }

    /// By how much g at the radius x, m, has more noise than the heights do (pure number), if theirs is independent:
    /// the root of the sum of squares of dg/dz, taken for straight lines between the points. At n equal steps it is sqrt(2n) and so.
    #[must_use]
    pub fn noise_amplification(&self, x: f64) -> f64 {
        let angle = |r: f64| (r / x).min(1.0).asin();
        let (mut sum, mut before) = (0.0, 0.0);
        for pair in self.radii.windows(2) {
            let share = x * (angle(pair[1]) - angle(pair[0])) / (pair[1] - pair[0]);
            sum += (share - before) * (share - before);
            before = share;
        }
        (sum + before * before).sqrt()
    }
}

/// What third divided differences say about the noise of single heights.
pub(super) fn of_heights(radii: &[f64], heights: &[f64]) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for (r, z) in radii.windows(4).zip(heights.windows(4)) {
        let (mut difference, mut size) = (0.0, 0.0);
        for i in 0..4 {
            let weight: f64 = (0..4).filter(|&j| j != i).map(|j| (r[3] - r[0]) / (r[i] - r[j])).product();
            difference += weight * (z[i] - z[0]);
            size += weight * weight;
        }
        sum += difference * difference / size;
        count += 1.0;
    }
    if count > 0.0 { (sum / count).sqrt() } else { 0.0 }
}
