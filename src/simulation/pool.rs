//! Where the solver runs when its work is worth a thread.

use std::sync::Arc;
use std::time::Duration;

use tokio::sync::Semaphore;
use tokio::task::spawn_blocking;
use tokio::time::timeout;

use super::cost::{INLINE, Nanoseconds};

/// How long work waits for a free thread before the server admits that it is overloaded.
pub const LONGEST_WAIT: Duration = Duration::from_secs(10);

/// As many permits as the machine has cores, so that solvers do not crowd out each other or the server.
#[derive(Clone, Debug)]
pub struct Pool {
    permits: Arc<Semaphore>,
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
        Pool { permits: Arc::new(Semaphore::new(threads.max(1))) }
    }

    /// A pool as wide as the machine.
    #[must_use]
    pub fn of_the_machine() -> Pool {
        Pool::new(std::thread::available_parallelism().map_or(1, usize::from))
    }

    /// Does the work: at once if it is cheap, else on a thread of its own.
    ///
    /// # Errors
    /// [`PoolError::Busy`] if no thread became free within [`LONGEST_WAIT`], [`PoolError::Panicked`] if the work did.
    pub async fn run<T: Send + 'static>(
        &self,
        cost: Nanoseconds,
        work: impl FnOnce() -> T + Send + 'static,
    ) -> Result<T, PoolError> {
        if cost < INLINE {
            return Ok(work());
        }
        let permit = match timeout(LONGEST_WAIT, self.permits.clone().acquire_owned()).await {
            Ok(Ok(permit)) => permit,
            // The semaphore is never closed, so that its error cannot come either.
            Ok(Err(_)) | Err(_) => return Err(PoolError::Busy),
        };
        let task = spawn_blocking(move || {
            // The permit stays with the work: a caller that gives up does not free a thread that is still busy.
            let _permit = permit;
            work()
        });
        task.await.map_err(|_| PoolError::Panicked)
    }
}
