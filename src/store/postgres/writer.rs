//! The writer: changes that arrive during a transaction go together in the next one.

use std::sync::Arc;
use std::time::Duration;

use tokio::sync::{Mutex, Semaphore, mpsc};
use tokio::time::timeout;
use uuid::Uuid;

use crate::store::{Changes, Commits, Receipt, Result, StoreError, batch};

use super::change_locks::ChangeLocks;
use super::client_pool::ClientPool;
use super::committer::Committer;
use super::fault::Backoff;
use super::request::{Change, WriteRequest};

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
    contacts: ChangeLocks<Uuid>,
    keys: ChangeLocks<String>,
    pub(super) commits: Arc<Commits>,
}

impl Writer {
    /// Starts the writer. It ends, after what waits, when this handle is dropped.
    pub(super) fn start(pool: Arc<ClientPool>, changes: Arc<Changes>) -> Writer {
        let (queue, requests) = mpsc::channel(QUEUE);
        let commits = Arc::new(Commits::new("postgres"));
        let committer = Committer::new(pool, changes, Arc::clone(&commits));
        tokio::spawn(write_batches(requests, committer));
        Writer { queue, contacts: ChangeLocks::default(), keys: ChangeLocks::default(), commits }
    }

    /// Makes a change, and returns when it is committed.
    pub(super) async fn write(&self, change: Change, receipt: Option<Receipt>) -> Result<()> {
        let _pending = self.commits.wait();
        let (mut request, answered) = WriteRequest::new(change, receipt);
        let send = async {
            request.locks.push(self.contacts.lock(request.id()).await);
            // After the contact, always: so nobody waits for a contact who has a key that others wait for.
            if let Some(key) = request.key().map(str::to_owned) {
                request.locks.push(self.keys.lock(key).await);
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
    let (places, beside) = (Arc::new(Semaphore::new(LOCKED)), Arc::new(Mutex::new(committer.another())));
    while let Some(first) = requests.recv().await {
        for held in committer.commit(batch::collect(first, &mut requests, WriteRequest::rows)).await {
            let Ok(place) = Arc::clone(&places).try_acquire_owned() else {
                held.refuse_as_locked();
                continue;
            };
            let beside = Arc::clone(&beside);
            tokio::spawn(async move {
                let _place = place;
                commit_when_free(held, &beside).await;
            });
        }
    }
}

/// Tries a change that another transaction holds until it is made or has waited for as long as it may.
async fn commit_when_free(request: WriteRequest, committer: &Mutex<Committer>) {
    let (mut backoff, mut held) = (Backoff::for_lock(), Some(request));
    while let Some(request) = held.take() {
        if request.is_overdue() {
            tracing::warn!(contact = %request.id(), "the lock of another transaction was not released");
            return request.refuse_as_locked();
        }
        backoff.pause().await;
        held = committer.lock().await.commit(vec![request]).await.pop();
    }
}
