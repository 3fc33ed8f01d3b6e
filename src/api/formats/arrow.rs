//! The table of a sweep as a stream of Arrow's record batches.

use std::sync::Arc;

use arrow_array::{ArrayRef, Float64Array, RecordBatch};
use arrow_ipc::writer::StreamWriter;
use arrow_schema::{ArrowError, DataType, Field, Schema};

use crate::api::formats::sheet::{PIECE, Table};

/// One batch after the other. A stream that ends before its mark tells the reader that something is missing.
pub(super) fn pieces(table: Table) -> impl Iterator<Item = Vec<u8>> + Send {
    let fields: Vec<Field> = table.names().map(|name| Field::new(name, DataType::Float64, true)).collect();
    let schema = Arc::new(Schema::new(fields));
    let mut writer = StreamWriter::try_new(Vec::new(), &schema).ok();
    let blocks = table.rows().div_ceil(PIECE);
    (0..=blocks).map_while(move |block| {
        let writer = writer.as_mut()?;
        let written = if block < blocks {
            batch(&table, &schema, block).and_then(|batch| writer.write(&batch))
        } else {
            writer.finish()
        };
        written.ok()?;
        Some(std::mem::take(writer.get_mut()))
    })
}

fn batch(table: &Table, schema: &Arc<Schema>, block: usize) -> Result<RecordBatch, ArrowError> {
    let rows = block * PIECE..table.rows().min((block + 1) * PIECE);
    let columns = (0..table.columns()).map(|column| {
        let numbers = rows.clone().map(|row| table.number(row, column).and_then(|number| number.as_f64()));
        Arc::new(numbers.collect::<Float64Array>()) as ArrayRef
    });
    RecordBatch::try_new(Arc::clone(schema), columns.collect())
}
