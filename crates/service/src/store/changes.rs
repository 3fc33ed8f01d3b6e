//! Noticing that a session changes.
//!
//! A wake-up says that something may have happened, not what: a listener that is woken reads the moves after the last
//! that it has seen. So wake-ups may be merged or spurious, and no change is missed.
//!
//! Where one process alone makes the changes, their number tells whether what has been read still holds. Sessions share
//! counters, so that no session takes memory for them: a number that has not changed is a proof, one that has is none.

use std::collections::HashMap;
use std::sync::atomic::{AtomicU64, Ordering};

use parking_lot::Mutex;
use tokio::sync::watch;
use uuid::Uuid;

/// Counters; a power of two.
const COUNTERS: usize = 8_192;
/// Sessions without listeners that the map may hold besides those with listeners.
const LEFT: usize = 64;

/// The waiting listeners by session, and counters of changes.
pub struct Changes {
    // Locked for a lookup, never across an await.
    waiting: Mutex<Waiting>,
    counters: Box<[Counter]>,
}

#[derive(Default)]
struct Waiting {
    senders: HashMap<Uuid, watch::Sender<()>>,
    /// How many there may be until those without listeners are removed.
    most: usize,
}

/// Changes that have begun, and those that have ended, made or not.
#[derive(Default)]
struct Counter {
    begun: AtomicU64,
    ended: AtomicU64,
}

impl Default for Changes {
    fn default() -> Changes {
        Changes { waiting: Mutex::default(), counters: (0..COUNTERS).map(|_| Counter::default()).collect() }
    }
}

impl Changes {
    /// A listener that is woken by each change of a session from now on.
    #[must_use]
    pub fn subscribe(&self, id: Uuid) -> watch::Receiver<()> {
        let mut waiting = self.waiting.lock();
        if waiting.senders.len() > waiting.most {
            waiting.senders.retain(|_, sender| sender.receiver_count() > 0);
            waiting.most = 2 * waiting.senders.len() + LEFT;
        }
        waiting.senders.entry(id).or_default().subscribe()
    }

    fn counter(&self, id: Uuid) -> &Counter {
        // The end of an identifier is random.
        let (_, random) = id.as_u64_pair();
        &self.counters[random as usize % COUNTERS]
    }

    /// How many changes a session has had in this process; none while one is under way.
    pub fn version(&self, id: Uuid) -> Option<u64> {
        let Counter { begun, ended } = self.counter(id);
        let ended = ended.load(Ordering::SeqCst);
        (begun.load(Ordering::SeqCst) == ended).then_some(ended)
    }

    /// Notes that a session may be about to change, before anybody can see the change.
    pub fn begin(&self, id: Uuid) {
        self.counter(id).begun.fetch_add(1, Ordering::SeqCst);
    }

    /// Notes that a change which has begun is made, or will not be, and wakes the listeners of the session.
    pub fn end(&self, id: Uuid) {
        self.counter(id).ended.fetch_add(1, Ordering::SeqCst);
        if let Some(sender) = self.waiting.lock().senders.get(&id) {
            sender.send_replace(());
        }
    }

    /// Wakes the listeners of a session that has changed.
    pub fn wake(&self, id: Uuid) {
        self.begin(id);
        self.end(id);
    }

    /// Wakes all listeners: after a gap in which changes may have been missed.
    pub fn wake_all(&self) {
        for sender in self.waiting.lock().senders.values() {
            sender.send_replace(());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Changes, LEFT};
    use uuid::Uuid;

    #[test]
    fn only_the_listeners_of_a_session_are_woken_and_few_are_kept_that_left() {
        let (changes, here, elsewhere) = (Changes::default(), Uuid::now_v7(), Uuid::now_v7());
        let (mut waits, idles) = (changes.subscribe(here), changes.subscribe(elsewhere));
        changes.wake(here);
        assert!(waits.has_changed().unwrap() && !idles.has_changed().unwrap());
        waits.mark_unchanged();
        changes.wake_all();
        assert!(waits.has_changed().unwrap() && idles.has_changed().unwrap());
        drop((waits, idles));
        for _ in 0..10 * LEFT {
            drop(changes.subscribe(Uuid::now_v7()));
        }
        assert!(changes.waiting.lock().senders.len() <= 2 * LEFT);
    }

    #[test]
    fn a_version_holds_while_nothing_changes_and_there_is_none_during_a_change() {
        let (changes, id) = (Changes::default(), Uuid::now_v7());
        let before = changes.version(id);
        assert_eq!((before, changes.version(id)), (Some(0), before));
        changes.begin(id);
        assert_eq!(changes.version(id), None);
        changes.end(id);
        assert_eq!(changes.version(id), Some(1));
    }
}
