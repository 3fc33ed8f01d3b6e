//! What `/contacts/{id}/events` sends.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};
use serde_with::apply;
use utoipa::ToSchema;
use uuid::Uuid;

use super::closed_cycle::Cycle;
use super::observation::ObservedForce;
use super::path::Move;
use super::reply::State;

/// The data of an event `state`: a move that has been applied, with the state after it.
#[apply(Option => #[serde(default, skip_serializing_if = "Option::is_none")] #[schema(nullable = false)])]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct StateEvent {
    /// The identifier of the contact.
    pub id: Uuid,
    /// The number of the move, and of moves so far; the identifier of the event.
    pub sequence: u64,
    /// The move as it was given; absent before the first.
    #[serde(rename = "move")]
    pub step: Option<Move>,
    /// The state after it.
    pub state: State,
    /// The cycle that it closed; the outermost if several.
    pub cycle: Option<Cycle>,
    /// What was measured there, if it is an observation.
    pub observation: Option<ObservedForce>,
    /// When it was applied, or the contact created (ISO 8601, UTC).
    pub at: Timestamp,
}

/// The data of the event `end`, the last one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct EndEvent {
    /// Why there are no more.
    pub reason: EndReason,
}

/// Why there are no more events.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum EndReason {
    /// The contact has been deleted.
    Deleted,
    /// The contact has been idle for so long that it has expired.
    Expired,
    /// The server stops. After a restart, or on another server, the stream continues from `Last-Event-ID`.
    Stopping,
    /// What is stored of the contact is damaged: there are moves that cannot be shown.
    Damaged,
}
