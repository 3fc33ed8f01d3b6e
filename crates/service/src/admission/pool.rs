//! The resources of the server and their permits: threads for the solver, permits for requests, bytes of memory.
//!
//! A request for resources that are in use waits for a bounded time in a queue of bounded length, and is then refused.
//! So the memory of requests is bounded too, however many arrive.

use std::any::Any;
use std::future::Future;
use std::pin::pin;
use std::sync::Arc;
use std::task::Poll;
use std::time::{Duration, Instant};

use prometheus::{Histogram, IntCounter, IntGauge};
use tokio::sync::{OwnedSemaphorePermit, Semaphore};
use tokio::task::spawn_blocking;
use tokio::time::timeout;
use tracing::Span;

use stickslip_compute::{LONGEST_WORK, Nanoseconds, begin_work, simulation::Worker as _};

use crate::metrics::{Counted, SECONDS, SHORT_SECONDS, metrics};

use super::deadline::{Deadline, StopOnDrop};
use super::fair_scheduler::{FairScheduler, INTERACTIVE, Kind, SolverSlot};
use super::memory::{BYTES, Memory};
use super::{Admission, Client, Quota, QuotaExceeded, QuotaLimits, Quotas, Share};

/// Work estimated below this runs on the thread that serves the connection.
pub const INLINE: Nanoseconds = 100_000;

/// How long a request waits for what it needs by default before it is refused as overload.
pub const LONGEST_WAIT: Duration = Duration::from_secs(10);
/// Requests that are served at a time by default.
pub const REQUESTS: usize = 512;
/// Requests that wait at a time by default.
pub const QUEUE: usize = 1024;
/// The resources of a pool.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Capacity {
    /// Threads for the solver.
    pub threads: usize,
    /// Requests that are served at a time.
    pub requests: usize,
    /// Requests that wait for any of this at a time.
    pub queue: usize,
    /// How long each waits.
    pub wait: Duration,
    /// How long the solver works for one request.
    pub deadline: Duration,
    /// Bytes of bodies, work and replies at a time.
    pub bytes: usize,
    /// What one client may have.
    pub quotas: QuotaLimits,
}

impl Default for Capacity {
    /// One thread per core, so that solvers slow down neither each other nor the server.
    fn default() -> Self {
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        let quotas = QuotaLimits::default();
        let (wait, deadline) = (LONGEST_WAIT, LONGEST_WORK);
        Capacity { threads, requests: REQUESTS, queue: QUEUE, wait, deadline, bytes: BYTES, quotas }
    }
}

/// The permits of the resources. Clones share it.
#[derive(Clone, Debug)]
pub struct Pool(Arc<Shared>);

#[derive(Debug)]
struct Shared {
    capacity: Capacity,
    threads: FairScheduler,
    requests: Permits,
    memory: Memory,
    queue: Permits,
    quotas: Quotas,
    meters: Arc<PoolMeters>,
}

/// Permits of which there are so many, at least one.
#[derive(Debug)]
pub(super) struct Permits {
    pub(super) free: Arc<Semaphore>,
    pub(super) all: usize,
}

impl Permits {
    pub(super) fn new(all: usize) -> Permits {
        let all = all.clamp(1, u32::MAX as usize);
        Permits { free: Arc::new(Semaphore::new(all)), all }
    }

    pub(super) fn try_take(&self, number: usize) -> Option<OwnedSemaphorePermit> {
        Arc::clone(&self.free).try_acquire_many_owned(u32::try_from(number).ok()?).ok()
    }

    pub(super) fn taken(&self) -> usize {
        self.all - self.free.available_permits()
    }
}

/// Permission to be served, held until dropped.
#[derive(Debug)]
pub struct RequestPermit(#[expect(dead_code, reason = "held for its drop")] OwnedSemaphorePermit);

metrics! {
    /// The metrics of a pool.
    pub struct PoolMeters {
        /// Long work that waits for a thread.
        waiting: IntGauge = gauge("stickslip_solver_waiting"),
        /// Long work that has begun; some of it may have yielded to other work.
        running: IntGauge = gauge("stickslip_solver_running"),
        /// Work for which no thread became free in time.
        refused: IntCounter = counter("stickslip_solver_refused_total"),
        /// How long work waited for its thread.
        wait: Histogram = histogram("stickslip_solver_wait_seconds", SECONDS),
        /// Time of a piece of work of the solver: moves, replays, stresses, simulations.
        work: Histogram = histogram("stickslip_solver_seconds", SHORT_SECONDS),
    }
}

/// The resources in use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Taken {
    /// Threads at work.
    pub threads: usize,
    /// Requests that are served.
    pub requests: usize,
    /// Requests that wait.
    pub waiting: usize,
    /// Bytes of the places of memory that are taken.
    pub bytes: usize,
}

/// Why work was not done.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PoolError {
    /// Nothing became free in time.
    #[error("the server is busy: no capacity became free in time")]
    Busy,
    /// The queue is full.
    #[error("the server is busy: its queue is full")]
    QueueFull,
    /// The client has as much as it may.
    #[error("{0}")]
    Quota(QuotaExceeded),
    /// The work panicked, which is a bug of this program.
    #[error("the solver panicked")]
    Panicked,
}

impl Pool {
    /// A pool with these resources; at least one of each.
    pub fn new(capacity: Capacity) -> Pool {
        Pool(Arc::new(Shared {
            capacity,
            threads: FairScheduler::new(capacity.threads),
            requests: Permits::new(capacity.requests),
            memory: Memory::new(&capacity),
            queue: Permits::new(capacity.queue),
            quotas: Quotas::new(capacity.quotas),
            meters: Arc::default(),
        }))
    }

    /// A pool with the default resources.
    pub fn with_defaults() -> Pool {
        Pool::new(Capacity::default())
    }

    /// The resources.
    pub fn capacity(&self) -> &Capacity {
        &self.0.capacity
    }

    pub(super) fn memory(&self) -> &Memory {
        &self.0.memory
    }

    /// What each client may have.
    pub fn quotas(&self) -> &Quotas {
        &self.0.quotas
    }

    /// One more of this for the client that this task serves.
    ///
    /// # Errors
    /// [`PoolError::Quota`] if it has as many as it may.
    pub fn share_of(&self, quota: Quota) -> Result<Share, PoolError> {
        self.share_for(quota, Client::current())
    }

    /// The same for a client.
    ///
    /// # Errors
    /// As [`Pool::share_of`].
    pub fn share_for(&self, quota: Quota, client: Client) -> Result<Share, PoolError> {
        let mut share = self.0.quotas.no_share(quota, client);
        share.resize(1).map_err(PoolError::Quota)?;
        Ok(share)
    }

    /// The resources in use.
    pub fn taken(&self) -> Taken {
        Taken {
            threads: self.0.threads.taken(),
            requests: self.0.requests.taken(),
            waiting: self.0.queue.taken(),
            bytes: self.0.memory.taken(),
        }
    }

    /// A flag for work that must end within the deadline.
    pub fn deadline(&self) -> (Deadline, StopOnDrop) {
        self.deadline_after(Duration::ZERO)
    }

    /// The same for a request that has had so much work done before.
    pub fn deadline_after(&self, spent: Duration) -> (Deadline, StopOnDrop) {
        Deadline::within(self.0.capacity.deadline, spent)
    }

    /// Waits for `request` within the limits of time and of the queue.
    ///
    /// # Errors
    /// [`PoolError::Busy`] if it was not ready in time, [`PoolError::QueueFull`] if too many wait already.
    pub async fn wait<T>(&self, request: impl Future<Output = T>) -> Result<T, PoolError> {
        let mut request = pin!(request);
        if let Poll::Ready(granted) = futures::poll!(request.as_mut()) {
            return Ok(granted);
        }
        let _queued = self.0.queue.free.try_acquire().map_err(|_| PoolError::QueueFull)?;
        timeout(self.0.capacity.wait, request).await.map_err(|_| PoolError::Busy)
    }

    pub(super) async fn permits(&self, of: &Permits, number: usize) -> Result<OwnedSemaphorePermit, PoolError> {
        if let Some(permit) = of.try_take(number) {
            return Ok(permit);
        }
        // In a box, so that a request that need not wait is not as large as one that does. The semaphores are never
        // closed, so their own error cannot occur.
        let permit = Arc::clone(&of.free).acquire_many_owned(u32::try_from(number).unwrap_or(u32::MAX));
        Box::pin(self.wait(permit)).await?.map_err(|_| PoolError::Busy)
    }

    /// Waits until a request may be served.
    ///
    /// # Errors
    /// As [`Pool::wait`].
    pub async fn admit_request(&self) -> Result<RequestPermit, PoolError> {
        self.permits(&self.0.requests, 1).await.map(RequestPermit)
    }

    /// The metrics.
    pub fn meters(&self) -> &PoolMeters {
        &self.0.meters
    }

    async fn wait_for_slot(&self, client: Client, kind: Kind) -> Result<SolverSlot, PoolError> {
        let (_waiting, begin) = (Counted::by(&self.0.meters.waiting), Instant::now());
        let slot =
            self.wait(self.0.threads.wait_for_slot(client, kind)).await.inspect_err(|_| self.0.meters.refused.inc())?;
        self.0.meters.wait.observe(begin.elapsed().as_secs_f64());
        Ok(slot)
    }

    /// Runs `work`, which must be short, with a slot on each thread that nobody waits for, at least one.
    ///
    /// # Errors
    /// As [`Pool::run`].
    pub async fn share<T: Send + 'static>(
        &self,
        kind: Kind,
        work: impl FnOnce(Vec<SolverSlot>) -> T + Send + 'static,
    ) -> Result<T, PoolError> {
        let client = Client::current();
        let mut slots = vec![self.wait_for_slot(client.clone(), kind).await?];
        while let Some(slot) = self.0.threads.another(&client, kind) {
            slots.push(slot);
        }
        self.on_thread(slots.len(), boxed(move || work(slots))).await.map(unboxed)
    }

    /// Runs `work`: in place if its estimated cost is below [`INLINE`], else on a thread of the blocking pool, which it
    /// shares by the checks of its [`Deadline`]. Work of cost zero is not counted.
    ///
    /// # Errors
    /// As [`Pool::wait`], or [`PoolError::Panicked`] if the work did.
    pub async fn run<T: Send + 'static>(
        &self,
        cost: Nanoseconds,
        work: impl FnOnce() -> T + Send + 'static,
    ) -> Result<T, PoolError> {
        if cost == 0 {
            return Ok(work());
        }
        if cost < INLINE {
            begin_work();
            return Ok(self.0.meters.timed(work));
        }
        // In a box, so that short work is not as large as long work.
        Box::pin(self.on_slot(cost, boxed(work))).await.map(unboxed)
    }

    /// Waits for a slot, and runs `work` with it.
    async fn on_slot(&self, cost: Nanoseconds, work: Work) -> Result<Done, PoolError> {
        let slot = self.wait_for_slot(Client::current(), Kind::of(cost)).await?;
        let request = Span::current();
        // The slot stays with the work: a caller that gives up does not free a thread that is still busy.
        self.on_thread(1, Box::new(move || request.in_scope(|| slot.work(work)))).await
    }

    /// Runs `work` on a thread of the blocking pool; it counts as so many pieces. It owns what its request holds: a
    /// caller that gives up frees no memory that is still in use.
    async fn on_thread(&self, pieces: usize, work: Work) -> Result<Done, PoolError> {
        let (meters, owned) = (Arc::clone(&self.0.meters), Admission::current());
        let task = spawn_blocking(move || {
            let _owned = owned;
            let _running: Vec<_> = (0..pieces).map(|_| Counted::by(&meters.running)).collect();
            meters.timed(work)
        });
        task.await.map_err(|_| PoolError::Panicked)
    }
}

/// Work on a thread, and what it gives, in boxes: the task of the runtime is compiled once, and not for each kind of
/// work.
type Work = Box<dyn FnOnce() -> Done + Send>;
type Done = Box<dyn Any + Send>;

fn boxed<T: Send + 'static>(work: impl FnOnce() -> T + Send + 'static) -> Work {
    Box::new(move || Box::new(work()))
}

fn unboxed<T: 'static>(done: Done) -> T {
    *done.downcast().expect("what the work of this call gives is of its type")
}

impl Kind {
    /// The kind of work of this estimated cost that somebody waits for.
    pub fn of(cost: Nanoseconds) -> Kind {
        if Duration::from_nanos(cost) > INTERACTIVE { Kind::Long } else { Kind::Interactive }
    }
}

impl PoolMeters {
    fn timed<T>(&self, work: impl FnOnce() -> T) -> T {
        let begin = Instant::now();
        let done = work();
        self.work.observe(begin.elapsed().as_secs_f64());
        done
    }
}
