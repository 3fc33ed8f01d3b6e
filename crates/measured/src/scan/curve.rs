//! The curve that is fitted: curvature constant over each of n intervals of equal width, f'(0) = 0.
//!
//! f(r) = f_0 + sum_i k_i [(r - r_i)_+^2 - (r - r_{i+1})_+^2]/2, the k_i being its curvatures: a sum of punches with rounded
//! edges (Schubert 1942), so that g and all that follows from it are closed forms, and pressures have no spikes. Of (r - b)_+^2/2
//! the slope g' is 2 sqrt(x^2 - b^2) - b arccos(b/x).

/// The curve, in whatever units its numbers have.
#[derive(Clone, Debug)]
pub(super) struct Curve {
    /// Width h of an interval.
    pub(super) width: f64,
    /// The curvature f'' in each.
    pub(super) curvatures: Vec<f64>,
    /// The height f_0 on the axis.
    pub(super) offset: f64,
    /// Height and slope where each interval begins.
    starts: Vec<[f64; 2]>,
}

impl Curve {
    pub(super) fn new(width: f64, curvatures: Vec<f64>, offset: f64) -> Curve {
        let (mut height, mut slope) = (offset, 0.0);
        let starts = curvatures
            .iter()
            .map(|curvature| {
                let start = [height, slope];
                height += width * (slope + 0.5 * curvature * width);
                slope += curvature * width;
                start
            })
            .collect();
        Curve { width, curvatures, offset, starts }
    }

    /// The interval of a radius, and how far into it that is; beyond the last interval its parabola continues.
    fn find(&self, r: f64) -> (usize, f64) {
        let index = ((r / self.width) as usize).min(self.curvatures.len() - 1);
        (index, r - index as f64 * self.width)
    }

    /// f(r).
    pub(super) fn height(&self, r: f64) -> f64 {
        let (index, step) = self.find(r);
        let [height, slope] = self.starts[index];
        height + step * (slope + 0.5 * self.curvatures[index] * step)
    }

    /// f'(r).
    pub(super) fn slope(&self, r: f64) -> f64 {
        let (index, step) = self.find(r);
        self.starts[index][1] + self.curvatures[index] * step
    }

    /// Where the last interval ends.
    pub(super) fn end(&self) -> f64 {
        self.width * self.curvatures.len() as f64
    }

    /// g'(x).
    pub(super) fn g_slope(&self, x: f64) -> f64 {
        g_slopes(self.width, self.curvatures.len(), x).iter().zip(&self.curvatures).map(|(one, k)| one * k).sum()
    }
}

/// g'(x) of each interval's curvature.
pub(super) fn g_slopes(width: f64, intervals: usize, x: f64) -> Vec<f64> {
    let from = |index: usize| {
        let b = index as f64 * width;
        if x <= b {
            return 0.0;
        }
        let root = ((x - b) * (x + b)).sqrt();
        2.0 * root - b * root.atan2(b)
    };
    (0..intervals).map(|index| from(index) - from(index + 1)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn g_is_that_of_the_rounded_punch_of_the_mechanics() {
        use stickslip_mechanics::profile::{Profile, RoundedPunch};
        let punch = Profile::RoundedPunch(RoundedPunch::new(0.25, 2.0).unwrap());
        let mut curvatures = vec![0.5; 8];
        curvatures[..2].fill(0.0);
        let curve = Curve::new(0.125, curvatures, 3.0);
        for x in [0.1, 0.26, 0.5, 0.93] {
            assert!((curve.g_slope(x) - punch.slope(x)).abs() < 1e-15, "{x}");
            assert!((curve.slope(x) - punch.surface_slope(x)).abs() < 1e-15);
            let height: f64 = (x - 0.25f64).max(0.0).powi(2) / 4.0 + 3.0;
            assert!((curve.height(x) - height).abs() < 1e-15);
        }
    }
}
