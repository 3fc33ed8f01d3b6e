//! Where the sessions stand that have moved of late: what the writer need not ask the database, being the only one to change it.

use hashlink::LruCache;
use uuid::Uuid;

/// Sessions that are known, of some 64 bytes each.
const SESSIONS: usize = 16_384;

/// Numbers and sequences of sessions, as the transaction under way leaves them. Whoever takes a transaction back clears them.
pub(super) struct SequenceCache {
    by_id: LruCache<Uuid, (i64, u64)>,
}

impl SequenceCache {
    pub(super) fn empty() -> SequenceCache {
        SequenceCache { by_id: LruCache::new(SESSIONS) }
    }

    /// The number of a session that is known to be at a sequence. To be told nothing says nothing.
    pub(super) fn number(&mut self, id: Uuid, expected: u64) -> Option<i64> {
        self.by_id.get(&id).filter(|(_, sequence)| *sequence == expected).map(|(number, _)| *number)
    }

    pub(super) fn moved(&mut self, id: Uuid, number: i64, sequence: u64) {
        self.by_id.insert(id, (number, sequence));
    }

    pub(super) fn forget(&mut self, id: Uuid) {
        self.by_id.remove(&id);
    }

    pub(super) fn clear(&mut self) {
        self.by_id.clear();
    }
}
