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

use crate::store::{RECEIPT_LIFETIME, Receipt, Result, Session, Snapshot, StoreError, Tenant};

use super::client_pool::{
    ANSWER, ClientPool, LONG_ANSWER, Parameter, execute, long_rows, rows, try_once, with_retries,
};
use super::columns::{Receipts, Sessions, from_bigint, split_time, to_bigint};
use super::fault::Fault;
use super::sql;

/// Receipts that one statement deletes.
const RECEIPTS: i64 = 1_000;
/// Sessions that one transaction deletes; each may have many moves.
const IDLE: usize = 50;
/// Identifiers of idle sessions that are looked up at a time.
const IDLE_PAGE: i64 = 10_000;

impl ClientPool {
    /// Why there is no such session.
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
        label: Option<String>,
        expected: u64,
        receipt: Option<Receipt>,
    ) -> Result<()> {
        let mut receipts = Receipts::default();
        if let Some(receipt) = &receipt {
            receipts.push((id, receipt));
            self.free_key(receipt).await?;
        }
        let (sent, sequence) = (AtomicBool::new(false), to_bigint(expected));
        let parameters: [Parameter<'_>; 3] = [&id, &label, &sequence];
        let parameters: Vec<_> = parameters.into_iter().chain(receipts.parameters()).collect();
        let rename = async |connection: &Object| {
            let in_doubt = sent.swap(true, Ordering::Relaxed);
            let found = rows(connection, sql::RENAME, &parameters).await?;
            sent.store(in_doubt, Ordering::Relaxed);
            done_at(&found, expected)
        };
        match (with_retries!(self, ANSWER, connection => rename(connection)), receipt) {
            // It may have been made before the connection was lost, and the contact moved since.
            (Ok(Err(StoreError::Stale { found })), _) if sent.into_inner() => {
                Err(StoreError::Unavailable(format!("the connection was lost in a commit, and {id} is now at {found}")))
            }
            (Ok(Err(StoreError::NotFound)), _) => Err(self.missing(id).await),
            (Ok(renamed), _) => renamed,
            (Err(_), Some(receipt)) if self.receipt(&receipt.request.key).await?.is_some() => Err(StoreError::KeyTaken),
            (Err(error), _) => Err(error),
        }
    }

    /// Makes room for the key of a receipt, if it is kept for a request from long ago.
    pub(super) async fn free_key(&self, receipt: &Receipt) -> Result<()> {
        let (keys, lifetime) = ([receipt.request.key.as_str()], RECEIPT_LIFETIME.as_secs_f64());
        self.rows(sql::DELETE_OLD_KEYS, &[&&keys[..], &lifetime]).await.map(drop)
    }

    /// [`crate::store::Store::delete`]
    pub(super) async fn delete(&self, id: Uuid, expected: u64) -> Result<()> {
        let (sent, statement) = (AtomicBool::new(false), sql::delete(self.announces));
        let delete = async |connection: &Object| {
            let in_doubt = sent.swap(true, Ordering::Relaxed);
            let found = long_rows(connection, &statement, &[&id, &to_bigint(expected)]).await?;
            // It has been answered, and what an earlier attempt has done is no clearer.
            sent.store(in_doubt, Ordering::Relaxed);
            Ok(match done_at(&found, expected)? {
                Err(StoreError::NotFound) if in_doubt => Ok(()),
                done => done,
            })
        };
        match with_retries!(self, LONG_ANSWER, connection => delete(connection))? {
            Err(StoreError::NotFound) => Err(self.missing(id).await),
            deleted => deleted,
        }
    }

    /// [`crate::store::Store::fork`]
    pub(super) async fn fork(&self, id: Uuid, copy: Session, receipt: Option<Receipt>) -> Result<()> {
        let definition = super::definition(&copy)?;
        let (mut sessions, mut receipts) = (Sessions::default(), Receipts::default());
        sessions.push((&copy, definition));
        if let Some(receipt) = &receipt {
            receipts.push((copy.id, receipt));
            self.free_key(receipt).await?;
        }
        let moves = to_bigint(copy.sequence);
        let parameters: [Parameter<'_>; 2] = [&id, &moves];
        let parameters: Vec<_> =
            parameters.into_iter().chain(sessions.parameters()).chain(receipts.parameters()).collect();
        let sent = AtomicBool::new(false);
        let fork = async |connection: &Object| {
            sent.store(true, Ordering::Relaxed);
            long_rows(connection, sql::FORK, &parameters).await
        };
        let forked = match with_retries!(self, LONG_ANSWER, connection => fork(connection)) {
            Ok(forked) => forked,
            Err(error) => {
                return match self.row(sql::SEQUENCE, &[&copy.id]).await? {
                    Some(_) if sent.into_inner() => Ok(()),
                    _ => match receipt {
                        Some(receipt) if self.receipt(&receipt.request.key).await?.is_some() => {
                            Err(StoreError::KeyTaken)
                        }
                        _ => Err(error),
                    },
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

    /// [`crate::store::Store::save_snapshot`]
    pub(super) async fn save_snapshot(&self, id: Uuid, snapshot: Snapshot) -> Result<()> {
        let keep = async |connection: &Object| {
            let statement = connection.prepare_cached(sql::SAVE_SNAPSHOT).await?;
            match connection.execute(&statement, &[&id, &to_bigint(snapshot.sequence), &snapshot.state]).await {
                // The session has just been deleted.
                Err(error) if error.code() == Some(&SqlState::FOREIGN_KEY_VIOLATION) => Ok(()),
                other => Ok(other.map(drop)?),
            }
        };
        with_retries!(self, ANSWER, connection => keep(connection))
    }

    /// [`crate::store::Store::purge_expired`]
    pub(super) async fn purge_expired(&self, idle_since: Option<Timestamp>) -> Result<Vec<Uuid>> {
        let lifetime = RECEIPT_LIFETIME.as_secs_f64();
        let which: [Parameter<'_>; 2] = [&lifetime, &RECEIPTS];
        let purge = async |connection: &Object| execute(connection, sql::PURGE_RECEIPTS, &which).await;
        while to_bigint(with_retries!(self, ANSWER, connection => purge(connection))?) == RECEIPTS {}
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
        let gone = long_rows(connection, &sql::purge_idle(self.announces), which).await?;
        Ok(gone.iter().map(|row| row.get(0)).collect())
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
