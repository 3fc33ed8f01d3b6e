//! The cached states and prepared profiles, of which the least recently used go first, and the locks of the sessions in
//! use.
//!
//! A request takes the state of its session out of the cache, and puts it back at the end with the size that it has
//! then. A session that no request uses has no lock, and one that is not cached takes no memory: requests for
//! identifiers that do not exist leave nothing behind, and a million idle sessions take space in the store alone.
//!
//! A profile that is kept counts once, however many states and requests have it. It is used whenever one of these
//! states is, so that it goes after them. A profile in use stays, because dropping it would free nothing.

use std::collections::HashMap;

use hashlink::LruCache;
use parking_lot::Mutex;
use prometheus::IntCounter;

use crate::store::{KeyLock, KeyedLocks};
use stickslip_compute::simulation::ProfileKey;
use stickslip_mechanics::Profile;

use super::prelude::*;

/// How many bytes of states are cached by default.
pub const CAPACITY: usize = 256 * 1024 * 1024;

/// A session of a tenant. Under the identifier of another tenant's session a tenant finds neither a state nor a lock.
type Key = (Tenant, Uuid);

/// States, profiles and locks.
pub(super) struct Cache {
    locks: Arc<KeyedLocks<Key>>,
    // Locked for a lookup, never across an await.
    cached: Mutex<Cached>,
    capacity: usize,
    // How often a state that was asked for was cached.
    hits: IntCounter,
}

/// States that no request uses, and profiles; `bytes` are theirs and those of the states that requests have taken out.
struct Cached {
    /// With their bytes; what was used least recently comes first.
    items: LruCache<ItemKey, (Item, usize)>,
    addresses: HashMap<ProfileKey, usize>,
    bytes: usize,
}

#[derive(PartialEq, Eq, Hash)]
enum ItemKey {
    State(Key),
    /// By its address, which the states know.
    Profile(usize),
}

enum Item {
    State(Box<LoadedSession>),
    Profile(Arc<Profile>, ProfileKey),
}

/// Exclusive use of a session until the guard is dropped, when its state goes back to the cache.
pub(super) struct Guard {
    /// The state, if it is cached: that after a stored move, though perhaps not the last.
    pub(super) live: Option<Box<LoadedSession>>,
    /// How long loading the state has taken for the request that has the guard.
    pub(super) loading: Duration,
    /// The memory of a state that did not come out of the cache, and of a copy of it.
    pub(super) held: Reservation,
    /// Bytes of the state as it came out of the cache, which are counted there.
    taken: usize,
    cache: Arc<Cache>,
    // Dropped after the state has been put back.
    lock: KeyLock<Key>,
}

impl Cache {
    /// A cache of at most this many bytes, and the counter of its hits.
    pub(super) fn new(capacity: usize, hits: IntCounter) -> Cache {
        let cached = Cached { items: LruCache::new_unbounded(), addresses: HashMap::new(), bytes: 0 };
        Cache { locks: Arc::default(), cached: Mutex::new(cached), capacity, hits }
    }

    /// Waits for exclusive use of a session. A dropped future no longer waits.
    pub(super) async fn lock(self: &Arc<Self>, tenant: &Tenant, id: Uuid) -> Guard {
        self.guard(self.locks.lock((tenant.clone(), id)).await)
    }

    /// Exclusive use of a session if nobody else has it.
    pub(super) fn try_lock(self: &Arc<Self>, tenant: &Tenant, id: Uuid) -> Option<Guard> {
        Some(self.guard(self.locks.try_lock((tenant.clone(), id))?))
    }

    /// The session with its state, if that is cached.
    fn guard(self: &Arc<Self>, lock: KeyLock<Key>) -> Guard {
        let (live, taken) = self.take(&lock.key).unzip();
        let (cache, taken) = (Arc::clone(self), taken.unwrap_or(0));
        Guard { live, loading: Duration::ZERO, held: Reservation::default(), taken, cache, lock }
    }

    /// Whether the state of a session is cached.
    pub(super) fn holds(&self, tenant: &Tenant, id: Uuid) -> bool {
        self.cached.lock().items.contains_key(&ItemKey::State((tenant.clone(), id)))
    }

    pub(super) fn capacity(&self) -> usize {
        self.capacity
    }

    /// Bytes of the states, cached or in use, and of the profiles; and the number of cached states.
    pub(super) fn held(&self) -> (usize, usize) {
        let cached = self.cached.lock();
        (cached.bytes, cached.items.len() - cached.addresses.len())
    }

    /// Takes a state out. It still counts, until it is given back.
    fn take(&self, key: &Key) -> Option<(Box<LoadedSession>, usize)> {
        let mut cached = self.cached.lock();
        let (Item::State(state), bytes) = cached.items.remove(&ItemKey::State(key.clone()))? else { return None };
        cached.use_profile(address_of(state.contact.profile()));
        drop(cached);
        self.hits.inc();
        Some((state, bytes))
    }

    pub(super) fn profile(&self, key: &ProfileKey) -> Option<Arc<Profile>> {
        let mut cached = self.cached.lock();
        let address = *cached.addresses.get(key)?;
        cached.use_profile(address)
    }

    /// Keeps a profile of so many bytes if it fits, unless there is one with this key already; returns the one that is
    /// to be used.
    pub(super) fn keep_profile(&self, key: ProfileKey, profile: Arc<Profile>, bytes: usize) -> Arc<Profile> {
        let mut cached = self.cached.lock();
        if let Some(ready) = cached.addresses.get(&key).copied().and_then(|address| cached.use_profile(address)) {
            return ready;
        }
        if bytes > self.capacity {
            return profile;
        }
        let gone = cached.make_room(self.capacity - bytes);
        // Where those that others have leave no room, only its user has it.
        if cached.bytes <= self.capacity - bytes {
            let address = address_of(&profile);
            cached.bytes += bytes;
            cached.addresses.insert(key, address);
            cached.items.insert(ItemKey::Profile(address), (Item::Profile(Arc::clone(&profile), key), bytes));
        }
        drop(cached);
        drop(gone);
        profile
    }

    /// Puts a state in, in place of `taken` bytes that had been taken out.
    fn put(&self, live: Option<Box<LoadedSession>>, taken: usize) {
        let (own, shape) = live.as_ref().map_or((0, 0), |live| (live.bytes(), live.shape_bytes()));
        let mut cached = self.cached.lock();
        cached.bytes -= taken;
        let Some(live) = live else { return };
        let profile = address_of(live.contact.profile());
        let bytes = if cached.use_profile(profile).is_some() { own } else { own + shape };
        // One that is too large would evict all others and itself.
        if bytes > self.capacity {
            return;
        }
        cached.bytes += bytes;
        let key = ItemKey::State((live.session.tenant.clone(), live.session.id));
        if let Some((_, before)) = cached.items.insert(key, (Item::State(live), bytes)) {
            cached.bytes -= before;
        }
        // After the state, so that it is the younger of the two.
        cached.use_profile(profile);
        let gone = cached.make_room(self.capacity);
        // Freed once others can get at the cache again.
        drop(cached);
        drop(gone);
    }
}

impl Cached {
    /// Marks the profile at an address as used, and returns it if it is kept.
    fn use_profile(&mut self, address: usize) -> Option<Arc<Profile>> {
        if self.addresses.is_empty() {
            return None;
        }
        match self.items.get(&ItemKey::Profile(address))? {
            (Item::Profile(profile, _), _) => Some(Arc::clone(profile)),
            _ => None,
        }
    }

    /// Takes out what was used least recently until the rest takes no more than this, but for profiles that somebody
    /// has.
    fn make_room(&mut self, most: usize) -> (Vec<Item>, Vec<Item>) {
        let (mut states, mut profiles) = (Vec::new(), Vec::new());
        // A profile that is in use is met once.
        for _ in 0..self.items.len() {
            if self.bytes <= most {
                break;
            }
            let Some((key, (item, bytes))) = self.items.remove_lru() else { break };
            if let Item::Profile(profile, digest) = &item {
                // Then the states that have just been taken out have theirs no longer.
                states.clear();
                if Arc::strong_count(profile) > 1 {
                    self.items.insert(key, (item, bytes));
                    continue;
                }
                self.addresses.remove(digest);
            }
            self.bytes -= bytes;
            if matches!(item, Item::Profile(..)) { profiles.push(item) } else { states.push(item) }
        }
        (states, profiles)
    }
}

fn address_of(profile: &Profile) -> usize {
    std::ptr::from_ref(profile).addr()
}

impl Guard {
    pub(super) fn id(&self) -> Uuid {
        self.lock.key.1
    }

    /// Ends the use of the session and leaves it in this state.
    pub(super) fn finish(mut self, live: Box<LoadedSession>) {
        self.live = Some(live);
    }
}

impl Drop for Guard {
    fn drop(&mut self) {
        if self.live.is_some() || self.taken > 0 {
            self.cache.put(self.live.take(), self.taken);
        }
    }
}
