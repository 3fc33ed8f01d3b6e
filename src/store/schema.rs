//! Versions of the tables of a store.
//!
//! A store has an ordered list of migrations, each a script that leads from one version to the next; the first one
//! makes the tables of version 1. The version of a store is the number of migrations it has seen. Those that it has not
//! seen are applied at start, all of them in one transaction. A version that has been released is never edited.

use std::cmp::Ordering;

/// Why tables of a version cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum VersionError {
    /// A later version of this program has migrated the store.
    #[error("it has schema version {found}, but this program supports versions up to {known}: start the newer program")]
    Newer {
        /// The version of the tables.
        found: i32,
        /// The newest version that this program supports.
        known: i32,
    },
    /// An earlier version has made the store, which is open for reading only.
    #[error("it has schema version {found}: `stickslip serve` migrates it to version {known}")]
    Older {
        /// The version of the tables.
        found: i32,
        /// The version that this program works with.
        known: i32,
    },
}

/// Why the tables of a store cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum SchemaError<E> {
    /// They have another version.
    #[error(transparent)]
    Version(VersionError),
    /// The database refused or was lost.
    #[error(transparent)]
    Database(#[from] E),
}

/// The migrations that are still to be applied to tables of a version, each with the version that it leads to.
///
/// # Errors
/// [`VersionError::Newer`] if the version is later than all migrations.
pub(super) fn pending<'a>(
    found: i32,
    migrations: &'a [&'a str],
) -> Result<impl Iterator<Item = (i32, &'a str)>, VersionError> {
    match check(found, migrations) {
        Err(error @ VersionError::Newer { .. }) => Err(error),
        _ => Ok((1..).zip(migrations.iter().copied()).filter(move |(version, _)| *version > found)),
    }
}

/// Whether tables are at the version of the last of these migrations.
pub(super) fn check(found: i32, migrations: &[&str]) -> Result<(), VersionError> {
    let known = newest(migrations);
    match found.cmp(&known) {
        Ordering::Less => Err(VersionError::Older { found, known }),
        Ordering::Equal => Ok(()),
        Ordering::Greater => Err(VersionError::Newer { found, known }),
    }
}

/// The version that the last of the migrations leads to.
pub(super) fn newest(migrations: &[&str]) -> i32 {
    i32::try_from(migrations.len()).unwrap_or(i32::MAX)
}
