//! What the sessions of all tenants share: the store, the pool, and the cache with its locks. A handle uses it within
//! its tenant.

use tokio::sync::Semaphore;

use crate::admission::{Pool, STREAMS};
use crate::store::{Extent, IdempotentRequest, Listeners, RequestKey, Session, Usage};
use stickslip_compute::simulation::{ProfileCache, ProfileKey, Profiles};
use stickslip_mechanics::Profile;

use super::cache::Cache;
use super::metrics::SessionMetrics;
use super::prelude::*;
use super::snapshot;
use super::storage_reservation::{StorageReservation, UsageByTenant};

/// How often a change is tried if other processes move the contact first. Each time, one of them has made progress.
pub(super) const ATTEMPTS: usize = 100;

/// What all tenants share.
pub struct Common {
    pub(super) store: Arc<dyn Store>,
    pub(super) pool: Pool,
    pub(super) cache: Arc<Cache>,
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
            cache: Arc::new(Cache::new(capacity, metrics.hits.clone())),
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
        self.cache.profile(key).is_some()
    }

    fn get(&self, key: &ProfileKey) -> Option<Arc<Profile>> {
        self.cache.profile(key).inspect(|_| self.metrics.profiles_shared.inc())
    }

    fn keep(&self, key: ProfileKey, profile: Arc<Profile>, bytes: usize) -> Arc<Profile> {
        self.metrics.profiles_prepared.inc();
        self.cache.keep_profile(key, profile, bytes)
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
        match self.cache.try_lock(&self.tenant, id) {
            Some(guard) => Ok(guard),
            None => Ok(Box::pin(self.pool.wait(self.cache.lock(&self.tenant, id))).await?),
        }
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
