//! The cached states and prepared profiles, of which the least recently used go first, and the locks of the sessions in
//! use.
//!
//! A request takes the state of its session out of the cache, and puts it back at the end with the size that it has
//! then. A session that no request uses has no lock, and one that is not cached takes no memory: requests for
//! identifiers that do not exist leave nothing behind, and a million idle sessions take space in the store alone.
//!
//! A profile that is kept counts once, however many states and requests have it. It is used whenever one of these
//! states is, so that it goes after them; and one that somebody has stays, because to forget it would free nothing.

use std::collections::hash_map::Entry;
use std::collections::{HashMap, VecDeque};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use hashlink::LruCache;
use parking_lot::Mutex;
use prometheus::IntCounter;
use tokio::sync::oneshot;
use tracing::Span;
use uuid::Uuid;

use crate::admission::Reservation;
use crate::store::{Reply, Tenant};
use stickslip_compute::simulation::ProfileKey;
use stickslip_mechanics::Profile;
use stickslip_wire::session::Advance;

use super::SessionError;
use super::expected::Expected;
use super::loaded::LoadedSession;
use super::storage_reservation::StorageReservation;

/// How many bytes of states are cached by default.
pub const CAPACITY: usize = 256 * 1024 * 1024;

/// A session of a tenant. Under the identifier of another tenant's session a tenant finds neither a state nor a lock.
type Key = (Tenant, Uuid);

/// States, profiles and locks.
pub(super) struct Cache {
    // Both are locked for a lookup, never across an await.
    /// The sessions in use, each with those who wait for it in the order of their arrival.
    queues: Mutex<HashMap<Key, VecDeque<Waiter>>>,
    cached: Mutex<Cached>,
    /// Numbers those who wait: no two of them have the same number.
    arrivals: AtomicU64,
    capacity: usize,
    // How often a state that was asked for was cached.
    hits: IntCounter,
}

/// A request that waits: with a move that whoever has the session may make, or for anything else.
struct Waiter {
    number: u64,
    waiting_move: Option<WaitingMove>,
    // Dropped when another one takes the move.
    lock: oneshot::Sender<(SessionLock, Option<WaitingMove>)>,
}

/// A move that may be made by whoever has the session.
pub(super) struct WaitingMove {
    pub(super) advance: Arc<Advance>,
    /// What the client expects the session to be.
    pub(super) expected: Option<Expected>,
    pub(super) by: Option<Arc<str>>,
    pub(super) reservation: StorageReservation,
    pub(super) span: Span,
    /// What becomes of it if another one takes it: it is stored, or the store has refused those made with it; nothing
    /// if it has not been made.
    pub(super) answer: oneshot::Sender<Option<Result<Reply, SessionError>>>,
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
    lock: SessionLock,
}

/// Exclusive use of a session, which goes to the next who waits for it when this is dropped.
pub(super) struct SessionLock {
    cache: Arc<Cache>,
    key: Key,
}

/// A position in the queue, which is left when this is dropped.
pub(super) struct QueuePosition {
    cache: Arc<Cache>,
    key: Key,
    number: u64,
    /// The session, with the move that has waited for it; an error if another one has taken the move.
    pub(super) lock: oneshot::Receiver<(SessionLock, Option<WaitingMove>)>,
}

impl Cache {
    /// A cache of at most this many bytes, and the counter of its hits.
    pub(super) fn new(capacity: usize, hits: IntCounter) -> Cache {
        let cached = Cached { items: LruCache::new_unbounded(), addresses: HashMap::new(), bytes: 0 };
        Cache { queues: Mutex::default(), cached: Mutex::new(cached), arrivals: AtomicU64::new(0), capacity, hits }
    }

    /// Waits for exclusive use of a session. A dropped future no longer waits.
    pub(super) async fn lock(self: &Arc<Self>, tenant: &Tenant, id: Uuid) -> Result<Guard, SessionError> {
        let locked = (&mut self.enqueue(tenant, id, None).lock).await;
        // Nobody else takes it from one who waits without a move.
        let (lock, _) = locked.map_err(|_| SessionError::Broken("a lock was lost".to_owned()))?;
        Ok(lock.guard())
    }

    /// Exclusive use of a session if nobody else has it.
    pub(super) fn try_lock(self: &Arc<Self>, tenant: &Tenant, id: Uuid) -> Option<Guard> {
        let key = (tenant.clone(), id);
        match self.queues.lock().entry(key.clone()) {
            Entry::Vacant(free) => drop(free.insert(VecDeque::new())),
            Entry::Occupied(_) => return None,
        }
        Some(SessionLock { cache: Arc::clone(self), key }.guard())
    }

    /// A position at the end of the queue for a session, which gets it at once if nobody has the session.
    pub(super) fn enqueue(
        self: &Arc<Self>,
        tenant: &Tenant,
        id: Uuid,
        waiting_move: Option<WaitingMove>,
    ) -> QueuePosition {
        let (cache, key) = (Arc::clone(self), (tenant.clone(), id));
        let (sender, lock) = oneshot::channel();
        let number = self.arrivals.fetch_add(1, Ordering::Relaxed);
        let mut queues = self.queues.lock();
        let is_free = !queues.contains_key(&key);
        queues.entry(key.clone()).or_default().push_back(Waiter { number, waiting_move, lock: sender });
        drop(queues);
        if is_free {
            // It goes to whoever has come first.
            drop(SessionLock { cache: Arc::clone(self), key: key.clone() });
        }
        QueuePosition { cache, key, number, lock }
    }

    /// Whether the state of a session is cached.
    pub(super) fn holds(&self, tenant: &Tenant, id: Uuid) -> bool {
        self.cached.lock().items.contains_key(&ItemKey::State((tenant.clone(), id)))
    }

    pub(super) fn capacity(&self) -> usize {
        self.capacity
    }

    /// Bytes of the cached states, with those in use, and of the profiles, and how many states nobody uses.
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

    /// Takes the moves at the head of the queue, at most so many, up to whatever else waits there.
    pub(super) fn take_moves(&self, most: usize) -> Vec<WaitingMove> {
        let mut queues = self.lock.cache.queues.lock();
        let Some(queue) = queues.get_mut(&self.lock.key) else { return Vec::new() };
        let moves = queue.iter().take(most).take_while(|waiter| waiter.waiting_move.is_some()).count();
        queue.drain(..moves).filter_map(|waiter| waiter.waiting_move).collect()
    }
}

impl SessionLock {
    /// The session with its state, if that is cached.
    pub(super) fn guard(self) -> Guard {
        let (live, taken) = self.cache.take(&self.key).unzip();
        let taken = taken.unwrap_or(0);
        Guard { live, loading: Duration::ZERO, held: Reservation::default(), taken, lock: self }
    }
}

impl QueuePosition {
    /// Leaves the queue; returns whether it was still there, so that nobody has taken its move.
    pub(super) fn leave(&self) -> bool {
        let left = {
            let mut queues = self.cache.queues.lock();
            queues.get_mut(&self.key).and_then(|queue| {
                let place = queue.iter().position(|waiter| waiter.number == self.number)?;
                queue.remove(place)
            })
        };
        // A move that is dropped gives its reservation back, for which the lock of the cache is not needed.
        left.is_some()
    }
}

impl Drop for QueuePosition {
    fn drop(&mut self) {
        self.leave();
    }
}

impl Drop for Guard {
    fn drop(&mut self) {
        if self.live.is_some() || self.taken > 0 {
            self.lock.cache.put(self.live.take(), self.taken);
        }
    }
}

impl Drop for SessionLock {
    fn drop(&mut self) {
        let next = {
            let mut queues = self.cache.queues.lock();
            let next = queues.get_mut(&self.key).and_then(VecDeque::pop_front);
            if next.is_none() {
                queues.remove(&self.key);
            }
            next
        };
        if let Some(waiter) = next {
            let lock = SessionLock { cache: Arc::clone(&self.cache), key: self.key.clone() };
            // From one who has just left, the lock comes back and goes on.
            let _ = waiter.lock.send((lock, waiter.waiting_move));
        }
    }
}
