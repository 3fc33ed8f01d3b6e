//! Tables of named columns, and how they are written: as rows, CSV, NDJSON and Arrow.

use std::collections::HashMap;
use std::fmt::Write as _;
use std::sync::Arc;

use arrow_array::{ArrayRef, Float64Array, RecordBatch, StringArray, TimestampNanosecondArray, UInt64Array};
use arrow_ipc::writer::StreamWriter;
use arrow_schema::{ArrowError, Field as ArrowField, Schema};
use jiff::Timestamp;
use serde_json::{Value, json};

use stickslip_wire::{Field, HistoryPage, LoopPage, StressReply};

use crate::api::formats::Format;
use crate::api::problem::Problem;

/// Columns of one length.
pub struct Table {
    columns: Vec<(&'static str, &'static str, Column)>,
}

/// The values of a column.
pub enum Column {
    /// Numbers; what has no value is infinite, or not there.
    Numbers(Vec<Option<f64>>),
    /// Whole numbers.
    Counts(Vec<u64>),
    /// Moments.
    Times(Vec<Timestamp>),
    /// Words, without commas and quotes.
    Words(Vec<&'static str>),
}

impl Column {
    fn length(&self) -> usize {
        match self {
            Column::Numbers(values) => values.len(),
            Column::Counts(values) => values.len(),
            Column::Times(values) => values.len(),
            Column::Words(values) => values.len(),
        }
    }

    fn value(&self, row: usize) -> Value {
        match self {
            Column::Numbers(values) => json!(values[row]),
            Column::Counts(values) => json!(values[row]),
            Column::Times(values) => json!(values[row]),
            Column::Words(values) => json!(values[row]),
        }
    }

    fn array(&self) -> ArrayRef {
        match self {
            Column::Numbers(values) => Arc::new(values.iter().copied().collect::<Float64Array>()),
            Column::Counts(values) => Arc::new(values.iter().copied().collect::<UInt64Array>()),
            Column::Times(values) => {
                let since = |time: &Timestamp| i64::try_from(time.as_nanosecond()).ok();
                let times: TimestampNanosecondArray = values.iter().map(since).collect();
                Arc::new(times.with_timezone("UTC"))
            }
            Column::Words(values) => Arc::new(values.iter().map(Some).collect::<StringArray>()),
        }
    }
}

/// Finite numbers as a column.
fn all(values: impl Iterator<Item = f64>) -> Column {
    Column::Numbers(values.map(Some).collect())
}

impl Table {
    /// Stresses.
    #[must_use]
    pub fn of_stress(reply: &StressReply) -> Table {
        let mut columns = vec![("radius", "m", all(reply.radius.iter().copied()))];
        for field in Field::ALL {
            let (unit, values) = match field {
                Field::Pressure => ("Pa", &reply.pressure),
                Field::Shear => ("Pa", &reply.shear),
                Field::Slip => ("m", &reply.slip),
                Field::Displacement => ("m", &reply.displacement),
            };
            columns.extend(values.clone().map(|values| (field.name(), unit, Column::Numbers(values))));
        }
        Table { columns }
    }

    /// A page of a history: the states with their numbers and times.
    #[must_use]
    pub fn of_history(page: &HistoryPage) -> Table {
        let items = || page.items.iter();
        let states = || page.items.iter().map(|item| &item.state);
        Table {
            columns: vec![
                ("sequence", "1", Column::Counts(items().map(|item| item.sequence).collect())),
                ("at", "UTC", Column::Times(items().map(|item| item.at).collect())),
                ("displacement", "m", all(states().map(|state| state.displacement))),
                ("force", "N", all(states().map(|state| state.force))),
                ("indentation", "m", all(states().map(|state| state.indentation))),
                ("normal_force", "N", all(states().map(|state| state.normal_force))),
                ("contact_radius", "m", all(states().map(|state| state.contact_radius))),
                ("stick_radius", "m", all(states().map(|state| state.stick_radius))),
                ("regime", "", Column::Words(states().map(|state| state.regime.name()).collect())),
                ("dissipated_energy", "J", all(states().map(|state| state.dissipated_energy))),
                ("elastic_energy", "J", all(states().map(|state| state.elastic_energy))),
                ("memory_depth", "1", Column::Counts(states().map(|state| state.memory_depth as u64).collect())),
            ],
        }
    }

    /// A page of a hysteresis loop.
    #[must_use]
    pub fn of_loop(page: &LoopPage) -> Table {
        Table {
            columns: vec![
                ("sequence", "1", Column::Counts(page.sequence.clone())),
                ("part", "1", all(page.part.iter().copied())),
                ("displacement", "m", all(page.displacement.iter().copied())),
                ("force", "N", all(page.force.iter().copied())),
            ],
        }
    }

    /// The table in a flat format.
    ///
    /// # Errors
    /// [`Problem::internal`] if Arrow refuses it, which it does with no table of ours.
    pub fn written(&self, format: Format) -> Result<Vec<u8>, Problem> {
        match format {
            Format::Arrow => {
                self.arrow().map_err(|error| Problem::internal(format!("a table cannot be written: {error}")))
            }
            text => Ok(self.text(text)),
        }
    }

    fn rows(&self) -> usize {
        self.columns.first().map_or(0, |(.., column)| column.length())
    }

    fn arrow(&self) -> Result<Vec<u8>, ArrowError> {
        let arrays: Vec<ArrayRef> = self.columns.iter().map(|(.., column)| column.array()).collect();
        let fields = self.columns.iter().zip(&arrays).map(|((name, unit, column), array)| {
            let nullable = matches!(column, Column::Numbers(_) | Column::Times(_));
            let unit = HashMap::from([("unit".to_owned(), (*unit).to_owned())]);
            ArrowField::new(*name, array.data_type().clone(), nullable).with_metadata(unit)
        });
        let schema = Arc::new(Schema::new(fields.collect::<Vec<_>>()));
        let batch = RecordBatch::try_new(Arc::clone(&schema), arrays)?;
        let mut writer = StreamWriter::try_new(Vec::new(), &schema)?;
        writer.write(&batch)?;
        writer.into_inner()
    }

    fn text(&self, format: Format) -> Vec<u8> {
        let csv = format == Format::Csv;
        let names: Vec<&str> = self.columns.iter().map(|(name, ..)| *name).collect();
        let mut text = match format {
            Format::Csv => names.join(",") + "\n",
            Format::Rows => "[".to_owned(),
            _ => String::new(),
        };
        for row in 0..self.rows() {
            if row > 0 && format == Format::Rows {
                text.push(',');
            }
            for (index, (name, _, column)) in self.columns.iter().enumerate() {
                let comma = if index > 0 { "," } else { "" };
                // Writing to a string cannot fail.
                let _ = match column.value(row) {
                    Value::Null if csv => write!(text, "{comma}"),
                    Value::String(value) if csv => write!(text, "{comma}{value}"),
                    value if csv => write!(text, "{comma}{value}"),
                    value if index == 0 => write!(text, "{{\"{name}\":{value}"),
                    value => write!(text, ",\"{name}\":{value}"),
                };
            }
            if !csv {
                text.push('}');
            }
            if format != Format::Rows {
                text.push('\n');
            }
        }
        if format == Format::Rows {
            text.push(']');
        }
        text.into_bytes()
    }
}
