//! Sweeps, whole or in slices.

use pyo3::exceptions::{PyIndexError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use stickslip_compute::Refusal;
use stickslip_compute::Stop;
use stickslip_compute::documents::Parse as _;
use stickslip_compute::formats::Format;
use stickslip_compute::simulation::{self, Anew, SweepResult};
use stickslip_wire::{Output, SweepRequest};

use super::compute::named;
use super::interrupt::interruptible;
use super::problem::refused;

/// A sweep that has been checked and planned.
#[pyclass(frozen, module = "stickslip._native")]
pub struct Sweep {
    plan: simulation::Sweep,
}

#[pymethods]
impl Sweep {
    /// Plans the sweep of the JSON text of a request.
    #[new]
    fn new(py: Python<'_>, body: &[u8]) -> PyResult<Sweep> {
        let plan =
            |stop: &dyn Stop| SweepRequest::read(body).and_then(|sweep| simulation::Sweep::plan(sweep, &Anew(stop)));
        Ok(Sweep { plan: interruptible(py, plan)?.map_err(refused)? })
    }

    /// Number of points.
    #[getter]
    fn points(&self) -> usize {
        self.plan.points()
    }

    /// Number of points in a chunk of about a second of work.
    #[getter]
    fn chunk(&self) -> usize {
        self.plan.chunk()
    }

    /// All points on so many threads: the document that POST /sweep sends, or a table.
    fn run<'py>(&self, py: Python<'py>, threads: usize, format: &str) -> PyResult<Bound<'py, PyBytes>> {
        let format = named(format)?;
        let result =
            interruptible(py, |stop| self.plan.compute(0..self.plan.points(), threads, stop))?.map_err(refused)?;
        self.sent(py, result, format)
    }

    /// What `run` gives, of numbers that were computed elsewhere: the outputs of all points as `f64`, point by point,
    /// how many points have no answer, and the first of these as JSON text.
    fn answer<'py>(
        &self,
        py: Python<'py>,
        outputs: &[u8],
        failed: u64,
        failures: &str,
        format: &str,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let format = named(format)?;
        let (numbers, rest) = outputs.as_chunks();
        if !rest.is_empty() || numbers.len() != self.plan.numbers(self.plan.points()) {
            let (points, found) = (self.plan.points(), numbers.len() / self.plan.numbers(1).max(1));
            return Err(PyValueError::new_err(format!("{found} of {points} points are there")));
        }
        let values = numbers.iter().map(|bytes| f64::from_ne_bytes(*bytes)).collect();
        let failures = serde_json::from_str(failures).map_err(|error| PyValueError::new_err(error.to_string()))?;
        self.sent(py, SweepResult { values, failed, failures }, format)
    }

    /// The names of the columns: the axes or inputs, then the outputs.
    #[getter]
    fn columns(&self) -> Vec<String> {
        let checked = self.plan.checked();
        let outputs = checked.request.outputs.iter().map(Output::column);
        checked.changing().into_iter().chain(outputs).map(str::to_owned).collect()
    }

    /// The rows of the points from `first` up to `end`: their numbers as `f64`, a row for each point, how
    /// many have no answer, and the first of these as JSON text.
    fn rows<'py>(
        &self,
        py: Python<'py>,
        first: usize,
        end: usize,
        threads: usize,
    ) -> PyResult<(Bound<'py, PyBytes>, u64, String)> {
        if first > end || end > self.plan.points() {
            return Err(PyIndexError::new_err(format!("this sweep has {} points", self.plan.points())));
        }
        let result = interruptible(py, |stop| self.plan.compute(first..end, threads, stop))?.map_err(refused)?;
        let (checked, outputs) = (self.plan.checked(), self.plan.checked().outputs.len().max(1));
        let (changing, number_of) = (checked.changing().len(), checked.numbers());
        let mut bytes = Vec::with_capacity(8 * (result.values.len() + (end - first) * changing));
        for (row, values) in result.values.chunks(outputs).enumerate() {
            let number = |column| number_of(first + row, column).and_then(|number| number.as_f64());
            let changed = (0..changing).map(|column| number(column).unwrap_or(f64::NAN));
            bytes.extend(changed.chain(values.iter().copied()).flat_map(f64::to_ne_bytes));
        }
        let failures = serde_json::to_string(&result.failures).unwrap_or_default();
        Ok((PyBytes::new(py, &bytes), result.failed, failures))
    }
}

impl Sweep {
    fn sent<'py>(&self, py: Python<'py>, result: SweepResult, format: Format) -> PyResult<Bound<'py, PyBytes>> {
        let blocks = result.blocks(self.plan.checked(), format).collect::<Result<Vec<_>, _>>();
        let blocks = blocks.map_err(|error| refused(Refusal::internal(error.to_string())))?;
        Ok(PyBytes::new(py, &blocks.concat()))
    }
}
