//! The states at hand, least recently used out, and the lock of each session that somebody works on.
//!
//! Whoever works on a session takes its state out of the cache, and puts it back at the end with the size that it has then.
//! A session that nobody works on has no lock, and one that is not at hand takes no memory: asking for identifiers that do
//! not exist leaves nothing behind, and a million idle sessions are the store's alone.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use hashlink::LruCache;
use prometheus::{IntCounter, Opts};
use tokio::sync::{Mutex as SessionLock, OwnedMutexGuard};
use uuid::Uuid;

use crate::admission::Reservation;
use crate::metrics::counter;
use crate::store::Tenant;

use super::live::Live;

/// How many bytes of states are kept at hand by default.
pub const CAPACITY: usize = 256 * 1024 * 1024;

/// A session as one tenant names it. Under the name of a session of somebody else there is nothing at hand and nobody to
/// wait for.
type Name = (Tenant, Uuid);

/// States and locks.
pub(super) struct Cache {
    // Std mutexes both: held for a lookup, never across an await.
    desks: Mutex<HashMap<Name, Desk>>,
    states: Mutex<States>,
    capacity: usize,
    // How often a state that was asked for was at hand.
    hits: IntCounter,
}

/// A session that somebody works on or waits for. It goes with the last of them, so that a session has one lock at a time.
#[derive(Default)]
struct Desk {
    // The lock is fair, so that moves apply in the order of their arrival.
    lock: Arc<SessionLock<()>>,
    users: usize,
}

/// States that nobody works on, with their bytes.
struct States {
    by_name: LruCache<Name, (Box<Live>, usize)>,
    bytes: usize,
}

/// A session that is one's own until the guard is dropped, when its state goes back to the cache.
pub(super) struct Guard {
    /// The state, if it is at hand: that after some move that is stored, though perhaps not the last.
    pub(super) live: Option<Box<Live>>,
    /// The memory of a state that did not come out of the cache.
    pub(super) held: Reservation,
    // Declared, and so released, before the desk is left: whoever comes in between finds the desk and waits at it.
    _lock: OwnedMutexGuard<()>,
    place: Place,
}

/// One of the users of a desk.
struct Place {
    cache: Arc<Cache>,
    name: Name,
}

impl Cache {
    /// A cache of at most so many bytes.
    pub(super) fn new(capacity: usize) -> Cache {
        let hits = Opts::new("stickslip_cache_hits_total", "Times that a contact that was asked for was in memory.");
        let hits = counter(hits);
        let states = States { by_name: LruCache::new_unbounded(), bytes: 0 };
        Cache { desks: Mutex::default(), states: Mutex::new(states), capacity, hits }
    }

    /// Waits until the session is one's own. Whoever gives up waiting has left.
    pub(super) async fn lock(self: &Arc<Self>, tenant: &Tenant, id: Uuid) -> Guard {
        let (lock, place) = self.enter((tenant.clone(), id));
        let lock = lock.lock_owned().await;
        Guard { live: self.take(&place.name), held: Reservation::default(), _lock: lock, place }
    }

    /// Whether the state of a session is at hand.
    pub(super) fn holds(&self, tenant: &Tenant, id: Uuid) -> bool {
        self.states().by_name.contains_key(&(tenant.clone(), id))
    }

    /// How many bytes there may be.
    pub(super) fn capacity(&self) -> usize {
        self.capacity
    }

    /// How often a state was at hand.
    pub(super) fn hits(&self) -> &IntCounter {
        &self.hits
    }

    /// Bytes of the states at hand, and how many they are.
    pub(super) fn held(&self) -> (usize, usize) {
        let states = self.states();
        (states.bytes, states.by_name.len())
    }

    fn enter(self: &Arc<Self>, name: Name) -> (Arc<SessionLock<()>>, Place) {
        let mut desks = self.desks();
        let desk = desks.entry(name.clone()).or_default();
        desk.users += 1;
        (Arc::clone(&desk.lock), Place { cache: Arc::clone(self), name })
    }

    fn take(&self, name: &Name) -> Option<Box<Live>> {
        let mut states = self.states();
        let (live, bytes) = states.by_name.remove(name)?;
        states.bytes -= bytes;
        self.hits.inc();
        Some(live)
    }

    fn put(&self, live: Box<Live>) {
        let bytes = live.bytes();
        if bytes > self.capacity {
            // It would drive out all others and go with them.
            return;
        }
        let mut gone = Vec::new();
        let mut states = self.states();
        states.bytes += bytes;
        let name = (live.session.tenant.clone(), live.session.id);
        if let Some((_, bytes)) = states.by_name.insert(name, (live, bytes)) {
            states.bytes -= bytes;
        }
        while states.bytes > self.capacity
            && let Some((_, (live, bytes))) = states.by_name.remove_lru()
        {
            states.bytes -= bytes;
            gone.push(live);
        }
        // Freed once others can get at the cache again.
        drop(states);
        drop(gone);
    }

    fn desks(&self) -> MutexGuard<'_, HashMap<Name, Desk>> {
        self.desks.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn states(&self) -> MutexGuard<'_, States> {
        self.states.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Guard {
    /// The session.
    pub(super) fn id(&self) -> Uuid {
        self.place.name.1
    }
}

impl Drop for Guard {
    fn drop(&mut self) {
        if let Some(live) = self.live.take() {
            self.place.cache.put(live);
        }
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        let mut desks = self.cache.desks();
        if let Some(desk) = desks.get_mut(&self.name) {
            desk.users -= 1;
            if desk.users == 0 {
                desks.remove(&self.name);
            }
        }
    }
}
