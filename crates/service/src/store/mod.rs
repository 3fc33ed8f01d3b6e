//! Stores: definitions of contacts, their moves, and the replies that retries get again.
//!
//! A store returns definitions and moves as they were saved, and contains no physics. Every call is atomic, and what it
//! has acknowledged is as durable as the store is. [`sqlite`] keeps all of it in a file, or in the process until that
//! ends, and [`postgres`] in a database that many processes share. [`open()`] chooses by the URL.

mod batch;
pub mod changes;
mod clock;
pub mod commits;
mod error;
pub mod idempotency;
pub mod job_store;
#[cfg(feature = "postgres")]
mod keyed_locks;
pub mod listeners;
pub mod open;
#[cfg(feature = "postgres")]
pub mod postgres;
mod probe;
mod rows;
pub mod schema;
pub mod sqlite;

use std::sync::Arc;

use async_trait::async_trait;
use jiff::Timestamp;
use uuid::Uuid;

use stickslip_wire::{ContactDefinition, ContactOrder, Move, ObservedForce, SessionSummary, State};

pub use changes::Changes;
pub use clock::Clock;
pub use commits::Commits;
pub use error::{Result, StoreError};
pub use idempotency::IdempotentRequest;
pub use job_store::{ChunkResult, Claim, Job, JobLimits, JobStore};
#[cfg(feature = "postgres")]
pub(crate) use keyed_locks::{KeyLock, KeyedLocks};
pub use listeners::{Listener, Listeners, StreamEvent};
pub use open::{OpenError, backup, open, open_to_read};
#[cfg(feature = "postgres")]
pub use postgres::PostgresStore;
pub use sqlite::SqliteStore;

pub use crate::tenant::Tenant;

/// How long a reply is kept for retries with the same idempotency key.
pub const RECEIPT_LIFETIME: std::time::Duration = std::time::Duration::from_secs(24 * 60 * 60);

/// How long a store remembers that a session has expired. Later the session is not found.
pub const EXPIRED_LIFETIME: std::time::Duration = std::time::Duration::from_secs(30 * 24 * 60 * 60);

/// A session as it is stored.
#[derive(Clone, Debug, PartialEq)]
pub struct Session {
    /// Its identifier; time-ordered, so that the order of identifiers is that of creation.
    pub id: Uuid,
    /// Its tenant, which never changes.
    pub tenant: Tenant,
    /// Its label.
    pub label: Option<String>,
    /// The contact as it was defined.
    pub definition: Arc<ContactDefinition>,
    /// The number of its moves.
    pub sequence: u64,
    /// When it was made.
    pub created_at: Timestamp,
    /// When it last moved.
    pub updated_at: Timestamp,
}

/// A move as it is stored, with the state after it.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// Its number, counted from 1 without a gap.
    pub sequence: u64,
    /// The move as it was given: replaying it gives the same state to the last bit.
    pub step: Move,
    /// The tolerance that it was followed to where it is not exact; part of what a replay needs.
    pub tolerance: f64,
    /// The state after it, for the history alone.
    pub state: State,
    /// What was measured there, if it is an observation. A replay does not need it.
    pub measured: Option<Measured>,
    /// The name of the key that made it, where keys were in use. A replay does not need it.
    pub by: Option<Arc<str>>,
    /// When it was applied.
    pub at: Timestamp,
}

impl Record {
    /// The measurement, if the move is an observation.
    pub fn observation(&self) -> Option<ObservedForce> {
        self.measured.map(|Measured { force, at }| ObservedForce::new(force, self.state.force.unwrap_or_default(), at))
    }
}

/// Bytes of a record in memory, with the longest name of a key.
pub const RECORD_BYTES: usize = size_of::<Record>() + 96;

/// The measurement of a bench at the displacement that a move goes to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// Tangential force, N.
    pub force: f64,
    /// The instant of the measurement, if it is known; from 1678 to 2261.
    pub at: Option<Timestamp>,
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
    /// The same key as that of a tenant. No key holds a space, so that the keys of two tenants always differ.
    #[must_use]
    pub fn for_tenant(self, tenant: &Tenant) -> RequestKey {
        match tenant.name() {
            "" => self,
            name => RequestKey { key: format!("{name} {}", self.key), ..self },
        }
    }

    /// Whether it is a key of this tenant.
    #[must_use]
    pub fn is_of(&self, tenant: &Tenant) -> bool {
        self.key.split_once(' ').map_or("", |(name, _)| name) == tenant.name()
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

impl Receipt {
    /// Bytes that it takes in the store.
    pub fn bytes(&self) -> u64 {
        RECEIPT_OVERHEAD + self.reply.body.len() as u64 + 2 * self.request.key.len() as u64
    }
}

/// A packed state for a replay to begin at: a cache that can always be rebuilt from the moves.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Snapshot {
    /// The move that it was taken after.
    pub sequence: u64,
    /// The state, in bytes that the store does not read.
    pub state: Vec<u8>,
}

/// The size of a session before it is read, its tenant, and its label, which can change.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Extent {
    /// Its tenant.
    pub tenant: Tenant,
    /// How many moves it has made.
    pub sequence: u64,
    /// Its label.
    pub label: Option<String>,
    /// Bytes of its definition as JSON.
    pub definition: u64,
    /// Bytes of its snapshot, if there is one.
    pub snapshot: u64,
    /// When it last moved, where others may change the store: of two pasts of one length it tells which is stored.
    pub moved_at: Option<Timestamp>,
}

impl Extent {
    /// Whether this may be the extent of a session that last moved at this time.
    pub fn is_moved_at(&self, at: Timestamp) -> bool {
        self.moved_at.is_none_or(|stored| stored == at)
    }
}

/// A label, or none, and the one that takes its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LabelChange {
    /// The label that the session must have.
    pub from: Option<String>,
    /// Its new label.
    pub to: Option<String>,
}

/// A page of sessions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Page {
    /// By the identifiers, which rise with the time at which a session is made.
    pub order: ContactOrder,
    /// The session that it comes after, in this order; it begins with the first if there is none.
    pub after: Option<Uuid>,
    /// As many sessions at most.
    pub limit: usize,
}

impl Page {
    /// The oldest first.
    pub fn oldest(after: Option<Uuid>, limit: usize) -> Page {
        Page { order: ContactOrder::Oldest, after, limit }
    }
}

/// Decides whether a session is small enough to be read at once.
pub type IsSmall = fn(&Extent) -> bool;

/// A session with all of its moves, from one consistent read.
#[derive(Clone, Debug, PartialEq)]
pub struct Whole {
    /// The session.
    pub session: Session,
    /// Its moves, from the first to the last.
    pub moves: Vec<Record>,
}

/// The space that a tenant takes in the store.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Usage {
    /// Contacts.
    pub contacts: u64,
    /// Bytes of its contacts, of their moves and snapshots, and of the replies that are kept for retries: as many as
    /// the storage takes for them, within a factor of two.
    pub bytes: u64,
}

impl Usage {
    /// The space of a change: contacts, bytes, and the bytes of its kept reply.
    pub fn of(contacts: u64, bytes: u64, receipt: Option<&Receipt>) -> Usage {
        Usage { contacts, bytes: bytes + receipt.map_or(0, Receipt::bytes) }
    }
}

/// Bytes that a contact takes besides its definition, its moves and its snapshot, roughly.
pub const CONTACT_BYTES: u64 = 512;
/// Bytes that a reply kept for retries takes besides its body and its key, roughly.
pub const RECEIPT_OVERHEAD: u64 = 256;

/// Storage of contacts. It returns the tenant of a contact and leaves access control to its callers: any identifier is
/// accepted here.
#[async_trait]
pub trait Store: JobStore {
    /// Whether it can serve: whether a change can be written now.
    async fn ready(&self) -> Result<()>;

    /// Stores a new session that has not moved, and the receipt with it.
    async fn create(&self, session: Session, receipt: Option<Receipt>) -> Result<()>;

    /// The size of a session, with its tenant and label.
    async fn extent(&self, id: Uuid) -> Result<Extent>;

    /// The size of a session; and the session with its moves, if `is_small` accepts the size and the store can read
    /// both in one step.
    async fn load(&self, id: Uuid, is_small: IsSmall) -> Result<(Extent, Option<Whole>)> {
        let _ = is_small;
        Ok((self.extent(id).await?, None))
    }

    /// The space that a tenant takes. It reads a row or two of each contact, and no moves.
    async fn usage(&self, tenant: &Tenant) -> Result<Usage>;

    /// Bytes that a move takes in the storage, with its share of the indexes; rather too many than too few.
    fn move_bytes(&self) -> u64;

    /// The session.
    async fn find(&self, id: Uuid) -> Result<Session>;

    /// A page of the sessions of a tenant, or of all tenants, by their identifiers; of those alone whose label contains
    /// `label`, whatever the case of ASCII letters. Without their definitions: a page of those could be larger than the
    /// memory. A search for a label may read all labels of a tenant: few run at a time, and one whose client has left
    /// ends.
    async fn list(&self, tenant: Option<Tenant>, label: Option<String>, page: Page) -> Result<Vec<SessionSummary>>;

    /// Changes the label of a session that is at sequence `expected`, and stores the receipt with it. Its sequence and
    /// its times stay. [`StoreError::Stale`] also if it has another label than the change is from.
    async fn rename(&self, id: Uuid, label: LabelChange, expected: u64, receipt: Option<Receipt>) -> Result<()>;

    /// Appends moves to a session that is at sequence `expected`, all or none of them, and the receipt with them. The
    /// records are numbered from `expected + 1`.
    async fn append(&self, id: Uuid, expected: u64, records: Vec<Record>, receipt: Option<Receipt>) -> Result<()> {
        self.append_after(id, (expected, None), records, receipt).await
    }

    /// The same for a session that last moved at this time, if others may change the store: they may have put back an
    /// earlier past, and moved the session on from there. [`StoreError::Stale`] if it last moved at another time.
    async fn append_after(
        &self,
        id: Uuid,
        past: (u64, Option<Timestamp>),
        records: Vec<Record>,
        receipt: Option<Receipt>,
    ) -> Result<()>;

    /// At most `limit` moves of a session with sequences greater than `after`, in order and without a gap.
    ///
    /// # Errors
    /// [`StoreError::Damaged`] if one of them is missing.
    async fn history(&self, id: Uuid, after: u64, limit: usize) -> Result<Vec<Record>>;

    /// How many of the first `end` moves of a session are stored: fewer if it is damaged.
    async fn count_moves(&self, id: Uuid, end: u64) -> Result<u64>;

    /// Stores `copy`, with the moves of `id` up to the copy's sequence as its own, and the receipt with it.
    /// [`StoreError::Stale`] if `id` has not made that many.
    async fn fork(&self, id: Uuid, copy: Session, receipt: Option<Receipt>) -> Result<()>;

    /// Deletes a session that is at sequence `expected`, and its moves.
    async fn delete(&self, id: Uuid, expected: u64) -> Result<()>;

    /// Stores the receipt of a request that changes nothing else.
    async fn keep(&self, receipt: Receipt) -> Result<()>;

    /// The receipt for an idempotency key, if the key has been used within [`RECEIPT_LIFETIME`].
    async fn receipt(&self, key: &str) -> Result<Option<Receipt>>;

    /// The newest snapshot of a session, if there is one.
    async fn snapshot(&self, id: Uuid) -> Result<Option<Snapshot>>;

    /// Stores a snapshot in place of an older one, or of the unreadable one after the move `unreadable`. Does nothing
    /// if the session is deleted or a newer snapshot is stored.
    async fn save_snapshot(&self, id: Uuid, snapshot: Snapshot, unreadable: Option<u64>) -> Result<()>;

    /// The time now, by the clock that says how old what is stored is.
    async fn now(&self) -> Result<Timestamp> {
        Ok(Timestamp::now())
    }

    /// Deletes receipts older than [`RECEIPT_LIFETIME`], jobs past their time, and, where `idle_since` is given, the
    /// sessions that have not moved since. Those are [`StoreError::Expired`] for [`EXPIRED_LIFETIME`] from then on.
    /// Returns how many sessions expired.
    async fn purge_expired(&self, idle_since: Option<Timestamp>) -> Result<u64>;

    /// Whether this process alone changes what is stored, and counts the changes in [`Store::changes`].
    fn is_exclusive(&self) -> bool {
        false
    }

    /// Wakes those who wait for changes, whichever process on the same storage makes them.
    fn changes(&self) -> &Changes;

    /// Metrics of its transactions.
    fn commits(&self) -> &Commits;

    /// Bytes of the log whose changes are not in the file of the store yet, if it has one.
    fn log_bytes(&self) -> Option<u64> {
        None
    }

    /// Faults of the storage itself, a line each: damage, and rows that belong to no contact.
    async fn check_integrity(&self) -> Result<Vec<String>>;
}
