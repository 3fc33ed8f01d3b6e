//! Computations by their names, and the document of the API.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use stickslip_compute::computations::{self, DisplayOptions};
use stickslip_compute::formats::Format;

use super::interrupt::interruptible;
use super::problem::refused;

/// The reply of the computation of this name to the JSON text of a request, as JSON or in another format.
#[pyfunction]
#[pyo3(signature = (name, body, format = "columns"))]
pub fn compute<'py>(py: Python<'py>, name: &str, body: &[u8], format: &str) -> PyResult<Bound<'py, PyBytes>> {
    let shown = DisplayOptions::in_format(named(format)?);
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
    let abouts = computations::entries().into_iter().map(|entry| entry.about);
    abouts.map(|about| (about.name, about.route.map(|route| route.path))).collect()
}

/// The table of known materials as JSON text.
#[pyfunction]
pub fn materials() -> &'static str {
    stickslip_wire::materials::MATERIALS
}

/// The OpenAPI document.
#[cfg(all(feature = "server", target_os = "linux"))]
#[pyfunction]
pub fn openapi() -> &'static str {
    stickslip::api::document()
}
