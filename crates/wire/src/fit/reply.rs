//! The reply of `POST /fit`.

use std::collections::BTreeMap;

use super::FitParameter;
use crate::prelude::*;

replies! {
/// The quantities that the loops determine, and the ones that they leave undetermined.
pub struct FitReply {
    /// Estimates of the free quantities, and of those known with a standard error, by name.
    pub estimates: BTreeMap<FitParameter, FitEstimate>,
    /// Correlation coefficients of the estimates, pure numbers, by both names; `null` where one is not determined.
    pub correlations: BTreeMap<FitParameter, BTreeMap<FitParameter, Option<f64>>>,
    /// What the loops determine: quantities by name, or combinations of them where a single one is not determined.
    pub identifiable: Vec<String>,
    /// The quantities that were fitted: those of the request, or those that the loops decided on.
    pub free: Vec<FitParameter>,
    /// A score test of each quantity that was not free.
    pub omitted: Vec<OmittedParameter>,
    /// The change of the estimates by small errors of the bench that were not free.
    pub sensitivity: Vec<ParameterSensitivity>,
    /// Measured less fitted forces.
    pub residual: FitResidual,
    /// The noise as given, otherwise as estimated.
    pub noise: NoiseLevels,
    /// The loops as they were fitted, in SI units; long ones are thinned.
    pub curve: Vec<FittedLoop>,
    /// The contact with the fitted values, for `POST /contacts` and `/simulate`.
    pub contact: ContactDefinition,
    /// Warnings about the fit.
    pub warnings: Vec<Warning>,
}

/// A quantity as the loops determine it, in its SI unit.
pub struct FitEstimate: Copy {
    /// The value of the best fit, in the SI unit of the quantity.
    pub value: f64,
    /// Its standard error from the linearised fit, in the SI unit of the quantity; `null` where it is not determined.
    pub standard_error: Option<f64>,
    /// Both ends of the 95 % confidence interval by profile likelihood, in the SI unit of the quantity; `null` for an
    /// end without a bound.
    pub interval: [Option<f64>; 2],
    /// Whether the value is at the end of its range; left out if not.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub at_bound: bool,
}

/// A quantity that was not free, with the result of one further step of the search in which it is.
pub struct OmittedParameter {
    /// The quantity.
    pub name: FitParameter,
    /// Its value after the step, in the SI unit of the quantity; `null` where the loops do not distinguish it from the
    /// free quantities, or where its unit needs times.
    pub value: Option<f64>,
    /// The distance of that value from the one assumed, in its standard errors, a pure number; beyond ±4 the assumption
    /// is wrong. `null` where the loops do not distinguish it from the free quantities.
    pub z: Option<f64>,
    /// The change of each estimate in the step, in the SI unit of the estimate; empty where `z` is `null`.
    pub shifts: BTreeMap<FitParameter, f64>,
}

/// The effect of a small error of the bench on the estimates.
pub struct ParameterSensitivity {
    /// The quantity that differs from what the fit assumes.
    pub name: FitParameter,
    /// By how much it differs, in the SI unit of the quantity; a delay of one sample; an offset of 1 % of the force or
    /// of the amplitude; 1 % of the compliance of the contact; a drift of 1 % over the record. `null` where its unit
    /// needs times.
    pub change: Option<f64>,
    /// The resulting change of each estimate, in the SI unit of the estimate.
    pub shifts: BTreeMap<FitParameter, f64>,
}

/// Measured less fitted forces, in a few numbers.
pub struct FitResidual: Copy {
    /// Root mean square without outliers, N.
    pub rms: f64,
    /// The largest magnitude without outliers, N.
    pub largest: f64,
    /// Fraction of the points that were left out as outliers, a pure number from 0 to 1.
    pub outliers: f64,
    /// The runs of one sign, which show whether the residual looks like noise.
    pub runs: SignRuns,
}

/// Runs of one sign in a residual; few runs mean a systematic deviation.
pub struct SignRuns: Copy {
    /// Number of runs.
    pub count: usize,
    /// Number of runs that noise has on average, a pure number.
    pub expected: f64,
    /// Whether the two numbers agree, as for noise, and neighbouring residuals are independent.
    pub random: bool,
}

/// Standard deviations of the noise.
pub struct NoiseLevels: Copy {
    /// Of a force, N.
    pub force: f64,
    /// Of a displacement, m.
    pub displacement: f64,
}

/// A loop as it was fitted, point by point.
pub struct FittedLoop {
    /// Measured displacements, m.
    pub displacement: Vec<f64>,
    /// The force of the fit, N.
    pub force: Vec<f64>,
    /// The measured force, N.
    pub measured: Vec<f64>,
    /// Whether the point was used; if not, it is an outlier.
    pub used: Vec<bool>,
}
}
