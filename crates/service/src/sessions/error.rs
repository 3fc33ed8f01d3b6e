//! Errors of operations on sessions.

use crate::admission::PoolError;
use stickslip_compute::formats::Unwritable;
use stickslip_compute::simulation;
use stickslip_wire::Rejection;

use super::prelude::*;

/// Why an operation on a session failed. Nothing has changed then.
#[derive(Debug, thiserror::Error)]
pub enum SessionError {
    /// The session was not found.
    #[error("the contact {0} was not found")]
    NotFound(Uuid),
    /// There was such a session, and it has expired.
    #[error("the contact {0} has expired")]
    Expired(Uuid),
    /// The definition differs from the one that the client gave.
    #[error("the contact {0} has another definition: leave `contact` out, or give the original one")]
    OtherDefinition(Uuid),
    /// The sequence is not the one that the client expects.
    #[error("the contact is at sequence {found}, not at {expected}")]
    Stale {
        /// What the client expects.
        expected: u64,
        /// The present sequence.
        found: u64,
    },
    /// The label is not the one that the client expects.
    #[error("the label of the contact, which is at sequence {found}, has changed")]
    Relabelled {
        /// The present sequence.
        found: u64,
    },
    /// Other processes have moved the session on, again and again.
    #[error("other requests keep moving the contact, which is now at sequence {found}: try again")]
    Overtaken {
        /// The present sequence.
        found: u64,
    },
    /// A fork is to begin after a move that has not been made.
    #[error("the contact has made {found} moves: give 0 to {found}")]
    NoSuchMove {
        /// The sequence of the session.
        found: u64,
    },
    /// Events are asked for from a move on that has not been made.
    #[error("the contact is at sequence {found}: event {after} does not exist yet")]
    Ahead {
        /// The last event that the client has received.
        after: u64,
        /// The sequence of the session.
        found: u64,
    },
    /// The limit of clients that listen to events is reached.
    #[error("{} clients follow events, which is the limit", crate::admission::STREAMS)]
    TooManyStreams,
    /// The mechanics has no answer, or the client no longer waits for it.
    #[error(transparent)]
    Failure(#[from] simulation::Failure),
    /// Replaying the moves of the session, which is not cached, takes longer than one request may. What has been
    /// replayed is kept.
    #[error(
        "the contact is being loaded, which takes longer than the {} s that are allowed: {replayed} of its moves have \
         been replayed, and the next request continues from there; send this request again", allowed.as_secs_f64()
    )]
    Loading {
        /// Moves that have been replayed.
        replayed: u64,
        /// How long work may take.
        allowed: Duration,
    },
    /// The request does not fit the definition of the contact.
    #[error(transparent)]
    Rejected(#[from] Rejection),
    /// No solver is free, or one failed.
    #[error(transparent)]
    Pool(#[from] PoolError),
    /// The storage refused or failed.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// A reply cannot be written: a fault of this program.
    #[error(transparent)]
    Unwritable(#[from] Unwritable),
    /// Another fault of this program.
    #[error("{0}")]
    Broken(String),
}
