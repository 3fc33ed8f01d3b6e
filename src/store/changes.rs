//! Waiting for a session to change.
//!
//! A wake-up says that something may have happened, not what: a listener that is woken reads the moves after the last
//! that it has seen. So wake-ups may be merged or spurious, and no change is missed.

use std::collections::HashMap;

use parking_lot::Mutex;
use tokio::sync::watch;
use uuid::Uuid;

/// The waiting listeners by session. The map holds an entry only while a listener waits.
#[derive(Default)]
pub struct Changes {
    // Locked for a lookup, never across an await.
    waiting: Mutex<HashMap<Uuid, watch::Sender<()>>>,
}

impl Changes {
    /// A listener that is woken by each change of a session from now on.
    #[must_use]
    pub fn subscribe(&self, id: Uuid) -> watch::Receiver<()> {
        let mut waiting = self.waiting.lock();
        waiting.retain(|_, sender| sender.receiver_count() > 0);
        waiting.entry(id).or_default().subscribe()
    }

    /// Wakes the listeners of a session.
    pub fn wake(&self, id: Uuid) {
        if let Some(sender) = self.waiting.lock().get(&id) {
            sender.send_replace(());
        }
    }

    /// Wakes all listeners: after a gap in which changes may have been missed.
    pub fn wake_all(&self) {
        for sender in self.waiting.lock().values() {
            sender.send_replace(());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Changes;
    use uuid::Uuid;

    #[test]
    fn only_the_listeners_of_a_session_are_woken_and_none_is_kept_that_left() {
        let (changes, here, elsewhere) = (Changes::default(), Uuid::now_v7(), Uuid::now_v7());
        let (mut waits, idles) = (changes.subscribe(here), changes.subscribe(elsewhere));
        changes.wake(here);
        assert!(waits.has_changed().unwrap() && !idles.has_changed().unwrap());
        waits.mark_unchanged();
        changes.wake_all();
        assert!(waits.has_changed().unwrap() && idles.has_changed().unwrap());
        drop((waits, idles));
        drop(changes.subscribe(here));
        assert_eq!(changes.waiting.lock().len(), 1);
    }
}
