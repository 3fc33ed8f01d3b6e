//! The changes that the writer makes, each checked before its first write: a refusal has written nothing.

use std::sync::{Arc, LazyLock};

use hashlink::LruCache;
use jiff::Timestamp;
use rusqlite::{Connection, params};
use tokio::sync::oneshot;
use uuid::Uuid;

use crate::store::rows::{RowReader as _, tenant};
use crate::store::{
    self, Clock, EXPIRED_LIFETIME, LabelChange, RECEIPT_LIFETIME, Receipt, Record, Session, Snapshot, StoreError,
};

use super::columns::{
    CONTACTS, MOVE_COLUMNS, all, clamped_nanoseconds, execute, first, insert_move, to_integer, to_nanoseconds,
};
use super::fault::Fault;
use super::fork::{Copying, Fork};
use super::schema;
use super::statements::{check_key, insert_receipt, insert_session, number_at};

/// Receipts that one change looks at.
const RECEIPTS_AT_ONCE: i64 = 256;
/// Marks of expired sessions that it deletes.
const MARKS_AT_ONCE: i64 = 1_000;
/// Bytes of replies that it deletes, roughly.
const RECEIPT_BYTES_AT_ONCE: i64 = 4 * 1024 * 1024;

static INSERT_MOVE: LazyLock<String> = LazyLock::new(|| {
    let places = ["?"].repeat(1 + MOVE_COLUMNS.split(',').count()).join(",");
    format!("INSERT INTO moves (contact, {MOVE_COLUMNS}) VALUES ({places})")
});

/// Numbers and sequences of contacts that have moved lately, as the transaction under way leaves them: what the writer,
/// which alone changes them, need not ask the database. A rollback clears the cache.
pub(super) type SequenceCache = LruCache<Uuid, (i64, u64)>;

/// Makes a change within the transaction under way.
type Apply = dyn Fn(&mut Transaction<'_>) -> Result<Done, Fault> + Send;

/// The channel for the outcome of a change.
pub(super) type Reply = oneshot::Sender<store::Result<u64>>;

/// A change whose caller waits.
pub(super) struct Change {
    /// Makes it; called again if its transaction fails.
    pub(super) apply: Box<Apply>,
    /// Rows that it writes, roughly; an append of one writes by one statement.
    pub(super) weight: usize,
    /// Whether it appends moves.
    pub(super) is_append: bool,
    /// The sessions and jobs whose listeners are to be woken when it is made.
    pub(super) touched: Vec<Uuid>,
    /// Kept with it.
    pub(super) receipt: Option<Receipt>,
    pub(super) reply: Reply,
}

impl Change {
    /// Whether it writes by one statement, which is a transaction of its own.
    pub(super) fn is_one_statement(&self) -> bool {
        self.is_append && self.weight == 1 && self.receipt.is_none()
    }

    /// Makes the change, and keeps its receipt, unless it goes on in small steps.
    pub(super) fn make(&self, transaction: &mut Transaction<'_>) -> Result<Done, Fault> {
        check_key(transaction.database, self.receipt.as_ref(), transaction.clock)?;
        let done = (self.apply)(transaction)?;
        if !matches!(done, Done::Copying(..)) {
            insert_receipt(transaction.database, self.receipt.as_ref(), transaction.clock)?;
        }
        Ok(done)
    }
}

pub(super) struct Transaction<'a> {
    pub(super) database: &'a Connection,
    pub(super) cache: &'a mut SequenceCache,
    /// A number that is free for a new contact.
    pub(super) number: i64,
    pub(super) clock: Clock,
}

pub(super) enum Done {
    /// It is made, with this count.
    Made(u64),
    /// This many contacts are deleted; their moves are removed later.
    Removed(u64),
    /// The fork has begun; copying goes on in small steps.
    Copying(Arc<Fork>, Copying),
}

impl Transaction<'_> {
    /// Writes a row again with its own values: for the disk, a change like any other.
    pub(super) fn probe(&self) -> Result<Done, Fault> {
        schema::mark(self.database, schema::IN_USE)?;
        Ok(Done::Made(0))
    }

    pub(super) fn create(&self, session: &Session) -> Result<Done, Fault> {
        insert_session(self.database, self.number, session, 0)?;
        Ok(Done::Made(0))
    }

    pub(super) fn append(&mut self, id: Uuid, expected: u64, records: &[Record]) -> Result<Done, Fault> {
        let last = records.last().map_or(expected, |last| last.sequence);
        let number = match self.cache.get_mut(&id) {
            Some((number, sequence)) if *sequence == expected => {
                *sequence = last;
                *number
            }
            _ => {
                let number = number_at(self.database, id, expected)?;
                self.cache.insert(id, (number, last));
                number
            }
        };
        let mut insert = self.database.prepare_cached(&INSERT_MOVE)?;
        for (index, record) in records.iter().enumerate() {
            if index > 0 {
                insert.clear_bindings();
            }
            insert_move(&mut insert, number, record)?;
        }
        Ok(Done::Made(0))
    }

    pub(super) fn fork(&self, fork: &Arc<Fork>) -> Result<Done, Fault> {
        let begun = fork.begin(self.database, self.number)?;
        Ok(begun.map_or(Done::Made(0), |copying| Done::Copying(Arc::clone(fork), copying)))
    }

    pub(super) fn rename(&self, id: Uuid, label: &LabelChange, expected: u64) -> Result<Done, Fault> {
        let number = number_at(self.database, id, expected)?;
        let sql = "UPDATE contacts SET label = ?3 WHERE number = ?1 AND label IS ?2";
        match execute(self.database, sql, params![number, label.from, label.to])? {
            0 => Err(StoreError::Stale { found: expected }.into()),
            _ => Ok(Done::Made(0)),
        }
    }

    pub(super) fn delete(&mut self, id: Uuid, expected: u64) -> Result<Done, Fault> {
        let number = number_at(self.database, id, expected)?;
        self.cache.remove(&id);
        delete_contact(self.database, number)?;
        Ok(Done::Removed(0))
    }

    pub(super) fn save_snapshot(&self, id: Uuid, snapshot: &Snapshot, unreadable: Option<u64>) -> Result<Done, Fault> {
        let sql = "INSERT INTO snapshots (contact, sequence, state)
                   SELECT number, ?2, ?3 FROM contacts WHERE id = ?1
                   ON CONFLICT (contact) DO UPDATE SET sequence = excluded.sequence, state = excluded.state
                   WHERE excluded.sequence > snapshots.sequence OR snapshots.sequence = ?4";
        let (sequence, unreadable) = (to_integer(snapshot.sequence)?, unreadable.map(to_integer).transpose()?);
        execute(self.database, sql, params![id.to_string(), sequence, snapshot.state, unreadable])?;
        Ok(Done::Made(0))
    }

    /// Deletes receipts past their time, and marks of sessions that expired long ago; returns 1 if there may be more of
    /// them.
    pub(super) fn purge_records(&self) -> Result<Done, Fault> {
        let cutoff = clamped_nanoseconds(self.clock.ago(RECEIPT_LIFETIME));
        let sql = "SELECT number, at, length(body) FROM receipts ORDER BY number LIMIT ?1";
        let oldest: Vec<(i64, i64, i64)> =
            all(self.database, sql, [RECEIPTS_AT_ONCE], |row| Ok((row.next()?, row.next()?, row.next()?)))?;
        let (mut last, mut count, mut bytes) = (None, 0, 0);
        for (number, at, length) in oldest {
            if at > cutoff || bytes > RECEIPT_BYTES_AT_ONCE {
                break;
            }
            (last, count, bytes) = (Some(number), count + 1, bytes + length);
        }
        if let Some(last) = last {
            execute(self.database, "DELETE FROM receipts WHERE number <= ?1", [last])?;
        }
        let sql = "DELETE FROM expired WHERE id IN (SELECT id FROM expired WHERE at <= ?1 LIMIT ?2)";
        let marks =
            execute(self.database, sql, [clamped_nanoseconds(self.clock.ago(EXPIRED_LIFETIME)), MARKS_AT_ONCE])?;
        let is_full =
            count == RECEIPTS_AT_ONCE || bytes > RECEIPT_BYTES_AT_ONCE || to_integer(marks as u64)? == MARKS_AT_ONCE;
        Ok(Done::Made(u64::from(is_full)))
    }

    /// Expires those of the sessions that still exist and have not moved since; returns their number.
    pub(super) fn expire(&mut self, ids: &[Uuid], since: Timestamp) -> Result<Done, Fault> {
        let mut expired = 0;
        for id in ids {
            self.cache.remove(id);
            expired += u64::from(expire(self.database, *id, since, self.clock)?);
        }
        Ok(Done::Removed(expired))
    }
}

/// Deletes a contact and leaves its moves to be removed some at a time.
fn delete_contact(database: &Connection, number: i64) -> rusqlite::Result<()> {
    execute(database, "DELETE FROM contacts WHERE number = ?1", [number])?;
    execute(database, "INSERT INTO unowned (contact, forming) VALUES (?1, 0)", [number]).map(drop)
}

/// Expires a session, unless it has been deleted or has moved meanwhile.
fn expire(database: &Connection, id: Uuid, since: Timestamp, clock: Clock) -> rusqlite::Result<bool> {
    let sql = format!(
        "SELECT c.number, c.tenant FROM {CONTACTS}
         WHERE c.id = ?1 AND iif(m.sequence > c.inherited, m.at, c.initial_updated_at) < ?2"
    );
    let which = params![id.to_string(), clamped_nanoseconds(since)];
    let idle = first(database, &sql, which, |row| Ok((row.next()?, tenant(row)?)))?;
    let Some((number, tenant)) = idle else { return Ok(false) };
    delete_contact(database, number)?;
    let expired = params![id.to_string(), to_nanoseconds(clock.now())?, tenant.name()];
    execute(database, "INSERT INTO expired (id, at, tenant) VALUES (?1, ?2, ?3)", expired)?;
    Ok(true)
}
