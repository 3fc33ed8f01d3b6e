//! Living contacts: one writer for each, a cache of states, and a replay of the moves if a state is not cached.
//!
//! Moves of one session queue at its lock in the order of their arrival, and those that wait together are made together
//! (`group`); sessions do not wait for each other. A move is computed, appended to the store, and only then visible: a
//! read shows a state that is stored. A client that hangs up while its move is computed leaves no trace; one that hangs
//! up later has its move stored or not, as a client that loses its connection must expect, and the next request asks
//! the store.
//!
//! Other processes may work on the same store. A cached state is always one that the session has been in, so that
//! the moves stored after it lead to the current one: a read applies them first, and a move whose sequence another
//! process has taken applies them and tries again. The store also says what has been deleted or has expired, whatever
//! is cached.
//!
//! A handle works for one tenant ([`Sessions::for_tenant`]) and does not see what belongs to others: their states and
//! locks have other keys, and the tenant of what comes from the store is checked before it is used.

mod apply;
mod attempt;
mod cache;
mod check;
mod cycle_log;
mod cycle_scan;
mod cycles;
mod error;
mod events;
mod expiry;
mod friction;
mod group;
mod loaded;
mod metrics;
mod observe;
mod profiles;
mod read;
mod relax;
mod replay;
mod replay_cost;
mod snapshot;
mod storage_reservation;
mod trace;
mod waiting_move;

use std::sync::Arc;

use jiff::Timestamp;
use tokio::sync::Semaphore;
use tracing::Instrument as _;
use uuid::Uuid;

use crate::admission::Pool;
use crate::formats;
use crate::otlp;
use crate::store::{
    CONTACT_BYTES, IdempotentRequest, Listeners, Reply, RequestKey, Session, Store, StoreError, Tenant, Usage,
};
use stickslip_wire::session::Creation;
use stickslip_wire::{ForkRequest, SessionReply};

pub use cache::CAPACITY;
use cache::{Cache, Guard};
pub use check::{CheckEvent, Checked, Finding, check, count_moves};
pub use error::SessionError;
pub use events::STREAMS;
use loaded::LoadedSession;
pub use metrics::{Readings, SessionMetrics};
pub use profiles::Profiles;
use storage_reservation::{StorageReservation, UsageByTenant};

/// How often a change is tried if other processes move the contact first. Each time, one of them has made progress.
const ATTEMPTS: usize = 100;

/// The sessions of a tenant. Clones, and those of other tenants, are handles on the same.
#[derive(Clone)]
pub struct Sessions {
    tenant: Tenant,
    /// The name of the key that the requests come with, where keys are in use.
    by: Option<Arc<str>>,
    common: Arc<Common>,
}

/// The state that the handles share.
struct Common {
    store: Arc<dyn Store>,
    pool: Pool,
    cache: Arc<Cache>,
    // A permit for each snapshot that is being stored.
    snapshots: Arc<Semaphore>,
    listeners: Listeners,
    metrics: SessionMetrics,
    usage: UsageByTenant,
}

impl Sessions {
    /// Sessions in a store, of the tenant without a name. At most `capacity` bytes of states are cached; the rest is
    /// replayed when needed.
    #[must_use]
    pub fn new(store: Arc<dyn Store>, pool: Pool, capacity: usize) -> Sessions {
        let metrics = SessionMetrics::default();
        let common = Common {
            store,
            pool,
            cache: Arc::new(Cache::new(capacity, metrics.hits.clone())),
            snapshots: Arc::new(Semaphore::new(snapshot::AT_ONCE)),
            listeners: Listeners::new(STREAMS),
            metrics,
            usage: UsageByTenant::default(),
        };
        Sessions { tenant: Tenant::default(), by: None, common: Arc::new(common) }
    }

    /// The sessions of another tenant, for requests that come with the key of this name.
    #[must_use]
    pub fn for_tenant(&self, tenant: Tenant, key: Arc<str>) -> Sessions {
        Sessions { tenant, by: Some(key), common: Arc::clone(&self.common) }
    }

    /// Whether requests come with keys, by whose names the history says who made a move.
    #[must_use]
    pub fn names_makers(&self) -> bool {
        self.by.is_some()
    }

    /// Whether the store can serve.
    ///
    /// # Errors
    /// [`SessionError::Store`] if it cannot.
    pub async fn ready(&self) -> Result<(), SessionError> {
        Ok(self.common.store.ready().await?)
    }

    /// Bytes of the cached states, and how many sessions they are.
    #[must_use]
    pub fn held(&self) -> (usize, usize) {
        self.common.cache.held()
    }

    /// A request that may have been answered before.
    fn request(&self, key: Option<RequestKey>) -> IdempotentRequest<'_> {
        IdempotentRequest::new(&*self.common.store, &self.tenant, key)
    }

    /// Reserves space in the store for what a change will add, within the quotas of the tenant.
    async fn reserve_storage(&self, requested: Usage) -> Result<StorageReservation, SessionError> {
        self.common.usage.reserve(&self.common.store, &self.common.pool, &self.tenant, requested).await
    }

    /// Exclusive use of a session: waits for earlier requests, as long as the pool permits.
    async fn lock(&self, id: Uuid) -> Result<Guard, SessionError> {
        match self.common.cache.try_lock(&self.tenant, id) {
            Ok(guard) => Ok(guard),
            Err(waiting) => Ok(Box::pin(self.common.pool.wait(waiting.lock())).await?),
        }
    }

    /// Makes a session.
    ///
    /// # Errors
    /// [`SessionError`]; nothing has been made then.
    pub async fn create(&self, creation: Creation, key: Option<RequestKey>) -> Result<Reply, SessionError> {
        let request = self.request(key);
        if let Some(reply) = request.earlier_reply().await? {
            return Ok(reply);
        }
        let now = Timestamp::now();
        let session = Session {
            id: Uuid::now_v7(),
            tenant: self.tenant.clone(),
            label: creation.label,
            definition: Arc::new(creation.definition),
            sequence: 0,
            created_at: now,
            updated_at: now,
        };
        let live = LoadedSession::start(session, creation.setup)?;
        let reply = live.created_reply()?;
        let receipt = request.receipt(&reply);
        let added = Usage::of(1, live.stored_bytes(), receipt.as_ref());
        let reservation = self.reserve_storage(added).await?;
        // A request that finds the new session in the store waits until it is cached.
        let mut guard = self.common.cache.lock(&self.tenant, live.session.id).await;
        let stored = self.common.store.create(live.session.clone(), receipt);
        if let Err(error) = stored.instrument(otlp::part!("store")).await {
            return Ok(request.after_refusal(error).await?);
        }
        reservation.used(added);
        guard.live = Some(Box::new(live));
        Ok(reply)
    }

    /// Makes a session with the same moves, or with the first of them.
    ///
    /// # Errors
    /// [`SessionError`]; nothing has been made then.
    pub async fn fork(&self, id: Uuid, asked: ForkRequest, key: Option<RequestKey>) -> Result<Reply, SessionError> {
        let request = self.request(key);
        if let Some(reply) = request.earlier_reply().await? {
            return Ok(reply);
        }
        let forked = self.fork_anew(id, asked, &request).await;
        unless_answered(&request, forked).await
    }

    async fn fork_anew(
        &self,
        id: Uuid,
        asked: ForkRequest,
        request: &IdempotentRequest<'_>,
    ) -> Result<Reply, SessionError> {
        // A tenant at its quota is refused before its past is read.
        drop(self.reserve_storage(Usage::of(1, CONTACT_BYTES, None)).await?);
        let mut guard = self.lock(id).await?;
        let (mut copy, _held) = self.after(&mut guard, asked.sequence).await?;
        let now = Timestamp::now();
        copy.session = Session {
            id: Uuid::now_v7(),
            label: asked.label.or(copy.session.label),
            created_at: now,
            updated_at: now,
            ..copy.session
        };
        let reply = copy.created_reply()?;
        let receipt = request.receipt(&reply);
        let extent = self.common.store.extent(id).await.map_err(|error| self.store_failure(&mut guard, error))?;
        let moves = copy.session.sequence * self.common.store.move_bytes();
        let added = Usage::of(1, copy.stored_bytes() + moves + extent.snapshot, receipt.as_ref());
        let reservation = self.reserve_storage(added).await?;
        let mut new = self.common.cache.lock(&self.tenant, copy.session.id).await;
        // The original may have moved on meanwhile in another process: its past stays what it was.
        let stored = self.common.store.fork(id, copy.session.clone(), receipt);
        match stored.instrument(otlp::part!("store")).await {
            Ok(()) => {
                reservation.used(added);
                new.live = Some(copy);
                Ok(reply)
            }
            Err(error @ (StoreError::NotFound | StoreError::Expired(_))) => Err(self.store_failure(&mut guard, error)),
            Err(StoreError::Stale { found }) => Err(SessionError::Overtaken { found }),
            Err(error) => Err(error.into()),
        }
    }

    /// Gives a session another label, or none, if it is at the sequence that the client expects, where it stays.
    ///
    /// # Errors
    /// [`SessionError`]; its label stays then.
    pub async fn rename(
        &self,
        id: Uuid,
        label: Option<String>,
        expected: Option<u64>,
        key: Option<RequestKey>,
    ) -> Result<Reply, SessionError> {
        let request = self.request(key);
        if let Some(reply) = request.earlier_reply().await? {
            return Ok(reply);
        }
        let renamed = self.rename_anew(id, label, expected, &request).await;
        unless_answered(&request, renamed).await
    }

    async fn rename_anew(
        &self,
        id: Uuid,
        label: Option<String>,
        expected: Option<u64>,
        request: &IdempotentRequest<'_>,
    ) -> Result<Reply, SessionError> {
        let mut guard = self.lock(id).await?;
        let mut overtaken = 0;
        for _ in 0..ATTEMPTS {
            let now = self.current(&mut guard).await?.reply();
            if let Some(expected) = expected.filter(|expected| *expected != now.sequence) {
                return Err(SessionError::Stale { expected, found: now.sequence });
            }
            let renamed = SessionReply { label: label.clone(), ..now };
            let reply = Reply { created: None, sequence: renamed.sequence, body: written(&renamed)? };
            let receipt = request.receipt(&reply);
            let added = Usage::of(0, 0, receipt.as_ref());
            let reservation = self.reserve_storage(added).await?;
            // The reply shows the sequence, and the client may expect one: both hold only as long as no other process
            // moves it.
            let stored = self.common.store.rename(id, label.clone(), reply.sequence, receipt);
            match stored.instrument(otlp::part!("store")).await {
                Ok(()) => {
                    reservation.used(added);
                    return Ok(reply);
                }
                Err(StoreError::Stale { found }) => overtaken = found,
                Err(error) => return Err(self.store_failure(&mut guard, error)),
            }
        }
        Err(SessionError::Overtaken { found: overtaken })
    }

    /// Deletes a session, if it is at the sequence that the client expects.
    ///
    /// # Errors
    /// [`SessionError`]; it is still there then.
    pub async fn delete(&self, id: Uuid, expected: Option<u64>) -> Result<(), SessionError> {
        let mut guard = self.lock(id).await?;
        let found = match &guard.live {
            Some(live) => live.session.sequence,
            None => self.find_own(id).await?.sequence,
        };
        let mut at = expected.unwrap_or(found);
        for _ in 0..ATTEMPTS {
            let deleted = self.common.store.delete(id, at).instrument(otlp::part!("store"));
            match (deleted.await, expected) {
                (Ok(()), _) => {
                    guard.live = None;
                    let bytes = CONTACT_BYTES + at * self.common.store.move_bytes();
                    self.common.usage.give_back(&self.tenant, Usage::of(1, bytes, None));
                    return Ok(());
                }
                (Err(StoreError::Stale { found }), Some(expected)) => {
                    return Err(SessionError::Stale { expected, found });
                }
                (Err(StoreError::Stale { found }), None) => at = found,
                (Err(error), _) => return Err(self.store_failure(&mut guard, error)),
            }
        }
        Err(SessionError::Overtaken { found: at })
    }
}

/// What a request is answered that was not answered before. One that is refused may be refused for what the same
/// request, sent twice, has changed elsewhere meanwhile: then it gets the reply to that one.
async fn unless_answered(
    request: &IdempotentRequest<'_>,
    done: Result<Reply, SessionError>,
) -> Result<Reply, SessionError> {
    match done {
        Err(SessionError::Store(error)) => Ok(request.after_refusal(error).await?),
        Err(refusal) => request.earlier_reply().await?.ok_or(refusal),
        done => done,
    }
}

/// Bytes that suffice for most replies, so that a buffer need not grow step by step.
const REPLY: usize = 768;

fn written(reply: &impl serde::Serialize) -> Result<Vec<u8>, SessionError> {
    Ok(formats::json(REPLY, reply)?)
}
