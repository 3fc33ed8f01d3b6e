//! The best values: robust against outliers first, least squares of what is left then, within the bounds of the
//! parameters.

use super::least_squares::{Control, Data, Rows};
use super::record::{Branches, area, clamp_friction, stiffness};
use super::{Error, Noise, Parameter, start};
use crate::robust::{HUBER, OUTLIER, robust_deviation};
use stickslip_mechanics::range;

/// Rounds of weights, each with a search of its own; a safeguard.
const MOST_ROUNDS: usize = 8;
/// What a search may still gain where it has ended, in variances of the residual: a tenth of a standard error.
const SETTLED: f64 = 0.01;
/// A noise that changes by less than this share is known.
const SAME_NOISE: f64 = 1e-2;
/// A fit whose sum of squares has moved by less than this is the same.
const SAME_FIT: f64 = 1e-2;
/// Residuals below this share of the force are rounding, and leave no point out.
const ROUNDING: f64 = 1e-9;
/// The least noise of a force, over the force.
const LEAST_NOISE: f64 = 1e-14;
/// The least variance of a force, over that of the residual.
const LEAST_SHARE: f64 = 1e-4;
/// Steps to the variances, each with the weights of the last.
const VARIANCE_STEPS: usize = 10;
/// Slopes that differ less than this, squared and relative, do not show which noise is that of the displacement.
const LEAST_CONTRAST: f64 = 1e-3;
/// A sample was not farther from where it was measured than this many standard deviations.
const MOST_SHIFT: f64 = 3.0;
/// A compliance below this share of the contact's, and a friction or a shear strength that carries less than this share
/// of the force, is tried against none at all.
const LEAST: f64 = 1e-2;

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
    /// Variance of the displacement, over the largest that it may have.
    pub(super) displacement_share: f64,
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

/// Fits, with the noise of force and displacement given or estimated.
pub(super) fn fit(data: &mut Data, noise: Noise, proceed: &dyn Fn() -> bool) -> Result<Fitted, Error> {
    let force = data.records.iter().map(|record| record.half_force).fold(0.0, f64::max);
    let ones = vec![1.0; data.samples()];
    let values = start::best(data, noise.force.unwrap_or(0.01 * force).max(LEAST_NOISE * force), proceed)?;
    let mut fitted = Fitted {
        values,
        factors: Vec::new(),
        cost: f64::INFINITY,
        force_noise: 0.0,
        displacement_share: 1.0,
        bound: Vec::new(),
        converged: true,
    };
    for robust in [true, false] {
        let control = if robust { Control::rough(proceed) } else { Control::exact(proceed) };
        let (mut weights, mut last): (Option<Vec<f64>>, Option<Vec<f64>>) = (None, None);
        for _ in 0..MOST_ROUNDS {
            let rows = data.rows(&fitted.values, &ones);
            let by_place = project(data, &fitted, &rows);
            let rows =
                if by_place.iter().any(|variance| *variance > 0.0) { data.rows(&fitted.values, &ones) } else { rows };
            let residual = &rows.residual.as_slice()[..ones.len()];
            let moved = last.as_ref().map_or(f64::INFINITY, |last| {
                let change = |((now, last), factor): ((&f64, &f64), &f64)| ((now - last) * factor).powi(2);
                residual.iter().zip(last).zip(&fitted.factors).map(change).sum()
            });
            last = Some(residual.to_vec());
            let kept = |index: &usize| robust || weights.as_ref().is_none_or(|weights| weights[*index] > 0.0);
            let squares = |index: usize| [residual[index].powi(2), by_place[index]];
            let squares: Vec<[f64; 2]> = (0..ones.len()).filter(kept).map(squares).collect();
            let freedom = squares.len().saturating_sub(data.layout.columns()).max(1) as f64 / squares.len() as f64;
            let given = noise.force.map(|noise| noise * noise);
            let [own, share] =
                variances(&squares, if robust { 1.0 } else { freedom }, given, noise.displacement.is_some());
            let own = own.sqrt().max(LEAST_NOISE * force);
            let deviation = |index: usize| (own * own + share * by_place[index]).sqrt();
            // Of a fit that is not good, all points are not outliers.
            let typical = {
                let mut sizes: Vec<f64> =
                    (0..ones.len()).map(|index| residual[index].abs() / deviation(index)).collect();
                robust_deviation(&mut sizes).max(1.0)
            };
            let limit = |index: usize| typical * deviation(index);
            let weight = |index: usize| {
                let size = residual[index].abs();
                if robust {
                    (HUBER * limit(index) / size.max(f64::MIN_POSITIVE)).min(1.0).sqrt()
                } else {
                    f64::from(u8::from(size <= (OUTLIER * limit(index)).max(ROUNDING * force)))
                }
            };
            let is_first = weights.is_none();
            if robust || is_first {
                weights = Some((0..ones.len()).map(weight).collect());
            }
            // The first noise has outliers in it.
            let known = !is_first && moved < SAME_FIT && (fitted.force_noise / own - 1.0).abs() < SAME_NOISE;
            (fitted.force_noise, fitted.displacement_share) = (own, share);
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

/// Moves each sample to where its displacement most likely was, and returns the variance that the largest noise of the
/// displacement gives its force, N^2.
///
/// Slope and gradient where the sample was measured depend on its noise, and would draw the fit to one side: so both
/// are those of the point of the curve that is nearest in units of both noises (Deming 1943).
fn project(data: &mut Data, fitted: &Fitted, rows: &Rows) -> Vec<f64> {
    let of_record = |record: &Branches| std::iter::repeat_n(record.noise, record.samples.len());
    let noises: Vec<f64> = data.records.iter().flat_map(of_record).collect();
    let mut sizes: Vec<f64> = rows.residual.as_slice()[..noises.len()].iter().map(|residual| residual.abs()).collect();
    let negligible = LEAST_SHARE.sqrt() * robust_deviation(&mut sizes);
    if noises.iter().zip(&rows.slopes).all(|(noise, slope)| noise * slope <= negligible) {
        return vec![0.0; noises.len()];
    }
    let ones = vec![1.0; noises.len()];
    let slopes_beside = |sign: f64| {
        let mut moved = data.clone();
        moved.samples_mut().zip(&noises).for_each(|(sample, noise)| sample.shift += sign * noise);
        moved.rows(&fitted.values, &ones).slopes
    };
    // Over the noise the slope has a mean, even where the contact begins to slide.
    let (below, above) = (slopes_beside(-1.0), slopes_beside(1.0));
    let slopes: Vec<f64> = (0..noises.len())
        .map(|index| ((rows.slopes[index].powi(2) + below[index].powi(2) + above[index].powi(2)) / 3.0).sqrt())
        .collect();
    if fitted.force_noise > 0.0 {
        for (index, sample) in data.samples_mut().enumerate() {
            let (noise, slope) = (fitted.displacement_share.sqrt() * noises[index], slopes[index]);
            let variance = fitted.force_noise.powi(2) + (noise * slope).powi(2);
            let residual = rows.residual[index] + sample.by_shift;
            let shift = noise * noise * slope * (slope * sample.shift - residual) / variance;
            sample.shift = shift.clamp(-MOST_SHIFT * noise, MOST_SHIFT * noise);
        }
        let slopes = data.rows(&fitted.values, &ones).slopes;
        data.samples_mut().zip(slopes).for_each(|(sample, slope)| sample.by_shift = slope * sample.shift);
    }
    slopes.iter().zip(&noises).map(|(slope, noise)| (slope * noise).powi(2)).collect()
}

/// The variance of the force, and the share of the largest variance of the displacement that there is: of residuals
/// with a variance of a + b x, from pairs of their squares and x, by weighted least squares. `freedom` is the share of
/// the residuals that the parameters leave.
fn variances(pairs: &[[f64; 2]], freedom: f64, given: Option<f64>, share_known: bool) -> [f64; 2] {
    let count = pairs.len() as f64;
    let mut sizes: Vec<f64> = pairs.iter().map(|[square, _]| square.sqrt()).collect();
    let total = robust_deviation(&mut sizes).powi(2) / freedom;
    let by_place = pairs.iter().map(|[_, by_place]| by_place).sum::<f64>() / count;
    let least = LEAST_SHARE * total;
    let (mut own, mut share) = (given.unwrap_or_else(|| (total - by_place).max(0.01 * total)), 1.0);
    if given.is_some() && share_known {
        return [own, share];
    }
    for _ in 0..VARIANCE_STEPS {
        let mut sums = [0.0; 5];
        for &[square, x] in pairs {
            let variance = (own + share * x).max(f64::MIN_POSITIVE);
            let square = (square / variance / freedom).min(OUTLIER * OUTLIER);
            let (a, b) = (1.0 / variance, x / variance);
            for (sum, term) in sums.iter_mut().zip([a * a, a * b, b * b, a * square, b * square]) {
                *sum += term;
            }
        }
        let [aa, ab, bb, ay, by] = sums;
        if !share_known {
            let determinant = aa * bb - ab * ab;
            let free = match given {
                _ if bb <= 0.0 => 0.0,
                Some(own) => (by - ab * own) / bb,
                None if determinant > LEAST_CONTRAST * aa * bb => (aa * by - ab * ay) / determinant,
                None => 1.0,
            };
            share = if free.is_finite() { free.clamp(0.0, 1.0) } else { 1.0 };
        }
        own = given.unwrap_or_else(|| ((ay - ab * share) / aa).max(least));
    }
    [own, share]
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
    let mut free: Vec<usize> = (0..layout.columns()).filter(|column| !held.contains(column)).collect();
    let sought = |parameter: Parameter, free: &[usize]| layout.column(parameter).filter(|column| free.contains(column));
    let contact = &data.records[0].contact;
    let force = data.records.iter().map(|record| record.half_force).fold(0.0, f64::max);
    let with_strength = layout.value(from, Parameter::ShearStrength) > 0.0
        || layout.column(Parameter::ShearStrength).is_some_and(|column| free.contains(&column));
    let friction = with_strength.then_some((Parameter::Friction, LEAST * force / contact.normal_force()));
    let from_zero = [
        (Parameter::MachineCompliance, LEAST / stiffness(contact)),
        (Parameter::ShearStrength, LEAST * force / area(contact)),
    ];
    let from_zero = from_zero.into_iter().chain(friction);
    let mut values = from.to_vec();
    for (parameter, least) in from_zero.clone() {
        if let Some(column) = sought(parameter, &free) {
            values[column] = values[column].max(1e-3 * least);
        }
    }
    let mut cost = data.minimise(&mut values, factors, &free, control)?;
    let mut bound = Vec::new();
    for (parameter, least) in from_zero {
        let Some(column) = sought(parameter, &free).filter(|&column| values[column] < least) else { continue };
        if !data.may_be_zero(parameter, &values) {
            continue;
        }
        let without: Vec<usize> = free.iter().copied().filter(|&one| one != column).collect();
        let mut zero = values.clone();
        zero[column] = 0.0;
        let zero_cost = data.minimise(&mut zero, factors, &without, control)?;
        if zero_cost <= cost {
            (values, cost, free) = (zero, zero_cost, without);
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
