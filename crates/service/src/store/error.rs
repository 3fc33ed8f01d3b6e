//! Why a call to a store failed.

use uuid::Uuid;

use super::Tenant;

/// Why a call to a store failed. Nothing has changed then, except perhaps after
/// [`StoreError::Unavailable`] and [`StoreError::Failed`].
#[derive(Clone, Debug, thiserror::Error)]
pub enum StoreError {
    /// The session was not found.
    #[error("the contact was not found")]
    NotFound,
    /// There was such a session, of this tenant; it has expired, within [`EXPIRED_LIFETIME`](super::EXPIRED_LIFETIME).
    #[error("the contact has expired")]
    Expired(Tenant),
    /// The session has another sequence than expected.
    #[error("the contact is at sequence {found}")]
    Stale {
        /// Its sequence.
        found: u64,
    },
    /// Another request has used the idempotency key meanwhile.
    #[error("the idempotency key has been used")]
    KeyTaken,
    /// The idempotency key belongs to another request.
    #[error("the idempotency key has been used for another request")]
    KeyReused,
    /// The tenant has as many jobs as it may; the text says which limit is reached.
    #[error("{0}")]
    TooManyJobs(String),
    /// Moves of a contact are missing, or cannot be replayed: its state might be wrong.
    #[error("contact {contact}: {what}")]
    Damaged {
        /// The contact.
        contact: Uuid,
        /// What is wrong with it.
        what: String,
    },
    /// There is no room left. Nothing has changed.
    #[error("the storage is full: {0}")]
    Full(String),
    /// Another transaction of the database holds what is to be changed. Nothing has changed.
    #[error("another transaction holds the lock of this change: {0}")]
    Locked(String),
    /// The storage cannot be reached for now; whether the change was made is unknown.
    #[error("the storage is unreachable: {0}")]
    Unavailable(String),
    /// The storage itself failed; whether the change was made is unknown.
    #[error("the storage failed: {0}")]
    Failed(String),
}

impl StoreError {
    /// Whether the same call may succeed later without a repair.
    pub fn is_transient(&self) -> bool {
        matches!(self, StoreError::Full(_) | StoreError::Locked(_) | StoreError::Unavailable(_))
    }
}

/// The result of a call to a store.
pub type Result<T, E = StoreError> = std::result::Result<T, E>;
