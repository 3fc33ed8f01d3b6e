//! Where the solver runs when its work is worth a thread.

use std::sync::Arc;
use std::time::{Duration, Instant};

use tokio::sync::Semaphore;
use tokio::task::spawn_blocking;
use tokio::time::timeout;

use crate::metrics::{Counter, Gauge, Histogram, SECONDS, SHORT_SECONDS};

use super::cost::{INLINE, Nanoseconds};

/// How long work waits for a free thread before the server admits that it is overloaded.
pub const LONGEST_WAIT: Duration = Duration::from_secs(10);

/// As many permits as the machine has cores, so that solvers do not crowd out each other or the server.
#[derive(Clone, Debug)]
pub struct Pool {
    permits: Arc<Semaphore>,
    meters: Arc<PoolMeters>,
}

/// What a pool counts.
#[derive(Debug)]
pub struct PoolMeters {
    /// Its threads.
    pub threads: usize,
    /// Work that waits for a thread.
    pub waiting: Gauge,
    /// Work on a thread.
    pub running: Gauge,
    /// Work for which no thread became free in time.
    pub refused: Counter,
    /// How long work waited for a thread, s.
    pub wait: Histogram,
    /// How long work took, at once or on a thread, s.
    pub work: Histogram,
}

/// Why work was not done.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PoolError {
    /// No thread became free in time.
    #[error("all solvers are busy")]
    Busy,
    /// The work panicked, which is a fault of this program.
    #[error("the solver panicked")]
    Panicked,
}

impl Pool {
    /// A pool of so many threads at most; at least one.
    #[must_use]
    pub fn new(threads: usize) -> Pool {
        let threads = threads.max(1);
        let meters = PoolMeters {
            threads,
            waiting: Gauge::default(),
            running: Gauge::default(),
            refused: Counter::default(),
            wait: Histogram::new(SECONDS),
            work: Histogram::new(SHORT_SECONDS),
        };
        Pool { permits: Arc::new(Semaphore::new(threads)), meters: Arc::new(meters) }
    }

    /// A pool as wide as the machine.
    #[must_use]
    pub fn of_the_machine() -> Pool {
        Pool::new(std::thread::available_parallelism().map_or(1, usize::from))
    }

    /// What it has counted.
    #[must_use]
    pub fn meters(&self) -> &PoolMeters {
        &self.meters
    }

    /// Does the work: at once if it is cheap, else on a thread of its own. What costs nothing is not counted.
    ///
    /// # Errors
    /// [`PoolError::Busy`] if no thread became free within [`LONGEST_WAIT`], [`PoolError::Panicked`] if the work did.
    pub async fn run<T: Send + 'static>(
        &self,
        cost: Nanoseconds,
        work: impl FnOnce() -> T + Send + 'static,
    ) -> Result<T, PoolError> {
        if cost == 0 {
            return Ok(work());
        }
        if cost < INLINE {
            return Ok(self.meters.timed(work));
        }
        let (waiting, begin) = (self.meters.waiting.enter(), Instant::now());
        let permit = match timeout(LONGEST_WAIT, self.permits.clone().acquire_owned()).await {
            Ok(Ok(permit)) => permit,
            // The semaphore is never closed, so that its error cannot come either.
            Ok(Err(_)) | Err(_) => {
                self.meters.refused.add(1);
                return Err(PoolError::Busy);
            }
        };
        self.meters.wait.observe_time(begin.elapsed());
        drop(waiting);
        let meters = Arc::clone(&self.meters);
        let task = spawn_blocking(move || {
            // The permit stays with the work: a caller that gives up does not free a thread that is still busy.
            let _permit = permit;
            let _running = meters.running.enter();
            meters.timed(work)
        });
        task.await.map_err(|_| PoolError::Panicked)
    }
}

impl PoolMeters {
    fn timed<T>(&self, work: impl FnOnce() -> T) -> T {
        let begin = Instant::now();
        let done = work();
        self.work.observe_time(begin.elapsed());
        done
    }
}
