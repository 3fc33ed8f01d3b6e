//! Noise that drifts along a line, as the height of a drifting instrument does, and what it adds to the errors.
//!
//! The curve follows a walk as if it were shape, so that the residual shows little of it. What differs between the two
//! sides of the axis is noise whatever the shape, but for a tilt and a shift of the axis. So its covariance is taken as
//! that of white noise plus a process with covariance s^2 e^(-d/t) (Uhlenbeck & Ornstein 1930), a random walk where t
//! is longer than the line, and the sizes of both are those of the largest restricted likelihood (Patterson & Thompson
//! 1971). Of the lengths t that the line does not exclude the longest counts. The curvatures answer heights e with
//! H X'e, H being the inverse of the penalised matrix and X'X the plain one, so that a covariance C of the heights adds
//! H X'C X H.

use nalgebra::{DMatrix, DVector};

use super::curve::interval;
use super::fit::{Fitted, Scaled};

/// Rings in which the sides are compared, and the fewest that tell noise from a tilt.
const RINGS: usize = 72;
const FEWEST_RINGS: usize = 12;
/// Points that a ring has on each side, at least.
const RING_POINTS: f64 = 1.0;
/// Parts of the line in which its points count as one.
const PARTS: usize = 240;
/// Lengths of correlation that are tried, in half the line: powers of two.
const LENGTHS: std::ops::RangeInclusive<i32> = -5..=2;
/// Variances of the process over that of white noise in a ring: powers of the root of ten.
const RATIOS: std::ops::RangeInclusive<i32> = -2..=10;
/// Twice the gain of the logarithm of the likelihood beyond which white noise is excluded, and another length.
const SURE: f64 = 12.0;
const EXCLUDED: f64 = 3.84;
/// The share of a column that is left beside those before it, below which it is one of them.
const DISTINCT: f64 = 1e-6;

/// The process: its variance in the square of the range of the heights, and its length in half the line.
#[derive(Clone, Copy)]
struct Process {
    variance: f64,
    length: f64,
}

/// What noise that drifts adds to the covariance of the curvatures, in the units of the scan; `None` without it.
pub(super) fn covariance(fitted: &Fitted, scaled: &Scaled) -> Option<DMatrix<f64>> {
    if scaled.plane {
        return None;
    }
    let process = process(&Sides::new(fitted, scaled)?)?;
    let design = design(fitted, scaled);
    let places = DVector::from_fn(PARTS, |part, _| place(part));
    let of_heights = DMatrix::from_fn(PARTS, PARTS, |a, b| {
        process.variance * (-(places[a] - places[b]).abs() / process.length).exp()
    });
    let response = &fitted.solution.inverse * design;
    let intervals = fitted.equations.intervals;
    let response = response.rows(0, intervals);
    Some(response * of_heights * response.transpose())
}

/// The middle of a part of the line, in half its extent.
fn place(part: usize) -> f64 {
    2.0 * (part as f64 + 0.5) / PARTS as f64 - 1.0
}

/// X' with the sums over the points of each part.
fn design(fitted: &Fitted, scaled: &Scaled) -> DMatrix<f64> {
    let (curve, size) = (&fitted.curve, fitted.solution.unknowns.len());
    let intervals = fitted.equations.intervals;
    let (breaks, others) = (&curve.breaks, size - intervals - 1);
    let mut design = DMatrix::zeros(size, PARTS);
    for (point, _) in scaled.points.iter().zip(&fitted.kept).filter(|(_, kept)| **kept) {
        let part = (0.5 * (point[0] + 1.0) * PARTS as f64).clamp(0.0, PARTS as f64 - 1.0) as usize;
        let (from, mut column) = (point[0] - fitted.axis[0], design.column_mut(part));
        let r = from.abs();
        let own = interval(breaks, r);
        for inner in 0..own {
            column[inner] += (breaks[inner + 1] - breaks[inner]) * (r - 0.5 * (breaks[inner] + breaks[inner + 1]));
        }
        column[own] += 0.5 * (r - breaks[own]).powi(2);
        column[intervals] += 1.0;
        // The tilt, if it is sought, and then the step of the axis.
        let step = -curve.slope(r) * from.signum();
        let further = if others == 2 { [from, step] } else { [step, 0.0] };
        for (index, value) in further.into_iter().take(others).enumerate() {
            column[intervals + 1 + index] += value;
        }
    }
    design
}

/// Half the difference between the two sides of the axis, ring by ring.
struct Sides {
    radii: Vec<f64>,
    differences: DVector<f64>,
    /// The variance of each, over that of white noise in a height.
    variances: Vec<f64>,
    /// What a tilt and a shift of the axis make of it.
    columns: DMatrix<f64>,
}

impl Sides {
    fn new(fitted: &Fitted, scaled: &Scaled) -> Option<Sides> {
        let kept = || {
            let of_kept = scaled.points.iter().zip(&fitted.residuals).zip(&fitted.kept).filter(|(_, kept)| **kept);
            of_kept.map(|((point, residual), _)| (point[0] - fitted.axis[0], *residual))
        };
        let reach = |side: f64| kept().map(|(place, _)| side * place).fold(0.0, f64::max);
        let end = reach(1.0).min(reach(-1.0));
        let count = kept().filter(|(place, _)| place.abs() <= end).count();
        let rings = (count / 4).min(RINGS);
        if rings < FEWEST_RINGS {
            return None;
        }
        let mut sums = vec![[[0.0; 2]; 2]; rings];
        for (place, residual) in kept().filter(|(place, _)| place.abs() <= end) {
            let ring = ((place.abs() / end * rings as f64) as usize).min(rings - 1);
            let sum = &mut sums[ring][usize::from(place > 0.0)];
            *sum = [sum[0] + residual, sum[1] + 1.0];
        }
        let both = |(_, [left, right]): &(usize, [[f64; 2]; 2])| left[1].min(right[1]) >= RING_POINTS;
        let filled: Vec<(usize, [[f64; 2]; 2])> = sums.into_iter().enumerate().filter(both).collect();
        let radii: Vec<f64> = filled.iter().map(|(ring, _)| end * (*ring as f64 + 0.5) / rings as f64).collect();
        let differences = filled.iter().map(|(_, [left, right])| 0.5 * (right[0] / right[1] - left[0] / left[1]));
        let differences = DVector::from_vec(differences.collect());
        let variances = filled.iter().map(|(_, [left, right])| 0.25 * (1.0 / left[1] + 1.0 / right[1])).collect();
        let columns = columns(&radii, &radii.iter().map(|r| fitted.curve.slope(*r)).collect::<Vec<f64>>());
        (filled.len() >= FEWEST_RINGS).then_some(Sides { radii, differences, variances, columns })
    }

    /// Twice the logarithm of the restricted likelihood, but for a constant, and the variance of white noise.
    fn likelihood(&self, ratio: f64, length: f64) -> Option<(f64, f64)> {
        let count = self.radii.len();
        let matrix = DMatrix::from_fn(count, count, |a, b| {
            let (one, other) = (self.radii[a], self.radii[b]);
            let white = if a == b { self.variances[a] } else { 0.0 };
            white + ratio * 0.5 * ((-(one - other).abs() / length).exp() - (-(one + other) / length).exp())
        });
        let factor = matrix.cholesky()?;
        let inverse_columns = factor.solve(&self.columns);
        let normal = (self.columns.transpose() * &inverse_columns).cholesky()?;
        let found = normal.solve(&(inverse_columns.transpose() * &self.differences));
        let left = &self.differences - &self.columns * found;
        let freedom = (count - self.columns.ncols()) as f64;
        let variance = left.dot(&factor.solve(&left)) / freedom;
        let logarithm = |of: DMatrix<f64>| 2.0 * of.diagonal().iter().map(|value| value.ln()).sum::<f64>();
        let determinants = logarithm(factor.l()) + logarithm(normal.l());
        Some((-freedom * variance.ln() - determinants, variance)).filter(|(likelihood, _)| likelihood.is_finite())
    }
}

/// The radii and the slopes as columns, the second where it is another one.
fn columns(radii: &[f64], slopes: &[f64]) -> DMatrix<f64> {
    let (first, second) = (DVector::from_column_slice(radii), DVector::from_column_slice(slopes));
    let rest = &second - &first * (first.dot(&second) / first.norm_squared());
    if rest.norm_squared() <= DISTINCT * second.norm_squared() {
        return DMatrix::from_columns(&[first]);
    }
    DMatrix::from_columns(&[first, rest])
}

/// The process of the largest likelihood for the longest length that is not excluded, if white noise is.
fn process(sides: &Sides) -> Option<Process> {
    let (white, _) = sides.likelihood(0.0, 1.0)?;
    let in_ring = sides.variances.iter().sum::<f64>() / sides.variances.len() as f64;
    let of_length = |power: i32| {
        let length = 2f64.powi(power);
        // The mean variance of the process in a ring is this share of its own.
        let shares = sides.radii.iter().map(|r| 0.5 * (1.0 - (-2.0 * r / length).exp()));
        let share = shares.sum::<f64>() / sides.radii.len() as f64;
        let of_ratio = |ratio: i32| {
            let ratio = 10f64.powf(0.5 * f64::from(ratio)) * in_ring / share;
            let (likelihood, variance) = sides.likelihood(ratio, length)?;
            Some((likelihood, Process { variance: ratio * variance, length }))
        };
        RATIOS.filter_map(of_ratio).max_by(|a, b| a.0.total_cmp(&b.0))
    };
    let found: Vec<(f64, Process)> = LENGTHS.filter_map(of_length).collect();
    let most = found.iter().map(|(likelihood, _)| *likelihood).fold(f64::NEG_INFINITY, f64::max);
    let longest = found.iter().rev().find(|(likelihood, _)| *likelihood > most - EXCLUDED);
    longest.filter(|_| most > white + SURE).map(|(_, process)| *process)
}
