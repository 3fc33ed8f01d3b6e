//! What a failure of SQLite means.

use rusqlite::{Error, ErrorCode, ffi};

use crate::store::StoreError;

/// Why a read or a change was not done.
#[derive(Debug, thiserror::Error)]
pub(super) enum Fault {
    /// The store refuses it; nothing was written.
    #[error(transparent)]
    Refused(#[from] StoreError),
    /// SQLite failed: a transaction under way must be rolled back.
    #[error(transparent)]
    Sqlite(#[from] Error),
}

impl Fault {
    /// The error of a read, or of a change that has been rolled back.
    pub(super) fn into_store_error(self) -> StoreError {
        match self {
            Fault::Refused(error) => error,
            Fault::Sqlite(error) => store_error(&error, Stage::Before),
        }
    }
}

/// When a failure occurred.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stage {
    /// Before the commit: the changes have been rolled back.
    Before,
    /// During the commit.
    Commit,
}

/// Whether another attempt with fewer changes may succeed.
pub(super) fn worth_splitting(error: &Error) -> bool {
    !matches!(
        error.sqlite_error_code(),
        Some(
            ErrorCode::DatabaseBusy
                | ErrorCode::DatabaseLocked
                | ErrorCode::DatabaseCorrupt
                | ErrorCode::NotADatabase
                | ErrorCode::ReadOnly
        )
    ) && !is_sync(error)
}

/// Whether another program has locked the file.
pub(super) fn is_locked(error: &Error) -> bool {
    matches!(error.sqlite_error_code(), Some(ErrorCode::DatabaseBusy | ErrorCode::DatabaseLocked))
}

/// Whether there is no room to write.
pub(super) fn is_full(error: &Error) -> bool {
    matches!(store_error(error, Stage::Before), StoreError::Full(_))
}

/// What a failure of SQLite means for a change or a read.
pub(super) fn store_error(error: &Error, stage: Stage) -> StoreError {
    let why = error.to_string();
    match error.sqlite_error_code() {
        Some(ErrorCode::DiskFull) => StoreError::Full(why),
        // A failed sync leaves open what has reached the disk.
        Some(ErrorCode::SystemIoFailure) if stage == Stage::Commit && is_sync(error) => StoreError::Unavailable(why),
        // Quotas and shared memory on a full disk are reported as failures to write.
        Some(ErrorCode::SystemIoFailure) if is_write(error) => StoreError::Full(why),
        Some(
            ErrorCode::DatabaseBusy
            | ErrorCode::DatabaseLocked
            | ErrorCode::CannotOpen
            | ErrorCode::ReadOnly
            | ErrorCode::OutOfMemory
            | ErrorCode::SystemIoFailure,
        ) => StoreError::Unavailable(why),
        _ => StoreError::Failed(why),
    }
}

fn extended(error: &Error) -> i32 {
    error.sqlite_error().map_or(0, |error| error.extended_code)
}

fn is_sync(error: &Error) -> bool {
    matches!(extended(error), ffi::SQLITE_IOERR_FSYNC | ffi::SQLITE_IOERR_DIR_FSYNC)
}

fn is_write(error: &Error) -> bool {
    matches!(extended(error), ffi::SQLITE_IOERR_WRITE | ffi::SQLITE_IOERR_SHMSIZE | ffi::SQLITE_IOERR_TRUNCATE)
}

#[cfg(test)]
mod tests {
    use super::{Stage, store_error, worth_splitting};
    use crate::store::StoreError;
    use rusqlite::{Error, ffi};

    fn failure(code: i32) -> Error {
        Error::SqliteFailure(ffi::Error::new(code), None)
    }

    #[test]
    fn a_failed_sync_leaves_the_change_in_doubt_and_a_full_disk_does_not() {
        let of = |code| store_error(&failure(code), Stage::Commit);
        assert!(matches!(of(ffi::SQLITE_IOERR_FSYNC), StoreError::Unavailable(_)));
        assert!(matches!(of(ffi::SQLITE_FULL), StoreError::Full(_)));
        assert!(matches!(of(ffi::SQLITE_IOERR_WRITE), StoreError::Full(_)));
        assert!(matches!(of(ffi::SQLITE_BUSY), StoreError::Unavailable(_)));
        assert!(matches!(of(ffi::SQLITE_CORRUPT), StoreError::Failed(_)));
        assert!(worth_splitting(&failure(ffi::SQLITE_FULL)) && !worth_splitting(&failure(ffi::SQLITE_IOERR_FSYNC)));
    }
}
