//! What the sessions of all tenants share: the store, the pool, and the cache with its locks. A handle uses it within
//! its tenant.

use tokio::sync::Semaphore;

use crate::admission::{Pool, STREAMS};
use crate::store::{Extent, IdempotentRequest, Listeners, RequestKey, Session, Usage};
use stickslip_compute::simulation::{ProfileCache, ProfileKey, Profiles};
use stickslip_mechanics::Profile;

use super::entries::Entries;
use super::metrics::SessionMetrics;
use super::prelude::*;
use super::published::Published;
use super::snapshot;
use super::storage_reservation::{StorageReservation, UsageByTenant};

/// How often a change is tried if other processes move the contact first. Each time, one of them has made progress.
pub(super) const ATTEMPTS: usize = 100;

/// What all tenants share.
pub struct Common {
    pub(super) store: Arc<dyn Store>,
    pub(super) pool: Pool,
    pub(super) entries: Arc<Entries>,
    /// A permit for each snapshot that is being stored.
    pub(super) snapshots: Arc<Semaphore>,
    pub(super) listeners: Listeners,
    /// Metrics that are counted as events happen.
    pub metrics: SessionMetrics,
    usage: UsageByTenant,
}

impl Common {
    /// Sessions in a store, of which at most `capacity` bytes of states are cached.
    pub(super) fn new(store: Arc<dyn Store>, pool: Pool, capacity: usize) -> Common {
        let metrics = SessionMetrics::default();
        Common {
            snapshots: Arc::new(Semaphore::new(snapshot::AT_ONCE)),
            entries: Arc::new(Entries::new(capacity, metrics.hits.clone())),
            store,
            pool,
            listeners: Listeners::new(STREAMS),
            metrics,
            usage: UsageByTenant::default(),
        }
    }

    /// Notes that a tenant takes less of the store.
    pub(super) fn give_back(&self, tenant: &Tenant, freed: Usage) {
        self.usage.give_back(tenant, freed);
    }
}

/// The profiles that requests share are kept in the cache of the states, within one bound.
impl ProfileCache for Common {
    fn holds(&self, key: &ProfileKey) -> bool {
        self.entries.profile(key).is_some()
    }

    fn get(&self, key: &ProfileKey) -> Option<Arc<Profile>> {
        self.entries.profile(key).inspect(|_| self.metrics.profiles_shared.inc())
    }

    fn keep(&self, key: ProfileKey, profile: Arc<Profile>, bytes: usize) -> Arc<Profile> {
        self.metrics.profiles_prepared.inc();
        self.entries.keep_profile(key, profile, bytes)
    }
}

impl Sessions {
    /// The shared profiles, for work that ends when this flag is raised.
    pub fn profiles(&self, stop: &Deadline) -> Profiles<Deadline> {
        Profiles::new(self.common.clone(), stop.clone(), self.pool.capacity().deadline)
    }

    /// A request that may have been answered before.
    pub(super) fn request(&self, key: Option<RequestKey>) -> IdempotentRequest<'_> {
        IdempotentRequest::new(&*self.store, &self.tenant, key)
    }

    /// Reserves space in the store for what a change will add, within the quotas of the tenant.
    pub(super) async fn reserve_storage(&self, requested: Usage) -> Result<StorageReservation, SessionError> {
        self.usage.reserve(&self.store, &self.pool, &self.tenant, requested).await
    }

    /// Exclusive use of a session: waits for earlier requests, as long as the pool permits.
    pub(super) async fn lock(&self, id: Uuid) -> Result<Guard, SessionError> {
        let mut guard = match self.entries.enter(&self.tenant, id).try_lock() {
            Ok(guard) => guard,
            Err(entry) => Box::pin(self.pool.wait(entry.lock())).await?,
        };
        guard.version = guard.published_version().filter(|version| self.is_version(id, *version));
        Ok(guard)
    }

    /// Whether what was the stored state of a session at a version still is.
    pub(super) fn is_version(&self, id: Uuid, version: u64) -> bool {
        self.store.is_exclusive() && self.store.changes().version(id) == Some(version)
    }

    /// What `read` takes of the published state of a session, once that is the stored one. It waits for no change.
    /// Where others change the store too, and while a change of this process is under way, the store is asked, which
    /// has the state after each move.
    pub(super) async fn shown<T>(&self, id: Uuid, read: impl Fn(&Published) -> T) -> Result<Option<T>, SessionError> {
        let (entries, tenant) = (&self.entries, &self.tenant);
        let shown = entries.published(tenant, id, |shown| self.is_version(id, shown.version).then(|| read(shown)));
        if let Some(Some(shown)) = shown {
            self.metrics.hits.inc();
            return Ok(Some(shown));
        }
        if shown.is_none() || (self.store.is_exclusive() && !entries.is_changing(tenant, id)) {
            return Ok(None);
        }
        let stored = self.extent(id).await?;
        let is_behind = |shown: &mut Published| shown.is_behind(&stored);
        if entries.published(tenant, id, is_behind) == Some(true) {
            let last =
                self.store.history(id, stored.sequence - 1, 1).await.map_err(|error| self.store_error(id, error))?;
            let Some(last) = last.first() else { return Ok(None) };
            entries.published(tenant, id, |shown| shown.advance(&stored, last));
        }
        let shown = entries.published(tenant, id, |shown| shown.is_stored(&stored).then(|| read(shown))).flatten();
        self.metrics.hits.inc_by(u64::from(shown.is_some()));
        Ok(shown)
    }

    /// The size of a session, with its tenant and label, if it belongs to the tenant.
    pub(super) async fn extent(&self, id: Uuid) -> Result<Extent, SessionError> {
        self.own(id, self.store.extent(id).await, |extent| &extent.tenant)
    }

    /// The session as it is stored, if it belongs to the tenant.
    pub(super) async fn find_own(&self, id: Uuid) -> Result<Session, SessionError> {
        self.own(id, self.store.find(id).await, |session| &session.tenant)
    }

    /// What was found of a session, if it belongs to the tenant.
    pub(super) fn own<T>(
        &self,
        id: Uuid,
        found: Result<T, StoreError>,
        tenant: impl FnOnce(&T) -> &Tenant,
    ) -> Result<T, SessionError> {
        let found = found.map_err(|error| self.store_error(id, error))?;
        if *tenant(&found) == self.tenant { Ok(found) } else { Err(SessionError::NotFound(id)) }
    }

    /// Converts a failure of the store. If the session is gone, its cached state is removed too.
    pub(super) fn store_failure(&self, guard: &mut Guard, error: StoreError) -> SessionError {
        guard.version = None;
        if matches!(error, StoreError::NotFound | StoreError::Expired(_)) {
            guard.live = None;
        }
        self.store_error(guard.id(), error)
    }

    pub(super) fn store_error(&self, id: Uuid, error: StoreError) -> SessionError {
        match error {
            StoreError::Expired(tenant) if tenant == self.tenant => SessionError::Expired(id),
            StoreError::NotFound | StoreError::Expired(_) => SessionError::NotFound(id),
            other => SessionError::Store(other),
        }
    }
}
