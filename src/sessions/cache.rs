//! The cached states, of which the least recently used go first, and the locks of the sessions in use.
//!
//! A request takes the state of its session out of the cache, and puts it back at the end with the size that it has
//! then. A session that no request uses has no lock, and one that is not cached takes no memory: requests for
//! identifiers that do not exist leave nothing behind, and a million idle sessions take space in the store alone.

use std::collections::{HashMap, VecDeque};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use hashlink::LruCache;
use prometheus::IntCounter;
use tokio::sync::{Mutex as SessionLock, OwnedMutexGuard};
use uuid::Uuid;

use crate::admission::Reservation;
use crate::store::Tenant;

use super::group::Member;
use super::loaded::LoadedSession;

/// How many bytes of states are cached by default.
pub const CAPACITY: usize = 256 * 1024 * 1024;

/// A session of a tenant. Under the identifier of another tenant's session a tenant finds neither a state nor a lock.
type Key = (Tenant, Uuid);

/// States and locks.
pub(super) struct Cache {
    // Std mutexes both: held for a lookup, never across an await.
    locks: Mutex<HashMap<Key, LockEntry>>,
    states: Mutex<States>,
    capacity: usize,
    // How often a state that was asked for was cached.
    hits: IntCounter,
}

/// The lock of a session that requests use or wait for. It is dropped with the last of them, so that a session has one lock
/// at a time.
#[derive(Default)]
struct LockEntry {
    // The lock is fair, so that moves apply in the order of their arrival.
    lock: Arc<SessionLock<()>>,
    users: usize,
    /// Who waits for the lock, in that order, with a number each: a move that whoever has the lock may make, or anything else.
    line: VecDeque<(u64, Option<Member>)>,
    /// The number of the next one in the line.
    next: u64,
}

/// States that no request uses, with their bytes; `bytes` are theirs and those of the states that requests have taken out.
struct States {
    by_key: LruCache<Key, (Box<LoadedSession>, usize)>,
    bytes: usize,
}

/// Exclusive use of a session until the guard is dropped, when its state goes back to the cache.
pub(super) struct Guard {
    /// The state, if it is cached: that after a stored move, though perhaps not the last.
    pub(super) live: Option<Box<LoadedSession>>,
    /// The memory of a state that did not come out of the cache, and of a copy of it.
    pub(super) held: Reservation,
    /// Bytes of the state as it came out of the cache, which are counted there.
    taken: usize,
    // Declared, and so released, before the user: a request that comes in between finds the entry and waits for its
    // lock.
    _lock: OwnedMutexGuard<()>,
    user: LockUser,
}

/// A user who waits for the lock.
pub(super) struct Waiting {
    lock: Arc<SessionLock<()>>,
    user: LockUser,
}

/// A place in the line before a lock, which is left when this is dropped.
pub(super) struct PlaceInLine<'a> {
    user: &'a LockUser,
    number: u64,
}

/// One of the users of a lock.
struct LockUser {
    cache: Arc<Cache>,
    key: Key,
}

impl Cache {
    /// A cache of at most this many bytes, and the counter of its hits.
    pub(super) fn new(capacity: usize, hits: IntCounter) -> Cache {
        let states = States { by_key: LruCache::new_unbounded(), bytes: 0 };
        Cache { locks: Mutex::default(), states: Mutex::new(states), capacity, hits }
    }

    /// Waits for exclusive use of a session. A dropped future no longer waits.
    pub(super) async fn lock(self: &Arc<Self>, tenant: &Tenant, id: Uuid) -> Guard {
        match self.try_lock(tenant, id) {
            Ok(guard) => guard,
            Err(waiting) => waiting.lock().await,
        }
    }

    /// Exclusive use of a session if nobody else has it.
    pub(super) fn try_lock(self: &Arc<Self>, tenant: &Tenant, id: Uuid) -> Result<Guard, Waiting> {
        let (lock, user) = self.enter((tenant.clone(), id));
        match Arc::clone(&lock).try_lock_owned() {
            Ok(free) => Ok(user.guard(free)),
            Err(_) => Err(Waiting { lock, user }),
        }
    }

    /// Whether the state of a session is cached.
    pub(super) fn holds(&self, tenant: &Tenant, id: Uuid) -> bool {
        self.states().by_key.contains_key(&(tenant.clone(), id))
    }

    /// How many bytes there may be.
    pub(super) fn capacity(&self) -> usize {
        self.capacity
    }

    /// Bytes of the cached states, with those in use, and how many nobody uses.
    pub(super) fn held(&self) -> (usize, usize) {
        let states = self.states();
        (states.bytes, states.by_key.len())
    }

    fn enter(self: &Arc<Self>, key: Key) -> (Arc<SessionLock<()>>, LockUser) {
        let mut locks = self.locks();
        let entry = locks.entry(key.clone()).or_default();
        entry.users += 1;
        (Arc::clone(&entry.lock), LockUser { cache: Arc::clone(self), key })
    }

    /// Takes a state out. It still counts, until it is given back.
    fn take(&self, key: &Key) -> Option<(Box<LoadedSession>, usize)> {
        let found = self.states().by_key.remove(key)?;
        self.hits.inc();
        Some(found)
    }

    /// Puts a state in, in place of `taken` bytes that had been taken out.
    fn put(&self, live: Option<Box<LoadedSession>>, taken: usize) {
        let bytes = live.as_ref().map_or(0, |live| live.bytes());
        let mut states = self.states();
        states.bytes -= taken;
        // One that is too large would evict all others and itself.
        let Some(live) = live.filter(|_| bytes <= self.capacity) else { return };
        let mut gone = Vec::new();
        states.bytes += bytes;
        let key = (live.session.tenant.clone(), live.session.id);
        if let Some((_, bytes)) = states.by_key.insert(key, (live, bytes)) {
            states.bytes -= bytes;
        }
        while states.bytes > self.capacity
            && let Some((_, (live, bytes))) = states.by_key.remove_lru()
        {
            states.bytes -= bytes;
            gone.push(live);
        }
        // Freed once others can get at the cache again.
        drop(states);
        drop(gone);
    }

    fn locks(&self) -> MutexGuard<'_, HashMap<Key, LockEntry>> {
        self.locks.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn states(&self) -> MutexGuard<'_, States> {
        self.states.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Guard {
    /// The session.
    pub(super) fn id(&self) -> Uuid {
        self.user.key.1
    }

    /// Takes the moves at the head of the line, at most so many, up to whatever else waits there.
    pub(super) fn take_moves(&self, most: usize) -> Vec<Member> {
        let mut locks = self.user.cache.locks();
        let Some(entry) = locks.get_mut(&self.user.key) else { return Vec::new() };
        let moves = entry.line.iter().take(most).take_while(|(_, member)| member.is_some()).count();
        entry.line.drain(..moves).filter_map(|(_, member)| member).collect()
    }
}

impl Waiting {
    /// The session.
    pub(super) fn id(&self) -> Uuid {
        self.user.key.1
    }

    /// The lock that is waited for.
    pub(super) fn awaited(&self) -> Arc<SessionLock<()>> {
        Arc::clone(&self.lock)
    }

    /// A place at the end of the line.
    pub(super) fn stand(&self, member: Option<Member>) -> PlaceInLine<'_> {
        let mut locks = self.user.cache.locks();
        let number = locks.get_mut(&self.user.key).map_or(0, |entry| {
            let number = entry.next;
            entry.next += 1;
            entry.line.push_back((number, member));
            number
        });
        PlaceInLine { user: &self.user, number }
    }

    /// Waits for exclusive use.
    pub(super) async fn lock(self) -> Guard {
        let place = self.stand(None);
        let lock = Arc::clone(&self.lock).lock_owned().await;
        drop(place);
        self.guard(lock)
    }

    /// Exclusive use, by the lock that has been acquired.
    pub(super) fn guard(self, lock: OwnedMutexGuard<()>) -> Guard {
        self.user.guard(lock)
    }
}

impl LockUser {
    fn guard(self, lock: OwnedMutexGuard<()>) -> Guard {
        let (live, taken) = self.cache.take(&self.key).unzip();
        Guard { live, held: Reservation::default(), taken: taken.unwrap_or(0), _lock: lock, user: self }
    }
}

impl PlaceInLine<'_> {
    /// Leaves the line, with the move if nobody has taken it.
    pub(super) fn leave(self) -> Option<Member> {
        self.remove()
    }

    fn remove(&self) -> Option<Member> {
        let mut locks = self.user.cache.locks();
        let line = &mut locks.get_mut(&self.user.key)?.line;
        let place = line.iter().position(|(number, _)| *number == self.number)?;
        line.remove(place)?.1
    }
}

impl Drop for PlaceInLine<'_> {
    fn drop(&mut self) {
        // A member that is dropped gives its room back, for which the lock of the cache is not needed.
        drop(self.remove());
    }
}

impl Drop for Guard {
    fn drop(&mut self) {
        if self.live.is_some() || self.taken > 0 {
            self.user.cache.put(self.live.take(), self.taken);
        }
    }
}

impl Drop for LockUser {
    fn drop(&mut self) {
        let mut locks = self.cache.locks();
        if let Some(entry) = locks.get_mut(&self.key) {
            entry.users -= 1;
            if entry.users == 0 {
                locks.remove(&self.key);
            }
        }
    }
}
