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
