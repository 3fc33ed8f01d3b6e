//! Cancellation and time limits of work on another thread.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};

use super::fair_scheduler;

/// How long the solver works for one request by default.
pub const LONGEST_WORK: Duration = Duration::from_secs(60);

/// Why work was broken off.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Interrupted {
    /// The client no longer waits for the result.
    #[error("stopped: the client no longer waits for the result")]
    Abandoned,
    /// The work has taken as long as it may.
    #[error("this takes longer than the {} s that are allowed", .0.as_secs_f64())]
    TimeLimit(Duration),
}

/// A flag that long loops check. Work on the blocking pool outlives the handler that asked for it; the flag ends it. At
/// a check the work also gives way to others that are next, so that no more than some milliseconds may pass between
/// two checks.
#[derive(Clone, Debug, Default)]
pub struct Stop(Arc<Flag>);

#[derive(Debug, Default)]
struct Flag {
    raised: AtomicBool,
    allowed: Option<Duration>,
    // Raising the parent raises this flag too.
    parent: Option<Stop>,
    // Set by the first check: the time that a request has waited for a thread does not count.
    started: OnceLock<Instant>,
    // Nanoseconds for which the work has given way to others since, which do not count either.
    waited: AtomicU64,
    // Nanoseconds of work for the same request under other flags that counts for the deadline.
    spent: AtomicU64,
    // Nanoseconds of all work for it before, under flags of its own.
    before: AtomicU64,
}

/// Raises the flag when dropped: held by a handler, it does so when the client hangs up.
#[derive(Debug)]
pub struct StopOnDrop(Stop);

impl Stop {
    /// A flag that is raised when the guard is dropped, or after work that has taken `spent` before has taken `allowed`
    /// in all. The default flag is never raised.
    #[must_use]
    pub fn within(allowed: Duration, spent: Duration) -> (Stop, StopOnDrop) {
        let stop = Stop(Arc::new(Flag { allowed: Some(allowed), ..Flag::default() }));
        stop.charge(spent);
        (stop.clone(), StopOnDrop(stop))
    }

    /// A flag that is raised when the guard is dropped, and not before.
    #[must_use]
    pub fn unbounded() -> (Stop, StopOnDrop) {
        let stop = Stop::default();
        (stop.clone(), StopOnDrop(stop))
    }

    /// A flag for a part of the work: it is raised with this one, or after the part has taken `allowed`.
    #[must_use]
    pub fn child_deadline(&self, allowed: Option<Duration>) -> Stop {
        Stop(Arc::new(Flag { allowed, parent: Some(self.clone()), ..Flag::default() }))
    }

    /// The time limit of the work, if it has one.
    #[must_use]
    pub fn time_limit(&self) -> Option<Duration> {
        self.0.allowed
    }

    /// Counts work that has been done for the same request under other flags: as time that the request took, and for
    /// its deadline.
    pub fn charge(&self, work: Duration) {
        self.count(work);
        self.0.spent.fetch_add(work.as_nanos() as u64, Ordering::Relaxed);
    }

    /// Counts work as time that the request took. For the deadline it counts by the checks of this flag.
    pub fn count(&self, work: Duration) {
        self.0.before.fetch_add(work.as_nanos() as u64, Ordering::Relaxed);
    }

    /// The work that has been counted by [`Stop::count`] and [`Stop::charge`].
    #[must_use]
    pub fn before(&self) -> Duration {
        Duration::from_nanos(self.0.before.load(Ordering::Relaxed))
    }

    /// How long the work has given way to others.
    #[must_use]
    pub fn waited(&self) -> Duration {
        Duration::from_nanos(self.0.waited.load(Ordering::Relaxed))
    }

    /// Ends the work if the flag is raised.
    ///
    /// # Errors
    /// [`Interrupted::Abandoned`] if the guard was dropped, [`Interrupted::TimeLimit`] if the time is up.
    pub fn check(&self) -> Result<(), Interrupted> {
        self.check_after(fair_scheduler::give_way())
    }

    /// The same, when the work has just waited for so long.
    fn check_after(&self, waited: Duration) -> Result<(), Interrupted> {
        if let Some(parent) = &self.0.parent {
            parent.check_after(waited)?;
        }
        // No other memory is published through the flag, so relaxed ordering suffices.
        if self.0.raised.load(Ordering::Relaxed) {
            return Err(Interrupted::Abandoned);
        }
        if !waited.is_zero() {
            self.0.waited.fetch_add(waited.as_nanos() as u64, Ordering::Relaxed);
        }
        let Some(allowed) = self.0.allowed else { return Ok(()) };
        let Some(started) = self.0.started.get() else {
            self.0.started.get_or_init(|| Instant::now().checked_sub(waited).unwrap_or_else(Instant::now));
            return Ok(());
        };
        let spent = Duration::from_nanos(self.0.spent.load(Ordering::Relaxed));
        let worked = (spent + started.elapsed()).saturating_sub(self.waited());
        if worked >= allowed { Err(Interrupted::TimeLimit(allowed)) } else { Ok(()) }
    }
}

impl Drop for StopOnDrop {
    fn drop(&mut self) {
        self.0.0.raised.store(true, Ordering::Relaxed);
    }
}
