//! Computations by their names, and the document of the API.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use stickslip::api;
use stickslip::computations::{self, Computation, Shown, Visitor};
use stickslip::formats::Format;

use super::interrupt::interruptible;
use super::problem::refused;

/// The reply of the computation of this name to the JSON text of a request, as JSON or in another format.
#[pyfunction]
#[pyo3(signature = (name, body, format = "columns"))]
pub fn compute<'py>(py: Python<'py>, name: &str, body: &[u8], format: &str) -> PyResult<Bound<'py, PyBytes>> {
    let shown = Shown::in_format(named(format)?);
    let reply = interruptible(py, |stop| computations::compute(name, body, shown, stop))?;
    Ok(PyBytes::new(py, &reply.map_err(refused)?))
}

/// The format of a name.
pub fn named(format: &str) -> PyResult<Format> {
    let unknown = || PyValueError::new_err(format!("there is no format {format}"));
    Format::named(format, &Format::ALL).ok_or_else(unknown)
}

/// The name of every computation, and the path of its POST, if it has one.
#[pyfunction]
pub fn names() -> Vec<(&'static str, Option<&'static str>)> {
    struct Names(Vec<(&'static str, Option<&'static str>)>);
    impl Visitor for Names {
        fn visit<C: Computation>(&mut self) {
            self.0.push((C::ABOUT.name, C::ABOUT.route.map(|route| route.path)));
        }
    }
    let mut names = Names(Vec::new());
    computations::each(&mut names);
    names.0
}

/// The OpenAPI document.
#[pyfunction]
pub fn openapi() -> &'static str {
    api::document()
}
