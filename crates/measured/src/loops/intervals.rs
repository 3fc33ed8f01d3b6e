//! How surely the values are known: standard errors from the Jacobian, intervals by profile likelihood.

use nalgebra::{DMatrix, DVector};

use super::Error;
use super::fit::{Fitted, within_bounds};
use super::least_squares::{Control, Data};

/// The 97.5 % quantile of the normal distribution.
const NORMAL_QUANTILE: f64 = 1.959_963_984_540_054;
/// Directions in which the sum of squares changes by less than this share of the most are not determined.
const NULL: f64 = 1e-11;
/// The root of the rise of the sum of squares is met within this share.
const MET: f64 = 0.01;
/// The correlations are followed up to this logarithm of a factor.
const MOST_GUESSED: f64 = 1.0;
/// Steps to one end of an interval.
const MOST_STEPS: usize = 16;
/// The least factor of a step that has not come to the end.
const LEAST_GROWTH: f64 = 1.2;
/// An interval ends nowhere if it is wider than this factor to one side of a positive value, or this many standard
/// errors.
const WIDEST: f64 = 1e3;

/// Covariances of the columns; `None` where data and priors leave a column open.
pub(super) struct Covariance {
    matrix: DMatrix<f64>,
    open: Vec<bool>,
}

impl Covariance {
    /// Of the minimum.
    pub(super) fn new(data: &Data, fitted: &Fitted) -> Result<Covariance, Error> {
        let rows = data.rows(&fitted.values, &fitted.factors);
        let size = |column: usize| {
            let value = fitted.values[column].abs();
            if data.logarithmic(column) && value > 0.0 { value } else { data.scales[column] }
        };
        let columns = data.layout.columns();
        if columns == 0 {
            return Ok(Covariance { matrix: DMatrix::zeros(0, 0), open: Vec::new() });
        }
        let mut jacobian = rows.jacobian;
        let norms: Vec<f64> = (0..columns).map(|column| jacobian.column(column).norm()).collect();
        for (column, norm) in norms.iter().enumerate() {
            if *norm > 0.0 {
                jacobian.column_mut(column).scale_mut(1.0 / norm);
            }
        }
        let decomposition = jacobian.svd(false, true);
        let (singular, right) = (&decomposition.singular_values, decomposition.v_t.ok_or(Error::NoSolution)?);
        let most = singular.max();
        let mut matrix: DMatrix<f64> = DMatrix::zeros(columns, columns);
        let mut open = vec![false; columns];
        for (direction, &value) in singular.iter().enumerate() {
            let row = right.row(direction);
            if value <= NULL * most {
                open.iter_mut().zip(row.iter()).for_each(|(open, share)| *open |= share.abs() > 1e-3);
                continue;
            }
            for a in 0..columns {
                for b in 0..columns {
                    let norms = norms[a].max(f64::MIN_POSITIVE) * norms[b].max(f64::MIN_POSITIVE);
                    matrix[(a, b)] += row[a] * row[b] / (value * value) / norms;
                }
            }
        }
        for column in 0..columns {
            open[column] |= norms[column] * size(column) <= NULL || !matrix[(column, column)].is_finite();
        }
        Ok(Covariance { matrix, open })
    }

    /// Standard error of a column.
    pub(super) fn error(&self, column: usize) -> Option<f64> {
        (!self.open[column]).then(|| self.matrix[(column, column)].max(0.0).sqrt())
    }

    /// Correlation of two columns, between -1 and 1.
    pub(super) fn correlation(&self, a: usize, b: usize) -> Option<f64> {
        if a == b {
            return self.error(a).map(|_| 1.0);
        }
        let errors = self.error(a)? * self.error(b)?;
        (errors > 0.0).then(|| (self.matrix[(a, b)] / errors).clamp(-1.0, 1.0))
    }

    /// The product with a column of numbers.
    pub(super) fn times(&self, column: &DVector<f64>) -> DVector<f64> {
        &self.matrix * column
    }

    /// Covariance of two columns.
    pub(super) fn of(&self, a: usize, b: usize) -> f64 {
        self.matrix[(a, b)]
    }
}

/// The interval of a column at 95 %, by profile likelihood: where the least sum of squares over all other columns has
/// risen by the square of the quantile. `None` at an end that the data leave open.
pub(super) fn interval(
    data: &Data,
    fitted: &Fitted,
    column: usize,
    covariance: &Covariance,
    noise_known: bool,
    proceed: &dyn Fn() -> bool,
) -> Result<[Option<f64>; 2], Error> {
    let Some(error) = covariance.error(column) else { return Ok([None; 2]) };
    let quantile = quantile(fitted.used().saturating_sub(data.layout.columns()), noise_known);
    let value = fitted.values[column];
    let from_zero = data.layout.parameters[column].is_some_and(|one| data.may_be_zero(one, &fitted.values));
    let logarithmic = data.logarithmic(column) && !from_zero;
    let at = |step: f64| if logarithmic { value * step.exp() } else { value + step };
    let first = if logarithmic { (quantile * error / value).min(1.0) } else { quantile * error };
    let widest = if logarithmic { WIDEST.ln() } else { WIDEST * quantile * error };
    let mut ends = [None; 2];
    for (end, sign) in ends.iter_mut().zip([-1.0, 1.0]) {
        let floor = if from_zero && sign < 0.0 { value } else { f64::INFINITY };
        // Where the last step below the quantile ended: the valley is followed from there.
        let mut nearest = fitted.values.clone();
        // Steps with the roots of the rise below and above the quantile.
        let (mut low, mut high) = ((0.0, 0.0), None);
        let mut step = first.min(floor);
        for count in 0..MOST_STEPS {
            if step <= 0.0 {
                *end = Some(at(0.0));
                break;
            }
            let from = along(data, &nearest, (column, at(sign * step)), covariance);
            let (found, cost) = match within_bounds(data, &from, &fitted.factors, &[column], &Control::rough(proceed)) {
                Ok((found, cost, _)) => (found, cost),
                Err(Error::Interrupted) => return Err(Error::Interrupted),
                Err(_) => (from, f64::INFINITY),
            };
            let root = (cost - fitted.cost).max(0.0).sqrt();
            // A rise that is nearly there and levels off may be far from its end.
            let is_end = count == 0 || high.is_some() || root >= quantile;
            if is_end && (root / quantile - 1.0).abs() < MET {
                *end = Some(at(sign * step));
                break;
            }
            if root < quantile {
                low = (step, root);
                nearest = found;
                if step >= floor {
                    *end = Some(at(-floor));
                    break;
                }
                if step >= widest {
                    break;
                }
            } else {
                high = Some((step, root));
            }
            step = match high {
                Some(high) if high.1.is_finite() => {
                    let between = low.0 + (high.0 - low.0) * (quantile - low.1) / (high.1 - low.1);
                    // Not so near to either end that a curved root makes it creep.
                    between.clamp(0.9 * low.0 + 0.1 * high.0, 0.1 * low.0 + 0.9 * high.0)
                }
                Some(high) => 0.5 * (low.0 + high.0),
                None => (step * (quantile / root.max(0.25 * quantile)).max(LEAST_GROWTH)).min(floor).min(widest),
            };
            *end = high.map(|high| at(sign * 0.5 * (low.0 + high.0)));
        }
    }
    Ok(ends)
}

/// Values with one column at a new value, and the others where the correlations lead.
fn along(data: &Data, values: &[f64], (column, value): (usize, f64), covariance: &Covariance) -> Vec<f64> {
    let by = |other: usize| covariance.of(other, column) / covariance.of(column, column);
    let logarithmic = |column: usize| data.logarithmic(column) && values[column] > 0.0;
    let (old, growing) = (values[column], logarithmic(column) && value > 0.0);
    let change = if growing { old * (value / old).ln() } else { value - old };
    let moved = |(other, &now): (usize, &f64)| {
        let step = by(other) * change;
        if other == column {
            value
        } else if covariance.open[other] {
            now
        } else if logarithmic(other) {
            now * (step / now).clamp(-MOST_GUESSED, MOST_GUESSED).exp()
        } else {
            now + step
        }
    };
    values.iter().enumerate().map(moved).collect()
}

/// Student's 97.5 % quantile, by the first terms of its expansion about the normal one (Fisher & Cornish 1960).
fn quantile(freedom: usize, noise_known: bool) -> f64 {
    let (z, freedom) = (NORMAL_QUANTILE, freedom.max(2) as f64);
    if noise_known {
        return z;
    }
    z + (z.powi(3) + z) / (4.0 * freedom) + (5.0 * z.powi(5) + 16.0 * z.powi(3) + 3.0 * z) / (96.0 * freedom * freedom)
}
