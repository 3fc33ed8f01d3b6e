//! The writer: changes that arrive during a transaction go together in the next one.

use std::collections::VecDeque;
use std::sync::Arc;
use std::time::{Duration, Instant};

use futures::future::join_all;
use tokio::sync::{mpsc, oneshot};
use tokio::time::timeout;

use crate::metrics::Counted;
use crate::store::{Changes, Commits, RECEIPT_LIFETIME, Receipt, Result, StoreError};

use super::batch_tx::WriterConnection;
use super::client_pool::ClientPool;
use super::fault::{Backoff, Fault};
use super::outcome::outcome_of;
use super::request::{Change, WriteRequest, collect_batch, stamp};
use super::sql;

/// Changes that may wait.
const QUEUE: usize = 4096;
/// How long a change waits for a place in the queue.
const PATIENCE: Duration = Duration::from_secs(10);
/// How often a batch may conflict with other transactions before its requests fail.
const COLLISIONS: usize = 8;
/// How often a connection may be lost under one batch: perhaps the batch itself is the cause.
const LOSSES: usize = 4;

/// The handle to which changes are sent.
pub(super) struct Writer {
    queue: mpsc::Sender<WriteRequest>,
    pub(super) commits: Arc<Commits>,
}

impl Writer {
    /// Starts the writer. It ends, after what waits, when this handle is dropped.
    pub(super) fn start(pool: Arc<ClientPool>, changes: Arc<Changes>) -> Writer {
        let (queue, requests) = mpsc::channel(QUEUE);
        let commits = Arc::new(Commits::new("postgres"));
        tokio::spawn(WriterTask { pool, changes, commits: Arc::clone(&commits), connection: None }.run(requests));
        Writer { queue, commits }
    }

    /// Makes a change, and returns when it is committed.
    pub(super) async fn write(&self, change: Change, receipt: Option<Receipt>) -> Result<()> {
        let _pending = Counted::by(&self.commits.pending);
        let (answer, answered) = oneshot::channel();
        let request = WriteRequest { change, receipt, stamp: stamp(), answer };
        match timeout(PATIENCE, self.queue.send(request)).await {
            Ok(Ok(())) => {}
            Ok(Err(_)) => return Err(StoreError::Failed("the writer has ended".to_owned())),
            Err(_) => return Err(StoreError::Unavailable("too many changes wait".to_owned())),
        }
        answered.await.unwrap_or_else(|_| Err(StoreError::Failed("the writer has ended".to_owned())))
    }
}

/// The writer's side of the queue.
struct WriterTask {
    pool: Arc<ClientPool>,
    changes: Arc<Changes>,
    commits: Arc<Commits>,
    connection: Option<WriterConnection>,
}

impl WriterTask {
    async fn run(mut self, mut requests: mpsc::Receiver<WriteRequest>) {
        let mut backlog = VecDeque::new();
        loop {
            if backlog.is_empty() {
                match requests.recv().await {
                    Some(request) => backlog.push_back(request),
                    None => return,
                }
            }
            while backlog.len() < QUEUE
                && let Ok(request) = requests.try_recv()
            {
                backlog.push_back(request);
            }
            self.commit_or_answer(collect_batch(&mut backlog), false).await;
        }
    }

    /// Makes or refuses each of the changes, and answers them; `in_doubt` if an earlier attempt may
    /// have been committed.
    async fn commit_or_answer(&mut self, mut batch: Vec<WriteRequest>, mut in_doubt: bool) {
        let (mut backoff, mut collisions, mut losses) = (Backoff::default(), 0, 0);
        while !batch.is_empty() {
            let begin = Instant::now();
            let pool = Arc::clone(&self.pool);
            let fault = match self.connection().await {
                Ok(connection) => match connection.commit_batch(&pool, &batch).await {
                    Ok(found) => {
                        self.pool.outage.end();
                        self.commits.committed(batch.len(), begin.elapsed());
                        for request in batch {
                            self.reply_committed(found.get(&request.id()).copied(), request, in_doubt);
                        }
                        return;
                    }
                    Err(fault) => {
                        if matches!(fault, Fault::Lost(_)) {
                            (in_doubt, losses) = (true, losses + 1);
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
                        return answer_all(batch, || StoreError::Unavailable(text.clone()));
                    }
                    backoff.pause().await;
                }
                Fault::Conflict(text) | Fault::Duplicate(text) if collisions == COLLISIONS => {
                    return answer_all(batch, || StoreError::Unavailable(text.clone()));
                }
                Fault::Conflict(_) => {
                    collisions += 1;
                    backoff.pause().await;
                }
                Fault::Duplicate(_) => {
                    collisions += 1;
                    batch = self.without_duplicates(batch, in_doubt).await;
                }
                Fault::Refused(StoreError::Full(text)) => return answer_all(batch, || StoreError::Full(text.clone())),
                // One of them is the cause: each is tried alone, so that the others succeed.
                Fault::Refused(StoreError::Failed(_)) if batch.len() > 1 => {
                    for request in batch {
                        Box::pin(self.commit_or_answer(vec![request], in_doubt)).await;
                    }
                    return;
                }
                Fault::Refused(StoreError::Failed(text)) => {
                    return answer_all(batch, || StoreError::Failed(text.clone()));
                }
                Fault::Refused(other) => return answer_all(batch, || StoreError::Unavailable(other.to_string())),
            }
        }
    }

    async fn connection(&mut self) -> Result<&WriterConnection, Fault> {
        match self.connection.take().filter(WriterConnection::is_open) {
            Some(connection) => Ok(self.connection.insert(connection)),
            None => Ok(self.connection.insert(WriterConnection::open(&self.pool).await?)),
        }
    }

    /// Answers a request of a batch that has been committed.
    fn reply_committed(&self, found: Option<u64>, request: WriteRequest, in_doubt: bool) {
        let Change::Append { expected, .. } = &request.change else {
            return request.answer(Ok(()));
        };
        match found {
            Some(found) if found == *expected => answer_known(request, Ok(()), &self.changes),
            Some(found) if request.receipt.is_none() && !in_doubt => request.answer(Err(StoreError::Stale { found })),
            found => {
                // The next batch need not wait for the reasons why a request of this one lost.
                let (pool, changes) = (Arc::clone(&self.pool), Arc::clone(&self.changes));
                tokio::spawn(async move {
                    let unexplained = found.map_or(StoreError::NotFound, |found| StoreError::Stale { found });
                    match outcome_of(&pool, &request, in_doubt).await {
                        Ok(false) => request.answer(Err(unexplained)),
                        known => answer_known(request, known.map(drop), &changes),
                    }
                });
            }
        }
    }

    /// Answers those requests of a batch whose keys or identifiers are taken, and returns the rest.
    async fn without_duplicates(&self, batch: Vec<WriteRequest>, in_doubt: bool) -> Vec<WriteRequest> {
        let keys: Vec<&str> = batch.iter().filter_map(WriteRequest::key).collect();
        let freed = self.pool.rows(sql::DELETE_OLD_KEYS, &[&keys, &RECEIPT_LIFETIME.as_secs_f64()]).await;
        if let Err(error) = freed {
            tracing::warn!(%error, "expired idempotency keys could not be freed");
        }
        let outcome = join_all(batch.iter().map(|request| outcome_of(&self.pool, request, in_doubt))).await;
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
