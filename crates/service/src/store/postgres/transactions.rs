//! Changes that are not made in batches: they are rare, or they are long. Each is one statement, which commits by
//! itself, so that no row stays locked while the database waits for this process.
//!
//! A change whose connection is lost is repeated. Once it has been sent, a contact that is missing counts as deleted,
//! and one that exists as created. What another transaction holds is tried again for a while, between which no
//! connection is held.

use std::sync::atomic::{AtomicBool, Ordering};

use deadpool_postgres::{Object, Transaction};
use jiff::Timestamp;
use tokio_postgres::error::SqlState;
use tokio_postgres::{IsolationLevel, Row};
use uuid::Uuid;

use crate::store::{
    EXPIRED_LIFETIME, LabelChange, RECEIPT_LIFETIME, Receipt, Result, Session, Snapshot, StoreError, Tenant,
};

use super::client_pool::{ANSWER, ClientPool, LONG_ANSWER, Parameter, execute, long_rows, rows, with_retries};
use super::columns::{Receipts, Sessions, from_bigint, split_time, to_bigint};
use super::fault::Fault;
use super::sql;

/// Receipts, or marks of expired sessions, that one statement deletes.
const RECEIPTS: i64 = 1_000;
/// Sessions that one transaction deletes; each may have many moves.
const IDLE: usize = 50;
/// Identifiers of idle sessions that are looked up at a time.
const IDLE_PAGE: i64 = 10_000;

impl ClientPool {
    /// Why the session was not found.
    pub(super) async fn missing(&self, id: Uuid) -> StoreError {
        match self.row(sql::EXPIRED, &[&id]).await {
            Ok(Some(row)) => StoreError::Expired(Tenant::new(row.get(0))),
            Ok(None) => StoreError::NotFound,
            Err(error) => error,
        }
    }

    /// [`crate::store::Store::rename`]: made twice, if its connection is lost, it is the same.
    pub(super) async fn rename(
        &self,
        id: Uuid,
        label: LabelChange,
        expected: u64,
        receipt: Option<Receipt>,
    ) -> Result<()> {
        let receipts = self.free_key(id, receipt.as_ref()).await?;
        let (sent, sequence) = (InDoubt::default(), to_bigint(expected));
        let parameters: [Parameter<'_>; 4] = [&id, &label.to, &sequence, &label.from];
        let parameters: Vec<_> = parameters.into_iter().chain(receipts.parameters()).collect();
        let renamed = with_retries!(self, ANSWER, connection => async {
            let found = sent.answered(rows(connection, sql::RENAME, &parameters)).await?;
            match found.first().filter(|row| !row.get::<_, bool>(2)) {
                Some(relabelled) => Ok(Err(StoreError::Stale { found: from_bigint(relabelled.get(1)) })),
                None => done_at(&found, expected),
            }
        });
        match renamed {
            // It may have been made before the connection was lost, and the contact moved since.
            Ok(Err(StoreError::Stale { found })) if sent.get() => {
                Err(StoreError::Unavailable(format!("the connection was lost in a commit, and {id} is now at {found}")))
            }
            Ok(Err(StoreError::NotFound)) => Err(self.missing(id).await),
            Ok(renamed) => renamed,
            Err(error) => Err(self.key_taken_or(receipt.as_ref(), error).await?),
        }
    }

    /// [`crate::store::Store::keep`]: made twice, if its connection is lost, the second one finds its own key taken.
    pub(super) async fn keep(&self, receipt: &Receipt) -> Result<()> {
        let receipts = self.free_key(Uuid::nil(), Some(receipt)).await?;
        let parameters = receipts.parameters();
        match with_retries!(self, ANSWER, connection => rows(connection, sql::KEEP, &parameters)) {
            Ok(_) => Ok(()),
            Err(error) => Err(self.key_taken_or(Some(receipt), error).await?),
        }
    }

    /// The columns of a receipt for a change of the contact or job with this identifier. Deletes an expired receipt
    /// with the same key.
    pub(super) async fn free_key(&self, id: Uuid, receipt: Option<&Receipt>) -> Result<Receipts> {
        let mut receipts = Receipts::default();
        if let Some(receipt) = receipt {
            receipts.push((id, receipt));
            let (keys, lifetime) = ([receipt.request.key.as_str()], RECEIPT_LIFETIME.as_secs_f64());
            self.rows(sql::DELETE_OLD_KEYS, &[&&keys[..], &lifetime]).await?;
        }
        Ok(receipts)
    }

    /// Why a change failed: perhaps because another request has used its key.
    pub(super) async fn key_taken_or(&self, receipt: Option<&Receipt>, error: StoreError) -> Result<StoreError> {
        let Some(receipt) = receipt else { return Ok(error) };
        let found = self.row(sql::RECEIPT, &[&receipt.request.key, &RECEIPT_LIFETIME.as_secs_f64()]).await?;
        Ok(if found.is_some() { StoreError::KeyTaken } else { error })
    }

    pub(super) async fn delete(&self, id: Uuid, expected: u64) -> Result<()> {
        let (sent, sequence) = (InDoubt::default(), to_bigint(expected));
        let deleted = with_retries!(self, LONG_ANSWER, connection => async {
            done_at(&sent.answered(long_rows(connection, sql::DELETE, &[&id, &sequence])).await?, expected)
        });
        match deleted? {
            Err(StoreError::NotFound) if sent.get() => Ok(()),
            Err(StoreError::NotFound) => Err(self.missing(id).await),
            deleted => deleted,
        }
    }

    pub(super) async fn fork(&self, id: Uuid, copy: Session, receipt: Option<Receipt>) -> Result<()> {
        let definition = super::definition(&copy)?;
        let mut sessions = Sessions::default();
        sessions.push((&copy, definition));
        let receipts = self.free_key(copy.id, receipt.as_ref()).await?;
        let moves = to_bigint(copy.sequence);
        let parameters: [Parameter<'_>; 2] = [&id, &moves];
        let parameters: Vec<_> =
            parameters.into_iter().chain(sessions.parameters()).chain(receipts.parameters()).collect();
        let sent = InDoubt::default();
        let forked = with_retries!(self, LONG_ANSWER, connection =>
            sent.answered(long_rows(connection, sql::FORK, &parameters)));
        let forked = match forked {
            Ok(forked) => forked,
            Err(error) => {
                return match self.row(sql::SEQUENCE, &[&copy.id]).await? {
                    Some(_) if sent.get() => Ok(()),
                    _ => Err(self.key_taken_or(receipt.as_ref(), error).await?),
                };
            }
        };
        match forked.first().map(|row| (from_bigint(row.get(0)), row.get::<_, i64>(1))) {
            None => Err(self.missing(id).await),
            Some((found, _)) if found < copy.sequence => Err(StoreError::Stale { found }),
            Some((found, stored)) if stored != moves => {
                let what = format!("some of its {found} moves are missing");
                Err(StoreError::Damaged { contact: id, what })
            }
            Some(_) => Ok(()),
        }
    }

    pub(super) async fn save_snapshot(&self, id: Uuid, snapshot: Snapshot, unreadable: Option<u64>) -> Result<()> {
        let (sequence, unreadable) = (to_bigint(snapshot.sequence), unreadable.map(to_bigint));
        with_retries!(self, ANSWER, connection => async {
            let statement = connection.prepare_cached(sql::SAVE_SNAPSHOT).await?;
            match connection.execute(&statement, &[&id, &sequence, &snapshot.state, &unreadable]).await {
                // The session has just been deleted.
                Err(error) if error.code() == Some(&SqlState::FOREIGN_KEY_VIOLATION) => Ok(()),
                other => Ok(other.map(drop)?),
            }
        })
    }

    pub(super) async fn purge_expired(&self, idle_since: Option<Timestamp>) -> Result<Vec<Uuid>> {
        for (purge, lifetime) in [(sql::PURGE_RECEIPTS, RECEIPT_LIFETIME), (sql::PURGE_MARKS, EXPIRED_LIFETIME)] {
            let lifetime = lifetime.as_secs_f64();
            let which: [Parameter<'_>; 2] = [&lifetime, &RECEIPTS];
            let purge = async |connection: &Object| execute(connection, purge, &which).await;
            while to_bigint(with_retries!(self, ANSWER, connection => purge(connection))?) == RECEIPTS {}
        }
        let Some((since, since_ns)) = idle_since.map(split_time) else {
            return Ok(Vec::new());
        };
        let mut gone = Vec::new();
        loop {
            let idle = self.rows(sql::IDLE, &[&since, &since_ns, &IDLE_PAGE]).await?;
            let ids: Vec<Uuid> = idle.iter().map(|row| row.get(0)).collect();
            let before = gone.len();
            for some in ids.chunks(IDLE) {
                gone.extend(with_retries!(self, LONG_ANSWER, connection =>
                    self.purge_idle(connection, &[&some, &since, &since_ns]))?);
            }
            // Another replica is deleting a page of which nothing was deleted here.
            if to_bigint(ids.len() as u64) < IDLE_PAGE || gone.len() == before {
                return Ok(gone);
            }
        }
    }

    async fn purge_idle(&self, connection: &Object, which: &[Parameter<'_>]) -> Result<Vec<Uuid>, Fault> {
        let gone = long_rows(connection, sql::PURGE_IDLE, which).await?;
        Ok(gone.iter().map(|row| row.get(0)).collect())
    }
}

/// Whether a change may have been made by an attempt whose connection was lost.
#[derive(Default)]
pub(super) struct InDoubt(AtomicBool);

impl InDoubt {
    /// The answer to another attempt, which says nothing about those before.
    pub(super) async fn answered<T>(&self, attempt: impl Future<Output = Result<T, Fault>>) -> Result<T, Fault> {
        let before = self.0.swap(true, Ordering::Relaxed);
        let answer = attempt.await;
        if !matches!(answer, Err(Fault::Lost(_))) {
            self.0.store(before, Ordering::Relaxed);
        }
        answer
    }

    pub(super) fn get(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// What a change at a sequence has done, by the row that its statement returns if the contact exists: whether it was at
/// that sequence and free, and its sequence.
fn done_at(found: &[Row], expected: u64) -> Result<Result<()>, Fault> {
    Ok(match found.first().map(|row| (row.get(0), from_bigint(row.get(1)))) {
        Some((true, _)) => Ok(()),
        Some((false, found)) if found == expected => return Err(Fault::locked()),
        Some((false, found)) => Err(StoreError::Stale { found }),
        None => Err(StoreError::NotFound),
    })
}

/// Begins a transaction that may take long.
pub(super) async fn begin(connection: &mut Object) -> Result<Transaction<'_>, Fault> {
    let transaction = connection.build_transaction().isolation_level(IsolationLevel::ReadCommitted).start().await?;
    transaction.batch_execute(sql::ALLOW_LONG).await?;
    Ok(transaction)
}
