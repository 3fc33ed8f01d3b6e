//! The best values: robust against outliers first, least squares of what is left then, within the bounds of the
//! parameters.

use super::least_squares::{Control, Data};
use super::record::{clamp_friction, stiffness};
use super::{Error, Parameter, start};
use crate::robust::{HUBER, OUTLIER, robust_deviation};
use stickslip_mechanics::range;

/// Rounds of weights, each with a search of its own; a safeguard.
const MOST_ROUNDS: usize = 8;
/// What a search may still gain where it has ended, in variances of the residual: a tenth of a standard error.
const SETTLED: f64 = 0.01;
/// A noise that changes by less than this share is known.
const SAME_NOISE: f64 = 1e-2;
/// Residuals below this share of the force are rounding, and leave no point out.
const ROUNDING: f64 = 1e-9;
/// The least noise of a force, over the force.
const LEAST_NOISE: f64 = 1e-14;
/// A compliance below this share of the contact's is tried against none at all.
const LEAST_COMPLIANCE: f64 = 1e-2;

/// The minimum.
#[derive(Clone, Debug)]
pub(super) struct Fitted {
    pub(super) values: Vec<f64>,
    /// Of each sample, one over its standard deviation; zero of outliers.
    pub(super) factors: Vec<f64>,
    /// Sum of squares at the minimum.
    pub(super) cost: f64,
    /// Standard deviation of the force, N.
    pub(super) force_noise: f64,
    /// Columns that lie at a bound.
    pub(super) bound: Vec<usize>,
    /// Whether the search has ended at a minimum, not at its bound of evaluations.
    pub(super) converged: bool,
}

impl Fitted {
    /// Samples that are not outliers.
    pub(super) fn used(&self) -> usize {
        self.factors.iter().filter(|&&factor| factor > 0.0).count()
    }
}

/// Fits, with the noise of the force given or estimated.
pub(super) fn fit(data: &Data, noise: Option<f64>, proceed: &dyn Fn() -> bool) -> Result<Fitted, Error> {
    let force = data.records.iter().map(|record| record.half_force).fold(0.0, f64::max);
    let ones = vec![1.0; data.samples()];
    let values = start::best(data, noise.unwrap_or(0.01 * force).max(LEAST_NOISE * force), proceed)?;
    let mut fitted = Fitted {
        values,
        factors: Vec::new(),
        cost: f64::INFINITY,
        force_noise: 0.0,
        bound: Vec::new(),
        converged: true,
    };
    for robust in [true, false] {
        let control = if robust { Control::rough(proceed) } else { Control::exact(proceed) };
        let mut weights: Option<Vec<f64>> = None;
        for _ in 0..MOST_ROUNDS {
            let rows = data.rows(&fitted.values, &ones);
            let residual = &rows.residual.as_slice()[..ones.len()];
            let spread: Vec<f64> = data
                .records
                .iter()
                .flat_map(|record| std::iter::repeat_n(record.noise, record.samples.len()))
                .zip(&rows.slopes)
                .map(|(noise, slope)| (noise * slope).powi(2))
                .collect();
            let kept = |index: usize| weights.as_ref().is_none_or(|weights| robust || weights[index] > 0.0);
            let total = if robust {
                let mut sizes: Vec<f64> = residual.iter().map(|residual| residual.abs()).collect();
                robust_deviation(&mut sizes).powi(2)
            } else {
                let of = |index: &usize| kept(*index);
                let count = (0..ones.len()).filter(of).count();
                let squares: f64 = (0..ones.len()).filter(of).map(|index| residual[index].powi(2)).sum();
                squares / count.saturating_sub(data.layout.columns).max(1) as f64
            };
            let by_place = spread.iter().sum::<f64>() / spread.len() as f64;
            let own = noise.unwrap_or_else(|| (total - by_place).max(0.01 * total).sqrt()).max(LEAST_NOISE * force);
            let deviation = |index: usize| (own * own + spread[index]).sqrt();
            let limit = |index: usize| deviation(index).max(total.sqrt());
            let weight = |index: usize| {
                let size = residual[index].abs();
                if robust {
                    (HUBER * limit(index) / size.max(f64::MIN_POSITIVE)).min(1.0).sqrt()
                } else {
                    f64::from(u8::from(size <= (OUTLIER * limit(index)).max(ROUNDING * force)))
                }
            };
            if robust || weights.is_none() {
                weights = Some((0..ones.len()).map(weight).collect());
            }
            let known = (fitted.force_noise / own - 1.0).abs() < SAME_NOISE;
            fitted.force_noise = own;
            let of_record =
                data.records.iter().flat_map(|record| std::iter::repeat_n(record.weight, record.samples.len()));
            fitted.factors = weights
                .iter()
                .flatten()
                .zip(of_record)
                .enumerate()
                .map(|(index, (weight, of_record))| weight * of_record.sqrt() / deviation(index))
                .collect();
            let (values, cost, bound) = within_bounds(data, &fitted.values, &fitted.factors, &[], &control)?;
            (fitted.values, fitted.cost, fitted.bound) = (values, cost, bound);
            if known {
                break;
            }
        }
    }
    // From a minimum a new search gains nothing.
    let (values, cost, bound) = within_bounds(data, &fitted.values, &fitted.factors, &[], &Control::rough(proceed))?;
    if cost < fitted.cost {
        let converged = fitted.cost - cost <= SETTLED * (cost / fitted.used().max(1) as f64).max(1.0);
        fitted = Fitted { values, cost, bound, converged, ..fitted };
    }
    Ok(fitted)
}

/// The minimum over all columns but those `held`, within the bounds of the parameters: values, cost, and the columns at
/// bounds.
pub(super) fn within_bounds(
    data: &Data,
    from: &[f64],
    factors: &[f64],
    held: &[usize],
    control: &Control<'_>,
) -> Result<(Vec<f64>, f64, Vec<usize>), Error> {
    let layout = &data.layout;
    let mut free: Vec<usize> = (0..layout.columns).filter(|column| !held.contains(column)).collect();
    let sought = |parameter: Parameter, free: &[usize]| layout.column(parameter).filter(|column| free.contains(column));
    let least = LEAST_COMPLIANCE / stiffness(&data.records[0].contact);
    let mut values = from.to_vec();
    if let Some(column) = sought(Parameter::MachineCompliance, &free) {
        values[column] = values[column].max(1e-3 * least);
    }
    let mut cost = data.minimise(&mut values, factors, &free, control)?;
    let mut bound = Vec::new();
    if let Some(column) = sought(Parameter::MachineCompliance, &free).filter(|&column| values[column] < least) {
        let without: Vec<usize> = free.iter().copied().filter(|&one| one != column).collect();
        let mut rigid = values.clone();
        rigid[column] = 0.0;
        let rigid_cost = data.minimise(&mut rigid, factors, &without, control)?;
        if rigid_cost <= cost {
            (values, cost, free) = (rigid, rigid_cost, without);
            bound.push(column);
        }
    }
    if let Some(column) = sought(Parameter::Friction, &free).filter(|&column| values[column] > range::FRICTION.max) {
        free.retain(|&one| one != column);
        values[column] = clamp_friction(values[column]);
        cost = data.minimise(&mut values, factors, &free, control)?;
        bound.push(column);
    }
    Ok((values, cost, bound))
}
