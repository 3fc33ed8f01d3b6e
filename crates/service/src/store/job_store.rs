//! Jobs: work that continues after its request has been answered, in chunks whose results are stored as they complete.
//!
//! A store has the request of a job, the number of its points, and the number of points of a chunk. Chunks are
//! claimed by any worker, and a claim ends with its worker. The store does not read the bytes of a result.

use std::time::Duration;

use async_trait::async_trait;
use jiff::Timestamp;
use uuid::Uuid;

use super::{Receipt, Result, StoreError, Tenant};

/// How long a job that has ended is kept, with its result.
pub const JOB_LIFETIME: Duration = Duration::from_secs(24 * 60 * 60);
/// How long a job may take to end.
pub const JOB_TIME_LIMIT: Duration = Duration::from_secs(7 * 24 * 60 * 60);

/// A job as it is stored.
#[derive(Clone, Debug, PartialEq)]
pub struct Job {
    /// Its identifier.
    pub id: Uuid,
    /// Whose it is.
    pub tenant: Tenant,
    /// When it was requested.
    pub created_at: Timestamp,
    /// When it ended, well or not.
    pub finished_at: Option<Timestamp>,
    /// Why it failed, if it did.
    pub error: Option<String>,
    /// How many points it has.
    pub points: u64,
    /// How many of them go in a chunk; the last one may have fewer.
    pub chunk: u64,
    /// How many are done.
    pub done: u64,
    /// How many of these have no answer.
    pub failed: u64,
    /// Bytes that it takes to keep it, roughly.
    pub bytes: u64,
    /// Nanoseconds of work, roughly.
    pub cost: u64,
}

impl Job {
    /// How many chunks it has.
    pub fn chunks(&self) -> u64 {
        self.points.div_ceil(self.chunk.max(1))
    }

    /// When it is deleted.
    pub fn expires_at(&self) -> Timestamp {
        let (from, time) = match self.finished_at {
            Some(at) => (at, JOB_LIFETIME),
            None => (self.created_at, JOB_TIME_LIMIT),
        };
        from.checked_add(time).unwrap_or(Timestamp::MAX)
    }
}

/// The limits of the jobs of a tenant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct JobLimits {
    /// How many there may be, with those that have ended.
    pub jobs: u64,
    /// Bytes of all of them.
    pub bytes: u64,
    /// Nanoseconds of work of those that have not ended.
    pub cost: u64,
}

impl JobLimits {
    /// Checks whether a tenant with these jobs, bytes and remaining work may have another job.
    pub(super) fn check(&self, jobs: u64, bytes: u64, cost: u64, new: &Job) -> Result<()> {
        if jobs >= self.jobs {
            return Err(StoreError::TooManyJobs(format!("{jobs} jobs are stored, which is the limit")));
        }
        if bytes.saturating_add(new.bytes) > self.bytes {
            return Err(StoreError::TooManyJobs(format!("the results of all jobs may take {} bytes", self.bytes)));
        }
        if cost.saturating_add(new.cost) > self.cost {
            let allowed = Duration::from_nanos(self.cost).as_secs();
            return Err(StoreError::TooManyJobs(format!("the jobs that are not done may need {allowed} s of work")));
        }
        Ok(())
    }
}

/// A chunk of a job that a worker has claimed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Claim {
    /// The job.
    pub job: Uuid,
    /// The number of the chunk, from 0.
    pub chunk: u64,
    /// The process that works on it, by its random name.
    pub owner: Uuid,
}

/// The result of a chunk.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ChunkResult {
    /// How many points it has.
    pub points: u64,
    /// How many of them have no answer.
    pub failed: u64,
    /// The result itself.
    pub content: Vec<u8>,
}

/// Storage of jobs. As with sessions, the callers separate tenants.
#[async_trait]
pub trait JobStore: Send + Sync + 'static {
    /// Stores a new job with its request, and the receipt with it, if the limits of its tenant allow another job.
    async fn create_job(&self, job: Job, request: String, limits: JobLimits, receipt: Option<Receipt>) -> Result<()>;

    /// The job.
    async fn job(&self, id: Uuid) -> Result<Job>;

    /// The jobs of a tenant, oldest first.
    async fn jobs(&self, tenant: Tenant) -> Result<Vec<Job>>;

    /// The request that the job was made of.
    async fn job_request(&self, id: Uuid) -> Result<String>;

    /// Claims a chunk that is not claimed, of the first job with an identifier greater than `after` that has one, or
    /// else of the first of all. Where many processes share the storage the claim ends after `lease`, unless it is
    /// renewed.
    async fn claim(&self, owner: Uuid, after: Option<Uuid>, lease: Duration) -> Result<Option<Claim>>;

    /// Extends a claim by another `lease`; returns whether it still held.
    async fn renew(&self, claim: Claim, lease: Duration) -> Result<bool>;

    /// Releases a chunk.
    async fn release(&self, claim: Claim) -> Result<()>;

    /// Stores the result of a chunk. If two workers compute the same chunk the first result counts. With its last chunk
    /// the job ends.
    async fn save_chunk(&self, claim: Claim, result: ChunkResult) -> Result<()>;

    /// Ends a job that cannot be done.
    async fn fail_job(&self, id: Uuid, error: String) -> Result<()>;

    /// The results of at most `limit` chunks from the number `first` on, in order.
    async fn chunks(&self, id: Uuid, first: u64, limit: usize) -> Result<Vec<Vec<u8>>>;

    /// Deletes a job, whether it has ended or not.
    async fn delete_job(&self, id: Uuid) -> Result<()>;
}
