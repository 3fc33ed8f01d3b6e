//! Changes on their way to the writer, and batches of them.

use std::collections::{HashSet, VecDeque};
use std::time::Instant;

use tokio::sync::oneshot;
use uuid::Uuid;

use crate::store::{Receipt, Record, Result, Session, StoreError};

use super::fault::{Backoff, LOCK_WAIT};

/// Requests in one transaction.
const REQUESTS: usize = 512;
/// Moves in one transaction, unless a single request has more.
const MOVES: usize = 20_000;

pub(super) enum Change {
    /// A new session, with its definition as text.
    Create(Session, String),
    /// Moves for a session at a sequence.
    Append { id: Uuid, expected: u64, records: Vec<Record> },
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
    /// When it is tried next, if another transaction holds a lock that it needs.
    pub(super) due: Instant,
    backoff: Backoff,
    pub(super) answer: oneshot::Sender<Result<()>>,
}

impl WriteRequest {
    /// A request that arrives now, and where its answer is awaited.
    pub(super) fn new(change: Change, receipt: Option<Receipt>) -> (WriteRequest, oneshot::Receiver<Result<()>>) {
        let (answer, answered) = oneshot::channel();
        let (stamp, arrived, backoff) = (random_stamp(), Instant::now(), Backoff::for_lock());
        (WriteRequest { change, receipt, stamp, arrived, in_doubt: false, due: arrived, backoff, answer }, answered)
    }

    /// Lets it wait for a lock, each time longer.
    pub(super) fn postpone(&mut self) {
        self.due = Instant::now() + self.backoff.next();
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

    fn moves(&self) -> usize {
        match &self.change {
            Change::Create(..) => 0,
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

/// Takes from the backlog what one transaction can hold: of each session and each key one request at most, as the order
/// of those decides who wins.
pub(super) fn collect_batch(backlog: &mut VecDeque<WriteRequest>) -> Vec<WriteRequest> {
    let (mut ids, mut keys, mut moves) = (HashSet::new(), HashSet::new(), 0);
    let (mut batch, mut rest) = (Vec::new(), VecDeque::new());
    while let Some(request) = backlog.pop_front() {
        let fits = batch.is_empty() || (batch.len() < REQUESTS && moves + request.moves() <= MOVES);
        let new_id = ids.insert(request.id());
        let new_key = request.key().is_none_or(|key| keys.insert(key.to_owned()));
        if fits && new_id && new_key {
            moves += request.moves();
            batch.push(request);
        } else {
            rest.push_back(request);
        }
    }
    *backlog = rest;
    batch
}

#[cfg(test)]
mod tests {
    use super::{Change, WriteRequest, collect_batch};
    use crate::store::{Receipt, Reply, RequestKey};
    use std::collections::VecDeque;
    use uuid::Uuid;

    fn request(id: Uuid, expected: u64, key: Option<&str>) -> WriteRequest {
        let receipt = key.map(|key| Receipt {
            request: RequestKey { key: key.to_owned(), fingerprint: [0; 32] },
            reply: Reply { created: None, sequence: 1, body: Vec::new() },
        });
        WriteRequest::new(Change::Append { id, expected, records: Vec::new() }, receipt).0
    }

    #[test]
    fn a_batch_has_each_session_and_each_key_once_and_keeps_their_order() {
        let (a, b, c) = (Uuid::now_v7(), Uuid::now_v7(), Uuid::now_v7());
        let requests = [
            request(a, 0, None),
            request(a, 1, None),
            request(b, 0, Some("k")),
            request(c, 0, Some("k")),
            request(c, 1, None),
        ];
        let mut backlog = VecDeque::from(requests);
        let mut batches = Vec::new();
        while !backlog.is_empty() {
            let batch = collect_batch(&mut backlog);
            batches.push(batch.iter().map(WriteRequest::id).collect::<Vec<_>>());
        }
        assert_eq!(batches, [vec![a, b], vec![a, c], vec![c]]);
    }
}
