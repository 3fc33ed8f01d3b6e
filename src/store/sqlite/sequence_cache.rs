//! The sequences of contacts that have moved lately: what the writer, which alone changes them, need not ask the
//! database.

use hashlink::LruCache;
use uuid::Uuid;

/// Contacts in the cache, of some 64 bytes each.
const CAPACITY: usize = 16_384;

/// Numbers and sequences of contacts, as the transaction under way leaves them. A rollback clears the cache.
pub(super) struct SequenceCache {
    by_id: LruCache<Uuid, (i64, u64)>,
}

impl SequenceCache {
    pub(super) fn new() -> SequenceCache {
        SequenceCache { by_id: LruCache::new(CAPACITY) }
    }

    /// The number of a contact that is known to be at a sequence. `None` means unknown.
    pub(super) fn number(&mut self, id: Uuid, expected: u64) -> Option<i64> {
        self.by_id.get(&id).filter(|(_, sequence)| *sequence == expected).map(|(number, _)| *number)
    }

    pub(super) fn insert(&mut self, id: Uuid, number: i64, sequence: u64) {
        self.by_id.insert(id, (number, sequence));
    }

    pub(super) fn remove(&mut self, id: Uuid) {
        self.by_id.remove(&id);
    }

    pub(super) fn clear(&mut self) {
        self.by_id.clear();
    }
}
