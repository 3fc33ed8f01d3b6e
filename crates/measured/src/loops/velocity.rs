//! How fast the displacement of a record changes at its points, and where it was a delay earlier.

use std::ops::RangeInclusive;

/// Points to either side of one whose velocity is sought, at least; and at most, as a share of the points of a branch.
const LEAST_REACH: usize = 2;
const LARGEST_SHARE: usize = 8;
/// In so many standard deviations of the noise, the displacement changes over the points to one side.
const OF_NOISE: f64 = 4.0;

/// A displacement over time, branch by branch: a parabola across a turn would round its corner.
pub(super) struct Velocity<'a> {
    times: &'a [f64],
    displacement: &'a [f64],
    /// The last point of each branch but the last.
    ends: &'a [usize],
    /// Points to either side through which a parabola averages the noise.
    reach: usize,
}

impl<'a> Velocity<'a> {
    /// Of a displacement, m, of this range and noise, m.
    pub(super) fn new(
        times: &'a [f64],
        displacement: &'a [f64],
        ends: &'a [usize],
        [range, noise]: [f64; 2],
    ) -> Velocity<'a> {
        let of_branch = displacement.len() / (ends.len() + 1);
        let wanted = (OF_NOISE * noise / range * of_branch as f64).ceil() as usize;
        let reach = wanted.clamp(LEAST_REACH, LEAST_REACH.max(of_branch / LARGEST_SHARE));
        Velocity { times, displacement, ends, reach }
    }

    /// The points about one, of its branch alone.
    fn about(&self, at: usize) -> RangeInclusive<usize> {
        let branch = self.ends.partition_point(|end| *end < at);
        let first = branch.checked_sub(1).map_or(0, |before| self.ends[before] + 1);
        let last = self.ends.get(branch).copied().unwrap_or(self.times.len() - 1);
        first.max(at.saturating_sub(self.reach))..=last.min(at + self.reach)
    }

    /// The velocity at a point, m/s.
    pub(super) fn at(&self, at: usize) -> f64 {
        self.parabola(at)[0]
    }

    /// The displacement a delay before the time of a point, m.
    pub(super) fn earlier(&self, at: usize, delay: f64) -> f64 {
        if delay.abs() <= 0.0 {
            return self.displacement[at];
        }
        let time = self.times[at] - delay;
        let after = self.times.partition_point(|point| *point < time).min(self.times.len() - 1);
        let before = after.saturating_sub(1);
        let nearest = if time - self.times[before] < self.times[after] - time { before } else { after };
        let ([slope, bend], step) = (self.parabola(nearest), time - self.times[nearest]);
        self.displacement[nearest] + step * (slope + bend * step)
    }

    /// Slope and half the curvature, at a point, of the parabola through the points about it, by least squares.
    fn parabola(&self, at: usize) -> [f64; 2] {
        let about = self.about(at);
        let reach = (self.times[*about.end()] - self.times[at]).max(self.times[at] - self.times[*about.start()]);
        if reach <= 0.0 {
            return [0.0; 2];
        }
        let basis = |index: usize| {
            let x = (self.times[index] - self.times[at]) / reach;
            nalgebra::Vector3::new(1.0, x, x * x)
        };
        let normal: nalgebra::Matrix3<f64> = about.clone().map(|index| basis(index) * basis(index).transpose()).sum();
        let right: nalgebra::Vector3<f64> =
            about.clone().map(|index| basis(index) * (self.displacement[index] - self.displacement[at])).sum();
        let points = about.end() - about.start() + 1;
        match normal.try_inverse().filter(|_| points > LEAST_REACH) {
            Some(inverse) => {
                let fitted = inverse * right;
                [fitted[1] / reach, fitted[2] / (reach * reach)]
            }
            None => [
                (normal[(0, 0)] * right[1] - normal[(0, 1)] * right[0])
                    / (normal[(0, 0)] * normal[(1, 1)] - normal[(0, 1)].powi(2))
                    / reach,
                0.0,
            ],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn velocities_and_earlier_places_of_a_triangle_stay_on_their_branch() {
        let times: Vec<f64> = (0..41).map(|index| 0.1 * f64::from(index)).collect();
        let place = |time: f64| if time < 1.95 { 3.0 * time } else { 3.0 * (3.9 - time) };
        let displacement: Vec<f64> = times.iter().map(|time| place(*time)).collect();
        let ends = [19];
        let velocity = Velocity::new(&times, &displacement, &ends, [5.85, 0.0]);
        for (index, time) in times.iter().enumerate() {
            let expected = if index < 20 { 3.0 } else { -3.0 };
            assert!((velocity.at(index) - expected).abs() < 1e-9, "{index}");
            let earlier = velocity.earlier(index, 0.13);
            assert!((earlier - place(time - 0.13)).abs() < 1e-9 || (time - 0.13 - 1.95).abs() < 0.05, "{index}");
        }
    }

    #[test]
    fn a_branch_of_two_points_has_the_velocity_between_them() {
        let (times, displacement) = ([0.0, 1.0, 2.0, 3.0], [0.0, 1.0, 0.0, -1.0]);
        let velocity = Velocity::new(&times, &displacement, &[1], [2.0, 0.0]);
        assert!((velocity.at(0) - 1.0).abs() < 1e-12 && (velocity.at(3) + 1.0).abs() < 1e-12);
    }
}
