//! Results of consecutive points of a sweep, and their encoding as bytes for a store.

use std::sync::Arc;

use serde_json::Number;

use stickslip_wire::PointFailure;
use stickslip_wire::sweep::CheckedSweep;

use super::uncertainty::uncertainty;
use crate::formats::{Blocks, Cells, Column, Format, Table};
use crate::prelude::*;

/// The outputs of consecutive points.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SweepResult {
    /// The numbers, point by point; NaN where one is missing.
    pub values: Vec<f64>,
    /// Number of points without an answer.
    pub failed: u64,
    /// The first points without an answer.
    pub failures: Vec<PointFailure>,
}

impl SweepResult {
    /// The row of a point without an answer.
    pub(super) fn push_failure(&mut self, outputs: usize, failure: PointFailure) {
        self.values.extend(std::iter::repeat_n(f64::NAN, outputs));
        self.failed += 1;
        if self.failures.len() < limits::SWEEP_FAILURES {
            self.failures.push(failure);
        }
    }

    /// Appends the results of the points that follow.
    pub fn append(&mut self, next: SweepResult) {
        self.values.extend(next.values);
        self.failed += next.failed;
        self.failures.extend(next.failures);
        self.failures.truncate(limits::SWEEP_FAILURES);
    }

    /// What is sent in a format, block by block: the table, or the document of uncertain inputs.
    pub fn blocks(self, sweep: &CheckedSweep, format: Format) -> Blocks<'static> {
        match &sweep.samples {
            Some(samples) if format == Format::Columns => {
                // Texts and numbers can always be written.
                let document = serde_json::to_vec(&uncertainty(&self, sweep, samples)).unwrap_or_default();
                Box::new(std::iter::once(Ok(document)))
            }
            _ => self.table(sweep).blocks(format),
        }
    }

    /// The table of the sweep: a row for each point, with the values that change and its outputs.
    pub fn table(self, sweep: &CheckedSweep) -> Table<'static> {
        let SweepResult { values, failed, failures } = self;
        let (number, values) = (sweep.numbers(), Arc::new(values));
        let (request, count) = (&sweep.request, sweep.outputs.len());
        let mut columns = Vec::new();
        for (index, name) in sweep.changing().into_iter().enumerate() {
            let number = number.clone();
            let value = move |row| number(row, index);
            columns.push(Column::new(name, None, Cells::Numbers(Box::new(value))));
        }
        for (index, output) in request.outputs.iter().enumerate() {
            let values = Arc::clone(&values);
            let value = move |row| values.get(row * count + index).and_then(|value| Number::from_f64(*value));
            columns.push(Column::new(output.column(), None, Cells::Numbers(Box::new(value))));
        }
        let failures = serde_json::to_string(&failures).unwrap_or_else(|_| "[]".to_owned());
        let before = format!("{{\"points\":{},\"columns\":{{", sweep.points);
        Table::new(sweep.points, columns, [before, format!("}},\"failed\":{failed},\"failures\":{failures}}}")])
    }

    /// Its bytes: how many failed, the length of their list, the list as JSON, and the numbers.
    pub fn to_bytes(&self) -> Vec<u8> {
        // Texts and numbers can always be written.
        let failures = serde_json::to_vec(&self.failures).unwrap_or_default();
        let mut bytes = Vec::with_capacity(16 + failures.len() + 8 * self.values.len());
        bytes.extend(self.failed.to_le_bytes());
        bytes.extend((failures.len() as u64).to_le_bytes());
        bytes.extend(failures);
        bytes.extend(self.values.iter().flat_map(|value| value.to_le_bytes()));
        bytes
    }

    /// The result with this many numbers from its bytes; `None` if they are something else.
    pub fn from_bytes(bytes: &[u8], numbers: usize) -> Option<SweepResult> {
        let (failed, rest) = bytes.split_first_chunk()?;
        let (length, rest) = rest.split_first_chunk()?;
        let (failures, values) = rest.split_at_checked(usize::try_from(u64::from_le_bytes(*length)).ok()?)?;
        let (values, odd) = values.as_chunks();
        (odd.is_empty() && values.len() == numbers).then_some(())?;
        Some(SweepResult {
            values: values.iter().map(|bytes| f64::from_le_bytes(*bytes)).collect(),
            failed: u64::from_le_bytes(*failed),
            failures: serde_json::from_slice(failures).ok()?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::SweepResult;
    use stickslip_wire::{PointFailure, limits};

    #[test]
    fn rows_are_read_to_the_last_bit_and_truncated_ones_are_not() {
        let failure = PointFailure {
            index: 7,
            code: "beyond_profile".to_owned(),
            pointer: String::new(),
            detail: "far".to_owned(),
        };
        let mut result = SweepResult { values: vec![0.1, -0.0, 1e-300], ..SweepResult::default() };
        for _ in 0..2 * limits::SWEEP_FAILURES {
            result.push_failure(1, failure.clone());
        }
        assert_eq!((result.failed, result.failures.len()), (2 * limits::SWEEP_FAILURES as u64, limits::SWEEP_FAILURES));
        let bytes = result.to_bytes();
        let back = SweepResult::from_bytes(&bytes, result.values.len()).unwrap();
        let bits = |result: &SweepResult| result.values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
        assert_eq!((bits(&back), back.failed, &back.failures), (bits(&result), result.failed, &result.failures));
        for length in [0, 8, 20, bytes.len() - 8, bytes.len() - 1] {
            assert!(SweepResult::from_bytes(&bytes[..length], result.values.len()).is_none(), "{length}");
        }
    }
}
