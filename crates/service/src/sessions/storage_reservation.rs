//! The space of each tenant in the store, against its quotas.
//!
//! The space of a tenant is counted by the store at the first change after the start, and again from time to time,
//! because others on the same store change it too. In between, this process adds what it stores itself.

use std::collections::HashMap;
use std::time::Instant;

use parking_lot::Mutex;

use crate::admission::{Pool, PoolError, Quota};
use crate::store::Usage;

use super::prelude::*;

/// How long a count is taken to hold.
const RECOUNT: Duration = Duration::from_secs(60);
/// How old a count must at least be for another one, where a quota is full.
const RECOUNT_FULL: Duration = Duration::from_secs(1);
/// A count that takes long is repeated less often: it may take one part in so many of the time.
const COUNTING_SHARE: u32 = 20;

/// The space of the tenants. Each has an entry from its first change on.
#[derive(Default)]
pub(super) struct UsageByTenant(Mutex<HashMap<Tenant, Arc<ClientUsage>>>);

/// The space of a tenant.
#[derive(Default)]
struct ClientUsage {
    // Held while the store counts, so that it counts once for all who wait.
    counting: Arc<tokio::sync::Mutex<()>>,
    // Held for a moment, never across an await.
    known: Mutex<Known>,
}

#[derive(Default)]
struct Known {
    /// As it was counted, when, and how long that took.
    counted: Option<(Usage, Instant, Duration)>,
    /// Space added since the last count began, even if that count is still running.
    stored: Usage,
    /// When the store last failed to count, if it has not counted since.
    failed: Option<Instant>,
    /// The most that pending changes will add.
    pending: Usage,
}

/// The space that a change may add to the store, given back when dropped.
pub(super) struct StorageReservation {
    client: Arc<ClientUsage>,
    reserved: Usage,
}

impl UsageByTenant {
    /// Reserves space for a change of a tenant.
    ///
    /// # Errors
    /// [`PoolError::Quota`] if it would have more than it may, by a count that is a second old or little more; or a
    /// failure of the store.
    pub(super) async fn reserve(
        &self,
        store: &Arc<dyn Store>,
        pool: &Pool,
        tenant: &Tenant,
        requested: Usage,
    ) -> Result<StorageReservation, SessionError> {
        let client = Arc::clone(self.0.lock().entry(tenant.clone()).or_default());
        match client.try_reserve(pool, requested) {
            Some(Ok(reservation)) => {
                if client.is_older_than(RECOUNT)
                    && let Ok(counting) = Arc::clone(&client.counting).try_lock_owned()
                {
                    let (store, tenant) = (Arc::clone(store), tenant.clone());
                    tokio::spawn(async move {
                        let _counting = counting;
                        if let Err(error) = client.count(&*store, &tenant).await {
                            tracing::debug!(%error, "what a tenant has stored could not be counted");
                        }
                    });
                }
                return Ok(reservation);
            }
            Some(Err(quota)) if !client.is_older_than(RECOUNT_FULL) => {
                return Err(PoolError::Quota(pool.quotas().exceeded(quota)).into());
            }
            _ => {}
        }
        // In a box, so that a change that is within its quota is not as large as one that waits for a count.
        Box::pin(client.reserve_after_count(store, pool, tenant, requested)).await
    }

    /// A tenant has deleted so much.
    pub(super) fn give_back(&self, tenant: &Tenant, deleted: Usage) {
        let client = self.0.lock().get(tenant).cloned();
        let Some(client) = client else { return };
        // A count under way may know of it already, and the next one does.
        let Ok(_counting) = client.counting.try_lock() else { return };
        let known = &mut *client.known.lock();
        if let Some((usage, ..)) = &mut known.counted {
            // Some of it may have been stored since the count.
            *usage = sum(*usage, std::mem::take(&mut known.stored));
            usage.contacts = usage.contacts.saturating_sub(deleted.contacts);
            usage.bytes = usage.bytes.saturating_sub(deleted.bytes);
        }
    }
}

impl ClientUsage {
    /// Whether the last count is older than this, or there is none. It counts as younger if counting takes long.
    fn is_older_than(&self, age: Duration) -> bool {
        self.known.lock().counted.is_none_or(|(_, at, took)| at.elapsed() >= age.max(took * COUNTING_SHARE))
    }

    /// Reserves by the last count, or names the quota that is exceeded; nothing if there has been no count.
    fn try_reserve(
        self: &Arc<ClientUsage>,
        pool: &Pool,
        requested: Usage,
    ) -> Option<Result<StorageReservation, Quota>> {
        let limits = &pool.quotas().limits;
        let mut known = self.known.lock();
        let all = [known.stored, known.pending, requested].into_iter().fold(known.counted?.0, sum);
        let fits = |most: usize, all: u64, requested: u64| requested == 0 || all <= most as u64;
        if !fits(limits.contacts, all.contacts, requested.contacts) {
            return Some(Err(Quota::Contacts));
        }
        if !fits(limits.store_bytes, all.bytes, requested.bytes) {
            return Some(Err(Quota::StoreBytes));
        }
        known.pending = sum(known.pending, requested);
        Some(Ok(StorageReservation { client: Arc::clone(self), reserved: requested }))
    }

    /// Reserves by a count that is a second old or little more.
    async fn reserve_after_count(
        self: &Arc<ClientUsage>,
        store: &Arc<dyn Store>,
        pool: &Pool,
        tenant: &Tenant,
        requested: Usage,
    ) -> Result<StorageReservation, SessionError> {
        let begin = Instant::now();
        let _counting = pool.wait(self.counting.lock()).await?;
        // Whoever had the lock before may have counted, or may have waited for a store that does not answer.
        if self.known.lock().failed.is_some_and(|at| at >= begin) {
            return Err(StoreError::Unavailable("what the tenant has stored cannot be counted".to_owned()).into());
        }
        if self.is_older_than(RECOUNT_FULL) {
            self.count(&**store, tenant).await?;
        }
        match self.try_reserve(pool, requested) {
            Some(Ok(reservation)) => Ok(reservation),
            Some(Err(quota)) => Err(PoolError::Quota(pool.quotas().exceeded(quota)).into()),
            None => Err(SessionError::Broken("what a tenant has stored is not known".to_owned())),
        }
    }

    async fn count(&self, store: &dyn Store, tenant: &Tenant) -> Result<(), SessionError> {
        let begin = Instant::now();
        {
            let mut known = self.known.lock();
            let stored = std::mem::take(&mut known.stored);
            if let Some((usage, ..)) = &mut known.counted {
                *usage = sum(*usage, stored);
            }
        }
        let counted = store.usage(tenant).await;
        let mut known = self.known.lock();
        known.failed = counted.is_err().then(Instant::now);
        // The store may have counted some of what is stored meanwhile: rather too much than too little.
        known.counted = Some((counted?, begin, begin.elapsed()));
        Ok(())
    }
}

impl StorageReservation {
    pub(super) fn bytes(&self) -> u64 {
        self.reserved.bytes
    }

    /// A change has been stored, and has added so much.
    pub(super) fn used(&self, added: Usage) {
        let mut known = self.client.known.lock();
        known.stored = sum(known.stored, added);
    }
}

impl Drop for StorageReservation {
    fn drop(&mut self) {
        let mut known = self.client.known.lock();
        known.pending.contacts -= self.reserved.contacts;
        known.pending.bytes -= self.reserved.bytes;
    }
}

fn sum(one: Usage, other: Usage) -> Usage {
    Usage { contacts: one.contacts.saturating_add(other.contacts), bytes: one.bytes.saturating_add(other.bytes) }
}
