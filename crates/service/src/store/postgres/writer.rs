//! The writer: changes that arrive during a transaction go together in the next one.

use std::sync::Arc;
use std::time::Duration;

use tokio::sync::mpsc::error::SendError;
use tokio::sync::{Semaphore, mpsc};
use tokio::time::timeout;

use crate::store::{Changes, Commits, KeyedLocks, Receipt, Result, StoreError, batch};

use super::client_pool::ClientPool;
use super::committer::{Committer, without_overdue};
use super::fault::Backoff;
use super::request::{Change, Locked, WriteRequest};

/// Changes that may wait.
const QUEUE: usize = 4096;
/// How long a change waits for earlier ones of its contact and for a place in the queue.
const PATIENCE: Duration = Duration::from_secs(10);
/// Changes that wait for locks of other transactions at a time. A further one is refused at once, so that those that
/// wait leave the others room among the requests that a server has in progress.
const LOCKED: usize = 256;

/// The handle to which changes are sent.
pub(super) struct Writer {
    queue: mpsc::Sender<WriteRequest>,
    locks: Arc<KeyedLocks<Locked>>,
    pub(super) commits: Arc<Commits>,
}

impl Writer {
    /// Starts the writer. It ends, after what waits, when this handle is dropped.
    pub(super) fn start(pool: Arc<ClientPool>, changes: Arc<Changes>) -> Writer {
        let (queue, requests) = mpsc::channel(QUEUE);
        let commits = Arc::new(Commits::new("postgres"));
        let committer = Committer::new(pool, changes, Arc::clone(&commits));
        tokio::spawn(write_batches(requests, committer));
        Writer { queue, locks: Arc::default(), commits }
    }

    /// Makes a change, and returns when it is committed.
    pub(super) async fn write(&self, change: Change, receipt: Option<Receipt>) -> Result<()> {
        let _pending = self.commits.wait();
        let (mut request, answered) = WriteRequest::new(change, receipt);
        let send = async {
            request.locks.push(self.locks.lock(Locked::Contact(request.id())).await);
            // After the contact, always: so nobody waits for a contact who has a key that others wait for.
            if let Some(key) = request.key().map(str::to_owned) {
                request.locks.push(self.locks.lock(Locked::Key(key)).await);
            }
            // Whoever had the locks before may have waited for those of other transactions.
            if request.is_overdue() {
                request.refuse_as_locked();
                return Ok(());
            }
            self.queue.send(request).await
        };
        match timeout(PATIENCE, send).await {
            Ok(Ok(())) => {}
            Ok(Err(_)) => return Err(StoreError::Failed("the writer has ended".to_owned())),
            Err(_) => return Err(StoreError::Unavailable("too many changes wait".to_owned())),
        }
        answered.await.unwrap_or_else(|_| Err(StoreError::Failed("the writer has ended".to_owned())))
    }
}

/// Makes changes as they arrive. What another transaction holds is tried again on a connection beside that of the
/// others, which go on without it.
async fn write_batches(mut requests: mpsc::Receiver<WriteRequest>, mut committer: Committer) {
    let (beside, held) = mpsc::unbounded_channel();
    let places = Arc::new(Semaphore::new(LOCKED));
    tokio::spawn(write_held(held, committer.another()));
    while let Some(first) = requests.recv().await {
        for mut held in committer.commit(batch::collect(first, &mut requests, WriteRequest::rows)).await {
            held.place = Arc::clone(&places).try_acquire_owned().ok();
            if held.place.is_none() {
                held.refuse_as_locked();
            } else if let Err(SendError(held)) = beside.send(held) {
                held.answer(Err(StoreError::Failed("the writer has ended".to_owned())));
            }
        }
    }
}

/// Tries changes that other transactions hold, all of them together, until they are made or have waited for as long as
/// they may.
async fn write_held(mut requests: mpsc::UnboundedReceiver<WriteRequest>, mut committer: Committer) {
    while let Some(first) = requests.recv().await {
        let (mut backoff, mut held) = (Backoff::for_lock(), vec![first]);
        while !held.is_empty() {
            tokio::select! {
                () = backoff.pause() => held = committer.commit(without_overdue(held)).await,
                Some(next) = requests.recv() => {
                    held.push(next);
                    backoff = Backoff::for_lock();
                }
            }
        }
    }
}
