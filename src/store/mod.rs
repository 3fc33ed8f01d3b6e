//! What must survive: definitions, the moves made since, and the replies that a retry is owed.
//!
//! Definitions and moves go in and the same come out; a store knows no physics. Every call is atomic, and what it has
//! acknowledged is as durable as the store is. [`memory`] keeps all of it in the process and forgets it at the end;
//! [`sqlite`] keeps it in a file, and [`postgres`] in a database that many processes share. [`open()`] tells them apart by
//! their URLs.

pub mod changes;
pub mod commits;
pub mod jobs;
pub mod memory;
pub mod open;
pub mod postgres;
pub mod sqlite;

use std::sync::Arc;

use futures::future::BoxFuture;
use jiff::Timestamp;
use uuid::Uuid;

use stickslip_wire::{ContactDefinition, Move, SessionSummary, State};

pub use changes::Changes;
pub use commits::Commits;
pub use jobs::{ChunkResult, Claim, Job, JobLimits, JobStore};
pub use memory::MemoryStore;
pub use open::{OpenError, backup, open, open_to_read};
pub use postgres::PostgresStore;
pub use sqlite::SqliteStore;

/// How long a reply is kept for retries with the same idempotency key.
pub const RECEIPT_LIFETIME: std::time::Duration = std::time::Duration::from_secs(24 * 60 * 60);

/// Whose sessions are: who has a key of one tenant knows nothing of the others. Without keys there is one tenant, and it has
/// no name.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Tenant(Arc<str>);

impl Tenant {
    /// The tenant of a name.
    #[must_use]
    pub fn new(name: &str) -> Tenant {
        Tenant(name.into())
    }

    /// The name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.0
    }
}

/// A session as it is stored.
#[derive(Clone, Debug, PartialEq)]
pub struct Session {
    /// Its identifier; time-ordered, so that the order of identifiers is that of creation.
    pub id: Uuid,
    /// Whose it is, for ever.
    pub tenant: Tenant,
    /// Its label.
    pub label: Option<String>,
    /// The contact as it was defined.
    pub definition: Arc<ContactDefinition>,
    /// How many moves it has behind it.
    pub sequence: u64,
    /// When it was made.
    pub created_at: Timestamp,
    /// When it last moved.
    pub updated_at: Timestamp,
}

/// A move as it is stored, with what came of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Record {
    /// Its number, counted from 1 without a gap.
    pub sequence: u64,
    /// The move as it was given: replaying it gives the same state to the last bit.
    pub step: Move,
    /// The tolerance that it was followed to where it is not exact; part of what a replay needs.
    pub tolerance: f64,
    /// The state after it, for the history alone.
    pub state: State,
    /// When it was applied.
    pub at: Timestamp,
}

/// A request with an idempotency key.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RequestKey {
    /// The key that the client chose, behind the name of its tenant and a space if the tenant has a name.
    pub key: String,
    /// SHA-256 of method, path and body.
    pub fingerprint: [u8; 32],
}

impl RequestKey {
    /// The same key as that of a tenant. No key holds a space, so that those of two tenants never meet.
    #[must_use]
    pub fn of(self, tenant: &Tenant) -> RequestKey {
        match tenant.name() {
            "" => self,
            name => RequestKey { key: format!("{name} {}", self.key), ..self },
        }
    }
}

/// The reply to a request that changed something.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Reply {
    /// The session that it made, if it made one.
    pub created: Option<Uuid>,
    /// The sequence of the session after it.
    pub sequence: u64,
    /// The JSON that was sent.
    pub body: Vec<u8>,
}

/// A reply that is kept for retries.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Receipt {
    /// The request that it answers.
    pub request: RequestKey,
    /// The reply.
    pub reply: Reply,
}

/// A packed state for a replay to begin at: a cache of what the moves say, and never a truth of its own.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Snapshot {
    /// The move that it was taken after.
    pub sequence: u64,
    /// The state, in bytes that the store does not read.
    pub state: Vec<u8>,
}

/// Why a store did not do what it was asked for. Nothing has changed then, except perhaps after [`StoreError::Unavailable`]
/// and [`StoreError::Failed`].
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// There is no such session.
    #[error("there is no such session")]
    NotFound,
    /// There was such a session, of this tenant; it has expired.
    #[error("the session has expired")]
    Expired(Tenant),
    /// The session has another sequence than expected.
    #[error("the session is at sequence {found}")]
    Stale {
        /// Its sequence.
        found: u64,
    },
    /// Another request has used the idempotency key meanwhile.
    #[error("the idempotency key has been used")]
    KeyTaken,
    /// The tenant has as many jobs as it may, and says what there is too much of.
    #[error("{0}")]
    TooManyJobs(String),
    /// There is no room left. Nothing has changed.
    #[error("the storage is full: {0}")]
    Full(String),
    /// The storage cannot be reached for now; whether the change was made is unknown.
    #[error("the storage is out of reach: {0}")]
    Unavailable(String),
    /// The storage itself failed; whether the change was made is unknown.
    #[error("the storage failed: {0}")]
    Failed(String),
}

/// What a call to a store comes to.
pub type Answer<'a, T> = BoxFuture<'a, Result<T, StoreError>>;

/// A place to keep sessions. It tells whose they are, and leaves it to its callers to keep tenants apart: an identifier is as
/// good as any other here.
pub trait Store: JobStore {
    /// Whether it can serve.
    fn ready(&self) -> Answer<'_, ()>;

    /// Stores a new session without a past, and the receipt with it.
    fn create(&self, session: Session, receipt: Option<Receipt>) -> Answer<'_, ()>;

    /// The session.
    fn find(&self, id: Uuid) -> Answer<'_, Session>;

    /// The sequence of a session: all that somebody who knows the rest has to ask.
    fn sequence(&self, id: Uuid) -> Answer<'_, u64>;

    /// At most `limit` sessions of a tenant, or of all of them, with identifiers beyond `after`, in order. Without their
    /// definitions: a page of those could be larger than the memory.
    fn list(&self, of: Option<Tenant>, after: Option<Uuid>, limit: usize) -> Answer<'_, Vec<SessionSummary>>;

    /// Appends moves to a session that is at sequence `expected`, all or none of them, and the receipt with them. The
    /// records are numbered from `expected + 1`.
    fn append(&self, id: Uuid, expected: u64, records: Vec<Record>, receipt: Option<Receipt>) -> Answer<'_, ()>;

    /// At most `limit` moves of a session with numbers beyond `after`, in order.
    fn history(&self, id: Uuid, after: u64, limit: usize) -> Answer<'_, Vec<Record>>;

    /// Stores `copy`, with the past of `id` as its own, and the receipt with it. The copy's sequence is that of `id`.
    fn fork(&self, id: Uuid, copy: Session, receipt: Option<Receipt>) -> Answer<'_, ()>;

    /// Deletes a session that is at sequence `expected`, and its past.
    fn delete(&self, id: Uuid, expected: u64) -> Answer<'_, ()>;

    /// The receipt for an idempotency key, if the key has been used within [`RECEIPT_LIFETIME`].
    fn receipt<'a>(&'a self, key: &'a str) -> Answer<'a, Option<Receipt>>;

    /// The newest snapshot of a session, if there is one.
    fn snapshot(&self, id: Uuid) -> Answer<'_, Option<Snapshot>>;

    /// Keeps a snapshot in place of an older one. Nothing happens where the session is gone or a newer one is kept.
    fn keep_snapshot(&self, id: Uuid, snapshot: Snapshot) -> Answer<'_, ()>;

    /// Deletes receipts past [`RECEIPT_LIFETIME`], and, where `idle_since` is given, the sessions that have not moved since.
    /// Those are [`StoreError::Expired`] from then on. Jobs go too whose time is over. Returns how many sessions went.
    fn sweep(&self, idle_since: Option<Timestamp>) -> Answer<'_, u64>;

    /// Who waits for changes, and is woken by every change that this or any other process on the same storage makes.
    fn changes(&self) -> &Changes;

    /// What it has committed; none if it has nothing to commit.
    fn commits(&self) -> Option<&Commits> {
        None
    }

    /// What is wrong with the storage itself, a line each: what is damaged, and what belongs to no session.
    fn examine(&self) -> Answer<'_, Vec<String>> {
        Box::pin(std::future::ready(Ok(Vec::new())))
    }
}
