//! The version of the tables in a file, and its migration to the newest one.

use rusqlite::{Connection, Error, TransactionBehavior};

use crate::store::schema::{self, SchemaError};

/// Marks a file as one of this program: "stck" in the header.
pub(super) const APPLICATION: i32 = 0x7374_636b;

/// The same while a process writes to it: "stco". A file with this mark has not been closed, and is not whole without
/// its write-ahead log. The mark is in the file itself before anything is written to the log, and is taken back when
/// the log has been merged.
pub(super) const IN_USE: i32 = 0x7374_636f;

/// The migrations, oldest first: each leads from one version of the tables to the next.
pub const MIGRATIONS: &[&str] = &[
    include_str!("schema_1.sql"),
    include_str!("schema_2.sql"),
    include_str!("schema_3.sql"),
    include_str!("schema_4.sql"),
    include_str!("schema_5.sql"),
    include_str!("schema_6.sql"),
    include_str!("schema_7.sql"),
];

pub(super) fn mark(connection: &Connection, application: i32) -> rusqlite::Result<()> {
    connection.pragma_update(None, "application_id", application)
}

/// The version of the tables; 0 where there are none.
pub(super) fn version(connection: &Connection) -> rusqlite::Result<i32> {
    connection.pragma_query_value(None, "user_version", |row| row.get(0))
}

/// Whether the tables have the version that this program works with.
pub(super) fn check(connection: &Connection) -> Result<(), SchemaError<Error>> {
    schema::check(version(connection)?, MIGRATIONS).map_err(SchemaError::Version)
}

/// Whether this program supports a version of tables, and so may migrate it.
pub(super) fn known(version: i32) -> Result<(), String> {
    if version < 1 {
        return Err("it is incomplete: its tables have no version".to_owned());
    }
    schema::pending(version, MIGRATIONS).map(drop)
}

/// Applies the migrations that a database has not seen, all of them or none.
///
/// # Errors
/// [`SchemaError`]; nothing has changed then.
pub fn migrate(connection: &mut Connection, migrations: &[&str]) -> Result<(), SchemaError<Error>> {
    let transaction = connection.transaction_with_behavior(TransactionBehavior::Immediate)?;
    for (version, script) in schema::pending(version(&transaction)?, migrations).map_err(SchemaError::Version)? {
        transaction.execute_batch(script)?;
        mark(&transaction, APPLICATION)?;
        transaction.pragma_update(None, "user_version", version)?;
    }
    Ok(transaction.commit()?)
}
