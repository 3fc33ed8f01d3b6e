//! The table of a sweep in each of the formats, piece by piece: a large one is never in memory as text.

#[path = "arrow.rs"]
mod arrow;

use std::fmt::Write as _;

use serde_json::{Number, Value};

use crate::simulation::Rows;
use stickslip_wire::sweep::{AxisValues, CheckedSweep, indices};

use crate::api::formats::Format;

/// Rows, or numbers of a column, that are written at a time.
const PIECE: usize = 512;

/// What was asked for, and what came of it.
pub struct Table {
    axes: Vec<AxisValues>,
    names: Vec<String>,
    points: usize,
    rows: Rows,
}

impl Table {
    /// The table of a sweep; there is a row for each of its points.
    #[must_use]
    pub fn new(draft: &CheckedSweep, rows: Rows) -> Table {
        let axes = draft.request.axes.iter().map(|axis| axis.pointer.clone());
        let names = axes.chain(draft.request.outputs.iter().cloned()).collect();
        Table { axes: draft.axes.clone(), names, points: draft.points, rows }
    }

    /// Its columns' names: the pointers of the axes and of the outputs.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.names.iter().map(String::as_str)
    }

    /// How many rows it has.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.points
    }

    /// How many columns it has.
    #[must_use]
    pub fn columns(&self) -> usize {
        self.names.len()
    }

    /// The number in a row and a column, if there is one.
    #[must_use]
    pub fn number(&self, row: usize, column: usize) -> Option<Number> {
        match column.checked_sub(self.axes.len()) {
            None => indices(&self.axes, row).nth(column).map(|(axis, index)| axis.number(index)),
            Some(output) => {
                let outputs = self.names.len() - self.axes.len();
                let value = self.rows.values.get(row * outputs + output)?;
                Number::from_f64(*value)
            }
        }
    }

    /// The table in a format; one piece after the other makes the whole.
    pub fn pieces(self, format: Format) -> Box<dyn Iterator<Item = Vec<u8>> + Send> {
        if format == Format::Arrow { Box::new(arrow::pieces(self)) } else { Box::new(self.text(format)) }
    }

    fn text(self, format: Format) -> impl Iterator<Item = Vec<u8>> + Send {
        let blocks = self.points.div_ceil(PIECE);
        let count = if format == Format::Columns { blocks * self.columns() } else { blocks };
        (0..count).map(move |piece| {
            let mut text = String::new();
            if format == Format::Columns {
                self.column(&mut text, piece / blocks, piece % blocks);
            } else {
                self.block(&mut text, format, piece);
            }
            text.into_bytes()
        })
    }

    fn last(&self, row: usize) -> bool {
        row + 1 == self.points
    }

    fn column(&self, text: &mut String, column: usize, block: usize) {
        let first = block * PIECE;
        if column == 0 && block == 0 {
            *text = format!("{{\"points\":{},\"columns\":{{", self.points);
        }
        if block == 0 {
            let name = Value::from(self.names().nth(column).unwrap_or_default());
            let comma = if column > 0 { "," } else { "" };
            // Writing to a string cannot fail.
            let _ = write!(text, "{comma}{name}:[");
        }
        for row in first..self.points.min(first + PIECE) {
            if row > 0 {
                text.push(',');
            }
            write_number(text, self.number(row, column), "null");
            if self.last(row) {
                text.push(']');
            }
            if self.last(row) && column + 1 == self.columns() {
                let failures = serde_json::to_string(&self.rows.failures).unwrap_or_else(|_| "[]".to_owned());
                let _ = write!(text, "}},\"failed\":{},\"failures\":{failures}}}", self.rows.failed);
            }
        }
    }

    fn block(&self, text: &mut String, format: Format, block: usize) {
        let first = block * PIECE;
        let names: Vec<String> = self.names().map(|name| Value::from(name).to_string()).collect();
        if block == 0 {
            match format {
                Format::Csv => *text = self.names().map(quoted).collect::<Vec<_>>().join(",") + "\n",
                Format::Rows => text.push('['),
                _ => {}
            }
        }
        for row in first..self.points.min(first + PIECE) {
            if format == Format::Rows && row > 0 {
                text.push(',');
            }
            for (column, name) in names.iter().enumerate() {
                let comma = if column > 0 { "," } else { "" };
                let number = self.number(row, column);
                if format == Format::Csv {
                    text.push_str(comma);
                    write_number(text, number, "");
                } else {
                    let open = if column == 0 { "{" } else { "" };
                    let _ = write!(text, "{comma}{open}{name}:");
                    write_number(text, number, "null");
                }
            }
            match format {
                Format::Csv => text.push('\n'),
                Format::Rows if self.last(row) => text.push_str("}]"),
                Format::Rows => text.push('}'),
                _ => text.push_str("}\n"),
            }
        }
    }
}

fn write_number(text: &mut String, number: Option<Number>, none: &str) {
    // Writing to a string cannot fail.
    let _ = match number {
        Some(number) => write!(text, "{number}"),
        None => write!(text, "{none}"),
    };
}

/// A name in a table of comma-separated values.
fn quoted(name: &str) -> String {
    if name.contains([',', '"', '\n', '\r']) { format!("\"{}\"", name.replace('"', "\"\"")) } else { name.to_owned() }
}
