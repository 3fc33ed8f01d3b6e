//! Jobs in the process.

use std::collections::BTreeMap;
use std::time::Duration;

use async_trait::async_trait;
use jiff::Timestamp;
use uuid::Uuid;

use super::MemoryStore;
use crate::store::job_store::{ChunkResult, Claim, Job, JobLimits, JobStore};
use crate::store::{Receipt, Result, StoreError, Tenant};

pub(super) struct StoredJob {
    job: Job,
    request: String,
    chunks: BTreeMap<u64, Vec<u8>>,
}

impl MemoryStore {
    pub(super) fn purge_jobs(&self) {
        let now = Timestamp::now();
        self.inner.lock().jobs.retain(|id, stored| {
            let stays = stored.job.expires_at() > now;
            if !stays {
                self.queue.remove_job(*id);
            }
            stays
        });
    }

    fn with_job<T>(&self, id: Uuid, look: impl FnOnce(&mut StoredJob) -> T) -> Result<T> {
        self.inner.lock().jobs.get_mut(&id).map(look).ok_or(StoreError::NotFound)
    }
}

#[async_trait]
impl JobStore for MemoryStore {
    async fn create_job(&self, job: Job, request: String, limits: JobLimits, receipt: Option<Receipt>) -> Result<()> {
        self.change(receipt, |inner| {
            let (mut jobs, mut bytes, mut cost) = (0, 0, 0);
            for other in inner.jobs.values().map(|stored| &stored.job).filter(|other| other.tenant == job.tenant) {
                jobs += 1;
                bytes += other.bytes;
                cost += if other.finished_at.is_none() { other.cost } else { 0 };
            }
            limits.check(jobs, bytes, cost, &job)?;
            let (id, chunks) = (job.id, job.chunks());
            inner.jobs.insert(id, StoredJob { job, request, chunks: BTreeMap::new() });
            self.queue.add_job(id, 0..chunks);
            Ok(())
        })
    }

    async fn job(&self, id: Uuid) -> Result<Job> {
        self.with_job(id, |stored| stored.job.clone())
    }

    async fn jobs(&self, tenant: Tenant) -> Result<Vec<Job>> {
        let inner = self.inner.lock();
        let own = inner.jobs.values().map(|stored| &stored.job).filter(|job| job.tenant == tenant);
        let mut own: Vec<Job> = own.cloned().collect();
        own.sort_by_key(|job| job.id);
        Ok(own)
    }

    async fn job_request(&self, id: Uuid) -> Result<String> {
        self.with_job(id, |stored| stored.request.clone())
    }

    async fn claim(&self, owner: Uuid, after: Option<Uuid>, _: Duration) -> Result<Option<Claim>> {
        Ok(self.queue.claim(owner, after))
    }

    async fn renew(&self, claim: Claim, _: Duration) -> Result<bool> {
        Ok(self.queue.is_claimed(claim))
    }

    async fn release(&self, claim: Claim) -> Result<()> {
        self.queue.release(claim);
        Ok(())
    }

    async fn save_chunk(&self, claim: Claim, result: ChunkResult) -> Result<()> {
        let saved = self.with_job(claim.job, |StoredJob { job, chunks, .. }| {
            if job.finished_at.is_none() && !chunks.contains_key(&claim.chunk) {
                job.done += result.points;
                job.failed += result.failed;
                chunks.insert(claim.chunk, result.content);
                if job.done == job.points {
                    job.finished_at = Some(Timestamp::now());
                }
            }
        });
        self.queue.finish(claim);
        self.changes.wake(claim.job);
        saved
    }

    async fn fail_job(&self, id: Uuid, error: String) -> Result<()> {
        let failed = self.with_job(id, |StoredJob { job, .. }| {
            if job.finished_at.is_none() {
                job.finished_at = Some(Timestamp::now());
                job.error = Some(error);
            }
        });
        self.queue.remove_job(id);
        self.changes.wake(id);
        failed
    }

    async fn chunks(&self, id: Uuid, first: u64, limit: usize) -> Result<Vec<Vec<u8>>> {
        self.with_job(id, |stored| stored.chunks.range(first..).take(limit).map(|(_, chunk)| chunk.clone()).collect())
    }

    async fn delete_job(&self, id: Uuid) -> Result<()> {
        let deleted = self.inner.lock().jobs.remove(&id).map(drop).ok_or(StoreError::NotFound);
        self.queue.remove_job(id);
        self.changes.wake(id);
        deleted
    }
}
