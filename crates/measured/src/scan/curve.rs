//! The curve that is fitted: curvature constant over each of n intervals, f'(0) = 0.
//!
//! f(r) = f_0 + sum_i k_i [(r - r_i)_+^2 - (r - r_{i+1})_+^2]/2, the k_i being its curvatures: a sum of punches with
//! rounded edges (Schubert 1942), so that g and all that follows from it are closed forms, and pressures have no
//! spikes. Of (r - b)_+^2/2 the slope g' is 2 sqrt(x^2 - b^2) - b arccos(b/x).

/// How often the intervals nearest the axis are halved at most.
const HALVINGS: usize = 3;

/// The curve, in whatever units its numbers have.
#[derive(Clone, Debug)]
pub(super) struct Curve {
    /// The radii r_0 = 0, ..., r_n at which intervals begin and the last ends.
    pub(super) breaks: Vec<f64>,
    /// The curvature f'' in each.
    pub(super) curvatures: Vec<f64>,
    /// The height f_0 on the axis.
    pub(super) offset: f64,
    /// Height and slope where each interval begins.
    starts: Vec<[f64; 2]>,
}

impl Curve {
    pub(super) fn new(breaks: Vec<f64>, curvatures: Vec<f64>, offset: f64) -> Curve {
        let (mut height, mut slope) = (offset, 0.0);
        let starts = curvatures
            .iter()
            .zip(breaks.windows(2))
            .map(|(curvature, ends)| {
                let width = ends[1] - ends[0];
                let start = [height, slope];
                height += width * (slope + 0.5 * curvature * width);
                slope += curvature * width;
                start
            })
            .collect();
        Curve { breaks, curvatures, offset, starts }
    }

    /// The interval of a radius, and how far into it that is; beyond the last interval its parabola continues.
    fn find(&self, r: f64) -> (usize, f64) {
        let index = interval(&self.breaks, r);
        (index, r - self.breaks[index])
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
        self.breaks[self.curvatures.len()]
    }

    /// g'(x).
    pub(super) fn g_slope(&self, x: f64) -> f64 {
        g_slopes(&self.breaks, x).iter().zip(&self.curvatures).map(|(one, k)| one * k).sum()
    }
}

/// `intervals` of equal width up to `end`.
pub(super) fn equal_breaks(end: f64, intervals: usize) -> Vec<f64> {
    (0..=intervals).map(|index| end * index as f64 / intervals as f64).collect()
}

/// As [`equal_breaks`] up to one, with the intervals near the axis halved, and those nearest up to [`HALVINGS`] times,
/// while they are longer than `shortest`.
pub(super) fn graded_breaks(intervals: usize, shortest: f64) -> Vec<f64> {
    let mut breaks = equal_breaks(1.0, intervals);
    let mut halved_to = 2.0 * breaks[1];
    for _ in 0..HALVINGS {
        if 0.5 * breaks[1] < shortest {
            break;
        }
        let halved = breaks.partition_point(|start| *start < halved_to * (1.0 - 1e-9));
        let middles = breaks[..=halved].windows(2).map(|ends| 0.5 * (ends[0] + ends[1]));
        let mut finer: Vec<f64> = breaks.iter().copied().chain(middles).collect();
        finer.sort_by(f64::total_cmp);
        breaks = finer;
        halved_to *= 0.5;
    }
    breaks
}

/// The interval of a radius; the last one beyond the end.
pub(super) fn interval(breaks: &[f64], r: f64) -> usize {
    breaks[1..breaks.len() - 1].partition_point(|end| *end <= r)
}

/// g'(x) of each interval's curvature.
pub(super) fn g_slopes(breaks: &[f64], x: f64) -> Vec<f64> {
    let from = |&b: &f64| {
        if x <= b {
            return 0.0;
        }
        let root = ((x - b) * (x + b)).sqrt();
        2.0 * root - b * root.atan2(b)
    };
    let slopes: Vec<f64> = breaks.iter().map(from).collect();
    slopes.windows(2).map(|pair| pair[0] - pair[1]).collect()
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
        let curve = Curve::new(equal_breaks(1.0, 8), curvatures, 3.0);
        for x in [0.1, 0.26, 0.5, 0.93] {
            assert!((curve.g_slope(x) - punch.indenter().slope(x)).abs() < 1e-15, "{x}");
            assert!((curve.slope(x) - punch.surface_slope(x)).abs() < 1e-15);
            let height: f64 = (x - 0.25f64).max(0.0).powi(2) / 4.0 + 3.0;
            assert!((curve.height(x) - height).abs() < 1e-15);
        }
    }
}
