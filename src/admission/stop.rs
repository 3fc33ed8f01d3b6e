//! Telling work on another thread that nobody waits for it any longer, or that it has had its time.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};

/// How long a server computes for one request unless it is told otherwise.
pub const LONGEST_WORK: Duration = Duration::from_secs(60);

/// Why work was broken off.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Interrupted {
    /// Nobody waits for the result any longer.
    #[error("stopped, as nobody waits for the result any longer")]
    Abandoned,
    /// The work has taken as long as it may.
    #[error("this takes longer than the {} s that are allowed", .0.as_secs_f64())]
    TimeLimit(Duration),
}

/// What a long loop looks at. Work on the blocking pool outlives the handler that asked for it; this ends it.
#[derive(Clone, Debug, Default)]
pub struct Stop(Arc<Flag>);

#[derive(Debug, Default)]
struct Flag {
    raised: AtomicBool,
    allowed: Option<Duration>,
    // Goes up with this one as well.
    whole: Option<Stop>,
    // The first look at the flag: what a request has waited for a thread is not held against it.
    begun: OnceLock<Instant>,
}

/// Raises the flag when dropped: held by a handler, it does so when the client hangs up.
#[derive(Debug)]
pub struct StopOnDrop(Stop);

impl Stop {
    /// As [`Stop::within`] the time of [`LONGEST_WORK`].
    #[must_use]
    pub fn guarded() -> (Stop, StopOnDrop) {
        Stop::within(LONGEST_WORK)
    }

    /// A flag that goes up when the guard is dropped, or by itself when the work has taken so long. The default one never
    /// does.
    #[must_use]
    pub fn within(allowed: Duration) -> (Stop, StopOnDrop) {
        let stop = Stop(Arc::new(Flag { allowed: Some(allowed), ..Flag::default() }));
        (stop.clone(), StopOnDrop(stop))
    }

    /// A flag that goes up when the guard is dropped, and not before.
    #[must_use]
    pub fn unbounded() -> (Stop, StopOnDrop) {
        let stop = Stop::default();
        (stop.clone(), StopOnDrop(stop))
    }

    /// A flag for a part of the work: it goes up with this one, or when the part has taken so long.
    #[must_use]
    pub fn child_deadline(&self, allowed: Duration) -> Stop {
        Stop(Arc::new(Flag { allowed: Some(allowed), whole: Some(self.clone()), ..Flag::default() }))
    }

    /// How long the work may take, if there is a bound.
    #[must_use]
    pub fn time_limit(&self) -> Option<Duration> {
        self.0.allowed
    }

    /// Ends the work if the flag is up.
    ///
    /// # Errors
    /// [`Interrupted::Abandoned`] if the guard is gone, [`Interrupted::TimeLimit`] if the time is up.
    pub fn check(&self) -> Result<(), Interrupted> {
        if let Some(whole) = &self.0.whole {
            whole.check()?;
        }
        // Nothing is published through the flag, so that no ordering is needed.
        if self.0.raised.load(Ordering::Relaxed) {
            return Err(Interrupted::Abandoned);
        }
        match self.0.allowed {
            Some(allowed) if self.0.begun.get_or_init(Instant::now).elapsed() >= allowed => {
                Err(Interrupted::TimeLimit(allowed))
            }
            _ => Ok(()),
        }
    }
}

impl Drop for StopOnDrop {
    fn drop(&mut self) {
        self.0.0.raised.store(true, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::{Interrupted, Stop};

    #[test]
    fn work_ends_with_the_guard() {
        let (stop, guard) = Stop::guarded();
        assert_eq!(stop.check(), Ok(()));
        drop(guard);
        assert_eq!(stop.check(), Err(Interrupted::Abandoned));
    }

    #[test]
    fn time_runs_from_the_first_look() {
        let allowed = Duration::from_millis(20);
        let (stop, _guard) = Stop::within(allowed);
        std::thread::sleep(2 * allowed);
        assert_eq!(stop.check(), Ok(()));
        std::thread::sleep(2 * allowed);
        assert_eq!(stop.check(), Err(Interrupted::TimeLimit(allowed)));
    }
}
