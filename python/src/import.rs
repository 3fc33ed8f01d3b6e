//! Files of instruments: measured scans and loops as documents, in the units of the file; numbers with units.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde::Serialize;
use stickslip_compute::Refusal;
use stickslip_compute::computations::files;
use stickslip_measured::import::{ImportError, Mapping, Unit};
use stickslip_wire::Fault;

use super::problem::refused;

/// What the keywords of a function say, as a mapping: entries such as `force` with `5:mN`.
fn mapping(hints: Vec<(String, String)>) -> PyResult<Mapping> {
    let mut said = Mapping::default();
    let mut entries = Mapping::default();
    for (name, hint) in hints {
        let quantity = name.strip_suffix("_unit").unwrap_or(&name);
        let read = match name.as_str() {
            "mapping" => entries.read(&hint),
            "lateral" | "height" | "displacement_unit" | "force_unit" | "time_unit" | "load_unit" => {
                said.set_unit(quantity, &hint)
            }
            "displacement" | "force" | "time" | "load" | "x" | "y" | "z" => said.set(&name, &format!("\"{hint}\"")),
            _ => said.set(&name, &hint),
        };
        read.map_err(|error| {
            refused(Refusal { errors: vec![Fault::new(format!("/{name}"), error.to_string())], ..error.into() })
        })?;
    }
    Ok(said.preceded_by(entries))
}

fn written(read: Result<impl Serialize, ImportError>) -> PyResult<String> {
    let reply = read.map_err(refused)?;
    serde_json::to_string(&reply).map_err(|error| PyValueError::new_err(error.to_string()))
}

/// A scan of a file, as the reply of POST /files/scan, with the parameters of its query.
#[pyfunction]
pub fn read_scan(content: &[u8], hints: Vec<(String, String)>) -> PyResult<String> {
    written(files::scan(content, &mapping(hints)?, &|| true))
}

/// A loop of a file, as the reply of POST /files/loop, with the parameters of its query.
#[pyfunction]
pub fn read_loop(content: &[u8], hints: Vec<(String, String)>) -> PyResult<String> {
    written(files::measured_loop(content, &mapping(hints)?, &|| true))
}

/// The number that a text such as `20 um` says, in the unit `needed`, or in the SI unit of its own dimension; `None`
/// for a text that does not begin with a number.
#[pyfunction]
#[pyo3(signature = (text, needed=None))]
pub fn quantity(text: &str, needed: Option<&str>) -> PyResult<Option<f64>> {
    let Some((number, rest)) = number(text.trim()) else { return Ok(None) };
    let rest = rest.trim();
    if rest.is_empty() {
        return Ok(Some(number));
    }
    let unknown = |error: String| PyValueError::new_err(error);
    let Some(needed) = needed else {
        let found = Unit::parse(rest).ok_or_else(|| unknown(format!("`{rest}` is not known as a unit")))?;
        return Ok(Some(found.to_si(number)));
    };
    let needed = Unit::parse(needed).ok_or_else(|| unknown(format!("`{needed}` is not known as a unit")))?;
    let found = Unit::of(rest, needed.dimension).map_err(|error| unknown(error.to_string()))?;
    // An angle may be needed in degrees or in radians.
    Ok(Some(found.convert(number, needed)))
}

/// The longest number at the beginning of a text, and what follows it.
fn number(text: &str) -> Option<(f64, &str)> {
    let unsigned = text.strip_prefix(['+', '-']).unwrap_or(text);
    unsigned.starts_with(|first: char| first.is_ascii_digit() || first == '.').then_some(())?;
    let is_part = |letter: char| letter.is_ascii_digit() || ".eE+-".contains(letter);
    let most = text.find(|letter| !is_part(letter)).unwrap_or(text.len());
    (1..=most).rev().find_map(|end| Some((text[..end].parse().ok()?, &text[end..])))
}
