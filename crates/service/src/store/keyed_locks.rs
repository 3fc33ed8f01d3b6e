//! Locks by key, which are given in the order of arrival. A key that nobody uses or waits for has no lock.

use std::collections::HashMap;
use std::hash::Hash;
use std::sync::Arc;

use parking_lot::Mutex;
use tokio::sync::{Mutex as FairMutex, OwnedMutexGuard};

/// The locks of the keys in use.
pub(crate) struct KeyedLocks<K> {
    // Locked for a lookup, never across an await.
    locks: Mutex<HashMap<K, Arc<FairMutex<()>>>>,
}

/// The lock of a key, or the place of one who waits for it. The last to leave removes the lock.
pub(crate) struct KeyLock<K: Eq + Hash> {
    locks: Arc<KeyedLocks<K>>,
    pub(crate) key: K,
    lock: Option<Arc<FairMutex<()>>>,
    held: Option<OwnedMutexGuard<()>>,
}

impl<K> Default for KeyedLocks<K> {
    fn default() -> Self {
        KeyedLocks { locks: Mutex::default() }
    }
}

impl<K: Clone + Eq + Hash> KeyedLocks<K> {
    /// Waits for the lock of a key. A dropped future no longer waits.
    pub(crate) async fn lock(self: &Arc<Self>, key: K) -> KeyLock<K> {
        let (mut entry, lock) = self.enter(key);
        entry.held = Some(lock.lock_owned().await);
        entry
    }

    fn enter(self: &Arc<Self>, key: K) -> (KeyLock<K>, Arc<FairMutex<()>>) {
        let lock = Arc::clone(self.locks.lock().entry(key.clone()).or_default());
        (KeyLock { locks: Arc::clone(self), key, lock: Some(Arc::clone(&lock)), held: None }, lock)
    }
}

impl<K: Eq + Hash> Drop for KeyLock<K> {
    fn drop(&mut self) {
        let mut locks = self.locks.locks.lock();
        // Both while nobody can enter, so that the last of those who leave at the same time finds nobody else.
        drop((self.held.take(), self.lock.take()));
        if locks.get(&self.key).is_some_and(|lock| Arc::strong_count(lock) == 1) {
            locks.remove(&self.key);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::task::Poll;
    use std::time::Duration;

    use futures::poll;
    use tokio::pin;

    use super::*;

    #[tokio::test(flavor = "multi_thread", worker_threads = 4)]
    async fn a_lock_is_exclusive_and_nothing_of_it_stays() {
        let (locks, users) = (Arc::<KeyedLocks<usize>>::default(), Arc::new(Mutex::new(0)));
        let tasks = (0..400).map(|number| {
            let (locks, users) = (Arc::clone(&locks), Arc::clone(&users));
            tokio::spawn(async move {
                let waiting = locks.lock(number % 2);
                let Ok(lock) = tokio::time::timeout(Duration::from_micros(50 * number as u64), waiting).await else {
                    return;
                };
                if number % 2 == 0 {
                    *users.try_lock().expect("another task has the lock") += 1;
                }
                drop(lock);
            })
        });
        for task in tasks.collect::<Vec<_>>() {
            task.await.unwrap();
        }
        assert!(locks.locks.lock().is_empty());
    }

    #[tokio::test]
    async fn those_who_wait_for_a_key_follow_each_other_in_order_and_those_for_others_do_not_wait() {
        let locks = Arc::<KeyedLocks<&str>>::default();
        let first = locks.lock("a").await;
        let (second, left, third) = (locks.lock("a"), locks.lock("a"), locks.lock("a"));
        pin!(second, third);
        assert!(poll!(&mut second).is_pending());
        {
            pin!(left);
            assert!(poll!(&mut left).is_pending());
        }
        assert!(poll!(&mut third).is_pending());
        drop(locks.lock("b").await);
        drop(first);
        assert!(poll!(&mut third).is_pending());
        let Poll::Ready(second) = poll!(&mut second) else { panic!("it is its turn") };
        assert!(poll!(&mut third).is_pending());
        // The one that has left while it waited keeps nobody.
        drop(second);
        assert!(poll!(&mut third).is_ready());
    }
}
