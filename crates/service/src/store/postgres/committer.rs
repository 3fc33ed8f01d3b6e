//! Commits batches of changes on a connection of its own, and answers those who wait for them.

use std::collections::HashMap;
use std::sync::Arc;
use std::time::{Duration, Instant};

use uuid::Uuid;

use crate::store::{Changes, Commits, RECEIPT_LIFETIME, Result, StoreError, Tenant};

use super::batch_tx::{Found, WriterConnection};
use super::client_pool::{ClientPool, Tries};
use super::columns::{from_bigint, to_bigint};
use super::fault::Fault;
use super::request::{Change, WriteRequest};
use super::sql;

/// How often a connection may be lost under one batch: perhaps the batch itself is the cause.
const LOSSES: usize = 4;

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

    /// Makes or refuses each of the changes, and answers them; but returns those whose contacts other transactions
    /// hold.
    pub(super) async fn commit(&mut self, mut batch: Vec<WriteRequest>) -> Vec<WriteRequest> {
        let (mut tries, mut losses, mut freed, pool) = (Tries::default(), 0, false, Arc::clone(&self.pool));
        let refusal = loop {
            if batch.is_empty() {
                return batch;
            }
            let begin = Instant::now();
            let (sent, outcome) = match self.connection().await {
                Ok(connection) => (true, connection.commit_batch(&pool, &batch).await),
                Err(fault) => (false, Err(fault)),
            };
            let fault = match outcome {
                Ok(found) => return self.reply_committed(batch, &found, begin.elapsed()),
                Err(fault) => fault,
            };
            self.commits.failed.inc();
            let fault = match fault {
                Fault::Locked(_) => {
                    batch = without_overdue(batch);
                    return if batch.len() < 2 { batch } else { self.commit_halves(batch).await };
                }
                // What fails for one of them.
                Fault::Duplicate(_) | Fault::Refused(StoreError::Failed(_)) if batch.len() > 1 => {
                    return self.commit_halves(batch).await;
                }
                Fault::Duplicate(text) => {
                    let Some(request) = batch.pop() else { return batch };
                    // A key from long ago is made free.
                    let known = async {
                        self.pool.free_key(request.id(), request.receipt.as_ref()).await?;
                        outcome_of(&self.pool, &request).await
                    };
                    match known.await {
                        Ok(false) if !freed => {
                            freed = true;
                            batch.push(request);
                            continue;
                        }
                        // It is taken again, or by something else.
                        Ok(false) => request.answer(Err(StoreError::Unavailable(text))),
                        known => answer_known(request, known.map(drop), &self.changes),
                    }
                    return batch;
                }
                Fault::Lost(text) => {
                    self.connection = None;
                    batch.iter_mut().for_each(|request| request.in_doubt |= sent);
                    losses += usize::from(sent);
                    if losses > LOSSES {
                        break StoreError::Unavailable(text);
                    }
                    Fault::Lost(text)
                }
                other => other,
            };
            if let Err(error) = tries.retry_or_fail(&pool.outage, fault).await {
                break error;
            }
        };
        batch.drain(..).for_each(|request| request.answer(Err(refusal.clone())));
        batch
    }

    /// Commits each half of a batch of which one request fails, or waits for what another transaction holds, so that
    /// the others succeed.
    async fn commit_halves(&mut self, mut batch: Vec<WriteRequest>) -> Vec<WriteRequest> {
        let second = batch.split_off(batch.len() / 2);
        let mut held = Box::pin(self.commit(batch)).await;
        held.extend(Box::pin(self.commit(second)).await);
        held
    }

    async fn connection(&mut self) -> Result<&WriterConnection, Fault> {
        match self.connection.take().filter(WriterConnection::is_open) {
            Some(connection) => Ok(self.connection.insert(connection)),
            None => Ok(self.connection.insert(WriterConnection::open(&self.pool).await?)),
        }
    }

    /// Answers the requests of a batch that has been committed, by the sequences at which their sessions were found;
    /// but returns those whose contacts other transactions hold.
    fn reply_committed(
        &self,
        batch: Vec<WriteRequest>,
        found: &HashMap<Uuid, Option<Found>>,
        time: Duration,
    ) -> Vec<WriteRequest> {
        self.pool.outage.end();
        let (locked, done): (Vec<_>, Vec<_>) =
            batch.into_iter().partition(|request| matches!(found.get(&request.id()), Some(None)));
        if done.is_empty() {
            self.commits.progressed();
        } else {
            self.commits.committed(done.len(), time);
        }
        for request in done {
            self.reply(found.get(&request.id()).copied().flatten(), request);
        }
        locked
    }

    /// Answers a request that was sent, and whose session was found at a sequence.
    fn reply(&self, found: Option<Found>, request: WriteRequest) {
        let Change::Append { .. } = &request.change else {
            return request.answer(Ok(()));
        };
        match found {
            Some(Found { as_expected: true, .. }) => answer_known(request, Ok(()), &self.changes),
            Some(Found { sequence, .. }) if request.receipt.is_none() && !request.in_doubt => {
                request.answer(Err(StoreError::Stale { found: sequence }));
            }
            found => {
                // The next batch need not wait for the reasons why a request of this one lost.
                let (pool, changes) = (Arc::clone(&self.pool), Arc::clone(&self.changes));
                tokio::spawn(async move {
                    let unexplained =
                        found.map_or(StoreError::NotFound, |found| StoreError::Stale { found: found.sequence });
                    match outcome_of(&pool, &request).await {
                        Ok(false) => request.answer(Err(unexplained)),
                        known => answer_known(request, known.map(drop), &changes),
                    }
                });
            }
        }
    }
}

/// Answers those that have waited for locks for as long as they may, and returns the others.
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

/// Reads whether a request is stored whose answer was lost, or why it was refused; one that is neither may be tried
/// again.
async fn outcome_of(pool: &ClientPool, request: &WriteRequest) -> Result<bool> {
    let (id, expected, last) = match &request.change {
        Change::Create(session, _) => (session.id, None, 0),
        Change::Append { id, expected, records, .. } => {
            (*id, Some(*expected), records.last().map_or(0, |record| record.sequence))
        }
    };
    let lifetime = RECEIPT_LIFETIME.as_secs_f64();
    let row = pool.row(sql::OUTCOME, &[&id, &request.key(), &lifetime, &to_bigint(last)]).await?;
    let row = row.ok_or_else(|| StoreError::Failed("the database returned no row".to_owned()))?;
    let (sequence, expired, taken): (Option<i64>, Option<&str>, bool) = (row.get(0), row.get(1), row.get(2));
    let stored = match expected {
        Some(_) => row.get::<_, Option<i64>>(3) == Some(request.stamp),
        None => sequence.is_some(),
    };
    match (expected, sequence.map(from_bigint)) {
        _ if request.in_doubt && stored => Ok(true),
        _ if taken => Err(StoreError::KeyTaken),
        (None, None) => Ok(false),
        (None, Some(_)) => Err(StoreError::Failed(format!("the contact {id} already exists"))),
        (Some(_), None) => Err(expired.map(Tenant::new).map_or(StoreError::NotFound, StoreError::Expired)),
        (Some(expected), Some(found)) if found == expected => Ok(false),
        (Some(_), Some(found)) => Err(StoreError::Stale { found }),
    }
}
