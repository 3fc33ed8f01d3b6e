//! Files of instruments: measured scans and loops as documents, in the units of the file.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde_json::{Value, json};
use stickslip_measured::import::{self, Force, Length, LoopHints, Places, ScanHints};
use stickslip_wire::limits::SCAN_POINTS;

/// The unit of a symbol, if one is given.
fn unit<U: Copy>(symbol: Option<&str>, all: [U; 4], name: fn(U) -> &'static str) -> PyResult<Option<U>> {
    let Some(symbol) = symbol else { return Ok(None) };
    let found = all.into_iter().find(|unit| name(*unit) == symbol);
    let unknown = || PyValueError::new_err(format!("`{symbol}` is none of {}", all.map(name).join(", ")));
    found.map(Some).ok_or_else(unknown)
}

/// A scan in columns of text: `scan` and `units` of the body of POST /profiles/fit, and what was taken for what.
#[pyfunction]
#[pyo3(signature = (content, lateral = None, height = None, spacing = None))]
pub fn read_scan(
    content: &[u8],
    lateral: Option<&str>,
    height: Option<&str>,
    spacing: Option<f64>,
) -> PyResult<String> {
    let hints = ScanHints {
        lateral: unit(lateral, Length::ALL, Length::symbol)?,
        height: unit(height, Length::ALL, Length::symbol)?,
        spacing,
        most: *SCAN_POINTS.end(),
    };
    let file = import::read_scan(content, &hints).map_err(|error| PyValueError::new_err(error.to_string()))?;
    let scan = match file.places {
        Places::Line { x, z } => json!({"line": {"x": x, "z": z}}),
        Places::Points { x, y, z } => json!({"points": {"x": x, "y": y, "z": z}}),
        Places::Map { dx, dy, z } => json!({"map": {"dx": dx, "dy": dy, "z": z}}),
    };
    let units = json!({"lateral": file.lateral.symbol(), "height": file.height.symbol()});
    Ok(json!({"scan": scan, "units": units, "reading": file.reading}).to_string())
}

/// A loop in columns of text: a member of `loops` and the `units` of the body of POST /fit, and what was taken for
/// what.
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
    let hints = LoopHints {
        displacement,
        force,
        time,
        load,
        displacement_unit: unit(displacement_unit, Length::ALL, Length::symbol)?,
        force_unit: unit(force_unit, Force::ALL, Force::symbol)?,
    };
    let file = import::read_loop(content, &hints).map_err(|error| PyValueError::new_err(error.to_string()))?;
    let mut measured = json!({"displacement": file.displacement, "force": file.force});
    for (name, value) in [("time", file.time.map(Value::from)), ("normal_force", file.load.map(Value::from))] {
        if let Some(value) = value {
            measured[name] = value;
        }
    }
    let units = json!({"displacement": file.displacement_unit.symbol(), "force": file.force_unit.symbol()});
    Ok(json!({"loop": measured, "units": units, "reading": file.reading}).to_string())
}
