//! Errors of operations on sessions.

use uuid::Uuid;

use crate::admission::PoolError;
use crate::formats::Unwritable;
use crate::simulation;
use crate::store::StoreError;
use stickslip_wire::Rejection;

/// Why an operation on a session failed. Nothing has changed then.
#[expect(missing_docs, reason = "the messages say it")]
#[derive(Debug, thiserror::Error)]
pub enum SessionError {
    #[error("there is no contact {0}")]
    NotFound(Uuid),
    #[error("the contact {0} has expired")]
    Expired(Uuid),
    #[error("the contact {0} has another definition: leave `contact` out, or give it as it was made")]
    OtherDefinition(Uuid),
    #[error("the contact is at sequence {found}, not at {expected}")]
    Stale { expected: u64, found: u64 },
    #[error("other requests keep moving the contact, which is now at sequence {found}: try again")]
    Overtaken { found: u64 },
    #[error("the contact has made {found} moves: give 0 to {found}")]
    NoSuchMove { found: u64 },
    #[error("the contact is at sequence {found}: there is no event {after} yet")]
    Ahead { after: u64, found: u64 },
    #[error("{} clients listen to events, which is the limit", super::STREAMS)]
    TooManyStreams,
    #[error(transparent)]
    Failure(#[from] simulation::Failure),
    #[error(transparent)]
    Rejected(#[from] Rejection),
    #[error(transparent)]
    Pool(#[from] PoolError),
    #[error(transparent)]
    Store(#[from] StoreError),
    #[error(transparent)]
    Unwritable(#[from] Unwritable),
    /// A fault of this program.
    #[error("{0}")]
    Broken(String),
}
