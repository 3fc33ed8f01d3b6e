//! What uncertain inputs mean for the outputs: distributions, and the share of each input in the variance.

use std::collections::BTreeMap;

use stickslip_wire::sweep::{CheckedSweep, Samples};
use stickslip_wire::{Output, Share, UncertainOutput, UncertaintyReply, Warning};

use super::SweepResult;

/// Fewer base points than this have no distribution.
const FEWEST: usize = 8;

/// The document of a sweep of uncertain inputs.
pub(super) fn uncertainty(result: &SweepResult, sweep: &CheckedSweep, samples: &Samples) -> UncertaintyReply {
    let outputs = &sweep.request.outputs;
    let of_output = |(index, output): (usize, &Output)| {
        let value = |point: usize| result.values.get(point * outputs.len() + index).copied().unwrap_or(f64::NAN);
        distribution(output.column(), samples, value)
    };
    let message =
        || format!("{} of {} points have no result: the numbers are those of the others", result.failed, sweep.points);
    UncertaintyReply {
        outputs: outputs.iter().enumerate().map(of_output).collect(),
        points: sweep.points,
        failed: result.failed,
        failures: result.failures.clone(),
        warnings: (result.failed > 0).then(|| Warning::new("points_failed", message())).into_iter().collect(),
    }
}

fn distribution(name: &str, samples: &Samples, value: impl Fn(usize) -> f64) -> UncertainOutput {
    let stride = samples.stride();
    let rows = |kind: usize| (0..samples.base).map(move |base| base * stride + kind);
    let mut values: Vec<f64> = rows(0).chain(rows(1)).map(&value).filter(|value| value.is_finite()).collect();
    values.sort_by(f64::total_cmp);
    let enough = values.len() >= FEWEST;
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let moment = |power: i32| values.iter().map(|value| (value - mean).powi(power)).sum::<f64>() / count;
    let variance = moment(2) * count / (count - 1.0);
    let deviation = variance.sqrt();
    // The variance of a sample variance is (mu_4 - sigma^4)/n, and that of its root follows to first order.
    let deviation_error = ((moment(4) - moment(2).powi(2)).max(0.0) / count).sqrt() / (2.0 * deviation);
    let share = |input: usize| {
        // Both rows have this input in common and no other.
        let pairs = (0..samples.base).map(|base| (value(base * stride + 1), value(base * stride + input + 2)));
        share(pairs.filter(|(one, other)| one.is_finite() && other.is_finite()).collect(), mean)
    };
    let known = |value: f64| Some(value).filter(|value| enough && value.is_finite());
    UncertainOutput {
        name: name.to_owned(),
        mean: known(mean),
        mean_error: known(deviation / count.sqrt()),
        standard_uncertainty: known(deviation),
        standard_uncertainty_error: known(if deviation > 0.0 { deviation_error } else { 0.0 }),
        interval: known(0.0).map(|_| [0.025, 0.975].map(|part| quantile(&values, part))),
        shares: samples
            .inputs
            .iter()
            .enumerate()
            .map(|(index, input)| (input.name.clone(), share(index)))
            .collect::<BTreeMap<_, _>>(),
    }
}

/// Sobol's index of first order by the correlation of pairs that share one input (Janon et al. 2014), with its standard
/// error to first order.
fn share(pairs: Vec<(f64, f64)>, centre: f64) -> Share {
    let count = pairs.len() as f64;
    let mean = |of: &dyn Fn(f64, f64) -> f64| pairs.iter().map(|(one, other)| of(*one, *other)).sum::<f64>() / count;
    // About a value near the mean, so that squares of large numbers are not subtracted.
    let offset = mean(&|one, other| 0.5 * ((one - centre) + (other - centre)));
    let of = |value: f64| value - centre - offset;
    let product = mean(&|one, other| of(one) * of(other));
    let square = mean(&|one, other| 0.5 * (of(one).powi(2) + of(other).powi(2)));
    let value = product / square;
    let influence =
        |one: f64, other: f64| (of(one) * of(other) - 0.5 * value * (of(one).powi(2) + of(other).powi(2))) / square;
    let error = (mean(&|one, other| influence(one, other).powi(2)) / count).sqrt();
    let known = |number: f64| Some(number).filter(|number| pairs.len() >= FEWEST && number.is_finite());
    Share { value: known(value), standard_error: known(error) }
}

/// The value below which this part of sorted values lies, straight between two of them.
fn quantile(sorted: &[f64], part: f64) -> f64 {
    let place = part * sorted.len().saturating_sub(1) as f64;
    let below = place.floor() as usize;
    let at = |index: usize| sorted.get(index).or(sorted.last()).copied().unwrap_or(f64::NAN);
    at(below) + (at(below + 1) - at(below)) * (place - place.floor())
}
