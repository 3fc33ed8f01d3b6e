//! Telling work on another thread that nobody waits for it any longer, or that it has had its time.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use super::Failure;

/// How long a server computes for one request.
pub const LONGEST_WORK: Duration = Duration::from_secs(60);

/// What a long loop looks at. Work on the blocking pool outlives the handler that asked for it; this ends it.
#[derive(Clone, Debug, Default)]
pub struct Stop {
    raised: Arc<AtomicBool>,
    deadline: Option<Instant>,
}

/// Raises the flag when dropped: held by a handler, it does so when the client hangs up.
#[derive(Debug)]
pub struct StopOnDrop(Arc<AtomicBool>);

impl Stop {
    /// A flag that goes up when the guard is dropped, or by itself after [`LONGEST_WORK`]. The default one never does.
    #[must_use]
    pub fn guarded() -> (Stop, StopOnDrop) {
        let stop = Stop { raised: Arc::default(), deadline: Some(Instant::now() + LONGEST_WORK) };
        let guard = StopOnDrop(Arc::clone(&stop.raised));
        (stop, guard)
    }

    /// Ends the work if the flag is up.
    ///
    /// # Errors
    /// [`Failure::Stopped`] if the guard is gone, [`Failure::TooLong`] if the time is up.
    pub fn check(&self) -> Result<(), Failure> {
        // Nothing is published through the flag, so that no ordering is needed.
        if self.raised.load(Ordering::Relaxed) {
            return Err(Failure::Stopped);
        }
        match self.deadline {
            Some(deadline) if Instant::now() >= deadline => Err(Failure::TooLong { pointer: String::new() }),
            _ => Ok(()),
        }
    }
}

impl Drop for StopOnDrop {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::{Failure, Stop};

    #[test]
    fn work_ends_with_the_guard() {
        let (stop, guard) = Stop::guarded();
        assert_eq!(stop.check(), Ok(()));
        drop(guard);
        assert_eq!(stop.check(), Err(Failure::Stopped));
    }
}
