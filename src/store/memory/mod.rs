//! Everything in the process: fast, and gone when it ends.

mod jobs;

use std::collections::{BTreeMap, HashMap, VecDeque};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use futures::FutureExt as _;
use jiff::Timestamp;
use uuid::Uuid;

use stickslip_wire::SessionSummary;

use super::{Answer, Changes, RECEIPT_LIFETIME, Receipt, Record, Session, Snapshot, Store, StoreError, Tenant};

/// Bytes of replies kept for retries. Beyond them the oldest go before their time: the price of a bounded memory.
const RECEIPT_BYTES: usize = 256 * 1024 * 1024;
/// What a receipt takes besides its body and key, roughly.
const RECEIPT_OVERHEAD: usize = 256;

/// Sessions in a map.
#[derive(Default)]
pub struct MemoryStore {
    // A std mutex: it is held for a lookup, a push or a page of copies, never across an await.
    inner: Mutex<Inner>,
    // Locked after the others, where both are.
    jobs: jobs::Jobs,
    changes: Changes,
}

#[derive(Default)]
struct Inner {
    sessions: BTreeMap<Uuid, Stored>,
    receipts: Receipts,
    // Only what expired: a deleted session leaves nothing behind.
    expired: HashMap<Uuid, Tenant>,
}

struct Stored {
    session: Session,
    // Forks share the past until one of them moves on.
    past: Arc<Vec<Record>>,
    snapshot: Option<Snapshot>,
}

#[derive(Default)]
struct Receipts {
    by_key: HashMap<String, Receipt>,
    // In the order of arrival, which is that of expiry.
    arrivals: VecDeque<(Instant, String)>,
    bytes: usize,
}

impl MemoryStore {
    /// An empty store.
    #[must_use]
    pub fn new() -> MemoryStore {
        MemoryStore::default()
    }

    fn lock(&self) -> MutexGuard<'_, Inner> {
        // Nothing that can panic stands between the first and the last change of a call, so that a poisoned map is whole.
        self.inner.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Inner {
    /// Why there is no such session, if there is none.
    fn missing(&self, id: Uuid) -> StoreError {
        self.expired.get(&id).cloned().map_or(StoreError::NotFound, StoreError::Expired)
    }

    fn at(&mut self, id: Uuid, expected: u64) -> Result<&mut Stored, StoreError> {
        let missing = self.missing(id);
        let stored = self.sessions.get_mut(&id).ok_or(missing)?;
        if stored.session.sequence == expected {
            Ok(stored)
        } else {
            Err(StoreError::Stale { found: stored.session.sequence })
        }
    }
}

impl Receipts {
    fn free(&mut self, receipt: Option<&Receipt>) -> Result<(), StoreError> {
        self.sweep();
        match receipt {
            Some(receipt) if self.by_key.contains_key(&receipt.request.key) => Err(StoreError::KeyTaken),
            _ => Ok(()),
        }
    }

    fn keep(&mut self, receipt: Option<Receipt>) {
        if let Some(receipt) = receipt {
            self.bytes += size(&receipt);
            self.arrivals.push_back((Instant::now(), receipt.request.key.clone()));
            self.by_key.insert(receipt.request.key.clone(), receipt);
            self.sweep();
        }
    }

    fn sweep(&mut self) {
        while let Some((arrival, key)) = self.arrivals.front() {
            if arrival.elapsed() < RECEIPT_LIFETIME && self.bytes <= RECEIPT_BYTES {
                break;
            }
            if let Some(receipt) = self.by_key.remove(key) {
                self.bytes -= size(&receipt);
            }
            self.arrivals.pop_front();
        }
    }
}

fn size(receipt: &Receipt) -> usize {
    RECEIPT_OVERHEAD + receipt.reply.body.len() + 2 * receipt.request.key.len()
}

fn summary(session: &Session) -> SessionSummary {
    let Session { id, ref label, sequence, created_at, updated_at, .. } = *session;
    SessionSummary { id, label: label.clone(), sequence, created_at, updated_at }
}

fn answer<'a, T: Send + 'a>(result: Result<T, StoreError>) -> Answer<'a, T> {
    std::future::ready(result).boxed()
}

impl Store for MemoryStore {
    fn ready(&self) -> Answer<'_, ()> {
        answer(Ok(()))
    }

    fn create(&self, session: Session, receipt: Option<Receipt>) -> Answer<'_, ()> {
        let mut inner = self.lock();
        answer(inner.receipts.free(receipt.as_ref()).map(|()| {
            inner.sessions.insert(session.id, Stored { session, past: Arc::default(), snapshot: None });
            inner.receipts.keep(receipt);
        }))
    }

    fn find(&self, id: Uuid) -> Answer<'_, Session> {
        let inner = self.lock();
        answer(inner.sessions.get(&id).map(|stored| stored.session.clone()).ok_or_else(|| inner.missing(id)))
    }

    fn sequence(&self, id: Uuid) -> Answer<'_, u64> {
        let inner = self.lock();
        answer(inner.sessions.get(&id).map(|stored| stored.session.sequence).ok_or_else(|| inner.missing(id)))
    }

    fn list(&self, of: Option<Tenant>, after: Option<Uuid>, limit: usize) -> Answer<'_, Vec<SessionSummary>> {
        use std::ops::Bound::{Excluded, Unbounded};
        let inner = self.lock();
        let beyond =
            inner.sessions.range((after.map_or(Unbounded, Excluded), Unbounded)).map(|(_, stored)| &stored.session);
        let own = beyond.filter(|session| of.as_ref().is_none_or(|tenant| session.tenant == *tenant));
        answer(Ok(own.take(limit).map(summary).collect()))
    }

    fn append(&self, id: Uuid, expected: u64, records: Vec<Record>, receipt: Option<Receipt>) -> Answer<'_, ()> {
        let append = |inner: &mut Inner| {
            inner.receipts.free(receipt.as_ref())?;
            let stored = inner.at(id, expected)?;
            if let Some(last) = records.last() {
                stored.session.sequence = last.sequence;
                stored.session.updated_at = last.at;
            }
            Arc::make_mut(&mut stored.past).extend(records);
            inner.receipts.keep(receipt);
            Ok(())
        };
        let appended = append(&mut self.lock());
        self.changes.wake(id);
        answer(appended)
    }

    fn history(&self, id: Uuid, after: u64, limit: usize) -> Answer<'_, Vec<Record>> {
        // Copied under the lock: a shared past would have to be copied whole by the next append.
        let inner = self.lock();
        let page = inner.sessions.get(&id).map(|stored| {
            // Numbers count from 1, so that the number of the last one seen is the index of the next.
            let start = usize::try_from(after).unwrap_or(usize::MAX).min(stored.past.len());
            stored.past[start..].iter().take(limit).copied().collect()
        });
        answer(page.ok_or_else(|| inner.missing(id)))
    }

    fn fork(&self, id: Uuid, copy: Session, receipt: Option<Receipt>) -> Answer<'_, ()> {
        let fork = |inner: &mut Inner| {
            inner.receipts.free(receipt.as_ref())?;
            let Stored { past, snapshot, .. } = inner.at(id, copy.sequence)?;
            let (past, snapshot) = (Arc::clone(past), snapshot.clone());
            inner.sessions.insert(copy.id, Stored { session: copy, past, snapshot });
            inner.receipts.keep(receipt);
            Ok(())
        };
        answer(fork(&mut self.lock()))
    }

    fn delete(&self, id: Uuid, expected: u64) -> Answer<'_, ()> {
        let mut inner = self.lock();
        let deleted = inner.at(id, expected).map(|_| ()).map(|()| inner.sessions.remove(&id));
        drop(inner);
        self.changes.wake(id);
        answer(deleted.map(drop))
    }

    fn receipt<'a>(&'a self, key: &'a str) -> Answer<'a, Option<Receipt>> {
        let mut inner = self.lock();
        inner.receipts.sweep();
        answer(Ok(inner.receipts.by_key.get(key).cloned()))
    }

    fn snapshot(&self, id: Uuid) -> Answer<'_, Option<Snapshot>> {
        let inner = self.lock();
        answer(inner.sessions.get(&id).map(|stored| stored.snapshot.clone()).ok_or_else(|| inner.missing(id)))
    }

    fn keep_snapshot(&self, id: Uuid, snapshot: Snapshot) -> Answer<'_, ()> {
        if let Some(stored) = self.lock().sessions.get_mut(&id)
            && stored.snapshot.as_ref().is_none_or(|kept| kept.sequence < snapshot.sequence)
        {
            stored.snapshot = Some(snapshot);
        }
        answer(Ok(()))
    }

    fn sweep(&self, idle_since: Option<Timestamp>) -> Answer<'_, u64> {
        self.jobs.sweep();
        let mut inner = self.lock();
        inner.receipts.sweep();
        let idle: Vec<Uuid> = idle_since.map_or_else(Vec::new, |since| {
            let idle = inner.sessions.values().filter(|stored| stored.session.updated_at < since);
            idle.map(|stored| stored.session.id).collect()
        });
        for id in &idle {
            if let Some(stored) = inner.sessions.remove(id) {
                inner.expired.insert(*id, stored.session.tenant);
            }
            self.changes.wake(*id);
        }
        answer(Ok(idle.len() as u64))
    }

    fn changes(&self) -> &Changes {
        &self.changes
    }
}

#[cfg(test)]
mod tests {
    use super::{MemoryStore, RECEIPT_BYTES, Receipts};
    use crate::store::{Receipt, Reply, RequestKey, Store as _, StoreError};
    use uuid::Uuid;

    fn receipt(key: &str, bytes: usize) -> Receipt {
        let request = RequestKey { key: key.to_owned(), fingerprint: [0; 32] };
        Receipt { request, reply: Reply { created: None, sequence: 1, body: vec![0; bytes] } }
    }

    #[test]
    fn old_receipts_make_room_for_new_ones() {
        let mut receipts = Receipts::default();
        for key in ["a", "b", "c"] {
            receipts.keep(Some(receipt(key, RECEIPT_BYTES / 3)));
        }
        assert!(!receipts.by_key.contains_key("a"));
        assert!(receipts.free(Some(&receipt("c", 0))).is_err() && receipts.bytes <= RECEIPT_BYTES);
        assert_eq!(receipts.arrivals.len(), receipts.by_key.len());
    }

    #[tokio::test]
    async fn what_is_not_there_cannot_be_changed() {
        let (store, id) = (MemoryStore::new(), Uuid::now_v7());
        assert!(matches!(store.append(id, 0, Vec::new(), None).await, Err(StoreError::NotFound)));
        assert!(matches!(store.delete(id, 0).await, Err(StoreError::NotFound)));
        assert!(matches!(store.history(id, 0, 1).await, Err(StoreError::NotFound)));
    }

    #[test]
    fn timestamps_and_identifiers_agree_on_the_order() {
        let ids: Vec<Uuid> = (0..1000).map(|_| Uuid::now_v7()).collect();
        assert!(ids.is_sorted());
    }
}
