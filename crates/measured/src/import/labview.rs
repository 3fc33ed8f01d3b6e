//! LabVIEW's measurement files (`.lvm`): a header with keys, the units of the channels, and the steps of the time.

use super::label::{Label, Mention};
use super::lines::Separator;
use super::number::{Mark, number};
use super::sheet::Sheet;
use super::units::Unit;

/// The time of the rows of a file without a column of times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Clock {
    /// The time of the first row, s.
    pub(super) start: f64,
    /// The time between rows, s.
    pub(super) step: f64,
}

/// Adds what the header of a measurement file says of the columns; the clock if no column has times.
pub(super) fn describe(sheet: &mut Sheet<'_>) -> Option<Clock> {
    if !sheet.header.first().is_some_and(|(_, line)| line.starts_with("LabVIEW Measurement")) {
        return None;
    }
    let mut cells = Vec::new();
    let mut fields = |key: &str| {
        let line = sheet.header.iter().rev().find(|(_, line)| line.starts_with(key)).map(|(_, line)| *line)?;
        Separator::TAB.split(line, &mut cells);
        (cells.len() < 2).then(|| Separator::COMMA.split(line, &mut cells));
        Some(cells.iter().map(|cell| (*cell).to_owned()).collect::<Vec<String>>())
    };
    let (units, dimensions) = (fields("Y_Unit_Label"), fields("X_Dimension"));
    let value = |fields: Option<Vec<String>>| fields?.into_iter().skip(1).find_map(|cell| number(&cell, Mark::Comma));
    let clock = Clock { start: value(fields("X0")).unwrap_or(0.0), step: value(fields("Delta_X"))? };
    for (label, unit) in sheet.labels.iter_mut().zip(units.unwrap_or_default()).skip(1) {
        if label.unit == Mention::Absent {
            label.unit = Label::of_unit(&unit);
        }
    }
    let is_time = dimensions.is_some_and(|fields| fields.iter().any(|field| field == "Time"));
    let has_times = sheet.labels.iter().any(|label| label.name == "X_Value") && is_time;
    let seconds = Unit::parse("s").map(|unit| Mention::Known(unit, "s".to_owned()));
    for label in sheet.labels.iter_mut().filter(|label| is_time && label.name == "X_Value") {
        "time".clone_into(&mut label.name);
        label.unit = seconds.clone().unwrap_or(Mention::Absent);
    }
    (is_time && !has_times && clock.step > 0.0).then_some(clock)
}
