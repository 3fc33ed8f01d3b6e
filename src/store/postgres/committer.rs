//! Commits batches of changes on a connection of its own, and answers those who wait for them.

use std::sync::Arc;
use std::time::Instant;

use futures::future::join_all;

use crate::store::{Changes, Commits, RECEIPT_LIFETIME, Result, StoreError};

use super::batch_tx::WriterConnection;
use super::client_pool::ClientPool;
use super::fault::{Backoff, Fault};
use super::outcome::outcome_of;
use super::request::{Change, WriteRequest};
use super::sql;

/// How often a batch may conflict with other transactions before its requests fail.
const COLLISIONS: usize = 8;
/// How often a connection may be lost under one batch: perhaps the batch itself is the cause.
const LOSSES: usize = 4;

/// A connection for batches.
pub(super) struct Committer {
    pool: Arc<ClientPool>,
    changes: Arc<Changes>,
    commits: Arc<Commits>,
    connection: Option<WriterConnection>,
}

impl Committer {
    /// One that connects when it has something to commit.
    pub(super) fn new(pool: Arc<ClientPool>, changes: Arc<Changes>, commits: Arc<Commits>) -> Committer {
        Committer { pool, changes, commits, connection: None }
    }

    /// One with another connection to the same database.
    pub(super) fn another(&self) -> Committer {
        Committer::new(Arc::clone(&self.pool), Arc::clone(&self.changes), Arc::clone(&self.commits))
    }

    /// Makes or refuses each of the changes, and answers them; but returns, in their order, those whose contacts other
    /// transactions hold.
    pub(super) async fn commit(&mut self, mut batch: Vec<WriteRequest>) -> Vec<WriteRequest> {
        let (mut backoff, mut collisions, mut losses) = (Backoff::default(), 0, 0);
        while !batch.is_empty() {
            let begin = Instant::now();
            let pool = Arc::clone(&self.pool);
            let fault = match self.connection().await {
                Ok(connection) => match connection.commit_batch(&pool, &batch).await {
                    Ok(found) => {
                        self.pool.outage.end();
                        let (locked, done): (Vec<_>, Vec<_>) =
                            batch.into_iter().partition(|request| found.get(&request.id()) == Some(&None));
                        if done.is_empty() {
                            self.commits.progressed();
                        } else {
                            self.commits.committed(done.len(), begin.elapsed());
                        }
                        for request in done {
                            self.reply_committed(found.get(&request.id()).copied().flatten(), request);
                        }
                        return locked;
                    }
                    Err(fault) => {
                        if matches!(fault, Fault::Lost(_)) {
                            losses += 1;
                            batch.iter_mut().for_each(|request| request.in_doubt = true);
                        }
                        fault
                    }
                },
                Err(fault) => fault,
            };
            self.commits.failed.inc();
            match fault {
                Fault::Lost(text) => {
                    self.connection = None;
                    if !self.pool.outage.worth_waiting(&text) || losses > LOSSES {
                        answer_all(batch, || StoreError::Unavailable(text.clone()));
                        break;
                    }
                    backoff.pause().await;
                }
                Fault::Conflict(text) | Fault::Duplicate(text) if collisions == COLLISIONS => {
                    answer_all(batch, || StoreError::Unavailable(text.clone()));
                    break;
                }
                Fault::Conflict(_) => {
                    collisions += 1;
                    backoff.pause().await;
                }
                Fault::Duplicate(_) => {
                    collisions += 1;
                    batch = self.without_duplicates(batch).await;
                }
                Fault::Refused(StoreError::Full(text)) => {
                    answer_all(batch, || StoreError::Full(text.clone()));
                    break;
                }
                Fault::Locked(_) => {
                    batch = without_overdue(batch);
                    if batch.len() < 2 {
                        return batch;
                    }
                    return self.commit_halves(batch).await;
                }
                Fault::Refused(StoreError::Failed(_)) if batch.len() > 1 => return self.commit_halves(batch).await,
                Fault::Refused(StoreError::Failed(text)) => {
                    answer_all(batch, || StoreError::Failed(text.clone()));
                    break;
                }
                Fault::Refused(other) => {
                    answer_all(batch, || StoreError::Unavailable(other.to_string()));
                    break;
                }
            }
        }
        Vec::new()
    }

    /// Commits each half of a batch of which one request fails, or waits for what another transaction holds: so that
    /// the others succeed.
    async fn commit_halves(&mut self, mut batch: Vec<WriteRequest>) -> Vec<WriteRequest> {
        let second = batch.split_off(batch.len() / 2);
        let mut locked = Box::pin(self.commit(batch)).await;
        locked.extend(Box::pin(self.commit(second)).await);
        locked
    }

    async fn connection(&mut self) -> Result<&WriterConnection, Fault> {
        match self.connection.take().filter(WriterConnection::is_open) {
            Some(connection) => Ok(self.connection.insert(connection)),
            None => Ok(self.connection.insert(WriterConnection::open(&self.pool).await?)),
        }
    }

    /// Answers a request of a batch that has been committed.
    fn reply_committed(&self, found: Option<u64>, request: WriteRequest) {
        let Change::Append { expected, .. } = &request.change else {
            return request.answer(Ok(()));
        };
        match found {
            Some(found) if found == *expected => answer_known(request, Ok(()), &self.changes),
            Some(found) if request.receipt.is_none() && !request.in_doubt => {
                request.answer(Err(StoreError::Stale { found }));
            }
            found => {
                // The next batch need not wait for the reasons why a request of this one lost.
                let (pool, changes) = (Arc::clone(&self.pool), Arc::clone(&self.changes));
                tokio::spawn(async move {
                    let unexplained = found.map_or(StoreError::NotFound, |found| StoreError::Stale { found });
                    match outcome_of(&pool, &request).await {
                        Ok(false) => request.answer(Err(unexplained)),
                        known => answer_known(request, known.map(drop), &changes),
                    }
                });
            }
        }
    }

    /// Answers those requests of a batch whose keys or identifiers are taken, and returns the rest.
    async fn without_duplicates(&self, batch: Vec<WriteRequest>) -> Vec<WriteRequest> {
        let keys: Vec<&str> = batch.iter().filter_map(WriteRequest::key).collect();
        let freed = self.pool.rows(sql::DELETE_OLD_KEYS, &[&keys, &RECEIPT_LIFETIME.as_secs_f64()]).await;
        if let Err(error) = freed {
            tracing::warn!(%error, "expired idempotency keys could not be freed");
        }
        let outcome = join_all(batch.iter().map(|request| outcome_of(&self.pool, request))).await;
        let mut rest = Vec::new();
        for (request, outcome) in batch.into_iter().zip(outcome) {
            match outcome {
                Ok(false) => rest.push(request),
                known => answer_known(request, known.map(drop), &self.changes),
            }
        }
        rest
    }
}

/// Answers those that have waited for locks for as long as they may, and returns the rest.
pub(super) fn without_overdue(batch: Vec<WriteRequest>) -> Vec<WriteRequest> {
    let (overdue, rest): (Vec<_>, Vec<_>) = batch.into_iter().partition(WriteRequest::is_overdue);
    if let Some(first) = overdue.first() {
        tracing::warn!(contact = %first.id(), changes = overdue.len(), "locks of other transactions were not released");
    }
    overdue.into_iter().for_each(WriteRequest::refuse_as_locked);
    rest
}

/// Answers a request, and wakes the listeners of a session that it has changed.
fn answer_known(request: WriteRequest, outcome: Result<()>, changes: &Changes) {
    if outcome.is_ok() {
        changes.wake(request.id());
    }
    request.answer(outcome);
}

fn answer_all(batch: Vec<WriteRequest>, error: impl Fn() -> StoreError) {
    batch.into_iter().for_each(|request| request.answer(Err(error())));
}
