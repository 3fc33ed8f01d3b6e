//! Forces and displacements in steps: how large they are, and by how much their rounding may shift the values of a fit.
//!
//! A converter rounds a force to the nearest multiple of its step q. Noise of standard deviation s before it makes the
//! rounding random, with a variance of q^2/12, but for its mean, which over the force F is -sum (-1)^k q/(pi k) exp(-2
//! pi^2 k^2 s^2/q^2) sin(2 pi k F/q) (Widrow, Kollár & Liu 1996): at s = q/3 some 4 % of a step, for all points that
//! have one force, as those of gross slip do. No number of points averages it out. At worst it is a wave over the force
//! of any phase; what that shifts each value by follows from the Jacobian.

use std::f64::consts::{PI, TAU};

use super::Curve;
use super::fit::Fitted;
use super::intervals::Covariance;
use super::least_squares::Data;
use super::record::Branches;
use crate::steps::step;
use nalgebra::DVector;

/// Residuals of fewer steps are not those of rounding; those of more hide it.
const RESIDUALS: std::ops::Range<f64> = 0.1..0.7;
/// The share of equal moves from which on a displacement was set.
const SET_SHARE: f64 = 0.9;
/// Steps of the displacement matter if what they change the force by, where nothing slips, exceeds this share of the
/// residual.
const LEAST_EFFECT: f64 = 0.5;
/// Terms of the mean error of rounding.
const TERMS: i32 = 8;

/// The variance of the rounding to a step.
pub(super) fn variance(step: f64) -> f64 {
    step * step / 12.0
}

/// The step of a displacement that a converter has rounded, m: one that moves by equal steps was set to them, and is
/// exact.
pub(super) fn displacement_step(displacement: &[f64]) -> Option<f64> {
    let step = step(displacement)?;
    let moved = |pair: &[f64]| ((pair[1] - pair[0]) / step).abs().round() as u64;
    let mut moves: Vec<u64> = displacement.windows(2).map(moved).collect();
    moves.sort_unstable();
    let most = moves.chunk_by(|a, b| a == b).map(<[u64]>::len).max().unwrap_or(0);
    ((most as f64) < SET_SHARE * moves.len() as f64).then_some(step)
}

/// A column of a record whose steps matter: the step, and the largest mean error of its rounding, in the unit of the
/// column.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rounding {
    step: f64,
    shift: f64,
}

/// The columns of a record whose steps matter.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Roundings {
    pub(super) force: Option<Rounding>,
    pub(super) displacement: Option<Rounding>,
}

/// The rounding of each record, where its residual shows that the step is not far below the noise; `steps` are those of
/// the forces, `stiffness` that of the fitted contact, N/m.
pub(super) fn roundings(data: &Data, steps: &[Option<f64>], curves: &[Curve], stiffness: f64) -> Vec<Roundings> {
    let of_record = |(record, (step, curve)): (&Branches, (&Option<f64>, &Curve))| {
        let used = curve.measured.iter().zip(&curve.fitted).zip(&curve.used).filter(|(_, used)| **used);
        let (squares, count) = used.fold((0.0, 0.0), |(squares, count), ((measured, fitted), _)| {
            (squares + (measured - fitted).powi(2), count + 1.0)
        });
        let square = squares / f64::max(count, 1.0);
        let of_force = |step: f64| {
            // The noise before the rounding, at the lower end of what the residual says of it.
            let noise = (square * (1.0 - 2.0 * (2.0 / f64::max(count, 8.0)).sqrt()) - variance(step)).max(0.0);
            let term = |k: i32| (-2.0 * noise * (PI * f64::from(k) / step).powi(2)).exp() / (PI * f64::from(k));
            Rounding { step, shift: step * (1..=TERMS).map(term).sum::<f64>().min(0.5) }
        };
        // The noise of a displacement that moves all the time says nothing of how it was rounded: at worst by half.
        let of_displacement = |step: f64| Rounding { step, shift: 0.5 * step };
        Roundings {
            force: step.filter(|step| RESIDUALS.contains(&(square.sqrt() / step))).map(of_force),
            displacement: record
                .displacement_step
                .filter(|step| step * stiffness > LEAST_EFFECT * square.sqrt())
                .map(of_displacement),
        }
    };
    data.records.iter().zip(steps.iter().zip(curves)).map(of_record).collect()
}

/// The mean errors of rounding as waves over force or displacement, of any phase: rows of their sines and cosines, one
/// pair for each record, column and direction.
pub(super) struct Waves(Vec<[DVector<f64>; 2]>);

impl Waves {
    pub(super) fn new(data: &Data, fitted: &Fitted, roundings: &[Roundings]) -> Waves {
        if roundings.iter().all(|of| of.force.is_none() && of.displacement.is_none()) {
            return Waves(Vec::new());
        }
        let rows = data.rows(&fitted.values, &fitted.factors);
        let (mut waves, mut first) = (Vec::new(), 0);
        for (record, roundings) in data.records.iter().zip(roundings) {
            let range = first..first + record.samples.len();
            first = range.end;
            for (rounding, is_force) in [(roundings.force, true), (roundings.displacement, false)] {
                let Some(Rounding { step, shift }) = rounding else { continue };
                // The values of either direction have a phase of their own.
                for direction in [-1.0, 1.0] {
                    let mut wave = [DVector::zeros(rows.residual.len()), DVector::zeros(rows.residual.len())];
                    for (row, sample) in range.clone().zip(&record.samples) {
                        let factor = fitted.factors[row];
                        if factor <= 0.0 || record.direction(sample.branch) * direction <= 0.0 {
                            continue;
                        }
                        let (value, effect) = if is_force {
                            (sample.force + rows.residual[row] / factor, 1.0)
                        } else {
                            (sample.measured, rows.slopes[row])
                        };
                        let (sine, cosine) = (TAU * (value / step).fract()).sin_cos();
                        wave[0][row] = factor * shift * effect * sine;
                        wave[1][row] = factor * shift * effect * cosine;
                    }
                    waves.push(wave);
                }
            }
        }
        Waves(waves)
    }

    /// What a sum over the rows may be off by because values are rounded: at most, and the variance of it.
    pub(super) fn shift(&self, sum: impl Fn(&DVector<f64>) -> f64) -> [f64; 2] {
        self.0.iter().fold([0.0; 2], |[most, variance], wave| {
            let [sine, cosine] = wave.each_ref().map(&sum);
            [most + sine.hypot(cosine), variance + 0.5 * (sine * sine + cosine * cosine)]
        })
    }

    /// The same of each column.
    pub(super) fn shifts(&self, data: &Data, fitted: &Fitted, covariance: &Covariance) -> Vec<[f64; 2]> {
        let columns = data.layout.columns();
        if self.0.is_empty() {
            return vec![[0.0; 2]; columns];
        }
        let jacobian = data.rows(&fitted.values, &fitted.factors).jacobian;
        let determined = |column: &usize| covariance.error(*column).is_some();
        let gradient = |wave: &DVector<f64>, column: usize| {
            let shares = (0..columns)
                .filter(determined)
                .map(|other| covariance.of(column, other) * jacobian.column(other).dot(wave));
            shares.sum::<f64>()
        };
        (0..columns).map(|column| self.shift(|wave| gradient(wave, column))).collect()
    }
}
