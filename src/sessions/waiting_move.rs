//! A move that waits for the lock of its session, and may be made by whoever has it.

use std::sync::Arc;

use tokio::sync::oneshot;
use tracing::Span;

use crate::store::Reply;
use stickslip_wire::session::Advance;

use super::SessionError;
use super::storage_reservation::StorageReservation;

/// A move that may be made by whoever has the lock.
pub(super) struct WaitingMove {
    pub(super) advance: Arc<Advance>,
    /// The sequence that the client expects.
    pub(super) expected: Option<u64>,
    /// The name of its key.
    pub(super) by: Option<Arc<str>>,
    pub(super) reservation: StorageReservation,
    pub(super) span: Span,
    pub(super) outcome: oneshot::Sender<Outcome>,
}

/// What a group has done of a move.
pub(super) enum Outcome {
    /// It is stored, or the store has refused the group.
    Answered(Result<Reply, SessionError>),
    /// Nothing.
    NotMade,
}

impl WaitingMove {
    /// Tells its client what has become of it.
    pub(super) fn finish(self, answer: Result<Reply, SessionError>) {
        // The client may have left.
        let _ = self.outcome.send(Outcome::Answered(answer));
    }

    /// Leaves it to its client.
    pub(super) fn decline(self) {
        let _ = self.outcome.send(Outcome::NotMade);
    }
}
