//! A store in the memory of the process: fast, and lost when it ends.

mod jobs;

use std::collections::{BTreeMap, HashMap, VecDeque};
use std::ops::Bound::{Excluded, Unbounded};
use std::sync::Arc;
use std::time::Instant;

use async_trait::async_trait;
use hashlink::LinkedHashMap;
use jiff::Timestamp;
use parking_lot::Mutex;
use uuid::Uuid;

use stickslip_wire::{ContactOrder, SessionSummary};

use jobs::StoredJob;

use super::job_store::ChunkQueue;
use super::{
    CONTACT_BYTES, Changes, EXPIRED_LIFETIME, Extent, LabelChange, Page, RECEIPT_LIFETIME, RECORD_BYTES, Receipt,
    Record, Result, Session, Snapshot, Store, StoreError, Tenant, Usage,
};

/// Sessions that a list looks at before others have their turn.
const SEARCHED: usize = 1_000;
/// Bytes of replies kept for retries. Beyond that the oldest are deleted early, because memory is bounded.
const RECEIPT_BYTES: u64 = 256 * 1024 * 1024;
/// Expired sessions that are remembered, of some hundred bytes each. Beyond that the oldest are forgotten early.
const EXPIRED_MARKS: usize = 100_000;

/// Sessions in a map.
#[derive(Default)]
pub struct MemoryStore {
    // Locked for a lookup, a push or a page of copies, never across an await. No call can panic between its first and
    // its last change, so that what a panic leaves is consistent.
    inner: Mutex<Inner>,
    queue: ChunkQueue,
    changes: Changes,
}

#[derive(Default)]
struct Inner {
    sessions: BTreeMap<Uuid, Stored>,
    receipts: Receipts,
    // Only what expired: a deleted session leaves nothing behind.
    expired: Expired,
    jobs: HashMap<Uuid, StoredJob>,
}

struct Stored {
    session: Session,
    // Bytes of its definition as JSON.
    definition: u64,
    // Forks share the moves until one of them moves on.
    moves: Arc<Vec<Record>>,
    snapshot: Option<Snapshot>,
}

#[derive(Default)]
struct Receipts {
    by_key: HashMap<String, Receipt>,
    // In the order of arrival, which is that of expiry.
    arrivals: VecDeque<(Instant, String)>,
    bytes: u64,
}

/// Sessions that have expired, with the time and the tenant, in the order of their expiry.
#[derive(Default)]
struct Expired(LinkedHashMap<Uuid, (Instant, Tenant)>);

impl Expired {
    fn purge(&mut self) {
        while let Some((_, (at, _))) = self.0.front()
            && (at.elapsed() >= EXPIRED_LIFETIME || self.0.len() > EXPIRED_MARKS)
        {
            self.0.pop_front();
        }
    }
}

impl MemoryStore {
    /// An empty store.
    pub fn new() -> MemoryStore {
        MemoryStore::default()
    }

    /// Makes a change, and keeps the receipt if that is done; refuses a receipt whose key is in use.
    fn change(&self, receipt: Option<Receipt>, work: impl FnOnce(&mut Inner) -> Result<()>) -> Result<()> {
        let mut inner = self.inner.lock();
        inner.receipts.check_free(receipt.as_ref())?;
        work(&mut inner)?;
        inner.receipts.insert(receipt);
        Ok(())
    }
}

impl Inner {
    /// Why the session was not found, if it was not.
    fn missing(&self, id: Uuid) -> StoreError {
        self.expired.0.get(&id).map_or(StoreError::NotFound, |(_, tenant)| StoreError::Expired(tenant.clone()))
    }

    fn get(&self, id: Uuid) -> Result<&Stored> {
        self.sessions.get(&id).ok_or_else(|| self.missing(id))
    }

    /// The session, which must be at a sequence.
    fn at(&mut self, id: Uuid, expected: u64) -> Result<&mut Stored> {
        let found = self.get(id)?.session.sequence;
        let stored = self.sessions.get_mut(&id).ok_or(StoreError::NotFound)?;
        if found == expected { Ok(stored) } else { Err(StoreError::Stale { found }) }
    }
}

impl Receipts {
    fn check_free(&mut self, receipt: Option<&Receipt>) -> Result<()> {
        self.purge();
        match receipt {
            Some(receipt) if self.by_key.contains_key(&receipt.request.key) => Err(StoreError::KeyTaken),
            _ => Ok(()),
        }
    }

    fn insert(&mut self, receipt: Option<Receipt>) {
        if let Some(receipt) = receipt {
            self.bytes += receipt.bytes();
            self.arrivals.push_back((Instant::now(), receipt.request.key.clone()));
            self.by_key.insert(receipt.request.key.clone(), receipt);
            self.purge();
        }
    }

    fn purge(&mut self) {
        while let Some((arrival, key)) = self.arrivals.front() {
            if arrival.elapsed() < RECEIPT_LIFETIME && self.bytes <= RECEIPT_BYTES {
                break;
            }
            if let Some(receipt) = self.by_key.remove(key) {
                self.bytes -= receipt.bytes();
            }
            self.arrivals.pop_front();
        }
    }
}

fn summary(session: &Session) -> SessionSummary {
    let Session { id, ref label, sequence, created_at, updated_at, .. } = *session;
    SessionSummary { id, label: label.clone(), sequence, created_at, updated_at }
}

#[async_trait]
impl Store for MemoryStore {
    async fn ready(&self) -> Result<()> {
        Ok(())
    }

    async fn create(&self, session: Session, receipt: Option<Receipt>) -> Result<()> {
        let definition = serde_json::to_vec(&*session.definition).map_or(0, |text| text.len() as u64);
        self.change(receipt, |inner| {
            inner.sessions.insert(session.id, Stored { session, definition, moves: Arc::default(), snapshot: None });
            Ok(())
        })
    }

    async fn extent(&self, id: Uuid) -> Result<Extent> {
        // What is in memory already is not read again: the definition is shared.
        self.inner.lock().get(id).map(|Stored { session, snapshot, .. }| Extent {
            tenant: session.tenant.clone(),
            sequence: session.sequence,
            label: session.label.clone(),
            definition: 0,
            snapshot: snapshot.as_ref().map_or(0, |snapshot| snapshot.state.len() as u64),
        })
    }

    async fn usage(&self, tenant: &Tenant) -> Result<Usage> {
        let inner = self.inner.lock();
        let own = inner.sessions.values().filter(|stored| stored.session.tenant == *tenant);
        let usage = own.fold(Usage::default(), |Usage { contacts, bytes }, stored| {
            let snapshot = stored.snapshot.as_ref().map_or(0, |snapshot| snapshot.state.len() as u64);
            let moves = stored.session.sequence * self.move_bytes();
            Usage { contacts: contacts + 1, bytes: bytes + CONTACT_BYTES + stored.definition + moves + snapshot }
        });
        let receipts = inner.receipts.by_key.values().filter(|receipt| receipt.request.is_of(tenant));
        Ok(Usage { bytes: usage.bytes + receipts.map(Receipt::bytes).sum::<u64>(), ..usage })
    }

    fn move_bytes(&self) -> u64 {
        RECORD_BYTES as u64
    }

    async fn find(&self, id: Uuid) -> Result<Session> {
        self.inner.lock().get(id).map(|stored| stored.session.clone())
    }

    async fn list(&self, tenant: Option<Tenant>, label: Option<String>, page: Page) -> Result<Vec<SessionSummary>> {
        let wanted = label.map(|label| label.to_ascii_lowercase());
        let is_wanted = |session: &Session| {
            tenant.as_ref().is_none_or(|tenant| session.tenant == *tenant)
                && wanted.as_ref().is_none_or(|wanted| {
                    session.label.as_ref().is_some_and(|label| label.to_ascii_lowercase().contains(wanted))
                })
        };
        let (mut found, mut after) = (Vec::new(), page.after);
        loop {
            let seen = {
                let inner = self.inner.lock();
                let beyond = after.map_or(Unbounded, Excluded);
                let rest: Box<dyn Iterator<Item = &Stored>> = match page.order {
                    ContactOrder::Oldest => Box::new(inner.sessions.range((beyond, Unbounded)).map(|(_, it)| it)),
                    ContactOrder::Newest => Box::new(inner.sessions.range((Unbounded, beyond)).rev().map(|(_, it)| it)),
                };
                let mut seen = 0;
                for stored in rest.take(SEARCHED) {
                    if found.len() == page.limit {
                        return Ok(found);
                    }
                    (seen, after) = (seen + 1, Some(stored.session.id));
                    if is_wanted(&stored.session) {
                        found.push(summary(&stored.session));
                    }
                }
                seen
            };
            if seen < SEARCHED {
                return Ok(found);
            }
            // Others have the sessions, and the thread, between two parts of a long search.
            tokio::task::yield_now().await;
        }
    }

    async fn rename(&self, id: Uuid, label: LabelChange, expected: u64, receipt: Option<Receipt>) -> Result<()> {
        self.change(receipt, |inner| {
            let session = &mut inner.at(id, expected)?.session;
            if session.label != label.from {
                return Err(StoreError::Stale { found: expected });
            }
            session.label = label.to;
            Ok(())
        })
    }

    async fn append(&self, id: Uuid, expected: u64, records: Vec<Record>, receipt: Option<Receipt>) -> Result<()> {
        self.change(receipt, |inner| {
            let stored = inner.at(id, expected)?;
            if let Some(last) = records.last() {
                stored.session.sequence = last.sequence;
                stored.session.updated_at = last.at;
            }
            Arc::make_mut(&mut stored.moves).extend(records);
            Ok(())
        })?;
        self.changes.wake(id);
        Ok(())
    }

    async fn history(&self, id: Uuid, after: u64, limit: usize) -> Result<Vec<Record>> {
        // Copied under the lock: moves that are shared would have to be copied whole by the next append.
        self.inner.lock().get(id).map(|stored| {
            // Sequences count from 1, so that the sequence of the last move seen is the index of the next one.
            let start = usize::try_from(after).unwrap_or(usize::MAX).min(stored.moves.len());
            stored.moves[start..].iter().take(limit).cloned().collect()
        })
    }

    async fn count_moves(&self, id: Uuid, end: u64) -> Result<u64> {
        self.inner.lock().get(id).map(|stored| end.min(stored.moves.len() as u64))
    }

    async fn fork(&self, id: Uuid, copy: Session, receipt: Option<Receipt>) -> Result<()> {
        self.change(receipt, |inner| {
            let Stored { session, definition, moves, snapshot } = inner.get(id)?;
            let (found, definition) = (session.sequence, *definition);
            if found < copy.sequence {
                return Err(StoreError::Stale { found });
            }
            let count = usize::try_from(copy.sequence).unwrap_or(usize::MAX);
            // All of the past is shared until one of the two moves on; a part of it is a copy.
            let moves = if count == moves.len() { Arc::clone(moves) } else { Arc::new(moves[..count].to_vec()) };
            let snapshot = snapshot.clone().filter(|snapshot| snapshot.sequence <= copy.sequence);
            inner.sessions.insert(copy.id, Stored { session: copy, definition, moves, snapshot });
            Ok(())
        })
    }

    async fn delete(&self, id: Uuid, expected: u64) -> Result<()> {
        {
            let mut inner = self.inner.lock();
            inner.at(id, expected)?;
            inner.sessions.remove(&id);
        }
        self.changes.wake(id);
        Ok(())
    }

    async fn keep(&self, receipt: Receipt) -> Result<()> {
        self.change(Some(receipt), |_| Ok(()))
    }

    async fn receipt(&self, key: &str) -> Result<Option<Receipt>> {
        let mut inner = self.inner.lock();
        inner.receipts.purge();
        Ok(inner.receipts.by_key.get(key).cloned())
    }

    async fn snapshot(&self, id: Uuid) -> Result<Option<Snapshot>> {
        self.inner.lock().get(id).map(|stored| stored.snapshot.clone())
    }

    async fn save_snapshot(&self, id: Uuid, snapshot: Snapshot, unreadable: Option<u64>) -> Result<()> {
        if let Some(stored) = self.inner.lock().sessions.get_mut(&id)
            && stored
                .snapshot
                .as_ref()
                .map(|other| other.sequence)
                .is_none_or(|other| other < snapshot.sequence || Some(other) == unreadable)
        {
            stored.snapshot = Some(snapshot);
        }
        Ok(())
    }

    async fn purge_expired(&self, idle_since: Option<Timestamp>) -> Result<u64> {
        self.purge_jobs();
        let mut inner = self.inner.lock();
        inner.receipts.purge();
        inner.expired.purge();
        let Some(since) = idle_since else { return Ok(0) };
        let idle = inner.sessions.values().filter(|stored| stored.session.updated_at < since);
        let idle: Vec<Uuid> = idle.map(|stored| stored.session.id).collect();
        for id in &idle {
            if let Some(stored) = inner.sessions.remove(id) {
                inner.expired.0.insert(*id, (Instant::now(), stored.session.tenant));
            }
            self.changes.wake(*id);
        }
        inner.expired.purge();
        Ok(idle.len() as u64)
    }

    fn changes(&self) -> &Changes {
        &self.changes
    }
}

#[cfg(test)]
mod tests {
    use super::{EXPIRED_MARKS, Expired, RECEIPT_BYTES, Receipts};
    use crate::store::{EXPIRED_LIFETIME, Receipt, Reply, RequestKey, Tenant};
    use std::time::Instant;
    use uuid::Uuid;

    fn receipt(key: &str, bytes: usize) -> Receipt {
        let request = RequestKey { key: key.to_owned(), fingerprint: [0; 32] };
        Receipt { request, reply: Reply { created: None, sequence: 1, body: vec![0; bytes] } }
    }

    #[test]
    fn old_receipts_make_room_for_new_ones() {
        let mut receipts = Receipts::default();
        for key in ["a", "b", "c"] {
            receipts.insert(Some(receipt(key, RECEIPT_BYTES as usize / 3)));
        }
        assert!(!receipts.by_key.contains_key("a"));
        assert!(receipts.check_free(Some(&receipt("c", 0))).is_err() && receipts.bytes <= RECEIPT_BYTES);
        assert_eq!(receipts.arrivals.len(), receipts.by_key.len());
    }

    #[test]
    fn what_expired_long_ago_and_more_than_fits_is_forgotten() {
        let (mut expired, now) = (Expired::default(), Instant::now());
        let ids: Vec<Uuid> = (0..EXPIRED_MARKS as u128 + 2).map(Uuid::from_u128).collect();
        let mut insert = |id: Uuid, at| drop(expired.0.insert(id, (at, Tenant::default())));
        // Where the clock of the machine is younger than that, only the number counts.
        insert(ids[0], now.checked_sub(EXPIRED_LIFETIME).unwrap_or(now));
        ids[1..].iter().for_each(|id| insert(*id, now));
        expired.purge();
        assert_eq!(expired.0.keys().copied().collect::<Vec<_>>(), ids[2..]);
    }
}
