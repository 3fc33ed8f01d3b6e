//! Files of instruments: measured scans and loops as documents, in the units of the file; numbers with units.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde::Serialize;
use stickslip_compute::Refusal;
use stickslip_compute::computations::files;
use stickslip_measured::import::{Dimension, ImportError, LoopHints, ScanHints, Unit, UnitHint};
use stickslip_wire::Code;

use super::problem::refused;

/// The unit of this dimension that the text of a hint names, if it is given.
fn unit(name: &str, text: Option<&str>, dimension: Dimension) -> PyResult<Option<UnitHint>> {
    let of = |text| {
        let unknown = |error: stickslip_measured::import::UnknownUnit| {
            refused(Refusal::at(Code::UnknownUnit, format!("/{name}"), error.to_string()))
        };
        UnitHint::of(text, dimension).map_err(unknown)
    };
    text.map(of).transpose()
}

fn written(read: Result<impl Serialize, ImportError>) -> PyResult<String> {
    let reply = read.map_err(refused)?;
    serde_json::to_string(&reply).map_err(|error| PyValueError::new_err(error.to_string()))
}

/// A scan of a file, as the reply of POST /files/scan.
#[pyfunction]
#[pyo3(signature = (content, lateral=None, height=None, spacing=None, x=None, y=None, z=None, sheet=None))]
#[expect(clippy::too_many_arguments, reason = "they are the keywords of a Python function")]
pub fn read_scan(
    content: &[u8],
    lateral: Option<&str>,
    height: Option<&str>,
    spacing: Option<f64>,
    x: Option<String>,
    y: Option<String>,
    z: Option<String>,
    sheet: Option<String>,
) -> PyResult<String> {
    let lateral = unit("lateral", lateral, Dimension::LENGTH)?;
    let height = unit("height", height, Dimension::LENGTH)?;
    written(files::scan(content, ScanHints { lateral, height, spacing, x, y, z, sheet, most: 0 }))
}

/// A loop of a file, as the reply of POST /files/loop.
#[pyfunction]
#[pyo3(signature = (
    content, displacement=None, force=None, time=None, load=None, displacement_unit=None, force_unit=None,
    time_unit=None, load_unit=None, sheet=None
))]
#[expect(clippy::too_many_arguments, reason = "they are the keywords of a Python function")]
pub fn read_loop(
    content: &[u8],
    displacement: Option<String>,
    force: Option<String>,
    time: Option<String>,
    load: Option<String>,
    displacement_unit: Option<&str>,
    force_unit: Option<&str>,
    time_unit: Option<&str>,
    load_unit: Option<&str>,
    sheet: Option<String>,
) -> PyResult<String> {
    let displacement_unit = unit("displacement_unit", displacement_unit, Dimension::LENGTH)?;
    let force_unit = unit("force_unit", force_unit, Dimension::FORCE)?;
    let time_unit = unit("time_unit", time_unit, Dimension::TIME)?;
    let load_unit = unit("load_unit", load_unit, Dimension::FORCE)?;
    let units = LoopHints { displacement_unit, force_unit, time_unit, load_unit, ..LoopHints::default() };
    written(files::measured_loop(content, &LoopHints { displacement, force, time, load, sheet, ..units }))
}

/// The number that a text such as `20 um` says, in the SI unit `needed`, or in that of its own dimension; `None` for a
/// text that does not begin with a number.
#[pyfunction]
#[pyo3(signature = (text, needed=None))]
pub fn quantity(text: &str, needed: Option<&str>) -> PyResult<Option<f64>> {
    let Some((number, rest)) = number(text.trim()) else { return Ok(None) };
    let rest = rest.trim();
    if rest.is_empty() {
        return Ok(Some(number));
    }
    let found = match needed.and_then(Unit::parse) {
        Some(needed) => Unit::of(rest, needed.dimension).map_err(|error| PyValueError::new_err(error.to_string()))?,
        None => Unit::parse(rest).ok_or_else(|| PyValueError::new_err(format!("`{rest}` is not known as a unit")))?,
    };
    Ok(Some(found.to_si(number)))
}

/// The longest number at the beginning of a text, and what follows it.
fn number(text: &str) -> Option<(f64, &str)> {
    let unsigned = text.strip_prefix(['+', '-']).unwrap_or(text);
    unsigned.starts_with(|first: char| first.is_ascii_digit() || first == '.').then_some(())?;
    let is_part = |letter: char| letter.is_ascii_digit() || ".eE+-".contains(letter);
    let most = text.find(|letter| !is_part(letter)).unwrap_or(text.len());
    (1..=most).rev().find_map(|end| Some((text[..end].parse().ok()?, &text[end..])))
}
