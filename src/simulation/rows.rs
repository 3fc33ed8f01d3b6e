//! Rows of a sweep's table, and how they become bytes for a store.

use stickslip_wire::{PointFailure, limits};

/// The outputs of points that follow each other.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rows {
    /// The numbers, row by row; not a number where there is none.
    pub values: Vec<f64>,
    /// How many points have no answer.
    pub failed: u64,
    /// The first of them.
    pub failures: Vec<PointFailure>,
}

impl Rows {
    /// The row of a point without an answer.
    pub(super) fn fail(&mut self, outputs: usize, failure: PointFailure) {
        self.values.extend(std::iter::repeat_n(f64::NAN, outputs));
        self.failed += 1;
        if self.failures.len() < limits::SWEEP_FAILURES {
            self.failures.push(failure);
        }
    }

    /// Puts the rows of the points that come next behind these.
    pub fn append(&mut self, next: Rows) {
        self.values.extend(next.values);
        self.failed += next.failed;
        self.failures.extend(next.failures);
        self.failures.truncate(limits::SWEEP_FAILURES);
    }

    /// The same as bytes: how many failed, how long their list is, the list as JSON, and the numbers.
    #[must_use]
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

    /// The rows of so many numbers from their bytes; none if they are not that.
    #[must_use]
    pub fn from_bytes(bytes: &[u8], numbers: usize) -> Option<Rows> {
        let (failed, rest) = bytes.split_first_chunk()?;
        let (length, rest) = rest.split_first_chunk()?;
        let (failures, values) = rest.split_at_checked(usize::try_from(u64::from_le_bytes(*length)).ok()?)?;
        let (values, odd) = values.as_chunks();
        (odd.is_empty() && values.len() == numbers).then_some(())?;
        Some(Rows {
            values: values.iter().map(|bytes| f64::from_le_bytes(*bytes)).collect(),
            failed: u64::from_le_bytes(*failed),
            failures: serde_json::from_slice(failures).ok()?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::Rows;
    use stickslip_wire::{PointFailure, limits};

    #[test]
    fn rows_come_back_to_the_last_bit_and_what_is_cut_off_does_not() {
        let failure = PointFailure {
            index: 7,
            code: "beyond_profile".to_owned(),
            pointer: String::new(),
            detail: "far".to_owned(),
        };
        let mut rows = Rows { values: vec![0.1, -0.0, 1e-300], ..Rows::default() };
        for _ in 0..2 * limits::SWEEP_FAILURES {
            rows.fail(1, failure.clone());
        }
        assert_eq!((rows.failed, rows.failures.len()), (2 * limits::SWEEP_FAILURES as u64, limits::SWEEP_FAILURES));
        let bytes = rows.to_bytes();
        let back = Rows::from_bytes(&bytes, rows.values.len()).unwrap();
        let bits = |rows: &Rows| rows.values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
        assert_eq!((bits(&back), back.failed, &back.failures), (bits(&rows), rows.failed, &rows.failures));
        for length in [0, 8, 20, bytes.len() - 8, bytes.len() - 1] {
            assert!(Rows::from_bytes(&bytes[..length], rows.values.len()).is_none(), "{length}");
        }
    }
}
