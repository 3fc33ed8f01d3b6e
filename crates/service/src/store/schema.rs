//! Versions of the tables of a store.
//!
//! A store has an ordered list of migrations, each a script that leads from one version to the next; the first one
//! makes the tables of version 1. The version of a store is the number of migrations it has seen. Those that it has not
//! seen are applied at start, all of them in one transaction. A version that has been released is never edited.

use std::cmp::Ordering;

/// Why the tables of a store cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum SchemaError<E> {
    /// They have another version, which the text names.
    #[error("{0}")]
    Version(String),
    /// The database refused or was lost.
    #[error(transparent)]
    Database(#[from] E),
}

/// The migrations that are still to be applied to tables of a version, each with the version that it leads to.
///
/// # Errors
/// Why the tables cannot be used, if a later version of this program has migrated them.
pub(super) fn pending<'a>(
    found: i32,
    migrations: &'a [&'a str],
) -> Result<impl Iterator<Item = (i32, &'a str)>, String> {
    if found > newest(migrations) {
        check(found, migrations)?;
    }
    Ok((1..).zip(migrations.iter().copied()).filter(move |(version, _)| *version > found))
}

/// Refuses tables that are not at the version of the last of these migrations.
pub(super) fn check(found: i32, migrations: &[&str]) -> Result<(), String> {
    let known = newest(migrations);
    match found.cmp(&known) {
        Ordering::Less => {
            Err(format!("it has schema version {found}: `stickslip serve` migrates it to version {known}"))
        }
        Ordering::Equal => Ok(()),
        Ordering::Greater => Err(format!(
            "it has schema version {found}, but this program supports versions up to {known}: start the newer program"
        )),
    }
}

/// The version that the last of the migrations leads to.
pub(super) fn newest(migrations: &[&str]) -> i32 {
    i32::try_from(migrations.len()).unwrap_or(i32::MAX)
}
