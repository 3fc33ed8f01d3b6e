//! The writer: what waits while a transaction is under way goes together in the next one.

use std::collections::VecDeque;
use std::sync::Arc;
use std::time::{Duration, Instant};

use futures::future::join_all;
use tokio::sync::{mpsc, oneshot};
use tokio::time::timeout;

use crate::metrics::Counted;
use crate::store::{Changes, Commits, RECEIPT_LIFETIME, StoreError};

use super::explain::{Verdict, explain};
use super::fault::{Fault, Pauses};
use super::flight::Line;
use super::job::{Change, Job, gather};
use super::link::Link;
use super::sql;

/// Changes that may wait.
const QUEUE: usize = 4096;
/// How long a change waits for a place in the queue.
const PATIENCE: Duration = Duration::from_secs(10);
/// How often a batch may collide with what others do before its clients are told.
const COLLISIONS: usize = 8;
/// How often a connection may be lost under one batch: perhaps it is the batch that the engine does not bear.
const LOSSES: usize = 4;

/// Where changes are handed in.
pub(super) struct Writer {
    queue: mpsc::Sender<Job>,
    pub(super) commits: Arc<Commits>,
}

impl Writer {
    /// Starts the writer. It ends, after what waits, when this handle is dropped.
    pub(super) fn start(link: Arc<Link>, changes: Arc<Changes>) -> Writer {
        let (queue, jobs) = mpsc::channel(QUEUE);
        let commits = Arc::new(Commits::new("postgres"));
        tokio::spawn(Desk { link, changes, commits: Arc::clone(&commits), line: None }.run(jobs));
        Writer { queue, commits }
    }

    /// Makes a change, and returns when it is committed.
    pub(super) async fn write(
        &self,
        job: impl FnOnce(oneshot::Sender<Result<(), StoreError>>) -> Job,
    ) -> Result<(), StoreError> {
        let _pending = Counted::by(&self.commits.pending);
        let (answer, answered) = oneshot::channel();
        match timeout(PATIENCE, self.queue.send(job(answer))).await {
            Ok(Ok(())) => {}
            Ok(Err(_)) => return Err(StoreError::Failed("the writer has ended".to_owned())),
            Err(_) => return Err(StoreError::Unavailable("too many changes wait".to_owned())),
        }
        answered.await.unwrap_or_else(|_| Err(StoreError::Failed("the writer has ended".to_owned())))
    }
}

/// The writer's side of the queue.
struct Desk {
    link: Arc<Link>,
    changes: Arc<Changes>,
    commits: Arc<Commits>,
    line: Option<Line>,
}

impl Desk {
    async fn run(mut self, mut jobs: mpsc::Receiver<Job>) {
        let mut backlog = VecDeque::new();
        loop {
            if backlog.is_empty() {
                match jobs.recv().await {
                    Some(job) => backlog.push_back(job),
                    None => return,
                }
            }
            while backlog.len() < QUEUE
                && let Ok(job) = jobs.try_recv()
            {
                backlog.push_back(job);
            }
            self.settle(gather(&mut backlog), false).await;
        }
    }

    /// Sees to it that each of the changes is made or refused, and answers them; `in_doubt` if an earlier attempt may have
    /// been committed.
    async fn settle(&mut self, mut batch: Vec<Job>, mut in_doubt: bool) {
        let (mut pauses, mut collisions, mut losses) = (Pauses::default(), 0, 0);
        while !batch.is_empty() {
            let begin = Instant::now();
            let fault = match self.line().await {
                Ok(line) => match line.fly(&batch).await {
                    Ok(found) => {
                        self.link.outage.end();
                        self.commits.committed(batch.len(), begin.elapsed());
                        for job in batch {
                            self.landed(found.get(&job.id()).copied(), job, in_doubt);
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
                    self.line = None;
                    if !self.link.outage.bearable(&text) || losses > LOSSES {
                        return answer_all(batch, || StoreError::Unavailable(text.clone()));
                    }
                    pauses.pause().await;
                }
                Fault::Again(text) | Fault::Duplicate(text) if collisions == COLLISIONS => {
                    return answer_all(batch, || StoreError::Unavailable(text.clone()));
                }
                Fault::Again(_) => {
                    collisions += 1;
                    pauses.pause().await;
                }
                Fault::Duplicate(_) => {
                    collisions += 1;
                    batch = self.without_duplicates(batch, in_doubt).await;
                }
                Fault::Refused(StoreError::Full(text)) => return answer_all(batch, || StoreError::Full(text.clone())),
                // One of them is to blame, and the others shall not suffer for it.
                Fault::Refused(StoreError::Failed(_)) if batch.len() > 1 => {
                    for job in batch {
                        Box::pin(self.settle(vec![job], in_doubt)).await;
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

    async fn line(&mut self) -> Result<&Line, Fault> {
        match self.line.take().filter(Line::is_open) {
            Some(line) => Ok(self.line.insert(line)),
            None => Ok(self.line.insert(Line::open(&self.link).await?)),
        }
    }

    /// Answers a request of a batch that has been committed.
    fn landed(&self, found: Option<u64>, job: Job, in_doubt: bool) {
        let Change::Append { id, expected, .. } = &job.change else {
            return job.answer(Ok(()));
        };
        match found {
            Some(found) if found == *expected => {
                self.changes.wake(*id);
                job.answer(Ok(()));
            }
            Some(found) if job.receipt.is_none() && !in_doubt => job.answer(Err(StoreError::Stale { found })),
            found => {
                // The next batch need not wait for the reasons why a request of this one lost.
                let (link, changes) = (Arc::clone(&self.link), Arc::clone(&self.changes));
                tokio::spawn(async move {
                    let unexplained = found.map_or(StoreError::NotFound, |found| StoreError::Stale { found });
                    match explain(&link, &job, in_doubt).await {
                        Verdict::Stored => {
                            changes.wake(job.id());
                            job.answer(Ok(()));
                        }
                        Verdict::Refused(error) => job.answer(Err(error)),
                        Verdict::Open => job.answer(Err(unexplained)),
                    }
                });
            }
        }
    }

    /// Answers those requests of a batch whose keys or identifiers are taken, and returns the rest.
    async fn without_duplicates(&self, batch: Vec<Job>, in_doubt: bool) -> Vec<Job> {
        let keys: Vec<&str> = batch.iter().filter_map(Job::key).collect();
        let freed = self.link.rows(sql::FREE_KEYS, &[&keys, &RECEIPT_LIFETIME.as_secs_f64()]).await;
        if let Err(error) = freed {
            tracing::warn!(%error, "idempotency keys past their time could not be freed");
        }
        let verdicts = join_all(batch.iter().map(|job| explain(&self.link, job, in_doubt))).await;
        let mut rest = Vec::new();
        for (job, verdict) in batch.into_iter().zip(verdicts) {
            match verdict {
                Verdict::Stored => {
                    self.changes.wake(job.id());
                    job.answer(Ok(()));
                }
                Verdict::Refused(error) => job.answer(Err(error)),
                Verdict::Open => rest.push(job),
            }
        }
        rest
    }
}

fn answer_all(batch: Vec<Job>, error: impl Fn() -> StoreError) {
    batch.into_iter().for_each(|job| job.answer(Err(error())));
}
