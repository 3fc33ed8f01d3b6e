//! The states at hand, each behind the lock of its session.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use tokio::sync::Mutex as SessionLock;
use uuid::Uuid;

use super::Live;

/// How many states are kept at hand by default.
pub const CAPACITY: usize = 10_000;

/// One session: its lock, and its state unless it has to be replayed. The lock is fair, so that moves apply in the
/// order of their arrival.
pub(super) type Slot = Arc<SessionLock<Option<Live>>>;

/// Slots by session. A slot that anybody holds is never dropped, so that a session has one lock at a time.
pub(super) struct Cache {
    // A std mutex: held for a lookup, never across an await.
    slots: Mutex<Slots>,
    capacity: usize,
}

#[derive(Default)]
struct Slots {
    by_id: HashMap<Uuid, (Slot, u64)>,
    // Counts the calls, to tell what has been used last.
    clock: u64,
}

impl Cache {
    pub(super) fn new(capacity: usize) -> Cache {
        Cache { slots: Mutex::default(), capacity: capacity.max(1) }
    }

    /// The slot of a session, empty if it is not at hand.
    pub(super) fn slot(&self, id: Uuid) -> Slot {
        self.enter(id, Slot::default)
    }

    /// Puts a session just made at hand.
    pub(super) fn insert(&self, live: Live) {
        self.enter(live.session.id, || Arc::new(SessionLock::new(Some(live))));
    }

    /// Drops a session that is gone from the store.
    pub(super) fn forget(&self, id: Uuid) {
        self.lock().by_id.remove(&id);
    }

    fn enter(&self, id: Uuid, slot: impl FnOnce() -> Slot) -> Slot {
        let mut slots = self.lock();
        slots.clock += 1;
        let now = slots.clock;
        if slots.by_id.len() >= self.capacity && !slots.by_id.contains_key(&id) {
            slots.make_room(self.capacity);
        }
        let (slot, used) = slots.by_id.entry(id).or_insert_with(|| (slot(), now));
        *used = now;
        Arc::clone(slot)
    }

    fn lock(&self) -> MutexGuard<'_, Slots> {
        self.slots.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Slots {
    /// Drops the quarter that has been idle longest, so that the search is paid once for many entries.
    fn make_room(&mut self, capacity: usize) {
        let idle = self.by_id.iter().filter(|(_, (slot, _))| Arc::strong_count(slot) == 1);
        let mut idle: Vec<(u64, Uuid)> = idle.map(|(id, (_, used))| (*used, *id)).collect();
        idle.sort_unstable();
        for (_, id) in idle.into_iter().take(capacity.div_ceil(4)) {
            self.by_id.remove(&id);
        }
    }
}
