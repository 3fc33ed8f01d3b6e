//! The curve of force over displacement between the ends of moves, for pictures.

use pyo3::prelude::*;
use stickslip_compute::Refusal;
use stickslip_compute::simulation::{self, Anew};
use stickslip_mechanics::{Contact, Move};
use stickslip_wire::{self as wire, SimulateRequest};

use super::interrupt::interruptible;
use super::problem::refused;
use super::stepped::{Pair, pair};

/// Moves that a contact has made, from the state that it had before.
#[pyclass(module = "stickslip._native", frozen)]
pub struct Trace {
    pub before: Contact,
    pub moves: Vec<(Move, f64)>,
}

#[pymethods]
impl Trace {
    /// Displacements, m, and tangential forces, N, along the moves.
    fn points<'py>(&self, py: Python<'py>) -> PyResult<Pair<'py>> {
        written(py, interruptible(py, |stop| simulation::trace(self.before.clone(), &self.moves, stop))?)
    }
}

/// Displacements, m, and tangential forces, N, along the path of the JSON text of a simulation.
#[pyfunction]
pub fn trace<'py>(py: Python<'py>, body: &[u8]) -> PyResult<Pair<'py>> {
    let traced = interruptible(py, |stop| {
        let task = simulation::check(wire::parse::<SimulateRequest>(body)?, &Anew(stop), stop)??;
        Ok::<_, Refusal>(simulation::trace_simulation(&task, stop)?)
    })?;
    written(py, traced)
}

fn written(py: Python<'_>, points: Result<Vec<simulation::Point>, impl Into<Refusal>>) -> PyResult<Pair<'_>> {
    Ok(pair(py, points.map_err(refused)?.into_iter().collect::<(_, _)>().into()))
}
