//! The writer: changes that arrive during a transaction go together in the next one.

use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Duration;

use tokio::sync::mpsc;
use tokio::time::timeout;

use crate::store::{Changes, Commits, Receipt, Result, StoreError};

use super::client_pool::ClientPool;
use super::committer::Committer;
use super::lock_line::LockLine;
use super::request::{Change, WriteRequest, collect_batch};

/// Changes that may wait.
const QUEUE: usize = 4096;
/// How long a change waits for a place in the queue.
const PATIENCE: Duration = Duration::from_secs(10);

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
        let committer = Committer::new(pool, changes, Arc::clone(&commits));
        tokio::spawn(write_batches(requests, committer));
        Writer { queue, commits }
    }

    /// Makes a change, and returns when it is committed.
    pub(super) async fn write(&self, change: Change, receipt: Option<Receipt>) -> Result<()> {
        let _pending = self.commits.wait();
        let (request, answered) = WriteRequest::new(change, receipt);
        match timeout(PATIENCE, self.queue.send(request)).await {
            Ok(Ok(())) => {}
            Ok(Err(_)) => return Err(StoreError::Failed("the writer has ended".to_owned())),
            Err(_) => return Err(StoreError::Unavailable("too many changes wait".to_owned())),
        }
        answered.await.unwrap_or_else(|_| Err(StoreError::Failed("the writer has ended".to_owned())))
    }
}

/// Makes changes as they arrive. What another transaction holds goes to a line of its own, as does what comes after it.
async fn write_batches(mut requests: mpsc::Receiver<WriteRequest>, mut committer: Committer) {
    let line = LockLine::start(committer.another());
    let mut backlog = VecDeque::new();
    loop {
        if backlog.is_empty() {
            match requests.recv().await {
                Some(request) => backlog.push_back(request),
                None => return line.end().await,
            }
        }
        while backlog.len() < QUEUE
            && let Ok(request) = requests.try_recv()
        {
            backlog.push_back(request);
        }
        line.take_followers(&mut backlog);
        line.push(committer.commit(collect_batch(&mut backlog)).await);
    }
}
