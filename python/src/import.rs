//! Files of instruments: measured scans and loops as documents, in the units of the file.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde::Serialize;
use stickslip::computations::files;
use stickslip_measured::import::{Dimension, ImportError, LoopHints, ScanHints, UnitHint};

/// The unit of this dimension that a text names, if one is given.
fn unit(text: Option<&str>, dimension: Dimension) -> PyResult<Option<UnitHint>> {
    let of = |text| UnitHint::of(text, dimension).map_err(|error| PyValueError::new_err(error.to_string()));
    text.map(of).transpose()
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
    let (lateral, height) = (unit(lateral, Dimension::LENGTH)?, unit(height, Dimension::LENGTH)?);
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
    let displacement_unit = unit(displacement_unit, Dimension::LENGTH)?;
    let force_unit = unit(force_unit, Dimension::FORCE)?;
    let hints = LoopHints { displacement, force, time, load, displacement_unit, force_unit, ..LoopHints::default() };
    written(files::measured_loop(content, &hints))
}
