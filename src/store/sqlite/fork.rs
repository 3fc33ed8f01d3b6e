//! Copying a past, and removing one that nobody owns: in steps, so that the moves of other sessions go on in between.
//!
//! A copy belongs to nobody until it is whole, and then to its session at once. Whatever a crash leaves without an owner
//! is removed after the next start.

use rusqlite::{Connection, OptionalExtension as _, params};

use crate::store::StoreError;

use super::change::{ChangeError, Done, Fork, at, free, insert_session, keep};
use super::rows::{MOVE_COLUMNS, integer};

/// Moves that are copied or removed in one step.
const MOVES_AT_ONCE: i64 = 4_000;
/// Pasts that are removed in one step.
const PASTS_AT_ONCE: usize = 200;

/// A fork under way.
#[derive(Clone, Copy)]
pub(super) struct Copying {
    /// The session that is copied.
    from: i64,
    /// The copy.
    to: i64,
    /// The last move copied.
    copied: i64,
    /// The last move to copy.
    last: i64,
}

impl Fork {
    /// Checks, and makes a short fork at once; a long one begins.
    pub(super) fn begin(&self, database: &Connection, to: i64) -> Result<Done, ChangeError> {
        free(database, self.receipt.as_ref())?;
        let from = at(database, self.id, self.copy.sequence)?;
        let mut copying = Copying { from, to, copied: 0, last: integer(self.copy.sequence)? };
        if copying.last <= MOVES_AT_ONCE {
            copying.step(database)?;
            self.complete(database, copying)?;
            return Ok(Done::Made(0));
        }
        database.prepare_cached("INSERT INTO unowned (contact, forming) VALUES (?1, 1)")?.execute([to])?;
        Ok(Done::Copying(copying))
    }

    /// Goes on with a fork; whether it is complete. The original may have moved on meanwhile, which the copy does not see.
    pub(super) fn proceed(&self, database: &Connection, copying: &mut Copying) -> Result<bool, ChangeError> {
        copying.step(database)?;
        if copying.copied < copying.last {
            return Ok(false);
        }
        free(database, self.receipt.as_ref())?;
        let mut original = database.prepare_cached("SELECT number FROM contacts WHERE number = ?1")?;
        if !original.exists([copying.from])? {
            return Err(ChangeError::Refused(StoreError::NotFound));
        }
        database.prepare_cached("DELETE FROM unowned WHERE contact = ?1")?.execute([copying.to])?;
        self.complete(database, *copying)?;
        Ok(true)
    }

    fn complete(&self, database: &Connection, copying: Copying) -> Result<(), ChangeError> {
        insert_session(database, copying.to, &self.copy, self.copy.sequence)?;
        let sql = "INSERT INTO snapshots (contact, sequence, state)
                   SELECT ?2, sequence, state FROM snapshots WHERE contact = ?1 AND sequence <= ?3";
        database.prepare_cached(sql)?.execute([copying.from, copying.to, copying.last])?;
        Ok(keep(database, self.receipt.as_ref())?)
    }
}

impl Copying {
    /// Gives a fork up: its copy is removed like any other past without an owner.
    pub(super) fn abandon(self, database: &Connection) -> rusqlite::Result<()> {
        database.prepare_cached("UPDATE unowned SET forming = 0 WHERE contact = ?1")?.execute([self.to]).map(drop)
    }

    fn step(&mut self, database: &Connection) -> rusqlite::Result<()> {
        let upto = self.last.min(self.copied + MOVES_AT_ONCE);
        let sql = format!(
            "INSERT INTO moves (contact, {MOVE_COLUMNS})
             SELECT ?2, {MOVE_COLUMNS} FROM moves WHERE contact = ?1 AND sequence > ?3 AND sequence <= ?4"
        );
        database.prepare_cached(&sql)?.execute(params![self.from, self.to, self.copied, upto])?;
        self.copied = upto;
        Ok(())
    }
}

/// Gives up the forks that a crash has left half made.
pub(super) fn abandon_all(database: &Connection) -> rusqlite::Result<()> {
    database.execute("UPDATE unowned SET forming = 0 WHERE forming = 1", []).map(drop)
}

/// Removes some of the moves without an owner; whether there may be more.
pub(super) fn remove_unowned(database: &Connection) -> rusqlite::Result<bool> {
    let mut left = MOVES_AT_ONCE;
    let mut next = database.prepare_cached("SELECT contact FROM unowned WHERE forming = 0 LIMIT 1")?;
    let sql = "DELETE FROM moves WHERE contact = ?1
               AND sequence < (SELECT min(sequence) + ?2 FROM moves WHERE contact = ?1)";
    let mut remove = database.prepare_cached(sql)?;
    let mut done = database.prepare_cached("DELETE FROM unowned WHERE contact = ?1")?;
    for _ in 0..PASTS_AT_ONCE {
        let Some(contact) = next.query_row([], |row| row.get::<_, i64>(0)).optional()? else { return Ok(false) };
        let removed = i64::try_from(remove.execute([contact, left])?).unwrap_or(left);
        left -= removed;
        if left <= 0 {
            return Ok(true);
        }
        done.execute([contact])?;
    }
    Ok(true)
}
