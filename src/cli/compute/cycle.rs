//! `stickslip cycle --map` and `--frequency`: a fretting map of the body in the file, or its cycles at frequencies.

use std::path::Path;

use clap::Args;
use serde_json::{Value, json};
use stickslip_wire::limits::Limited as _;
use stickslip_wire::{Faults, FrettingMap, JsonPath, LoadSpan};

use super::{Body, Flags};
use crate::cli::command_error::CommandError;
use crate::cli::io::{parsed, read};
use stickslip_compute::formats::Format;

/// The flags that change the body.
#[derive(Args)]
pub struct CycleFlags {
    /// A fretting map: a row for each amplitude under each of these normal forces, N, as `from:to:count`, evenly spaced
    /// in their logarithm. It is printed as `csv` unless the format is named.
    #[arg(long, value_name = "FROM:TO:COUNT", value_parser = loads)]
    map: Option<FrettingMap>,
    /// Frequencies, Hz, of bodies with memory: a row for each amplitude at each of them. Printed as `csv` unless the
    /// format is named.
    #[arg(long, value_name = "HZ,...", value_delimiter = ',', conflicts_with = "map")]
    frequency: Vec<f64>,
}

/// The loads of a map as the command line has them.
fn loads(text: &str) -> Result<FrettingMap, &'static str> {
    let parts: Vec<&str> = text.split(':').collect();
    let read = || {
        let [from, to, count] = parts[..] else { return None };
        let normal_force = LoadSpan { from: from.parse().ok()?, to: to.parse().ok()?, count: count.parse().ok()? };
        Some(FrettingMap { normal_force })
    };
    let sound = |map: &FrettingMap| {
        let mut faults = Faults::default();
        map.check_limits(JsonPath::Root, &mut faults);
        map.check(1, JsonPath::Root, &mut faults);
        faults.is_empty()
    };
    read().filter(sound).ok_or("expected from:to:count, with 0 < from < to in N and 2 to 1000 loads")
}

impl Flags for CycleFlags {
    fn body(self, file: Option<&Path>) -> Result<Body, CommandError> {
        let text = read(file.unwrap_or(Path::new("-")))?;
        let (name, value) = match self.map {
            Some(map) => ("map", json!(map)),
            None if self.frequency.is_empty() => return Ok(Body { text, ..Body::default() }),
            None => ("frequency", json!(self.frequency)),
        };
        let mut body: Value = parsed(&text)?;
        body.as_object_mut().ok_or_else(|| "the body must be a JSON object".to_owned())?.insert(name.to_owned(), value);
        Ok(Body { text: body.to_string().into_bytes(), format: Some(Format::Csv), ..Body::default() })
    }
}
