//! Jobs in the process.

use std::collections::{BTreeMap, HashMap};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use jiff::Timestamp;
use uuid::Uuid;

use super::super::jobs::{Board, ChunkResult, Claim, Job, JobLimits, JobStore};
use super::super::{Answer, Receipt, StoreError};
use super::{MemoryStore, answer};

/// Jobs in a map.
#[derive(Default)]
pub(super) struct Jobs {
    // A std mutex: held for a lookup or the copy of a few chunks, never across an await.
    kept: Mutex<HashMap<Uuid, Kept>>,
    board: Board,
}

struct Kept {
    job: Job,
    request: String,
    chunks: BTreeMap<u64, Vec<u8>>,
}

impl Jobs {
    fn lock(&self) -> MutexGuard<'_, HashMap<Uuid, Kept>> {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Deletes the jobs whose time is over.
    pub(super) fn sweep(&self) {
        let now = Timestamp::now();
        self.lock().retain(|id, kept| {
            let stays = kept.job.expires_at() > now;
            if !stays {
                self.board.close(*id);
            }
            stays
        });
    }

    fn with<T>(&self, id: Uuid, look: impl FnOnce(&mut Kept) -> T) -> Result<T, StoreError> {
        self.lock().get_mut(&id).map(look).ok_or(StoreError::NotFound)
    }
}

impl JobStore for MemoryStore {
    fn create_job(&self, job: Job, request: String, limits: JobLimits, receipt: Option<Receipt>) -> Answer<'_, ()> {
        let create = || {
            let mut inner = self.lock();
            inner.receipts.free(receipt.as_ref())?;
            let mut kept = self.jobs.lock();
            let (mut jobs, mut bytes, mut cost) = (0, 0, 0);
            for other in kept.values().map(|kept| &kept.job).filter(|other| other.tenant == job.tenant) {
                jobs += 1;
                bytes += other.bytes;
                cost += if other.finished_at.is_none() { other.cost } else { 0 };
            }
            limits.admit(jobs, bytes, cost, &job)?;
            let (id, chunks) = (job.id, job.chunks());
            kept.insert(id, Kept { job, request, chunks: BTreeMap::new() });
            self.jobs.board.open(id, 0..chunks);
            inner.receipts.keep(receipt);
            Ok(())
        };
        answer(create())
    }

    fn job(&self, id: Uuid) -> Answer<'_, Job> {
        answer(self.jobs.with(id, |kept| kept.job.clone()))
    }

    fn job_request(&self, id: Uuid) -> Answer<'_, String> {
        answer(self.jobs.with(id, |kept| kept.request.clone()))
    }

    fn claim(&self, owner: Uuid, after: Option<Uuid>, _: Duration) -> Answer<'_, Option<Claim>> {
        answer(Ok(self.jobs.board.claim(owner, after)))
    }

    fn renew(&self, claim: Claim, _: Duration) -> Answer<'_, bool> {
        answer(Ok(self.jobs.board.holds(claim)))
    }

    fn release(&self, claim: Claim) -> Answer<'_, ()> {
        self.jobs.board.release(claim);
        answer(Ok(()))
    }

    fn keep_chunk(&self, claim: Claim, result: ChunkResult) -> Answer<'_, ()> {
        let done = self.jobs.with(claim.job, |Kept { job, chunks, .. }| {
            if job.finished_at.is_none() && !chunks.contains_key(&claim.chunk) {
                job.done += result.points;
                job.failed += result.failed;
                chunks.insert(claim.chunk, result.content);
                if job.done == job.points {
                    job.finished_at = Some(Timestamp::now());
                }
            }
        });
        self.jobs.board.done(claim);
        self.changes.wake(claim.job);
        answer(done)
    }

    fn fail_job(&self, id: Uuid, error: String) -> Answer<'_, ()> {
        let failed = self.jobs.with(id, |kept| {
            if kept.job.finished_at.is_none() {
                kept.job.finished_at = Some(Timestamp::now());
                kept.job.error = Some(error);
            }
        });
        self.jobs.board.close(id);
        self.changes.wake(id);
        answer(failed)
    }

    fn chunks(&self, id: Uuid, first: u64, limit: usize) -> Answer<'_, Vec<Vec<u8>>> {
        answer(
            self.jobs.with(id, |kept| kept.chunks.range(first..).take(limit).map(|(_, kept)| kept.clone()).collect()),
        )
    }

    fn delete_job(&self, id: Uuid) -> Answer<'_, ()> {
        let deleted = self.jobs.lock().remove(&id).map(drop).ok_or(StoreError::NotFound);
        self.jobs.board.close(id);
        self.changes.wake(id);
        answer(deleted)
    }
}
