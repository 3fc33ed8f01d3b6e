//! Locks of the contacts and idempotency keys that have a change under way: the next change waits for its end, so that
//! changes of one contact, and those with one key, are made in the order of their arrival.

use std::collections::HashMap;
use std::hash::Hash;
use std::sync::{Arc, Weak};

use parking_lot::Mutex;
use tokio::sync::OwnedMutexGuard;

/// Locks that are kept before the unused ones are removed.
const KEPT: usize = 1_024;

/// The locks of one kind.
pub(super) struct ChangeLocks<K> {
    // Locked for a lookup, never across an await.
    locks: Mutex<HashMap<K, Weak<tokio::sync::Mutex<()>>>>,
}

impl<K> Default for ChangeLocks<K> {
    fn default() -> Self {
        ChangeLocks { locks: Mutex::default() }
    }
}

impl<K: Eq + Hash> ChangeLocks<K> {
    /// Waits for the lock of a contact or a key.
    pub(super) async fn lock(&self, of: K) -> OwnedMutexGuard<()> {
        let lock = {
            let mut locks = self.locks.lock();
            if locks.len() >= KEPT {
                locks.retain(|_, lock| lock.strong_count() > 0);
            }
            let known = locks.entry(of).or_default();
            known.upgrade().unwrap_or_else(|| {
                let new = Arc::default();
                *known = Arc::downgrade(&new);
                new
            })
        };
        lock.lock_owned().await
    }
}

#[cfg(test)]
mod tests {
    use std::task::Poll;

    use futures::poll;
    use tokio::pin;

    use super::{ChangeLocks, KEPT};

    #[tokio::test]
    async fn changes_of_one_contact_follow_each_other_in_order_and_those_of_others_do_not_wait() {
        let locks = ChangeLocks::default();
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

    #[tokio::test]
    async fn locks_that_nobody_has_are_removed_and_held_ones_are_not() {
        let locks = ChangeLocks::default();
        let held = locks.lock(0).await;
        for other in 1..2 * KEPT {
            drop(locks.lock(other).await);
        }
        assert!(locks.locks.lock().len() <= KEPT);
        // So many locks have used up the turn of this task, without which nothing is ready.
        tokio::task::yield_now().await;
        let again = locks.lock(0);
        pin!(again);
        assert!(poll!(&mut again).is_pending());
        drop(held);
        assert!(poll!(&mut again).is_ready());
    }
}
