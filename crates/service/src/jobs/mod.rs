//! Sweeps, answered at once or run as jobs that continue after their request has been answered.
//!
//! A job is done in chunks whose results are stored as they come, so that a process which is killed loses the chunks
//! under way and no others, and any process on the same store continues with the rest. Jobs take turns, chunk by chunk.
//! The jobs of a tenant are bounded in number, bytes and work.

mod error;
mod events;
mod work;

use std::ops::Range;
use std::sync::Arc;
use std::time::Duration;

use jiff::Timestamp;
use prometheus::{IntCounter, IntGauge};
use tokio::sync::Notify;
use uuid::Uuid;

use crate::admission::{Deadline, INLINE, Kind, Pool};
use crate::metrics::metrics;
use crate::store::job_store::JOB_LIFETIME;
use crate::store::{IdempotentRequest, Job, JobLimits, Listeners, Reply, RequestKey, Store, StoreError, Tenant};
use stickslip_compute::Nanoseconds;
use stickslip_compute::documents::Parse as _;
use stickslip_compute::simulation::cost::MARGIN;
use stickslip_compute::simulation::{Sweep, SweepResult};
use stickslip_wire::sweep::CheckedSweep;
use stickslip_wire::{JobList, JobProgress, JobReply, JobState, SweepRequest};

pub use error::JobError;

/// Clients that may follow jobs at a time.
pub const STREAMS: usize = 250;
/// A sweep of more work than this becomes a job.
pub const AT_ONCE: Nanoseconds = 1_000_000_000;
/// The limits of the jobs of a tenant.
pub const LIMITS: JobLimits = JobLimits { jobs: 50, bytes: 512 * 1024 * 1024, cost: 48 * HOUR };
/// The largest cost of one job.
pub const LARGEST_JOB: Nanoseconds = 12 * HOUR;
/// How long a process may be silent before others claim its chunks.
pub const LEASE: Duration = Duration::from_secs(30);

const HOUR: Nanoseconds = 3_600_000_000_000;
/// Bytes of a number in a result, stored or in memory.
const NUMBER_BYTES: usize = 8;
/// Bytes of a job besides its request and its result.
const JOB_BYTES: usize = 4_096;
/// Chunks that are read from the store at a time.
const CHUNKS_AT_ONCE: usize = 16;

/// The jobs of a tenant. Clones, and those of other tenants, are handles on the same.
#[derive(Clone)]
pub struct Jobs {
    tenant: Tenant,
    common: Arc<Common>,
}

struct Common {
    store: Arc<dyn Store>,
    pool: Pool,
    // Wakes the workers of this process: there is a new job.
    new: Notify,
    // The name of this process in its claims.
    owner: Uuid,
    // Clients that follow jobs; when they end, the work on jobs ends too.
    listeners: Listeners,
    meters: JobMeters,
}

metrics! {
    /// Metrics of the sweeps that this process has computed since its start. Points without an answer count too.
    pub struct JobMeters {
        /// Points of sweeps computed by this process, at once or for jobs.
        points: IntCounter = counter("stickslip_sweep_points_total"),
        /// Chunks of jobs that this process has computed and stored.
        chunks: IntCounter = counter("stickslip_job_chunks_total"),
        /// Chunks that this process released unfinished.
        returned: IntCounter = counter("stickslip_job_chunks_returned_total"),
        /// Jobs that failed in this process; the log says why.
        failed: IntCounter = counter("stickslip_jobs_failed_total"),
        /// Chunks under way in this process.
        running: IntGauge = gauge("stickslip_job_chunks_running"),
    }
}

impl Jobs {
    /// Jobs in a store, of the tenant without a name.
    pub fn new(store: Arc<dyn Store>, pool: Pool) -> Jobs {
        let common = Common {
            store,
            pool,
            new: Notify::new(),
            owner: Uuid::now_v7(),
            listeners: Listeners::new(STREAMS),
            meters: JobMeters::default(),
        };
        Jobs { tenant: Tenant::default(), common: Arc::new(common) }
    }

    /// The jobs of another tenant.
    pub fn for_tenant(&self, tenant: Tenant) -> Jobs {
        Jobs { tenant, common: Arc::clone(&self.common) }
    }

    /// Computes a sweep at once.
    ///
    /// # Errors
    /// [`JobError::Failure`] if it was stopped or took too long.
    pub async fn at_once(&self, sweep: &Arc<Sweep>, stop: &Deadline) -> Result<SweepResult, JobError> {
        let kind = Kind::of(sweep.cost());
        let rows = self.compute(sweep, 0..sweep.points(), (kind, stop), None).await?;
        self.common.meters.points.inc_by(sweep.points() as u64);
        Ok(rows)
    }

    /// Computes points slice by slice, on the threads that are free for each. A point may take as long as `allowed`, or
    /// as `stop` permits.
    async fn compute(
        &self,
        sweep: &Arc<Sweep>,
        points: Range<usize>,
        (kind, stop): (Kind, &Deadline),
        allowed: Option<Duration>,
    ) -> Result<SweepResult, JobError> {
        let (mut result, mut next) = (SweepResult::default(), points.start);
        while next < points.end {
            let (sweep, stop, rest) = (Arc::clone(sweep), stop.clone(), next..points.end);
            let work =
                move |slots| sweep.slice(rest, slots, &stop, allowed).map(|slice| (sweep.points_of(&slice), slice));
            let (done, slice) = self.common.pool.share(kind, work).await??;
            next += done;
            result.append(slice);
        }
        Ok(result)
    }

    /// The metrics of this process, for all tenants.
    pub fn meters(&self) -> &JobMeters {
        &self.common.meters
    }

    /// Makes a job of a sweep. The reply describes the new job.
    ///
    /// # Errors
    /// [`JobError`]; no job has been made then.
    pub async fn start(&self, sweep: &Sweep, key: Option<RequestKey>) -> Result<Reply, JobError> {
        let idempotent = IdempotentRequest::new(&*self.common.store, &self.tenant, key);
        if let Some(reply) = idempotent.earlier_reply().await? {
            return Ok(reply);
        }
        let (whole, each) = (Duration::from_nanos(sweep.cost()), Duration::from_nanos(sweep.cost_per_point()));
        let (most, deadline) = (Duration::from_nanos(LARGEST_JOB), self.common.pool.capacity().deadline);
        if each > deadline.saturating_mul(MARGIN) {
            return Err(JobError::LongPoint { wanted: each.as_secs(), allowed: deadline.as_secs() });
        }
        if whole > most {
            let each = each.as_secs_f64();
            return Err(JobError::TooMuch { wanted: whole.as_secs(), each, allowed: most.as_secs() });
        }
        let request =
            serde_json::to_string(&sweep.checked().request).map_err(|error| JobError::Broken(error.to_string()))?;
        let bytes = request.len() + sweep.numbers(sweep.points()) * NUMBER_BYTES + JOB_BYTES;
        let job = Job {
            id: Uuid::now_v7(),
            tenant: self.tenant.clone(),
            created_at: Timestamp::now(),
            finished_at: None,
            error: None,
            points: sweep.points() as u64,
            chunk: sweep.chunk() as u64,
            done: 0,
            failed: 0,
            bytes: bytes as u64,
            cost: sweep.cost(),
        };
        let wanted = job.clone();
        let body = serde_json::to_vec(&job_reply(&job)).map_err(|error| JobError::Broken(error.to_string()))?;
        let reply = Reply { created: Some(job.id), sequence: 0, body };
        if let Err(error) = self.common.store.create_job(job, request, LIMITS, idempotent.receipt(&reply)).await {
            return match idempotent.after_refusal(error).await {
                Err(StoreError::TooManyJobs(why)) => {
                    let retry_after = self.time_to_room(&wanted).await?;
                    Err(JobError::TooMany { why, retry_after })
                }
                answer => Ok(answer?),
            };
        }
        // Without it, as after a client that has hung up, the workers find the job within a second.
        self.common.new.notify_waiters();
        Ok(reply)
    }

    /// How long it may take until there is room for another job, if none is deleted.
    async fn time_to_room(&self, wanted: &Job) -> Result<Duration, JobError> {
        let (jobs, now) = (self.common.store.jobs(self.tenant.clone()).await?, Timestamp::now());
        let bytes: u64 = jobs.iter().map(|job| job.bytes).sum();
        let time = if jobs.len() as u64 >= LIMITS.jobs || bytes + wanted.bytes > LIMITS.bytes {
            // One that has ended keeps its place until it is deleted.
            let ended = jobs.iter().filter(|job| job.finished_at.is_some());
            let first = ended.map(Job::expires_at).min();
            first.map(|first| Duration::try_from(first.duration_since(now)).unwrap_or_default())
        } else {
            // One that ends has no more work.
            let left = |job: &Job| job.cost / job.points.max(1) * (job.points - job.done);
            let first = jobs.iter().filter(|job| job.finished_at.is_none()).map(left).min();
            first.map(|work| Duration::from_nanos(work / self.common.pool.capacity().threads.max(1) as u64))
        };
        Ok(time.unwrap_or(JOB_LIFETIME).max(Duration::from_secs(1)))
    }

    /// The jobs in this state, or all, oldest first.
    ///
    /// # Errors
    /// A failure of the store.
    pub async fn list(&self, state: Option<JobState>) -> Result<JobList, JobError> {
        let jobs = self.common.store.jobs(self.tenant.clone()).await?;
        let wanted = |job: &JobReply| state.is_none_or(|state| job.state == state);
        Ok(JobList { items: jobs.iter().map(job_reply).filter(wanted).collect() })
    }

    async fn find_own(&self, id: Uuid) -> Result<Job, JobError> {
        let job = self.common.store.job(id).await.map_err(store_error(id))?;
        if job.tenant == self.tenant { Ok(job) } else { Err(JobError::NotFound(id)) }
    }

    /// The progress of a job.
    ///
    /// # Errors
    /// [`JobError::NotFound`], or a failure of the store.
    pub async fn get(&self, id: Uuid) -> Result<JobReply, JobError> {
        self.find_own(id).await.map(|job| job_reply(&job))
    }

    /// Bytes that the result of a job takes in memory.
    ///
    /// # Errors
    /// [`JobError::NotFound`], [`JobError::Unfinished`], [`JobError::Failed`], or a failure of the store.
    pub async fn size(&self, id: Uuid) -> Result<usize, JobError> {
        let job = self.find_own(id).await?;
        match (job.finished_at, job.error) {
            (_, Some(error)) => Err(JobError::Failed(error)),
            (None, None) => Err(JobError::Unfinished { done: job.done, points: job.points }),
            (Some(_), None) => Ok(usize::try_from(2 * job.bytes).unwrap_or(usize::MAX)),
        }
    }

    /// The request and the result of a job.
    ///
    /// # Errors
    /// As [`Jobs::size`].
    pub async fn result(&self, id: Uuid) -> Result<(CheckedSweep, SweepResult), JobError> {
        self.size(id).await?;
        let job = self.find_own(id).await?;
        let request = self.common.store.job_request(id).await.map_err(store_error(id))?;
        let read = move || SweepRequest::read(request.as_bytes());
        let draft = self.common.pool.run(INLINE, read).await?;
        let draft = draft.map_err(|error| JobError::Broken(format!("a job cannot be read: {error}")))?;
        let (mut rows, mut next) = (SweepResult::default(), 0);
        while next < job.chunks() {
            let chunks = self.common.store.chunks(id, next, CHUNKS_AT_ONCE).await.map_err(store_error(id))?;
            if chunks.is_empty() {
                // Deleted meanwhile, or else incomplete.
                self.find_own(id).await?;
                return Err(JobError::Broken(format!("chunk {next} of job {id} is missing")));
            }
            for content in chunks {
                let points = job.chunk.min(job.points - next * job.chunk);
                let numbers = usize::try_from(points).unwrap_or(usize::MAX).saturating_mul(draft.outputs.len());
                let read = SweepResult::from_bytes(&content, numbers);
                rows.append(read.ok_or_else(|| JobError::Broken(format!("chunk {next} of job {id} cannot be read")))?);
                next += 1;
            }
        }
        Ok((draft, rows))
    }

    /// Ends a job and deletes it.
    ///
    /// # Errors
    /// [`JobError::NotFound`], or a failure of the store.
    pub async fn delete(&self, id: Uuid) -> Result<(), JobError> {
        self.find_own(id).await?;
        self.common.store.delete_job(id).await.map_err(store_error(id))
    }
}

fn store_error(id: Uuid) -> impl Fn(StoreError) -> JobError {
    move |error| match error {
        StoreError::NotFound => JobError::NotFound(id),
        other => JobError::Store(other),
    }
}

fn job_reply(job: &Job) -> JobReply {
    let state = match (job.finished_at, &job.error) {
        (_, Some(_)) => JobState::Failed,
        (Some(_), None) => JobState::Done,
        (None, None) => JobState::Running,
    };
    JobReply {
        id: job.id,
        state,
        progress: JobProgress { points: job.points, done: job.done, failed: job.failed },
        point_time: Duration::from_nanos(job.cost / job.points.max(1)).as_secs_f64(),
        created_at: job.created_at,
        finished_at: job.finished_at,
        expires_at: job.expires_at(),
        detail: job.error.clone(),
        result: format!("/jobs/{}/result", job.id),
    }
}
