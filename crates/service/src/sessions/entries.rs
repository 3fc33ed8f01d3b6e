//! The contacts in use, an entry each: whose turn it is to change the contact, its cached state, and what readers are
//! shown of it.
//!
//! A change takes the state out of the entry, and puts it back at the end with the size that it has then. It publishes
//! what readers are shown, who therefore wait for no change. An entry without users and without a state goes: requests
//! for identifiers that do not exist leave nothing behind, and a million idle contacts take space in the store alone.
//!
//! Of the states, and of the profiles that they share, the least recently used go first. A profile counts once, however
//! many states and requests have it. It is used whenever one of these states is, so that it goes after them. What is in
//! use stays, because dropping it would free nothing.

use std::collections::HashMap;
use std::mem;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering::SeqCst};

use hashlink::LruCache;
use parking_lot::Mutex;
use prometheus::IntCounter;
use tokio::sync::Semaphore;

use stickslip_compute::simulation::ProfileKey;
use stickslip_mechanics::Profile;

use super::feed::Feed;
use super::prelude::*;
use super::published::Published;

/// How many bytes of states are cached by default.
pub const CAPACITY: usize = 256 * 1024 * 1024;

/// A contact of a tenant. Under the identifier of another tenant's contact a tenant finds no entry.
type Key = (Tenant, Uuid);

/// A contact in use.
pub(super) struct ContactEntry {
    pub(super) key: Key,
    /// One permit, which is given in the order of arrival.
    turn: Semaphore,
    /// How many use the entry.
    users: AtomicUsize,
    // Locked to take the state out or to put it back, never across an await.
    state: Mutex<Option<Box<LoadedSession>>>,
    /// Whether there is a state, in the entry or in use.
    has_state: AtomicBool,
    /// The address of its profile, which is used with it.
    profile: AtomicUsize,
    // Locked for a copy.
    published: Mutex<Option<Published>>,
    /// What its followers receive, while there are any.
    pub(super) feed: Mutex<Option<Arc<Feed>>>,
}

/// A use of an entry. The last one removes an entry without a state.
pub(super) struct EntryRef {
    entries: Arc<Entries>,
    entry: Arc<ContactEntry>,
}

/// All entries, and profiles.
pub(super) struct Entries {
    // Locked for a lookup, never across an await.
    kept: Mutex<Kept>,
    capacity: usize,
    // How often a state that was asked for was cached.
    hits: IntCounter,
}

struct Kept {
    /// With the bytes of their states, cached or in use; what was used least recently comes first.
    items: LruCache<ItemKey, (Item, usize)>,
    addresses: HashMap<ProfileKey, usize>,
    bytes: usize,
    /// How many entries have a state.
    states: usize,
}

#[derive(PartialEq, Eq, Hash)]
enum ItemKey {
    Contact(Key),
    /// By its address, which the entries know.
    Profile(usize),
}

enum Item {
    Contact(Arc<ContactEntry>),
    Profile(Arc<Profile>, ProfileKey),
}

/// What is dropped once others can look up again.
type Evicted = (Vec<Box<LoadedSession>>, Vec<Arc<Profile>>);

/// The turn to change a contact, until the guard is dropped, when its state goes back to the entry.
pub(super) struct Guard {
    /// The state, if it is cached: that after a stored move, though perhaps not the last.
    pub(super) live: Option<Box<LoadedSession>>,
    /// How long loading the state has taken for the request that has the guard.
    pub(super) loading: Duration,
    /// The memory of a state that did not come out of the entry, and of a copy of it.
    pub(super) held: Reservation,
    /// The version of the contact in this process at which the state is known to be the stored one.
    pub(super) version: Option<u64>,
    /// Bytes of the state, with those of its profile that count for it, as it came out of the entry.
    taken: Option<(usize, usize)>,
    entry: EntryRef,
}

impl Entries {
    /// Entries with at most this many bytes of states, and the counter of their hits.
    pub(super) fn new(capacity: usize, hits: IntCounter) -> Entries {
        let kept = Kept { items: LruCache::new_unbounded(), addresses: HashMap::new(), bytes: 0, states: 0 };
        Entries { kept: Mutex::new(kept), capacity, hits }
    }

    /// The entry of a contact, which is made if there is none.
    pub(super) fn enter(self: &Arc<Self>, tenant: &Tenant, id: Uuid) -> EntryRef {
        let mut kept = self.kept.lock();
        let key = ItemKey::Contact((tenant.clone(), id));
        if let Some((Item::Contact(entry), _)) = kept.items.get(&key) {
            let entry = Arc::clone(entry);
            entry.users.fetch_add(1, SeqCst);
            kept.use_profile(entry.profile.load(SeqCst));
            return EntryRef { entries: Arc::clone(self), entry };
        }
        let entry = Arc::new(ContactEntry {
            key: (tenant.clone(), id),
            turn: Semaphore::new(1),
            users: AtomicUsize::new(1),
            state: Mutex::default(),
            has_state: AtomicBool::new(false),
            profile: AtomicUsize::new(0),
            published: Mutex::default(),
            feed: Mutex::default(),
        });
        kept.items.insert(key, (Item::Contact(Arc::clone(&entry)), 0));
        EntryRef { entries: Arc::clone(self), entry }
    }

    /// What `read` takes of what is published of a contact, if anything is. It waits for no change.
    pub(super) fn published<T>(&self, tenant: &Tenant, id: Uuid, read: impl FnOnce(&mut Published) -> T) -> Option<T> {
        let entry = match self.kept.lock().items.get(&ItemKey::Contact((tenant.clone(), id)))? {
            (Item::Contact(entry), _) => Arc::clone(entry),
            _ => return None,
        };
        let mut published = entry.published.lock();
        published.as_mut().map(read)
    }

    /// Whether somebody has the turn to change a contact.
    pub(super) fn is_changing(&self, tenant: &Tenant, id: Uuid) -> bool {
        match self.kept.lock().items.peek(&ItemKey::Contact((tenant.clone(), id))) {
            Some((Item::Contact(entry), _)) => entry.turn.available_permits() == 0,
            _ => false,
        }
    }

    pub(super) fn capacity(&self) -> usize {
        self.capacity
    }

    /// Bytes of the states, cached or in use, and of the profiles; and the number of states.
    pub(super) fn held(&self) -> (usize, usize) {
        let kept = self.kept.lock();
        (kept.bytes, kept.states)
    }

    pub(super) fn profile(&self, key: &ProfileKey) -> Option<Arc<Profile>> {
        let mut kept = self.kept.lock();
        let address = *kept.addresses.get(key)?;
        kept.use_profile(address)
    }

    /// Keeps a profile of so many bytes if it fits, unless there is one with this key already; returns the one that is
    /// to be used.
    pub(super) fn keep_profile(&self, key: ProfileKey, profile: Arc<Profile>, bytes: usize) -> Arc<Profile> {
        let mut kept = self.kept.lock();
        if let Some(ready) = kept.addresses.get(&key).copied().and_then(|address| kept.use_profile(address)) {
            return ready;
        }
        if bytes > self.capacity {
            return profile;
        }
        let evicted = kept.make_room(self.capacity - bytes);
        // Where those that others have leave no room, only its user has it.
        if kept.bytes <= self.capacity - bytes {
            let address = address_of(&profile);
            kept.bytes += bytes;
            kept.addresses.insert(key, address);
            kept.items.insert(ItemKey::Profile(address), (Item::Profile(Arc::clone(&profile), key), bytes));
        }
        drop(kept);
        drop(evicted);
        profile
    }

    /// Counts a state that goes back to its entry, in place of what has been counted for it, and keeps it if it fits.
    fn put(&self, entry: &Arc<ContactEntry>, live: Option<Box<LoadedSession>>) {
        let (own, shape) = live.as_ref().map_or((0, 0), |live| (live.bytes(), live.shape_bytes()));
        let profile = live.as_ref().map_or(0, |live| address_of(live.contact.profile()));
        let mut kept = self.kept.lock();
        let shape = if kept.use_profile(profile).is_some() { 0 } else { shape };
        // One that is too large would evict all others and itself.
        let live = live.filter(|_| own + shape <= self.capacity);
        let bytes = if live.is_some() { own + shape } else { 0 };
        let Some((_, counted)) = kept.items.get_mut(&ItemKey::Contact(entry.key.clone())) else { return };
        let before = mem::replace(counted, bytes);
        kept.bytes = kept.bytes - before + bytes;
        let had_state = entry.has_state.swap(live.is_some(), SeqCst);
        kept.states = kept.states + usize::from(live.is_some()) - usize::from(had_state);
        entry.profile.store(profile, SeqCst);
        *entry.state.lock() = live.map(|mut live| {
            live.counted = (own, shape);
            live
        });
        // After the state, so that it is the younger of the two.
        kept.use_profile(profile);
        let evicted = kept.make_room(self.capacity);
        drop(kept);
        drop(evicted);
    }

    /// Removes an entry that has no state, unless somebody uses it again.
    fn remove_unused(&self, entry: &ContactEntry) {
        let mut kept = self.kept.lock();
        // Nobody can enter meanwhile.
        if entry.users.load(SeqCst) == 0 && !entry.has_state.load(SeqCst) {
            let key = ItemKey::Contact(entry.key.clone());
            if matches!(kept.items.peek(&key), Some((Item::Contact(found), _)) if std::ptr::eq(&**found, entry)) {
                kept.items.remove(&key);
            }
        }
    }
}

impl Kept {
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

    /// Takes out the states and profiles that were used least recently until the rest takes no more than this, but for
    /// those that are in use.
    fn make_room(&mut self, most: usize) -> Evicted {
        let (mut states, mut profiles) = (Vec::new(), Vec::new());
        // What is in use is met once.
        for _ in 0..self.items.len() {
            if self.bytes <= most {
                break;
            }
            let Some((key, (item, bytes))) = self.items.remove_lru() else { break };
            match &item {
                Item::Contact(entry) => {
                    let state = entry.state.lock().take();
                    let is_evicted = state.is_some();
                    states.extend(state);
                    if is_evicted {
                        self.bytes -= bytes;
                        self.states -= 1;
                        entry.has_state.store(false, SeqCst);
                    }
                    if entry.users.load(SeqCst) > 0 {
                        self.items.insert(key, (item, if is_evicted { 0 } else { bytes }));
                    }
                }
                Item::Profile(profile, digest) => {
                    // Then the states that have just been taken out have theirs no longer.
                    states.clear();
                    if Arc::strong_count(profile) > 1 {
                        self.items.insert(key, (item, bytes));
                        continue;
                    }
                    self.addresses.remove(digest);
                    self.bytes -= bytes;
                    profiles.push(Arc::clone(profile));
                }
            }
        }
        (states, profiles)
    }
}

fn address_of(profile: &Profile) -> usize {
    std::ptr::from_ref(profile).addr()
}

impl EntryRef {
    /// Waits for the turn to change the contact. A dropped future no longer waits.
    pub(super) async fn lock(self) -> Guard {
        // The semaphore is never closed.
        if let Ok(turn) = self.entry.turn.acquire().await {
            turn.forget();
        }
        self.guard()
    }

    /// The turn to change the contact if nobody else has it or waits for it.
    pub(super) fn try_lock(self) -> Result<Guard, EntryRef> {
        let turn = self.entry.turn.try_acquire().map(|turn| turn.forget());
        if turn.is_ok() { Ok(self.guard()) } else { Err(self) }
    }

    fn guard(self) -> Guard {
        let live = self.entry.state.lock().take();
        if live.is_some() {
            self.entries.hits.inc();
        }
        let taken = live.as_ref().map(|live| live.counted);
        Guard { live, loading: Duration::ZERO, held: Reservation::default(), version: None, taken, entry: self }
    }

    pub(super) fn entry(&self) -> &ContactEntry {
        &self.entry
    }
}

impl Drop for EntryRef {
    fn drop(&mut self) {
        // An entry with a state is removed by the one who evicts the state.
        if self.entry.users.fetch_sub(1, SeqCst) == 1 && !self.entry.has_state.load(SeqCst) {
            self.entries.remove_unused(&self.entry);
        }
    }
}

impl Guard {
    pub(super) fn id(&self) -> Uuid {
        self.entry.entry.key.1
    }

    /// Ends the use of a new contact and leaves it in this state, which is the stored one at this version.
    pub(super) fn finish(mut self, live: Box<LoadedSession>, version: Option<u64>) {
        (self.live, self.version) = (Some(live), version);
    }

    /// The version at which the published state was the stored one, if the state of the guard is the same.
    pub(super) fn published_version(&self) -> Option<u64> {
        let published = self.entry.entry.published.lock();
        let (published, live) = (published.as_ref()?, self.live.as_ref()?);
        (!live.is_behind && published.is_of(live)).then_some(published.version)
    }
}

impl Drop for Guard {
    fn drop(&mut self) {
        let (live, entry) = (self.live.take(), &self.entry.entry);
        if let (Some(live), Some(version)) = (&live, self.version)
            && !live.is_behind
        {
            Published::update(&mut entry.published.lock(), live, version);
        }
        match live {
            // Nothing about its size has changed.
            Some(live) if self.taken == Some((live.bytes(), live.counted.1)) => *entry.state.lock() = Some(live),
            None if self.taken.is_none() => {}
            live => self.entry.entries.put(entry, live),
        }
        entry.turn.add_permits(1);
    }
}
