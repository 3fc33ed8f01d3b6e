//! Files of instruments: measured scans and loops as documents, in the units of the file.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde::Serialize;
use stickslip::computations::files;
use stickslip_measured::import::{Force, ImportError, Length, LoopHints, ScanHints};

/// The unit of a symbol, if one is given.
fn unit<U>(symbol: Option<&str>, find: fn(&str) -> Option<U>, allowed: &[&str]) -> PyResult<Option<U>> {
    let Some(symbol) = symbol else { return Ok(None) };
    let unknown = || PyValueError::new_err(format!("`{symbol}` is none of {}", allowed.join(", ")));
    find(symbol).map(Some).ok_or_else(unknown)
}

fn length(symbol: Option<&str>) -> PyResult<Option<Length>> {
    unit(symbol, files::length, &Length::ALL.map(Length::symbol))
}

fn written(read: Result<impl Serialize, ImportError>) -> PyResult<String> {
    let reply = read.map_err(|error| PyValueError::new_err(error.to_string()))?;
    serde_json::to_string(&reply).map_err(|error| PyValueError::new_err(error.to_string()))
}

/// A scan of a file, as the reply of POST /files/scan.
#[pyfunction]
#[pyo3(signature = (content, lateral = None, height = None, spacing = None))]
pub fn read_scan(
    content: &[u8],
    lateral: Option<&str>,
    height: Option<&str>,
    spacing: Option<f64>,
) -> PyResult<String> {
    let (lateral, height) = (length(lateral)?, length(height)?);
    written(files::scan(content, ScanHints { lateral, height, spacing, ..ScanHints::default() }))
}

/// A loop of a file, as the reply of POST /files/loop.
#[pyfunction]
#[pyo3(signature = (
    content, displacement = None, force = None, time = None, load = None, displacement_unit = None, force_unit = None
))]
pub fn read_loop(
    content: &[u8],
    displacement: Option<String>,
    force: Option<String>,
    time: Option<String>,
    load: Option<String>,
    displacement_unit: Option<&str>,
    force_unit: Option<&str>,
) -> PyResult<String> {
    let displacement_unit = length(displacement_unit)?;
    let force_unit = unit(force_unit, files::force, &Force::ALL.map(Force::symbol))?;
    let hints = LoopHints { displacement, force, time, load, displacement_unit, force_unit };
    written(files::measured_loop(content, &hints))
}
