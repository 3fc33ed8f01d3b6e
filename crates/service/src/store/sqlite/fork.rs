//! Copying the moves of a contact, and removing those that belong to none: in steps, so that the moves of other
//! contacts go on in between.
//!
//! A copy belongs to no contact until it is whole, and then to its contact at once. What a crash leaves without a
//! contact is removed after the next start.

use rusqlite::{Connection, OptionalExtension as _};
use uuid::Uuid;

use crate::store::{Session, StoreError};

use super::columns::{MOVE_COLUMNS, execute, to_integer};
use super::fault::Fault;
use super::statements::{insert_session, number_and_sequence};

/// Moves that are copied or removed in one step.
const MOVES_AT_ONCE: i64 = 4_000;
/// Contacts whose moves are removed in one step.
const CONTACTS_AT_ONCE: usize = 200;

/// A session to be copied with its moves.
pub(super) struct Fork {
    pub(super) id: Uuid,
    pub(super) copy: Session,
}

#[derive(Clone, Copy)]
pub(super) struct Copying {
    from: i64,
    to: i64,
    copied: i64,
    last: i64,
}

impl Fork {
    /// Checks a fork and makes a short one, whose contact gets this number, at once; a long one begins, and
    /// [`Fork::proceed`] goes on with what is returned.
    pub(super) fn begin(&self, database: &Connection, number: i64) -> Result<Option<Copying>, Fault> {
        let (from, found) = number_and_sequence(database, self.id)?;
        if found < self.copy.sequence {
            return Err(StoreError::Stale { found }.into());
        }
        let mut copying = Copying { from, to: number, copied: 0, last: to_integer(self.copy.sequence)? };
        if copying.last <= MOVES_AT_ONCE {
            copying.step(database, self.id)?;
            self.complete(database, copying)?;
            return Ok(None);
        }
        execute(database, "INSERT INTO unowned (contact, forming) VALUES (?1, 1)", [copying.to])?;
        Ok(Some(copying))
    }

    /// Goes on with a fork; returns whether it is complete. The original may have moved on meanwhile, which the copy
    /// does not see.
    pub(super) fn proceed(&self, database: &Connection, copying: &mut Copying) -> Result<bool, Fault> {
        copying.step(database, self.id)?;
        if copying.copied < copying.last {
            return Ok(false);
        }
        if !database.prepare_cached("SELECT number FROM contacts WHERE number = ?1")?.exists([copying.from])? {
            return Err(StoreError::NotFound.into());
        }
        execute(database, "DELETE FROM unowned WHERE contact = ?1", [copying.to])?;
        self.complete(database, *copying)?;
        Ok(true)
    }

    fn complete(&self, database: &Connection, copying: Copying) -> Result<(), Fault> {
        insert_session(database, copying.to, &self.copy, self.copy.sequence)?;
        let sql = "INSERT INTO snapshots (contact, sequence, state)
                   SELECT ?2, sequence, state FROM snapshots WHERE contact = ?1 AND sequence <= ?3";
        execute(database, sql, [copying.from, copying.to, copying.last])?;
        Ok(())
    }
}

impl Copying {
    /// Abandons a fork: its copy is removed like all moves without a contact.
    pub(super) fn abandon(self, database: &Connection) -> rusqlite::Result<()> {
        execute(database, "UPDATE unowned SET forming = 0 WHERE contact = ?1", [self.to]).map(drop)
    }

    /// Copies the next moves of the contact `original`, unless one of them is missing.
    fn step(&mut self, database: &Connection, original: Uuid) -> Result<(), Fault> {
        let upto = self.last.min(self.copied + MOVES_AT_ONCE);
        let sql = "SELECT count(*) FROM moves WHERE contact = ?1 AND sequence > ?2 AND sequence <= ?3";
        let found: i64 = database.prepare_cached(sql)?.query_row([self.from, self.copied, upto], |row| row.get(0))?;
        if found != upto - self.copied {
            let what = format!("{} of the moves {} to {upto} are missing", upto - self.copied - found, self.copied + 1);
            return Err(StoreError::Damaged { contact: original, what }.into());
        }
        let sql = format!(
            "INSERT INTO moves (contact, {MOVE_COLUMNS})
             SELECT ?2, {MOVE_COLUMNS} FROM moves WHERE contact = ?1 AND sequence > ?3 AND sequence <= ?4"
        );
        execute(database, &sql, [self.from, self.to, self.copied, upto])?;
        self.copied = upto;
        Ok(())
    }
}

/// Removes some of the moves without a contact; returns whether there may be more.
pub(super) fn remove_unowned(database: &Connection) -> rusqlite::Result<bool> {
    let mut left = MOVES_AT_ONCE;
    let mut next = database.prepare_cached("SELECT contact FROM unowned WHERE forming = 0 LIMIT 1")?;
    let sql = "DELETE FROM moves WHERE contact = ?1
               AND sequence < (SELECT min(sequence) + ?2 FROM moves WHERE contact = ?1)";
    let mut remove = database.prepare_cached(sql)?;
    let mut done = database.prepare_cached("DELETE FROM unowned WHERE contact = ?1")?;
    for _ in 0..CONTACTS_AT_ONCE {
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
