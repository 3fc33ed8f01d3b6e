//! The cached states and prepared profiles, of which the least recently used go first, and the locks of the sessions in
//! use.
//!
//! A request takes the state of its session out of the cache, and puts it back at the end with the size that it has
//! then. A session that no request uses has no lock, and one that is not cached takes no memory: requests for
//! identifiers that do not exist leave nothing behind, and a million idle sessions take space in the store alone.
//!
//! A profile that is kept counts once, however many states and requests have it. It is used whenever one of these
//! states is, so that it goes after them; and one that somebody has stays, because to forget it would free nothing.

use std::collections::{HashMap, VecDeque};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use hashlink::LruCache;
use prometheus::IntCounter;
use tokio::sync::{Mutex as SessionLock, OwnedMutexGuard};
use uuid::Uuid;

use crate::admission::Reservation;
use crate::store::Tenant;
use stickslip_mechanics::Profile;

use super::loaded::LoadedSession;
use super::waiting_move::WaitingMove;

/// How many bytes of states are cached by default.
pub const CAPACITY: usize = 256 * 1024 * 1024;

/// A session of a tenant. Under the identifier of another tenant's session a tenant finds neither a state nor a lock.
type Key = (Tenant, Uuid);

/// What tells prepared profiles apart: a digest.
pub(super) type ProfileKey = [u8; 32];

/// A prepared profile, and the bytes that it takes.
pub(super) struct KeptProfile {
    pub(super) profile: Arc<Profile>,
    pub(super) bytes: usize,
}

/// States, profiles and locks.
pub(super) struct Cache {
    // Std mutexes both: held for a lookup, never across an await.
    locks: Mutex<HashMap<Key, LockEntry>>,
    states: Mutex<States>,
    capacity: usize,
    // How often a state that was asked for was cached.
    hits: IntCounter,
}

/// The lock of a session that requests use or wait for. It is dropped with the last of them, so that a session has one
/// lock at a time.
#[derive(Default)]
struct LockEntry {
    // The lock is fair, so that moves apply in the order of their arrival.
    lock: Arc<SessionLock<()>>,
    users: usize,
    /// Who waits for the lock, in that order, with a number each: a move that whoever has the lock may make, or
    /// anything else.
    line: VecDeque<(u64, Option<WaitingMove>)>,
    /// The number of the next one in the line.
    next: u64,
}

/// States that no request uses, and profiles; `bytes` are theirs and those of the states that requests have taken out.
struct States {
    by_key: LruCache<Key, Cached<Box<LoadedSession>>>,
    /// By their addresses, which the states know.
    profiles: LruCache<usize, Cached<(Arc<Profile>, ProfileKey)>>,
    addresses: HashMap<ProfileKey, usize>,
    bytes: usize,
    /// Counts the uses.
    clock: u64,
}

/// A state or a profile, its bytes, and when it was used last.
struct Cached<T> {
    item: T,
    bytes: usize,
    used: u64,
}

/// What no longer fits.
#[derive(Default)]
struct Evicted {
    #[expect(clippy::vec_box, reason = "a pointer is moved while others wait for the cache, not the state")]
    states: Vec<Box<LoadedSession>>,
    profiles: Vec<Arc<Profile>>,
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
pub(super) struct QueuePosition<'a> {
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
        let (by_key, profiles) = (LruCache::new_unbounded(), LruCache::new_unbounded());
        let states = States { by_key, profiles, addresses: HashMap::new(), bytes: 0, clock: 0 };
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

    /// Bytes of the cached states, with those in use, and of the profiles, and how many states nobody uses.
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
        let mut states = self.states();
        let Cached { item, bytes, .. } = states.by_key.remove(key)?;
        states.use_profile(item.contact.profile());
        drop(states);
        self.hits.inc();
        Some((item, bytes))
    }

    /// A profile, if it is kept.
    pub(super) fn profile(&self, key: &ProfileKey) -> Option<Arc<Profile>> {
        let mut states = self.states();
        let address = *states.addresses.get(key)?;
        states.use_profile_at(address)
    }

    /// Keeps a profile if it fits, unless there is one with this key already; returns the one that is to be used.
    pub(super) fn keep_profile(&self, key: ProfileKey, kept: KeptProfile) -> Arc<Profile> {
        let KeptProfile { profile, bytes } = kept;
        let mut states = self.states();
        if let Some(ready) = states.addresses.get(&key).copied().and_then(|address| states.use_profile_at(address)) {
            return ready;
        }
        if bytes > self.capacity {
            return profile;
        }
        let gone = states.make_room(self.capacity - bytes);
        // Where those that others have leave no room, only its user has it.
        if states.bytes <= self.capacity - bytes {
            let (address, used) = (address_of(&profile), states.tick());
            states.bytes += bytes;
            states.addresses.insert(key, address);
            states.profiles.insert(address, Cached { item: (Arc::clone(&profile), key), bytes, used });
        }
        drop(states);
        drop(gone);
        profile
    }

    /// Puts a state in, in place of `taken` bytes that had been taken out.
    fn put(&self, live: Option<Box<LoadedSession>>, taken: usize) {
        let (own, shape) = live.as_ref().map_or((0, 0), |live| (live.bytes(), live.shape_bytes()));
        let mut states = self.states();
        states.bytes -= taken;
        let Some(live) = live else { return };
        // Before its profile, which is to be the younger of the two.
        let used = states.tick();
        let bytes = if states.use_profile(live.contact.profile()) { own } else { own + shape };
        // One that is too large would evict all others and itself.
        if bytes > self.capacity {
            return;
        }
        states.bytes += bytes;
        let key = (live.session.tenant.clone(), live.session.id);
        if let Some(before) = states.by_key.insert(key, Cached { item: live, bytes, used }) {
            states.bytes -= before.bytes;
        }
        let gone = states.make_room(self.capacity);
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

impl States {
    fn tick(&mut self) -> u64 {
        self.clock += 1;
        self.clock
    }

    /// Marks a profile as used; returns whether it is kept.
    fn use_profile(&mut self, profile: &Profile) -> bool {
        !self.profiles.is_empty() && self.use_profile_at(address_of(profile)).is_some()
    }

    fn use_profile_at(&mut self, address: usize) -> Option<Arc<Profile>> {
        let now = self.tick();
        let kept = self.profiles.get_mut(&address)?;
        kept.used = now;
        Some(Arc::clone(&kept.item.0))
    }

    /// Takes out what was used least recently until the rest takes no more than this, but for profiles that somebody
    /// has.
    fn make_room(&mut self, most: usize) -> Evicted {
        let mut gone = Evicted::default();
        // Each profile that is in use is met once.
        let mut profiles = self.profiles.len();
        while self.bytes > most {
            let state = self.by_key.iter().next().map(|(_, oldest)| oldest.used);
            let profile = self.profiles.iter().next().map(|(_, oldest)| oldest.used).filter(|_| profiles > 0);
            if profile.is_some_and(|used| state.is_none_or(|of_state| used < of_state)) {
                profiles -= 1;
                // Then the states that have just been taken out have theirs no longer.
                gone.states.clear();
                self.take_out_profile(&mut gone);
            } else if let Some((_, state)) = self.by_key.remove_lru() {
                self.bytes -= state.bytes;
                gone.states.push(state.item);
            } else {
                break;
            }
        }
        gone
    }

    /// Takes out the profile that was used least recently, unless somebody has it.
    fn take_out_profile(&mut self, gone: &mut Evicted) {
        let Some((address, mut kept)) = self.profiles.remove_lru() else { return };
        if Arc::strong_count(&kept.item.0) > 1 {
            kept.used = self.tick();
            self.profiles.insert(address, kept);
            return;
        }
        self.bytes -= kept.bytes;
        self.addresses.remove(&kept.item.1);
        gone.profiles.push(kept.item.0);
    }
}

fn address_of(profile: &Profile) -> usize {
    std::ptr::from_ref(profile).addr()
}

impl Guard {
    /// The session.
    pub(super) fn id(&self) -> Uuid {
        self.user.key.1
    }

    /// Takes the moves at the head of the line, at most so many, up to whatever else waits there.
    pub(super) fn take_moves(&self, most: usize) -> Vec<WaitingMove> {
        let mut locks = self.user.cache.locks();
        let Some(entry) = locks.get_mut(&self.user.key) else { return Vec::new() };
        let moves = entry.line.iter().take(most).take_while(|(_, waiting_move)| waiting_move.is_some()).count();
        entry.line.drain(..moves).filter_map(|(_, waiting_move)| waiting_move).collect()
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
    pub(super) fn enqueue(&self, waiting_move: Option<WaitingMove>) -> QueuePosition<'_> {
        let mut locks = self.user.cache.locks();
        let number = locks.get_mut(&self.user.key).map_or(0, |entry| {
            let number = entry.next;
            entry.next += 1;
            entry.line.push_back((number, waiting_move));
            number
        });
        QueuePosition { user: &self.user, number }
    }

    /// Waits for exclusive use.
    pub(super) async fn lock(self) -> Guard {
        let place = self.enqueue(None);
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
        Guard {
            live,
            loading: Duration::ZERO,
            held: Reservation::default(),
            taken: taken.unwrap_or(0),
            _lock: lock,
            user: self,
        }
    }
}

impl QueuePosition<'_> {
    /// Leaves the line, with the move if nobody has taken it.
    pub(super) fn leave(self) -> Option<WaitingMove> {
        self.remove()
    }

    fn remove(&self) -> Option<WaitingMove> {
        let mut locks = self.user.cache.locks();
        let line = &mut locks.get_mut(&self.user.key)?.line;
        let place = line.iter().position(|(number, _)| *number == self.number)?;
        line.remove(place)?.1
    }
}

impl Drop for QueuePosition<'_> {
    fn drop(&mut self) {
        // A move that is dropped gives its reservation back, for which the lock of the cache is not needed.
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
