//! Working on jobs: claim a chunk, compute it, store it, again and again.

use std::ops::Range;
use std::panic::AssertUnwindSafe;
use std::sync::Arc;
use std::time::Duration;

use futures::FutureExt as _;
use uuid::Uuid;

use crate::admission::{Client, Deadline, INLINE, Kind, PoolError};
use crate::metrics::Counted;
use crate::store::{ChunkResult, Claim, Job, StoreError, Tenant};
use stickslip_compute::documents::Parse as _;
use stickslip_compute::simulation::bytes::NUMBER;
use stickslip_compute::simulation::{Sweep, SweepResult};
use stickslip_wire::{PrepareAnew, SweepRequest};

use super::{JobError, Jobs, store_error};

/// Chunks that a process works on at a time: while one is being stored, the threads compute the other.
const CHUNKS_AT_A_TIME: usize = 2;
/// How long to wait if there is no work, or if the store or the pool refuses.
const PAUSE: Duration = Duration::from_secs(1);
/// How often a claim is renewed within a lease.
const RENEWALS: u32 = 3;
/// How often a result is sent to a store that refuses it for now.
const SAVE_ATTEMPTS: usize = 30;

/// The job whose chunks are being computed.
type OpenJob = Option<(Job, Arc<Sweep>)>;

impl Jobs {
    /// Works on the jobs of all tenants until [`Jobs::end`], and releases unfinished chunks then. The chunks of a
    /// process whose lease has run out are claimed by others.
    pub async fn work(self, lease: Duration) {
        futures::future::join_all((0..CHUNKS_AT_A_TIME).map(|_| self.clone().work_on_chunks(lease))).await;
    }

    /// Goes on after a panic, as where the system refuses a thread to the runtime.
    async fn work_on_chunks(self, lease: Duration) {
        while AssertUnwindSafe(self.claim_chunks(lease)).catch_unwind().await.is_err() {
            tracing::error!("work on jobs has panicked, and begins again");
            tokio::time::sleep(PAUSE).await;
        }
    }

    async fn claim_chunks(&self, lease: Duration) {
        let (mut last, mut known) = (None, None);
        let mut ending = self.common.listeners.ending();
        while !*ending.borrow() {
            let new = self.common.new.notified();
            match self.common.store.claim(self.common.owner, last, lease).await {
                Ok(Some(claim)) => {
                    last = Some(claim.job);
                    self.compute_or_release(claim, &mut known, lease).await;
                }
                Ok(None) => {
                    known = None;
                    tokio::select! {
                        () = new => {}
                        _ = ending.changed() => {}
                        () = tokio::time::sleep(PAUSE) => {}
                    }
                }
                Err(error) => {
                    tracing::debug!(%error, "no chunk can be claimed for now");
                    tokio::time::sleep(PAUSE).await;
                }
            }
        }
    }

    async fn compute_or_release(&self, claim: Claim, known: &mut OpenJob, lease: Duration) {
        let meters = &self.common.meters;
        let running = Counted::by(&meters.running);
        let done = AssertUnwindSafe(self.chunk(claim, known, lease)).catch_unwind().await;
        drop(running);
        let error = match done {
            // The job has been deleted, or the claim has ended.
            Ok(Ok(()) | Err(JobError::NotFound(_))) => return,
            Ok(Err(error)) => error,
            // The runtime panics where the system refuses a thread, which it may give later.
            Err(_) => JobError::Pool(PoolError::Busy),
        };
        let permanent = match &error {
            JobError::Broken(why) | JobError::Store(StoreError::Failed(why)) => Some(why.clone()),
            JobError::Pool(PoolError::Panicked) => {
                Some("the solver has failed; the operator finds the cause in the log".to_owned())
            }
            _ => None,
        };
        let done = match permanent {
            Some(why) => {
                tracing::error!(job = %claim.job, chunk = claim.chunk, %error, "a job has failed");
                meters.failed.inc();
                self.common.store.fail_job(claim.job, why).await
            }
            None => {
                tracing::warn!(job = %claim.job, chunk = claim.chunk, %error, "a chunk is released, to be tried again");
                meters.returned.inc();
                self.common.store.release(claim).await
            }
        };
        if let Err(error) = done {
            tracing::warn!(job = %claim.job, %error, "a chunk stays claimed until its lease expires");
        }
        tokio::time::sleep(PAUSE).await;
    }

    async fn chunk(&self, claim: Claim, known: &mut OpenJob, lease: Duration) -> Result<(), JobError> {
        if known.as_ref().is_none_or(|(job, _)| job.id != claim.job) {
            *known = Some(self.open(claim.job).await?);
        }
        let Some((job, sweep)) = known else { return Ok(()) };
        let first = claim.chunk * job.chunk;
        let points = to_usize(first)..to_usize(job.points.min(first + job.chunk));
        let pool = &self.common.pool;
        let bytes = sweep.bytes(pool.capacity().threads) + NUMBER * sweep.numbers(points.len());
        let _held = pool.reserve(bytes).await?;
        let Some(rows) = self.rows(claim, sweep, points.clone(), (job.tenant.clone(), lease)).await? else {
            return self.common.store.release(claim).await.map_err(store_error(claim.job));
        };
        let count = points.len() as u64;
        self.common.meters.points.inc_by(count);
        let result = ChunkResult { points: count, failed: rows.failed, content: rows.to_bytes() };
        self.save(claim, result, lease).await?;
        self.common.meters.chunks.inc();
        Ok(())
    }

    async fn open(&self, id: Uuid) -> Result<(Job, Arc<Sweep>), JobError> {
        let job = self.common.store.job(id).await.map_err(store_error(id))?;
        let request = self.common.store.job_request(id).await.map_err(store_error(id))?;
        let read = move || SweepRequest::read(request.as_bytes());
        let checked = self.common.pool.run(INLINE, read).await?;
        let plan = |checked| async {
            let cost = Sweep::planning_cost(&checked);
            let plan = self.common.pool.run(cost, move || Sweep::plan(checked, &PrepareAnew));
            Client::Tenant(job.tenant.clone()).serve(plan).await
        };
        let sweep = match checked {
            Ok(checked) => plan(checked).await?,
            Err(rejection) => Err(rejection),
        };
        let sweep = sweep
            .map_err(|error| JobError::Broken(format!("this version does not accept the stored request: {error}")))?;
        Ok((job, Arc::new(sweep)))
    }

    /// Computes a chunk while the claim holds; nothing if the process is about to stop.
    async fn rows(
        &self,
        claim: Claim,
        sweep: &Arc<Sweep>,
        points: Range<usize>,
        (tenant, lease): (Tenant, Duration),
    ) -> Result<Option<SweepResult>, JobError> {
        let (stop, guard) = Deadline::unbounded();
        let mut guard = Some(guard);
        let pool = &self.common.pool;
        let allowed = Some(pool.capacity().deadline);
        let compute = self.compute(sweep, points, (Kind::Job, &stop), allowed);
        let mut rows = std::pin::pin!(Client::Tenant(tenant).serve(compute));
        let mut changed = self.common.store.changes().subscribe(claim.job);
        let mut ending = self.common.listeners.ending();
        loop {
            tokio::select! {
                rows = &mut rows => return match rows {
                    // The claim has ended, and the work with it.
                    Err(_) if guard.is_none() => Err(JobError::NotFound(claim.job)),
                    rows => rows.map(Some),
                },
                _ = ending.wait_for(|ending| *ending) => return Ok(None),
                _ = changed.changed() => {}
                () = tokio::time::sleep(lease / RENEWALS) => {}
            }
            // An unreachable store says nothing about the claim.
            if matches!(self.common.store.renew(claim, lease).await, Ok(false)) {
                drop(guard.take());
            }
        }
    }

    /// Stores the result of a chunk, as soon as the store takes it.
    async fn save(&self, claim: Claim, result: ChunkResult, lease: Duration) -> Result<(), JobError> {
        for _ in 0..SAVE_ATTEMPTS {
            match self.common.store.save_chunk(claim, result.clone()).await {
                Ok(()) => return Ok(()),
                Err(StoreError::Full(_) | StoreError::Unavailable(_) | StoreError::Locked(_)) => {
                    tokio::time::sleep(PAUSE).await;
                    // Fails while the store is unreachable.
                    let _ = self.common.store.renew(claim, lease).await;
                }
                Err(error) => return Err(store_error(claim.job)(error)),
            }
        }
        Err(JobError::Store(StoreError::Unavailable("the storage does not accept the result".to_owned())))
    }
}

fn to_usize(number: u64) -> usize {
    usize::try_from(number).unwrap_or(usize::MAX)
}
