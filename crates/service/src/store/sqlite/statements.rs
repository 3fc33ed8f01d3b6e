//! Statements that several changes make within the transaction under way.

use rusqlite::{Connection, params};
use uuid::Uuid;

use crate::store::rows::{RowReader as _, tenant};
use crate::store::{Clock, RECEIPT_LIFETIME, Receipt, Session, StoreError};

use super::columns::{clamped_nanoseconds, execute, first, to_integer, to_nanoseconds};
use super::fault::Fault;

/// Refuses a receipt whose key is in use.
pub(super) fn check_key(database: &Connection, receipt: Option<&Receipt>, clock: Clock) -> Result<(), Fault> {
    let Some(receipt) = receipt else { return Ok(()) };
    let mut statement = database.prepare_cached("SELECT number FROM receipts WHERE key = ?1 AND at > ?2")?;
    if statement.exists(params![receipt.request.key, clamped_nanoseconds(clock.ago(RECEIPT_LIFETIME))])? {
        return Err(StoreError::KeyTaken.into());
    }
    Ok(())
}

/// Stores a receipt, in place of an expired one.
pub(super) fn insert_receipt(database: &Connection, receipt: Option<&Receipt>, clock: Clock) -> rusqlite::Result<()> {
    let Some(Receipt { request, reply }) = receipt else { return Ok(()) };
    let sql = "INSERT OR REPLACE INTO receipts (key, fingerprint, created, sequence, body, at)
               VALUES (?1, ?2, ?3, ?4, ?5, ?6)";
    let (created, now) = (reply.created.map(|id| id.to_string()), to_nanoseconds(clock.now())?);
    let receipt = params![request.key, request.fingerprint, created, to_integer(reply.sequence)?, reply.body, now];
    execute(database, sql, receipt).map(drop)
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
    let (created_at, updated_at) = (to_nanoseconds(session.created_at)?, to_nanoseconds(session.updated_at)?);
    let (id, inherited, tenant) = (session.id.to_string(), to_integer(inherited)?, session.tenant.name());
    let contact = params![number, id, session.label, definition, created_at, updated_at, inherited, tenant];
    execute(database, sql, contact).map(drop)
}

/// The number of a session, and its sequence.
pub(super) fn number_and_sequence(database: &Connection, id: Uuid) -> Result<(i64, u64), Fault> {
    let sql = "SELECT number, (SELECT coalesce(max(sequence), 0) FROM moves WHERE contact = number) FROM contacts
               WHERE id = ?1";
    let found = first(database, sql, [id.to_string()], |row| Ok((row.next()?, row.count()?)))?;
    found.ok_or_else(|| missing(database, id))
}

/// The number of a session that must be at a sequence.
pub(super) fn number_at(database: &Connection, id: Uuid, expected: u64) -> Result<i64, Fault> {
    match number_and_sequence(database, id)? {
        (number, found) if found == expected => Ok(number),
        (_, found) => Err(StoreError::Stale { found }.into()),
    }
}

/// Why the session was not found.
pub(super) fn missing(database: &Connection, id: Uuid) -> Fault {
    let expired = first(database, "SELECT tenant FROM expired WHERE id = ?1", [id.to_string()], |row| tenant(row));
    expired.map_or_else(Fault::from, |tenant| tenant.map_or(StoreError::NotFound, StoreError::Expired).into())
}
