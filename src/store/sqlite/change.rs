//! The changes that the writer makes, each checked before its first write: a refusal has written nothing.

use jiff::{SignedDuration, Timestamp};
use rusqlite::{Connection, OptionalExtension as _, params};
use uuid::Uuid;

use crate::store::{RECEIPT_LIFETIME, Receipt, Record, Session, Snapshot, StoreError};

use super::fork;
use super::jobs::JobChange;
use super::rows::{MOVE_COLUMNS, bound, insert_move, integer, nanoseconds, natural, tenant};
use super::sequence_cache::SequenceCache;

/// Receipts that one sweep of the writer passes.
const RECEIPTS_AT_ONCE: i64 = 256;
/// Bytes of their replies that it deletes, roughly.
const RECEIPT_BYTES_AT_ONCE: i64 = 4 * 1024 * 1024;

/// A change to the database.
pub(super) enum Change {
    Create { session: Session, receipt: Option<Receipt> },
    Append { id: Uuid, expected: u64, records: Vec<Record>, receipt: Option<Receipt> },
    Fork(Box<Fork>),
    Delete { id: Uuid, expected: u64 },
    KeepSnapshot { id: Uuid, snapshot: Snapshot },
    SweepReceipts,
    Expire { ids: Vec<Uuid>, since: Timestamp },
    Job(JobChange),
}

/// A session to be copied with its past.
pub(super) struct Fork {
    pub(super) id: Uuid,
    pub(super) copy: Session,
    pub(super) receipt: Option<Receipt>,
}

/// What a change came to.
pub(super) enum Done {
    /// It is made, and counts so much: sessions expired, or whether there are more receipts to sweep.
    Made(u64),
    /// The fork has begun; copying goes on in small steps.
    Copying(fork::Copying),
}

/// Why a change was not made.
pub(super) enum ChangeError {
    /// It was refused; nothing was written.
    Refused(StoreError),
    /// SQLite failed half-way: the transaction must be taken back.
    Failed(rusqlite::Error),
}

impl From<rusqlite::Error> for ChangeError {
    fn from(error: rusqlite::Error) -> Self {
        ChangeError::Failed(error)
    }
}

impl Change {
    /// How many rows it writes, roughly.
    pub(super) fn weight(&self) -> usize {
        match self {
            Change::Append { records, .. } => records.len().max(1),
            Change::Expire { ids, .. } => ids.len(),
            _ => 1,
        }
    }

    /// The sessions whose watchers are to be woken when it is made.
    pub(super) fn touched(&self) -> &[Uuid] {
        match self {
            Change::Append { id, .. } | Change::Delete { id, .. } => std::slice::from_ref(id),
            Change::Expire { ids, .. } => ids,
            Change::Job(change) => change.touched(),
            Change::Create { .. } | Change::Fork(_) | Change::KeepSnapshot { .. } | Change::SweepReceipts => &[],
        }
    }

    /// Makes the change within the transaction under way. `number` is free for a new session.
    pub(super) fn make(
        &self,
        database: &Connection,
        cache: &mut SequenceCache,
        number: i64,
    ) -> Result<Done, ChangeError> {
        match self {
            Change::Create { session, receipt } => {
                free(database, receipt.as_ref())?;
                insert_session(database, number, session, 0)?;
                keep(database, receipt.as_ref())?;
            }
            Change::Append { id, expected, records, receipt } => {
                free(database, receipt.as_ref())?;
                let number = match cache.number(*id, *expected) {
                    Some(number) => number,
                    None => at(database, *id, *expected)?,
                };
                let mut insert = database.prepare_cached(&format!(
                    "INSERT INTO moves (contact, {MOVE_COLUMNS})
                     VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14, ?15, ?16, ?17, ?18, ?19, ?20)"
                ))?;
                records.iter().try_for_each(|record| insert_move(&mut insert, number, record))?;
                keep(database, receipt.as_ref())?;
                if let Some(last) = records.last() {
                    cache.moved(*id, number, last.sequence);
                }
            }
            Change::Fork(fork) => return fork.begin(database, number),
            Change::Delete { id, expected } => {
                let number = at(database, *id, *expected)?;
                cache.forget(*id);
                disown(database, number)?;
            }
            Change::KeepSnapshot { id, snapshot } => {
                let sql = "INSERT INTO snapshots (contact, sequence, state)
                           SELECT number, ?2, ?3 FROM contacts WHERE id = ?1
                           ON CONFLICT (contact) DO UPDATE SET sequence = excluded.sequence, state = excluded.state
                           WHERE excluded.sequence > snapshots.sequence";
                let sequence = integer(snapshot.sequence)?;
                database.prepare_cached(sql)?.execute(params![id.to_string(), sequence, snapshot.state])?;
            }
            Change::Job(change) => return change.make(database),
            Change::SweepReceipts => return Ok(Done::Made(sweep_receipts(database)?)),
            Change::Expire { ids, since } => {
                let mut gone = 0;
                for id in ids {
                    cache.forget(*id);
                    gone += u64::from(expire(database, *id, *since)?);
                }
                return Ok(Done::Made(gone));
            }
        }
        Ok(Done::Made(0))
    }
}

/// Refuses a receipt whose key is in use.
pub(super) fn free(database: &Connection, receipt: Option<&Receipt>) -> Result<(), ChangeError> {
    let Some(receipt) = receipt else { return Ok(()) };
    let mut statement = database.prepare_cached("SELECT number FROM receipts WHERE key = ?1 AND at > ?2")?;
    if statement.exists(params![receipt.request.key, bound(receipts_from())])? {
        return Err(ChangeError::Refused(StoreError::KeyTaken));
    }
    Ok(())
}

/// Keeps a receipt, in place of one past its time.
pub(super) fn keep(database: &Connection, receipt: Option<&Receipt>) -> rusqlite::Result<()> {
    let Some(Receipt { request, reply }) = receipt else { return Ok(()) };
    let sql = "INSERT OR REPLACE INTO receipts (key, fingerprint, created, sequence, body, at)
               VALUES (?1, ?2, ?3, ?4, ?5, ?6)";
    database.prepare_cached(sql)?.execute(params![
        request.key,
        request.fingerprint,
        reply.created.map(|id| id.to_string()),
        integer(reply.sequence)?,
        reply.body,
        nanoseconds(Timestamp::now())?,
    ])?;
    Ok(())
}

/// The time since which receipts count.
pub(super) fn receipts_from() -> Timestamp {
    let lifetime = SignedDuration::try_from(RECEIPT_LIFETIME).unwrap_or(SignedDuration::MAX);
    Timestamp::now().checked_sub(lifetime).unwrap_or(Timestamp::MIN)
}

/// Deletes receipts past their time; one if there may be more of them.
fn sweep_receipts(database: &Connection) -> rusqlite::Result<u64> {
    let from = bound(receipts_from());
    let sql = "SELECT number, at, length(body) FROM receipts ORDER BY number LIMIT ?1";
    let mut statement = database.prepare_cached(sql)?;
    let mut rows = statement.query([RECEIPTS_AT_ONCE])?;
    let (mut last, mut count, mut bytes) = (None, 0, 0);
    while let Some(row) = rows.next()? {
        if row.get::<_, i64>(1)? > from || bytes > RECEIPT_BYTES_AT_ONCE {
            break;
        }
        (last, count, bytes) = (Some(row.get::<_, i64>(0)?), count + 1, bytes + row.get::<_, i64>(2)?);
    }
    drop(rows);
    if let Some(last) = last {
        database.prepare_cached("DELETE FROM receipts WHERE number <= ?1")?.execute([last])?;
    }
    Ok(u64::from(count == RECEIPTS_AT_ONCE || bytes > RECEIPT_BYTES_AT_ONCE))
}

/// Writes a session that has taken over so many moves.
pub(super) fn insert_session(
    database: &Connection,
    number: i64,
    session: &Session,
    inherited: u64,
) -> Result<(), rusqlite::Error> {
    let definition = serde_json::to_string(&*session.definition);
    let definition = definition.map_err(|error| rusqlite::Error::ToSqlConversionFailure(Box::new(error)))?;
    let sql = "INSERT INTO contacts (number, id, label, definition, created_at, initial_updated_at, inherited, tenant)
               VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8)";
    database.prepare_cached(sql)?.execute(params![
        number,
        session.id.to_string(),
        session.label,
        definition,
        nanoseconds(session.created_at)?,
        nanoseconds(session.updated_at)?,
        integer(inherited)?,
        session.tenant.name(),
    ])?;
    Ok(())
}

/// The number of a session that must be at a sequence.
pub(super) fn at(database: &Connection, id: Uuid, expected: u64) -> Result<i64, ChangeError> {
    let sql = "SELECT number, (SELECT coalesce(max(sequence), 0) FROM moves WHERE contact = number) FROM contacts
               WHERE id = ?1";
    let mut statement = database.prepare_cached(sql)?;
    let found = statement.query_row([id.to_string()], |row| Ok((row.get(0)?, natural(row, 1)?))).optional()?;
    match found {
        Some((number, found)) if found == expected => Ok(number),
        Some((_, found)) => Err(ChangeError::Refused(StoreError::Stale { found })),
        None => Err(ChangeError::Refused(missing(database, id)?)),
    }
}

/// Why there is no such session.
pub(super) fn missing(database: &Connection, id: Uuid) -> rusqlite::Result<StoreError> {
    let mut statement = database.prepare_cached("SELECT tenant FROM expired WHERE id = ?1")?;
    let expired = statement.query_row([id.to_string()], |row| tenant(row, 0)).optional()?;
    Ok(expired.map_or(StoreError::NotFound, StoreError::Expired))
}

/// Deletes a session and leaves its moves to be removed bit by bit.
fn disown(database: &Connection, number: i64) -> rusqlite::Result<()> {
    database.prepare_cached("DELETE FROM contacts WHERE number = ?1")?.execute([number])?;
    database.prepare_cached("INSERT INTO unowned (contact, forming) VALUES (?1, 0)")?.execute([number])?;
    Ok(())
}

/// Lets a session expire, unless it is gone or has moved meanwhile.
fn expire(database: &Connection, id: Uuid, since: Timestamp) -> rusqlite::Result<bool> {
    let sql = format!(
        "SELECT c.number, c.tenant FROM {} WHERE c.id = ?1 AND iif(m.sequence > c.inherited, m.at, c.initial_updated_at) < ?2",
        super::rows::SESSIONS
    );
    let mut statement = database.prepare_cached(&sql)?;
    let idle = statement.query_row(params![id.to_string(), bound(since)], |row| Ok((row.get(0)?, tenant(row, 1)?)));
    let Some((number, tenant)) = idle.optional()? else { return Ok(false) };
    disown(database, number)?;
    let now = nanoseconds(Timestamp::now())?;
    let mut mark = database.prepare_cached("INSERT INTO expired (id, at, tenant) VALUES (?1, ?2, ?3)")?;
    mark.execute(params![id.to_string(), now, tenant.name()])?;
    Ok(true)
}
