//! Changes that take a transaction of their own: they are rare, or they are long.
//!
//! A change whose connection is lost during its commit is repeated. Once a commit has been sent, a contact that is
//! missing counts as deleted, and one that exists as created.

use std::sync::atomic::{AtomicBool, Ordering};

use deadpool_postgres::{Object, Transaction};
use jiff::Timestamp;
use tokio_postgres::IsolationLevel;
use tokio_postgres::error::SqlState;
use uuid::Uuid;

use crate::store::{RECEIPT_LIFETIME, Receipt, Result, Session, Snapshot, StoreError, Tenant};

use super::batch_tx::{announcements, created};
use super::client_pool::{ANSWER, ClientPool, LONG_ANSWER, Parameter, execute, rows, try_once, with_retries};
use super::columns::{Receipts, Sessions, split_time, to_bigint};
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

    /// Why a session is no longer at the expected sequence.
    async fn not_at(&self, id: Uuid) -> StoreError {
        match self.row(sql::SEQUENCE, &[&id]).await {
            Ok(Some(row)) => StoreError::Stale { found: super::columns::from_bigint(row.get(0)) },
            Ok(None) => self.missing(id).await,
            Err(error) => error,
        }
    }

    /// [`crate::store::Store::rename`]: made twice, if its connection is lost, it is the same.
    pub(super) async fn rename(&self, id: Uuid, label: Option<String>, receipt: Option<Receipt>) -> Result<()> {
        let mut receipts = Receipts::default();
        if let Some(receipt) = &receipt {
            receipts.push((id, receipt));
        }
        let renamed = with_retries!(self, ANSWER, connection => rename_on(connection, id, label.as_deref(), &receipts));
        match (renamed, receipt) {
            (Ok(true), _) => Ok(()),
            (Ok(false), _) => Err(self.missing(id).await),
            (Err(_), Some(receipt)) if self.receipt(&receipt.request.key).await?.is_some() => Err(StoreError::KeyTaken),
            (Err(error), _) => Err(error),
        }
    }

    /// [`crate::store::Store::delete`]
    pub(super) async fn delete(&self, id: Uuid, expected: u64) -> Result<()> {
        let commit_sent = AtomicBool::new(false);
        if with_retries!(self, LONG_ANSWER, connection => self.delete_on(connection, id, expected, &commit_sent))? {
            return Ok(());
        }
        match self.not_at(id).await {
            StoreError::NotFound if commit_sent.into_inner() => Ok(()),
            error => Err(error),
        }
    }

    async fn delete_on(
        &self,
        connection: &mut Object,
        id: Uuid,
        expected: u64,
        commit_sent: &AtomicBool,
    ) -> Result<bool, Fault> {
        let transaction = begin(connection).await?;
        if execute(&transaction, sql::DELETE, &[&id, &to_bigint(expected)]).await? == 0 {
            return Ok(false);
        }
        execute(&transaction, sql::DELETE_PAST, &[&id]).await?;
        self.announce(&transaction, &[id]).await?;
        commit_sent.store(true, Ordering::Relaxed);
        transaction.commit().await?;
        Ok(true)
    }

    /// [`crate::store::Store::fork`]
    pub(super) async fn fork(&self, id: Uuid, copy: Session, receipt: Option<Receipt>) -> Result<()> {
        let definition = super::definition(&copy)?;
        let (mut sessions, mut receipts) = (Sessions::default(), Receipts::default());
        sessions.push((&copy, definition));
        if let Some(receipt) = &receipt {
            receipts.push((copy.id, receipt));
        }
        let fork = Fork { id, copy: copy.id, sequence: to_bigint(copy.sequence), sessions, receipts };
        let commit_sent = AtomicBool::new(false);
        let forked = with_retries!(self, LONG_ANSWER, connection => fork.make(connection, &commit_sent));
        match forked {
            Ok(true) => Ok(()),
            Ok(false) => Err(match self.not_at(id).await {
                // It is where it should be, and yet there were fewer moves to copy.
                StoreError::Stale { found } if found == copy.sequence => {
                    StoreError::Damaged { contact: id, what: format!("some of its {found} moves are missing") }
                }
                error => error,
            }),
            Err(error) => match self.row(sql::SEQUENCE, &[&copy.id]).await? {
                Some(_) if commit_sent.into_inner() => Ok(()),
                _ => match receipt {
                    Some(receipt) if self.receipt(&receipt.request.key).await?.is_some() => Err(StoreError::KeyTaken),
                    _ => Err(error),
                },
            },
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

    async fn purge_idle(&self, connection: &mut Object, which: &[Parameter<'_>]) -> Result<Vec<Uuid>, Fault> {
        let transaction = begin(connection).await?;
        let gone = rows(&transaction, sql::PURGE_IDLE, which).await?;
        let gone: Vec<Uuid> = gone.iter().map(|row| row.get(0)).collect();
        self.announce(&transaction, &gone).await?;
        transaction.commit().await?;
        Ok(gone)
    }

    /// Announces changes when the transaction is committed.
    pub(super) async fn announce(&self, transaction: &Transaction<'_>, ids: &[Uuid]) -> Result<(), Fault> {
        if self.announces && !ids.is_empty() {
            execute(transaction, sql::NOTIFY, &[&sql::CHANNEL, &announcements(ids)]).await?;
        }
        Ok(())
    }
}

/// A copy of a session to be made.
struct Fork {
    id: Uuid,
    copy: Uuid,
    sequence: i64,
    sessions: Sessions,
    receipts: Receipts,
}

impl Fork {
    /// Makes it, unless the session has made fewer moves or is deleted.
    async fn make(&self, connection: &mut Object, commit_sent: &AtomicBool) -> Result<bool, Fault> {
        let transaction = begin(connection).await?;
        create(&transaction, &self.sessions, &self.receipts).await?;
        let found = rows(&transaction, sql::SEQUENCE, &[&self.id]).await?;
        if found.first().is_none_or(|row| row.get::<_, i64>(0) < self.sequence) {
            return Ok(false);
        }
        let copied = execute(&transaction, sql::COPY_PAST, &[&self.copy, &self.id, &self.sequence]).await?;
        execute(&transaction, sql::COPY_SNAPSHOT, &[&self.copy, &self.id, &self.sequence]).await?;
        // Fewer if the session was deleted in between.
        if to_bigint(copied) != self.sequence {
            return Ok(false);
        }
        commit_sent.store(true, Ordering::Relaxed);
        transaction.commit().await?;
        Ok(true)
    }
}

async fn rename_on(connection: &mut Object, id: Uuid, label: Option<&str>, receipts: &Receipts) -> Result<bool, Fault> {
    let transaction = begin(connection).await?;
    if execute(&transaction, sql::RENAME, &[&id, &label]).await? == 0 {
        return Ok(false);
    }
    create(&transaction, &Sessions::default(), receipts).await?;
    transaction.commit().await?;
    Ok(true)
}

/// Begins a transaction that may take long.
pub(super) async fn begin(connection: &mut Object) -> Result<Transaction<'_>, Fault> {
    let transaction = connection.build_transaction().isolation_level(IsolationLevel::ReadCommitted).start().await?;
    transaction.batch_execute(sql::ALLOW_LONG).await?;
    Ok(transaction)
}

/// Makes sessions, and keeps receipts in place of expired ones.
pub(super) async fn create(
    transaction: &Transaction<'_>,
    sessions: &Sessions,
    receipts: &Receipts,
) -> Result<(), Fault> {
    execute(transaction, sql::DELETE_OLD_KEYS, &[&receipts.key, &RECEIPT_LIFETIME.as_secs_f64()]).await?;
    execute(transaction, sql::CREATE, &created(sessions, receipts)).await.map(drop)
}
