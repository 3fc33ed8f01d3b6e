//! Changes on their way to the writer.

use std::time::Instant;

use jiff::Timestamp;
use tokio::sync::{OwnedSemaphorePermit, oneshot};
use uuid::Uuid;

use crate::store::{KeyLock, Receipt, Record, Result, Session, StoreError};

use super::fault::LOCK_WAIT;

pub(super) enum Change {
    /// A new session, with its definition as text.
    Create(Session, String),
    /// Moves for a session at a sequence, which last moved at this time, if that is known.
    Append { id: Uuid, expected: u64, moved_at: Option<Timestamp>, records: Vec<Record> },
}

/// What a change locks.
#[derive(Clone, PartialEq, Eq, Hash)]
pub(super) enum Locked {
    Contact(Uuid),
    Key(String),
}

/// A change, and the channel for its answer.
pub(super) struct WriteRequest {
    pub(super) change: Change,
    pub(super) receipt: Option<Receipt>,
    /// A random number of the request: it shows, after a lost connection, whose moves were stored.
    pub(super) stamp: i64,
    arrived: Instant,
    /// Whether an earlier attempt may have been committed.
    pub(super) in_doubt: bool,
    /// The locks of its contact and its key: later changes wait until it is answered, so that changes of one contact,
    /// and those with one key, are made in the order of their arrival.
    pub(super) locks: Vec<KeyLock<Locked>>,
    /// Its place among those that wait for other transactions, if it has one.
    pub(super) place: Option<OwnedSemaphorePermit>,
    pub(super) answer: oneshot::Sender<Result<()>>,
}

impl WriteRequest {
    /// A request that arrives now, and where its answer is awaited.
    pub(super) fn new(change: Change, receipt: Option<Receipt>) -> (WriteRequest, oneshot::Receiver<Result<()>>) {
        let (answer, answered) = oneshot::channel();
        let (stamp, arrived, locks) = (random_stamp(), Instant::now(), Vec::new());
        (WriteRequest { change, receipt, stamp, arrived, in_doubt: false, locks, place: None, answer }, answered)
    }

    /// Whether it has waited for locks for as long as it may.
    pub(super) fn is_overdue(&self) -> bool {
        self.arrived.elapsed() >= LOCK_WAIT
    }

    /// Answers that another transaction holds what it changes.
    pub(super) fn refuse_as_locked(self) {
        let why = "its locks were not released in time".to_owned();
        let refusal = if self.in_doubt { StoreError::Unavailable(why) } else { StoreError::Locked(why) };
        self.answer(Err(refusal));
    }

    pub(super) fn id(&self) -> Uuid {
        match &self.change {
            Change::Create(session, _) => session.id,
            Change::Append { id, .. } => *id,
        }
    }

    pub(super) fn key(&self) -> Option<&str> {
        self.receipt.as_ref().map(|receipt| receipt.request.key.as_str())
    }

    /// Rows that it writes, roughly.
    pub(super) fn rows(&self) -> usize {
        match &self.change {
            Change::Create(..) => 1,
            Change::Append { records, .. } => records.len(),
        }
    }

    pub(super) fn answer(self, answer: Result<()>) {
        // The client may have hung up; the change stays made.
        let _ = self.answer.send(answer);
    }
}

/// A random number that no other request has.
fn random_stamp() -> i64 {
    let (_, random) = Uuid::now_v7().as_u64_pair();
    i64::from_ne_bytes(random.to_ne_bytes())
}
