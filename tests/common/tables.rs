//! Tables in every flat format.

use arrow_array::cast::AsArray as _;
use arrow_array::types::{Float64Type, TimestampNanosecondType, UInt64Type};
use arrow_array::{Array as _, ArrayRef, RecordBatch};
use arrow_ipc::reader::StreamReader;
use arrow_schema::{DataType, TimeUnit};
use serde_json::{Map, Value, json};

/// A number or a text in CSV.
fn cell(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}

/// A value as in JSON.
fn arrow_value(column: &ArrayRef, row: usize) -> Value {
    if column.is_null(row) {
        return Value::Null;
    }
    match column.data_type() {
        DataType::Float64 => json!(column.as_primitive::<Float64Type>().value(row)),
        DataType::UInt64 => json!(column.as_primitive::<UInt64Type>().value(row)),
        DataType::Utf8 => json!(column.as_string::<i32>().value(row)),
        DataType::Timestamp(TimeUnit::Nanosecond, Some(zone)) if &**zone == "UTC" => {
            let since = column.as_primitive::<TimestampNanosecondType>().value(row);
            json!(jiff::Timestamp::from_nanosecond(i128::from(since)).unwrap())
        }
        other => panic!("{other}"),
    }
}

/// The names and rows of a stream of Arrow's record batches.
fn read(stream: &[u8]) -> (Vec<String>, Vec<Vec<Value>>) {
    let stream = StreamReader::try_new(stream, None).unwrap();
    let names = stream.schema().fields().iter().map(|field| field.name().clone()).collect();
    let batches: Vec<RecordBatch> = stream.map(Result::unwrap).collect();
    let row = |batch: &RecordBatch, row| batch.columns().iter().map(|column| arrow_value(column, row)).collect();
    let rows = batches.iter().flat_map(|batch| (0..batch.num_rows()).map(|at| row(batch, at)).collect::<Vec<_>>());
    (names, rows.collect())
}

/// Asserts that the flat formats of a table hold the same numbers; its names, and its rows.
pub fn same_numbers(rows: &[u8], csv: &[u8], ndjson: &[u8], arrow: &[u8]) -> (Vec<String>, Vec<Vec<Value>>) {
    let (names, of_arrow) = read(arrow);
    let of = |objects: Vec<Map<String, Value>>| -> Vec<Vec<Value>> {
        let row = |object: Map<String, Value>| {
            assert_eq!(object.len(), names.len(), "{object:?}");
            names.iter().map(|name| object[name].clone()).collect()
        };
        objects.into_iter().map(row).collect()
    };
    let text = |bytes| std::str::from_utf8(bytes).unwrap();
    let of_rows = of(serde_json::from_slice(rows).unwrap());
    assert_eq!(of_rows, of(text(ndjson).lines().map(|line| serde_json::from_str(line).unwrap()).collect()));
    // A whole number is a number there.
    let same = |one: &Value, other: &Value| one == other || one.is_number() && one.as_f64() == other.as_f64();
    let differ = of_rows.iter().flatten().zip(of_arrow.iter().flatten()).find(|(one, other)| !same(one, other));
    assert_eq!((of_rows.len(), None), (of_arrow.len(), differ));
    let expected = of_rows.iter().map(|row| row.iter().map(cell).collect::<Vec<_>>().join(","));
    let expected: Vec<String> = std::iter::once(names.join(",")).chain(expected).collect();
    assert_eq!(text(csv).lines().collect::<Vec<_>>(), expected);
    (names, of_rows)
}
