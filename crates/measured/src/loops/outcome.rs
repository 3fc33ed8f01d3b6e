//! From the minimum to what is reported: estimates, residual, curves, the fitted contact.

use stickslip_mechanics::profile::Profile;
use stickslip_mechanics::{Contact, Elasticity, Friction, Preload, Setup, Sphere, range};

use super::fit::Fitted;
use super::identifiable::identifiable;
use super::intervals::{Covariance, interval};
use super::least_squares::Data;
use super::omitted::Tests;
use super::quantised::{Roundings, Waves};
use super::randomness::Randomness;
use super::{Curve, Error, Estimate, Parameter, Residual, Task};

/// How surely the values of a fit are known.
pub(super) struct Uncertainty {
    pub(super) estimates: Vec<Estimate>,
    pub(super) correlations: Vec<Vec<Option<f64>>>,
    pub(super) identifiable: Vec<String>,
    pub(super) tests: Tests,
}

impl Uncertainty {
    pub(super) fn new(
        task: &Task,
        data: &Data,
        fitted: &Fitted,
        roundings: &[Roundings],
        proceed: &dyn Fn() -> bool,
    ) -> Result<Uncertainty, Error> {
        let covariance = Covariance::new(data, fitted)?;
        let mut estimates = estimates(task, data, fitted, &covariance, proceed)?;
        let waves = Waves::new(data, fitted, roundings);
        let shifts = waves.shifts(data, fitted, &covariance);
        for estimate in &mut estimates {
            let Some(column) = data.layout.column(estimate.parameter) else { continue };
            let ([most, variance], [low, high]) = (shifts[column], estimate.interval);
            let least = if estimate.parameter.positive() { 0.0 } else { f64::NEG_INFINITY };
            estimate.standard_error = estimate.standard_error.map(|error| (error * error + variance).sqrt());
            estimate.interval = [low.map(|low| (low - most).max(least)), high.map(|high| high + most)];
        }
        let column = |estimate: &Estimate| data.layout.column(estimate.parameter);
        let correlation = |a: &Estimate, b: &Estimate| covariance.correlation(column(a)?, column(b)?);
        let correlations = estimates.iter().map(|a| estimates.iter().map(|b| correlation(a, b)).collect()).collect();
        let identifiable = identifiable(data, fitted, &covariance, &estimates);
        let tests = Tests::new(data, fitted, &covariance, &waves);
        Ok(Uncertainty { estimates, correlations, identifiable, tests })
    }
}

/// The estimates of a task, each with its interval.
fn estimates(
    task: &Task,
    data: &Data,
    fitted: &Fitted,
    covariance: &Covariance,
    proceed: &dyn Fn() -> bool,
) -> Result<Vec<Estimate>, Error> {
    let uncertain = task.known.iter().filter(|known| known.standard_error > 0.0).map(|known| known.parameter);
    let beside = uncertain.filter(|parameter| !task.free.contains(parameter));
    let mut estimates = Vec::new();
    for parameter in task.free.iter().copied().chain(beside) {
        let Some(column) = data.layout.column(parameter) else {
            let value = middle(data);
            estimates.push(Estimate { parameter, value, standard_error: None, interval: [None; 2], at_bound: false });
            continue;
        };
        let standard_error = covariance.error(column);
        let interval = interval(data, fitted, column, covariance, task.noise.force.is_some(), proceed)?;
        let (value, at_bound) = (fitted.values[column], fitted.bound.contains(&column));
        estimates.push(Estimate { parameter, value, standard_error, interval, at_bound });
    }
    Ok(estimates)
}

/// The middle of the loops, m: what a steady loop has in place of a displacement offset.
fn middle(data: &Data) -> f64 {
    let middles =
        data.records.iter().map(|record| 0.5 * (record.extremes[0].displacement + record.extremes[1].displacement));
    middles.sum::<f64>() / data.records.len() as f64
}

/// What a fit leaves.
pub(super) struct LeftOver {
    /// The records beside their fit.
    pub(super) curves: Vec<Curve>,
    pub(super) residual: Residual,
    /// Share of the points at which something sticks.
    pub(super) sticking: f64,
    /// Root of the mean square of the residuals, each over its standard deviation.
    pub(super) excess: f64,
}

/// The records beside their fit, and what is left.
pub(super) fn left_over(data: &Data, fitted: &Fitted) -> Result<LeftOver, Error> {
    let ones = vec![1.0; data.samples()];
    let rows = data.rows(&fitted.values, &ones);
    let (mut curves, mut row) = (Vec::new(), 0);
    let (mut squares, mut largest, mut used, mut relative) = (0.0, 0.0_f64, 0, 0.0);
    let mut randomness = Randomness::default();
    for record in &data.records {
        let (mut curve, mut standardised) = (Curve::default(), Vec::new());
        for sample in &record.samples {
            let residual = rows.residual[row];
            let kept = fitted.factors[row] > 0.0;
            curve.displacement.push(sample.measured);
            curve.measured.push(sample.force);
            curve.fitted.push(sample.force + residual);
            curve.used.push(kept);
            curve.branch.push(sample.branch);
            if kept {
                squares += residual * residual;
                relative += (residual * fitted.factors[row]).powi(2) / record.weight;
                largest = largest.max(residual.abs());
                used += 1;
                standardised.push(residual * fitted.factors[row]);
            }
            row += 1;
        }
        randomness.add(&standardised);
        curves.push(curve);
    }
    let residual = Residual {
        rms: (squares / f64::from(used).max(1.0)).sqrt(),
        largest,
        outliers: 1.0 - f64::from(used) / ones.len() as f64,
        runs: randomness.runs(),
    };
    let sticking = rows.slopes.iter().filter(|&&slope| slope > 0.0).count() as f64 / ones.len() as f64;
    Ok(LeftOver { curves, residual, sticking, excess: (relative / f64::from(used).max(1.0)).sqrt() })
}

/// The contact of the definition with the fitted values, at its own load.
pub(super) fn fitted_contact(task: &Task, data: &Data, fitted: &Fitted) -> Result<Contact, Error> {
    let value = |parameter| data.layout.value(&fitted.values, parameter);
    let elasticity = task.contact.elasticity();
    let (e_star, g_star) = (value(Parameter::EStar), value(Parameter::GStar));
    let same =
        [(e_star, elasticity.e_star()), (g_star, elasticity.g_star())].iter().all(|(a, b)| a.to_bits() == b.to_bits());
    let profile = match task.contact.profile() {
        Profile::Sphere(_) => Profile::Sphere(Sphere::new(value(Parameter::Radius))?),
        profile => profile.clone(),
    };
    let strength = value(Parameter::ShearStrength);
    // Less than the mechanics computes with is none.
    let shear_strength = if strength < range::MIN_POSITIVE_FRICTION * g_star { 0.0 } else { strength };
    Ok(Contact::new(Setup {
        profile,
        elasticity: if same { elasticity } else { Elasticity::effective(e_star, g_star)? },
        friction: Friction { shear_strength, ..Friction::from(value(Parameter::Friction)) },
        preload: Preload::NormalForce(task.contact.normal_force()),
    })?)
}
