//! The least squares of a fit: residuals and Jacobian of all records with what is known beforehand, and their minimum.

use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt, TerminationReason};
use nalgebra::storage::Owned;
use nalgebra::{DMatrix, DVector, Dyn};

use super::model::{Layout, predict};
use super::record::{Branches, Sample, area};
use super::{Error, Parameter};

/// A sum of columns that is known beforehand, as one more measurement.
#[derive(Clone, Debug)]
pub(super) struct Prior {
    /// Columns with their factors; that which it is about first.
    pub(super) terms: Vec<(usize, f64)>,
    pub(super) value: f64,
    pub(super) standard_error: f64,
    /// When a turning point that it is about was passed, s: by so many seconds of a drift its value moves.
    pub(super) time: f64,
}

/// What is to be explained, and by which parameters.
#[derive(Clone, Debug)]
pub(super) struct Data {
    pub(super) records: Vec<Branches>,
    pub(super) layout: Layout,
    pub(super) priors: Vec<Prior>,
    /// Sizes of the parameters, by which those that may change sign are scaled; one a column.
    pub(super) scales: Vec<f64>,
}

impl Prior {
    /// Of one column.
    pub(super) fn new(column: usize, value: f64, standard_error: f64) -> Prior {
        Prior { terms: vec![(column, 1.0)], value, standard_error, time: 0.0 }
    }

    /// Gives its first column the value that agrees with the others.
    pub(super) fn apply(&self, values: &mut [f64]) {
        let (column, factor) = self.terms[0];
        let others: f64 = self.terms[1..].iter().map(|(column, factor)| factor * values[*column]).sum();
        values[column] = (self.value - others) / factor;
    }
}

/// How far a search goes.
#[derive(Clone, Copy)]
pub(super) struct Control<'a> {
    /// Relative change of the sum of squares, and of the values, at which it ends.
    pub(super) tolerance: f64,
    /// Asked before each evaluation.
    pub(super) proceed: &'a dyn Fn() -> bool,
}

impl<'a> Control<'a> {
    /// To the last digits.
    pub(super) fn exact(proceed: &'a dyn Fn() -> bool) -> Control<'a> {
        Control { tolerance: 30.0 * f64::EPSILON, proceed }
    }

    /// Far less than the noise.
    pub(super) fn rough(proceed: &'a dyn Fn() -> bool) -> Control<'a> {
        Control { tolerance: 1e-9, proceed }
    }
}

/// What the data leave at some values: one row a sample, then one a prior.
pub(super) struct Rows {
    pub(super) residual: DVector<f64>,
    pub(super) jacobian: DMatrix<f64>,
    /// Slope of the branch at each sample, N/m.
    pub(super) slopes: Vec<f64>,
}

impl Data {
    /// The same with about one sample in `every`.
    pub(super) fn thinned(&self, every: usize) -> Data {
        let mut coarse = self.clone();
        for record in &mut coarse.records {
            let mut place = 0;
            record.samples.retain(|_| {
                place += 1;
                (place - 1) % every == 0
            });
        }
        coarse
    }

    pub(super) fn samples(&self) -> usize {
        self.records.iter().map(|record| record.samples.len()).sum()
    }

    pub(super) fn samples_mut(&mut self) -> impl Iterator<Item = &mut Sample> {
        self.records.iter_mut().flat_map(|record| &mut record.samples)
    }

    /// Rows at these values, each sample's times its factor, which is one over its standard deviation, and zero where
    /// it is left out.
    pub(super) fn rows(&self, values: &[f64], factors: &[f64]) -> Rows {
        let count = factors.len() + self.priors.len();
        let mut residual = DVector::zeros(count);
        let mut jacobian = DMatrix::zeros(count, self.layout.columns());
        let mut slopes = vec![0.0; factors.len()];
        let mut row = 0;
        for record in &self.records {
            predict(record, &self.layout, values, |sample, predicted, gradient| {
                residual[row] = (predicted.force - sample.force) * factors[row];
                slopes[row] = predicted.slope;
                for (column, by) in gradient.iter().enumerate() {
                    jacobian[(row, column)] = by * factors[row];
                }
                row += 1;
            });
        }
        for prior in &self.priors {
            let sum: f64 = prior.terms.iter().map(|(column, factor)| factor * values[*column]).sum();
            residual[row] = (sum - prior.value) / prior.standard_error;
            for (column, factor) in &prior.terms {
                jacobian[(row, *column)] = factor / prior.standard_error;
            }
            row += 1;
        }
        Rows { residual, jacobian, slopes }
    }

    /// Whether the logarithm of a column is sought.
    pub(super) fn logarithmic(&self, column: usize) -> bool {
        self.layout.parameters[column].is_some_and(Parameter::positive)
    }

    /// Whether a parameter may be zero, which its logarithm never reaches: friction where a strength carries shear.
    pub(super) fn may_be_zero(&self, parameter: Parameter, values: &[f64]) -> bool {
        match parameter {
            Parameter::MachineCompliance => true,
            Parameter::ShearStrength => self.layout.value(values, Parameter::Friction) > 0.0,
            Parameter::Friction => self.layout.value(values, Parameter::ShearStrength) > 0.0,
            _ => false,
        }
    }

    /// The change of a value with its coordinate in the search.
    fn by_coordinate(&self, values: &[f64], column: usize) -> f64 {
        if self.logarithmic(column) { values[column] } else { self.scales[column] }
    }

    /// The least sum of squares over the columns `free`, from the values given, which become those of the minimum.
    ///
    /// # Errors
    /// [`Error::NoSolution`] if the search runs into numbers that are not finite, [`Error::Interrupted`].
    pub(super) fn minimise(
        &self,
        values: &mut Vec<f64>,
        factors: &[f64],
        free: &[usize],
        control: &Control<'_>,
    ) -> Result<f64, Error> {
        let &Control { tolerance, proceed } = control;
        let mut search =
            Search { data: self, factors, free, start: values.clone(), values: values.clone(), rows: None, proceed };
        search.evaluate();
        if free.is_empty() {
            let rows = search.rows.ok_or(Error::NoSolution)?;
            return Ok(rows.residual.norm_squared());
        }
        let patience = (PATIENCE / (free.len() + 1)).max(LEAST_PATIENCE);
        let (found, report) = LevenbergMarquardt::new().with_tol(tolerance).with_patience(patience).minimize(search);
        match report.termination {
            TerminationReason::User(_) if !proceed() => Err(Error::Interrupted),
            TerminationReason::User(_) | TerminationReason::Numerical(_) => Err(Error::NoSolution),
            _ if !report.objective_function.is_finite() => Err(Error::NoSolution),
            _ => {
                *values = found.values;
                Ok(2.0 * report.objective_function)
            }
        }
    }
}

/// One search, in logarithms of positive parameters and shares of the scales of the others.
struct Search<'a> {
    data: &'a Data,
    factors: &'a [f64],
    free: &'a [usize],
    start: Vec<f64>,
    values: Vec<f64>,
    rows: Option<Rows>,
    proceed: &'a dyn Fn() -> bool,
}

/// Evaluations after which a search takes what it has, where it has few parameters; and the least for each of many.
const PATIENCE: usize = 160;
const LEAST_PATIENCE: usize = 3;
/// The largest factor by which a search may change a positive parameter.
const MOST_CHANGE: f64 = 1e6;

impl Search<'_> {
    fn evaluate(&mut self) {
        self.rows = (self.proceed)().then(|| self.data.rows(&self.values, self.factors));
    }
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for Search<'_> {
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;
    type ParameterStorage = Owned<f64, Dyn>;

    fn set_params(&mut self, coordinates: &DVector<f64>) {
        for (&column, &coordinate) in self.free.iter().zip(coordinates) {
            self.values[column] = if self.data.logarithmic(column) {
                self.start[column] * coordinate.clamp(-MOST_CHANGE.ln(), MOST_CHANGE.ln()).exp()
            } else {
                coordinate * self.data.scales[column]
            };
        }
        self.evaluate();
    }

    fn params(&self) -> DVector<f64> {
        let coordinate = |&column: &usize| {
            if self.data.logarithmic(column) {
                (self.values[column] / self.start[column]).ln()
            } else {
                self.values[column] / self.data.scales[column]
            }
        };
        DVector::from_iterator(self.free.len(), self.free.iter().map(coordinate))
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        self.rows.as_ref().map(|rows| rows.residual.clone())
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        let rows = self.rows.as_ref()?;
        let mut jacobian = rows.jacobian.select_columns(self.free);
        for (place, &column) in self.free.iter().enumerate() {
            let factor = self.data.by_coordinate(&self.values, column);
            jacobian.column_mut(place).scale_mut(factor);
        }
        Some(jacobian)
    }
}

/// The scales of parameters and turning points: those of the data.
pub(super) fn scales(layout: &Layout, records: &[Branches]) -> Vec<f64> {
    let most = |of: fn(&Branches) -> f64| records.iter().map(of).fold(0.0, f64::max);
    let way = most(|record| record.extremes[0].displacement - record.extremes[1].displacement);
    let time = most(|record| record.samples.last().map_or(0.0, |last| last.time - record.samples[0].time));
    let force = most(|record| record.half_force);
    layout
        .parameters
        .iter()
        .map(|parameter| match parameter {
            Some(Parameter::ForceOffset) => force,
            Some(Parameter::ShearStrength) => force / area(&records[0].contact),
            Some(Parameter::Drift) if time > 0.0 => way / time,
            Some(Parameter::Delay) if time > 0.0 => time,
            Some(Parameter::GainDrift) if time > 0.0 => 1.0 / time,
            _ => way,
        })
        .collect()
}
