//! Statements that several changes make within the transaction under way.

use jiff::{SignedDuration, Timestamp};
use rusqlite::{Connection, OptionalExtension as _, params};
use uuid::Uuid;

use crate::store::rows::{RowReader as _, tenant};
use crate::store::{RECEIPT_LIFETIME, Receipt, Session, StoreError};

use super::columns::{clamped_nanoseconds, reader, to_integer, to_nanoseconds};
use super::fault::Fault;

/// Refuses a receipt whose key is in use.
pub(super) fn check_key(database: &Connection, receipt: Option<&Receipt>) -> Result<(), Fault> {
    let Some(receipt) = receipt else { return Ok(()) };
    let mut statement = database.prepare_cached("SELECT number FROM receipts WHERE key = ?1 AND at > ?2")?;
    if statement.exists(params![receipt.request.key, clamped_nanoseconds(receipt_cutoff())])? {
        return Err(StoreError::KeyTaken.into());
    }
    Ok(())
}

/// Stores a receipt, in place of an expired one.
pub(super) fn insert_receipt(database: &Connection, receipt: Option<&Receipt>) -> rusqlite::Result<()> {
    let Some(Receipt { request, reply }) = receipt else { return Ok(()) };
    let sql = "INSERT OR REPLACE INTO receipts (key, fingerprint, created, sequence, body, at)
               VALUES (?1, ?2, ?3, ?4, ?5, ?6)";
    database.prepare_cached(sql)?.execute(params![
        request.key,
        request.fingerprint,
        reply.created.map(|id| id.to_string()),
        to_integer(reply.sequence)?,
        reply.body,
        to_nanoseconds(Timestamp::now())?,
    ])?;
    Ok(())
}

/// The time since which receipts count.
pub(super) fn receipt_cutoff() -> Timestamp {
    let lifetime = SignedDuration::try_from(RECEIPT_LIFETIME).unwrap_or(SignedDuration::MAX);
    Timestamp::now().checked_sub(lifetime).unwrap_or(Timestamp::MIN)
}

/// Writes a session that has inherited this many moves.
pub(super) fn insert_session(
    database: &Connection,
    number: i64,
    session: &Session,
    inherited: u64,
) -> rusqlite::Result<()> {
    let definition = serde_json::to_string(&*session.definition);
    let definition = definition.map_err(|error| rusqlite::Error::ToSqlConversionFailure(Box::new(error)))?;
    let sql = "INSERT INTO contacts (number, id, label, definition, created_at, initial_updated_at, inherited, tenant)
               VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8)";
    database.prepare_cached(sql)?.execute(params![
        number,
        session.id.to_string(),
        session.label,
        definition,
        to_nanoseconds(session.created_at)?,
        to_nanoseconds(session.updated_at)?,
        to_integer(inherited)?,
        session.tenant.name(),
    ])?;
    Ok(())
}

/// The number of a session, and its sequence.
pub(super) fn number_and_sequence(database: &Connection, id: Uuid) -> Result<(i64, u64), Fault> {
    let sql = "SELECT number, (SELECT coalesce(max(sequence), 0) FROM moves WHERE contact = number) FROM contacts
               WHERE id = ?1";
    let found = database.prepare_cached(sql)?.query_row([id.to_string()], |row| {
        let mut row = reader(row);
        Ok((row.next()?, row.count()?))
    });
    found.optional()?.ok_or_else(|| missing(database, id))
}

/// The number of a session that must be at a sequence.
pub(super) fn number_at(database: &Connection, id: Uuid, expected: u64) -> Result<i64, Fault> {
    match number_and_sequence(database, id)? {
        (number, found) if found == expected => Ok(number),
        (_, found) => Err(StoreError::Stale { found }.into()),
    }
}

/// Why there is no such session.
pub(super) fn missing(database: &Connection, id: Uuid) -> Fault {
    let expired = database
        .prepare_cached("SELECT tenant FROM expired WHERE id = ?1")
        .and_then(|mut statement| statement.query_row([id.to_string()], |row| tenant(&mut reader(row))).optional());
    expired.map_or_else(Fault::from, |tenant| tenant.map_or(StoreError::NotFound, StoreError::Expired).into())
}
