//! Forces in steps: how large they are, and by how much their rounding may shift the values of a fit.
//!
//! A converter rounds a force to the nearest multiple of its step q. Noise of standard deviation s before it makes the
//! rounding random, with a variance of q^2/12, but for its mean, which over the force F is -sum (-1)^k q/(pi k) exp(-2
//! pi^2 k^2 s^2/q^2) sin(2 pi k F/q) (Widrow, Kollár & Liu 1996): at s = q/3 some 4 % of a step, for all points that
//! have one force, as those of gross slip do. No number of points averages it out. At worst it is a wave over the force
//! of any phase; what that shifts each value by follows from the Jacobian.

use std::f64::consts::{PI, TAU};

use super::fit::Fitted;
use super::intervals::Covariance;
use super::least_squares::Data;
use super::{Curve, Record};

/// Steps that are more alike than this share of the largest force are rounding of numbers.
const SAME: f64 = 1e-9;
/// How far from a multiple of the step a force may be, in steps; and the share of the forces that must not be farther.
const OFF: f64 = 0.1;
const MOSTLY: f64 = 0.99;
/// Distinct forces from which a step can be told; of fewer points than so many times that, more.
const LEAST_LEVELS: usize = 4;
const LEVELS_OF_FEW: usize = 12;
const POINTS_EACH: usize = 3;
/// Residuals of fewer steps are not those of rounding; those of more hide it.
const RESIDUALS: std::ops::Range<f64> = 0.1..0.7;
/// Terms of the mean error of rounding.
const TERMS: i32 = 8;

/// The variance of the rounding to a step.
pub(super) fn variance(step: f64) -> f64 {
    step * step / 12.0
}

/// The step of which all forces are multiples, but for an offset, N; `None` if there is none.
pub(super) fn step(record: &Record) -> Option<f64> {
    let mut levels = record.force.clone();
    levels.sort_by(f64::total_cmp);
    let same = SAME * levels.iter().fold(0.0, |largest, level| f64::max(largest, level.abs()));
    levels.dedup_by(|next, level| *next - *level <= same);
    let few = levels.len() * POINTS_EACH > record.force.len();
    if levels.len() < if few { LEVELS_OF_FEW } else { LEAST_LEVELS } {
        return None;
    }
    let gaps: Vec<f64> = levels.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let mut step = gaps.iter().copied().fold(f64::INFINITY, f64::min);
    let mut off = 0.0;
    // The least gap is the first guess; a straight line through all levels over their numbers is the second.
    for _ in 0..2 {
        let mut number = 0.0;
        let numbers: Vec<f64> = std::iter::once(0.0)
            .chain(gaps.iter().map(|gap| {
                number += (gap / step).round();
                number
            }))
            .collect();
        let count = levels.len() as f64;
        let [mean, middle] = [&numbers, &levels].map(|values| values.iter().sum::<f64>() / count);
        let pairs = || numbers.iter().zip(&levels).map(|(number, level)| (number - mean, level - middle));
        step = pairs().map(|(n, l)| n * l).sum::<f64>() / pairs().map(|(n, _)| n * n).sum::<f64>();
        off = offset_of_most(pairs().map(|(n, l)| (l - n * step).abs() / step).collect());
    }
    (off <= OFF).then_some(step)
}

/// The distance that most are not beyond.
fn offset_of_most(mut distances: Vec<f64>) -> f64 {
    let place = ((distances.len() - 1) as f64 * MOSTLY) as usize;
    *distances.select_nth_unstable_by(place, f64::total_cmp).1
}

/// A record whose steps matter: the step, and the largest mean error of its rounding, N.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rounding {
    step: f64,
    shift: f64,
}

/// The rounding of each record, where its residual shows that the step is not far below the noise.
pub(super) fn roundings(steps: &[Option<f64>], curves: &[Curve]) -> Vec<Option<Rounding>> {
    let of_record = |(step, curve): (&Option<f64>, &Curve)| {
        let step = (*step)?;
        let used = curve.measured.iter().zip(&curve.fitted).zip(&curve.used).filter(|(_, used)| **used);
        let (squares, count) = used.fold((0.0, 0.0), |(squares, count), ((measured, fitted), _)| {
            (squares + (measured - fitted).powi(2), count + 1.0)
        });
        let square = squares / f64::max(count, 1.0);
        RESIDUALS.contains(&(square.sqrt() / step)).then(|| {
            // The noise before the rounding, at the lower end of what the residual says of it.
            let noise = (square * (1.0 - 2.0 * (2.0 / f64::max(count, 8.0)).sqrt()) - variance(step)).max(0.0);
            let term = |k: i32| (-2.0 * noise * (PI * f64::from(k) / step).powi(2)).exp() / (PI * f64::from(k));
            Rounding { step, shift: step * (1..=TERMS).map(term).sum::<f64>().min(0.5) }
        })
    };
    steps.iter().zip(curves).map(of_record).collect()
}

/// What each column may be off by because forces are rounded: at most, and the variance of it.
pub(super) fn shifts(
    data: &Data,
    fitted: &Fitted,
    covariance: &Covariance,
    roundings: &[Option<Rounding>],
) -> Vec<[f64; 2]> {
    let columns = data.layout.columns;
    let mut shifts = vec![[0.0; 2]; columns];
    let rows = data.rows(&fitted.values, &fitted.factors);
    let mut row = 0;
    for (record, rounding) in data.records.iter().zip(roundings) {
        let first = row;
        row += record.samples.len();
        let Some(Rounding { step, shift }) = *rounding else { continue };
        // The forces of either direction have a phase of their own.
        for direction in [-1.0, 1.0] {
            let mut gradients = vec![[0.0; 2]; columns];
            for (row, sample) in (first..row).zip(&record.samples) {
                let factor = fitted.factors[row];
                if factor <= 0.0 || record.direction(sample.branch) * direction <= 0.0 {
                    continue;
                }
                let force = sample.force + rows.residual[row] / factor;
                let (sine, cosine) = (TAU * (force / step).fract()).sin_cos();
                for (column, gradient) in gradients.iter_mut().enumerate() {
                    let weighted = factor * shift * rows.jacobian[(row, column)];
                    *gradient = [gradient[0] + weighted * sine, gradient[1] + weighted * cosine];
                }
            }
            for (column, [most, variance]) in shifts.iter_mut().enumerate() {
                let [sine, cosine] = [0, 1].map(|part| {
                    let shares = gradients.iter().enumerate().filter(|(other, _)| covariance.error(*other).is_some());
                    shares.map(|(other, gradient)| covariance.of(column, other) * gradient[part]).sum::<f64>()
                });
                *most += sine.hypot(cosine);
                *variance += 0.5 * (sine * sine + cosine * cosine);
            }
        }
    }
    shifts
}
