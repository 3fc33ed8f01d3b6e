//! What `/contacts/{id}/events` sends.

use super::closed_cycle::Cycle;
use super::observation::ObservedForce;
use crate::prelude::*;

replies! {
/// The data of an event `state`: a move that has been applied, with the state after it.
pub struct StateEvent omits Option {
    /// The identifier of the contact.
    pub id: Uuid,
    /// The number of the move, which is the number of moves so far and the identifier of the event.
    pub sequence: u64,
    /// The move as it was given; absent before the first move.
    #[serde(rename = "move")]
    pub step: Option<Move>,
    /// The state after it.
    pub state: State,
    /// The cycle that it closed; the outermost if several.
    pub cycle: Option<Cycle>,
    /// The measurement, if the move is an observation.
    pub observation: Option<ObservedForce>,
    /// When it was applied, or the contact created (ISO 8601, UTC).
    pub at: Timestamp,
}

/// The data of the last event, `end`.
pub struct EndEvent: Copy, Eq {
    /// Why there are no more events.
    pub reason: EndReason,
}
}

words! {
/// Why there are no more events.
pub enum EndReason {
    /// The contact has been deleted.
    Deleted = "deleted",
    /// The contact has been idle for so long that it has expired.
    Expired = "expired",
    /// The server stops. After a restart, or on another server, the stream continues from `Last-Event-ID`.
    Stopping = "stopping",
    /// The key of the client counts no longer.
    Revoked = "revoked",
    /// The stored contact is damaged: some moves cannot be shown.
    Damaged = "damaged",
    /// The server cannot read the next move; the operator finds the cause in the log.
    Failed = "failed",
}
}
