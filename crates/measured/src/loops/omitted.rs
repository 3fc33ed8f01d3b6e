//! What a fit leaves out: the score test of each parameter that is not free, and what each would shift.
//!
//! At the minimum the residual e is orthogonal to the Jacobian J of what is sought. The column k of a parameter that is
//! not, less its projection c = (J'J)^-1 J'k on J, leaves q = k - J c, and one Gauss-Newton step with that parameter
//! too changes it by t = -q'e/q'q and the others by -c t. Its score z is t over its standard error (Rao 1948), by the
//! residual that this step leaves. Where q is small beside k, the data do not distinguish the parameter from others: it
//! has no score then, yet -c times any value of it is what the others are off by.

use super::fit::Fitted;
use super::intervals::Covariance;
use super::least_squares::Data;
use super::parameter::is_of;
use super::quantised::Waves;
use super::record::stiffness;
use super::{Estimate, LoopFit, Omitted, Parameter, Sensitivity, Start};

/// A score beyond so many standard errors is no accident.
pub(super) const SIGNIFICANT: f64 = 4.0;
/// A column that keeps less than this share of its square beside the others is not distinguished from them.
const DISTINCT: f64 = 1e-5;
/// The least noise of a force, over the force: no sensor is better.
const LEAST_NOISE: f64 = 1e-5;
/// The small change of which the effect is stated, over the size of the record.
const SMALL: f64 = 0.01;

/// The tests of one fit.
pub(super) struct Tests {
    pub(super) omitted: Vec<Omitted>,
    pub(super) sensitivity: Vec<Sensitivity>,
}

impl Tests {
    pub(super) fn new(data: &Data, fitted: &Fitted, covariance: &Covariance, waves: &Waves) -> Tests {
        let tested = tested(data);
        let own = data.layout.columns();
        let sought: Vec<(usize, Parameter)> = data.layout.sought().collect();
        let extended = extended(data, &tested);
        let mut values = fitted.values.clone();
        values.extend(tested.iter().map(|parameter| data.layout.held[*parameter as usize]));
        let rows = extended.rows(&values, &fitted.factors);
        let (residual, jacobian) = (rows.residual, rows.jacobian);
        let sought_by = jacobian.columns(0, own);
        let freedom = fitted.used().saturating_sub(own + 1).max(1) as f64;
        let half_force = data.records.iter().map(|record| record.half_force).fold(0.0, f64::max);
        let least = LEAST_NOISE * half_force * fitted.factors.iter().copied().fold(0.0, f64::max);
        let (mut omitted, mut sensitivity) = (Vec::new(), Vec::new());
        for (index, &parameter) in tested.iter().enumerate() {
            let column = jacobian.column(own + index);
            let projected = covariance.times(&sought_by.tr_mul(&column));
            let rest = column - sought_by * &projected;
            let size = rest.norm_squared();
            let shift = |change: f64| sought.iter().map(|&(place, one)| (one, -projected[place] * change)).collect();
            let distinct = size > DISTINCT * column.norm_squared();
            let step = if distinct { -rest.dot(&residual) / size } else { 0.0 };
            let deviation = ((&residual + &rest * step).norm_squared() / freedom).sqrt().max(least);
            // What rounding may do to the step does not average out.
            let [by_rounding, _] = waves.shift(|wave| rest.dot(wave) / size);
            let z = distinct.then(|| step / (deviation / size.sqrt()).hypot(by_rounding));
            let known_value = data.layout.held[parameter as usize] + step;
            let value = z.filter(|_| has_unit(data, parameter)).map(|_| known_value);
            omitted.push(Omitted { parameter, value, z, shifts: z.map_or_else(Vec::new, |_| shift(step)) });
            if let Some(change) = small_change(data, parameter) {
                let stated = has_unit(data, parameter).then_some(change);
                sensitivity.push(Sensitivity { parameter, change: stated, shifts: shift(change) });
            }
        }
        Tests { omitted, sensitivity }
    }
}

/// The parameters that are not sought, of those with the same effect the first.
fn tested(data: &Data) -> Vec<Parameter> {
    let profile = data.records[0].contact.profile();
    let mut stiffness_named = data.layout.sought().any(|(_, parameter)| parameter.power_of_stiffness() != 0);
    let is_tested = |&parameter: &Parameter| {
        let of_stiffness = parameter.power_of_stiffness() != 0;
        let again = of_stiffness && stiffness_named;
        stiffness_named |= of_stiffness;
        data.layout.column(parameter).is_none() && is_of(parameter, profile) && !again
    };
    Parameter::ALL.into_iter().filter(is_tested).collect()
}

/// The data with further parameters, in columns behind the others.
fn extended(data: &Data, parameters: &[Parameter]) -> Data {
    let mut extended = data.clone();
    for &parameter in parameters {
        if parameter == Parameter::Drift {
            let column = extended.layout.columns();
            for prior in extended.priors.iter_mut().filter(|prior| prior.time.abs() > 0.0) {
                prior.terms.push((column, prior.time));
                prior.value += prior.time * data.layout.held[Parameter::Drift as usize];
            }
        }
        extended.layout.parameters.push(Some(parameter));
        extended.scales.push(1.0);
    }
    extended
}

/// Whether numbers of a parameter have a unit: without times, points are counted.
fn has_unit(data: &Data, parameter: Parameter) -> bool {
    !parameter.needs_time() || data.records.iter().all(|record| record.timed)
}

/// A delay of one sample, an offset of one percent, and so on; `None` of what belongs to the contact.
fn small_change(data: &Data, parameter: Parameter) -> Option<f64> {
    let record = &data.records[0];
    let (first, last) = (record.samples.first()?, record.samples.last()?);
    let duration = last.time - first.time;
    let way = 0.5 * (record.extremes[0].displacement - record.extremes[1].displacement);
    let virgin = data.records.iter().any(|record| record.start == Start::Virgin);
    match parameter {
        Parameter::Delay => (duration > 0.0).then_some(record.step),
        Parameter::ForceOffset => Some(SMALL * record.half_force),
        Parameter::DisplacementOffset => virgin.then_some(SMALL * way),
        Parameter::Drift => (duration > 0.0).then_some(SMALL * way / duration),
        Parameter::GainDrift => (duration > 0.0).then_some(SMALL / duration),
        Parameter::MachineCompliance => Some(SMALL / stiffness(&record.contact)),
        Parameter::Friction | Parameter::GStar | Parameter::EStar | Parameter::Radius | Parameter::ShearStrength => {
            None
        }
    }
}

impl Omitted {
    /// Whether the data show that the parameter is not what it was taken for.
    #[must_use]
    pub fn is_significant(&self) -> bool {
        // No machine has a negative compliance, and no interface a negative strength: something else is wrong then.
        let is_positive = matches!(self.parameter, Parameter::MachineCompliance | Parameter::ShearStrength);
        let possible = !is_positive || self.value.is_none_or(|value| value > 0.0);
        possible && self.z.is_some_and(|z| z.abs() > SIGNIFICANT)
    }
}

impl LoopFit {
    /// The interval of an estimate at 95 %, in its SI unit, that holds small errors of the bench too: a force that
    /// comes late by up to one sample, an offset of up to 1 % and a gain that drifts by up to 1 % either way; `None`
    /// where an end is open. A force that comes early is not among them: friction does not change in proportion to it.
    /// A positive estimate changes by factors, as its logarithm is nearer to linear.
    #[must_use]
    pub fn interval_with_bench(&self, estimate: &Estimate) -> Option<[f64; 2]> {
        let of_bench = |one: &&Sensitivity| {
            matches!(one.parameter, Parameter::Delay | Parameter::ForceOffset | Parameter::GainDrift)
        };
        let shifts = self.sensitivity.iter().filter(of_bench).flat_map(|one| &one.shifts);
        let own = shifts.filter(|(parameter, _)| *parameter == estimate.parameter);
        let shift: f64 = own.map(|(_, shift)| shift.abs()).sum();
        let [low, high] = [estimate.interval[0]?, estimate.interval[1]?];
        if estimate.parameter.positive() && estimate.value > 0.0 {
            let factor = (shift / estimate.value).exp();
            return Some([low / factor, high * factor]);
        }
        Some([low - shift, high + shift])
    }
}
