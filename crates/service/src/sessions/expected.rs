//! What a client expects a contact to be when it changes it.

use super::prelude::*;

/// The version of a contact that a client expects: an `ETag` of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Expected {
    /// How many moves it has made.
    pub sequence: u64,
    /// The checksum of its label, where the client has given it.
    pub label: Option<u32>,
}

/// The checksum of a label; 0 of none.
pub fn label_checksum(label: Option<&str>) -> u32 {
    crc32fast::hash(label.unwrap_or_default().as_bytes())
}

impl From<u64> for Expected {
    fn from(sequence: u64) -> Expected {
        Expected { sequence, label: None }
    }
}

impl Expected {
    /// Refuses a contact that is another one than expected.
    pub(super) fn check(self, found: u64, label: Option<&str>) -> Result<(), SessionError> {
        if found != self.sequence {
            return Err(SessionError::Stale { expected: self.sequence, found });
        }
        if self.label.is_some_and(|expected| expected != label_checksum(label)) {
            return Err(SessionError::Relabelled { found });
        }
        Ok(())
    }
}
