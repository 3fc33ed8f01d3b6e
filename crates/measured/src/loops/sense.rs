//! The sense of a record: how its force depends on displacement and direction, which tells swapped columns, a wrong
//! sign and a force without its sign.

use nalgebra::{Matrix3, Vector3};

use super::Start;
use super::record::Branches;

/// Standard errors by which a dependence is sure.
const SURELY: f64 = 5.0;
/// Below this share of the force a loop has no width.
const ROUNDING: f64 = 1e-9;
/// A share of the largest force below which a force is zero, as far as samples are apart and noisy.
const ZERO: f64 = 0.3;
/// What displacement and direction explain of the variance of a force: at most the first of a magnitude, and at least
/// the second of what it is the magnitude of.
const EXPLAINED: [f64; 2] = [0.3, 0.6];
/// At most this of a magnitude that is hardly ever near zero.
const HARDLY: f64 = 0.1;

/// The regression of a force on displacement and direction.
struct Regression {
    /// Half of what the force is more on the way up than on the way down at the same displacement, N.
    direction: f64,
    /// Its standard error, N.
    error: f64,
    /// Whether neither dependence is sure.
    is_unsure: bool,
    /// The share of the variance of the force that is explained.
    explained: f64,
}

impl Branches {
    /// By how much the force on the way up is below that on the way down, where that is sure.
    pub(super) fn wrong_way(&self) -> Option<f64> {
        let forces: Vec<f64> = self.samples.iter().map(|sample| sample.force).collect();
        let Regression { direction, error, .. } = self.regression(&forces)?;
        (direction < -SURELY * error - ROUNDING * self.half_force).then_some(-2.0 * direction)
    }

    /// Whether the force is a magnitude: of one sign, as good as independent of displacement and direction, and a loop
    /// as soon as it is against the motion from each turn to the next zero, and with the motion from there on.
    pub(super) fn is_rectified(&self) -> bool {
        let (middle, half) = (self.middle_force.abs(), self.half_force);
        if middle < (1.0 - ZERO) * half {
            return false;
        }
        let mut forces: Vec<f64> = self.samples.iter().map(|sample| sample.force).collect();
        let Some(as_it_is) = self.regression(&forces) else { return false };
        // Of long ways of gross slip hardly a sample shows the zeros.
        if ZERO * middle > half {
            return as_it_is.explained < HARDLY && as_it_is.is_unsure;
        }
        let mut begin = 0;
        for branch in 0..=self.turns.len() {
            let end = self.samples.partition_point(|sample| sample.branch <= branch);
            let least = (begin..end).min_by(|a, b| forces[*a].abs().total_cmp(&forces[*b].abs()));
            // A record may begin or end within a branch, before or behind its zero.
            let zero = least.filter(|least| forces[*least].abs() < ZERO * (middle + half)).unwrap_or(begin);
            for (place, force) in forces[begin..end].iter_mut().enumerate() {
                *force = if begin + place < zero { -1.0 } else { 1.0 } * self.direction(branch) * force.abs();
            }
            begin = end;
        }
        let signed = self.regression(&forces);
        as_it_is.explained < EXPLAINED[0] && signed.is_some_and(|signed| signed.explained > EXPLAINED[1])
    }

    /// The regression of a force of each sample, without the first loading.
    fn regression(&self, forces: &[f64]) -> Option<Regression> {
        let scale = self.extremes[0].displacement - self.extremes[1].displacement;
        let rows =
            || self.samples.iter().zip(forces).filter(|(sample, _)| sample.branch > 0 || self.start == Start::Steady);
        let basis = |displacement: f64, branch: usize| Vector3::new(1.0, displacement / scale, self.direction(branch));
        let bases = || rows().map(|(sample, force)| (basis(sample.displacement, sample.branch), *force));
        let normal: Matrix3<f64> = bases().map(|(basis, _)| basis * basis.transpose()).sum();
        let right: Vector3<f64> = bases().map(|(basis, force)| basis * force).sum();
        let inverse = normal.try_inverse()?;
        let fitted = inverse * right;
        let count = rows().count();
        let mean = right[0] / count as f64;
        let left: f64 = bases().map(|(basis, force)| (force - fitted.dot(&basis)).powi(2)).sum();
        let all: f64 = rows().map(|(_, force)| (force - mean).powi(2)).sum();
        let error = |index: usize| (left / count.saturating_sub(3).max(1) as f64 * inverse[(index, index)]).sqrt();
        Some(Regression {
            direction: fitted[2],
            error: error(2),
            is_unsure: (1..3).all(|index| fitted[index].abs() < SURELY * error(index)),
            explained: 1.0 - left / all,
        })
    }
}
