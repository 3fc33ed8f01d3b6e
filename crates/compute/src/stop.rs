//! Whom long work asks whether to go on: cancellation and time limits.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// How long the solver works for one request by default.
pub const LONGEST_WORK: Duration = Duration::from_secs(60);

/// Why work was stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Interrupted {
    /// The client no longer waits for the result.
    #[error("stopped: the client no longer waits for the result")]
    Abandoned,
    /// The work has reached its time limit.
    #[error("this takes longer than the {} s that are allowed", .0.as_secs_f64())]
    TimeLimit(Duration),
}

/// Tells long loops whether to continue. At most some milliseconds may pass between two checks, because at each of them
/// the work may yield to other work.
pub trait Stop: Send + Sync {
    /// The flag that ends the work, and the times that have been counted for it.
    fn flag(&self) -> &Flag;

    /// Lets other work go first where it shares the threads; returns how long that took.
    fn yield_slot(&self) -> Duration {
        Duration::ZERO
    }

    /// Ends the work if the flag is raised.
    ///
    /// # Errors
    /// [`Interrupted::Abandoned`] if no client waits for the result any more, [`Interrupted::TimeLimit`] if the time is
    /// up.
    fn check(&self) -> Result<(), Interrupted> {
        self.check_after(self.yield_slot())
    }

    /// As [`Stop::check`], after the work has just yielded for this time.
    ///
    /// # Errors
    /// As [`Stop::check`].
    fn check_after(&self, waited: Duration) -> Result<(), Interrupted> {
        self.flag().check_after(waited)
    }
}

/// A flag that is raised by another thread, or once the allowed work is used up. The default flag has no time limit.
#[derive(Debug, Default)]
pub struct Flag {
    raised: AtomicBool,
    allowed: Option<Duration>,
    // Set by the first check: the time that a request has waited for a thread does not count.
    started: OnceLock<Instant>,
    // Nanoseconds for which the work has yielded to others since, which do not count either.
    waited: AtomicU64,
    // Nanoseconds of work for the same request under other flags that counts for the time limit.
    spent: AtomicU64,
    // Nanoseconds of all work for it before, under flags of its own.
    before: AtomicU64,
}

impl Flag {
    /// A flag that is also raised after this much work.
    pub fn within(allowed: Option<Duration>) -> Flag {
        Flag { allowed, ..Flag::default() }
    }

    /// Ends the work at its next check.
    pub fn raise(&self) {
        // No other memory is published through the flag, so relaxed ordering suffices.
        self.raised.store(true, Ordering::Relaxed);
    }

    /// The time limit of the work, if it has one.
    pub fn time_limit(&self) -> Option<Duration> {
        self.allowed
    }

    /// Counts work that has been done for the same request under other flags: as time that the request took, and for
    /// its time limit.
    pub fn charge(&self, work: Duration) {
        self.count(work);
        self.spent.fetch_add(work.as_nanos() as u64, Ordering::Relaxed);
    }

    /// Counts work as time that the request took. For the time limit it counts by the checks of this flag.
    pub fn count(&self, work: Duration) {
        self.before.fetch_add(work.as_nanos() as u64, Ordering::Relaxed);
    }

    /// The work that has been counted by [`Flag::count`] and [`Flag::charge`].
    pub fn before(&self) -> Duration {
        Duration::from_nanos(self.before.load(Ordering::Relaxed))
    }

    /// How long the work has yielded to others.
    pub fn waited(&self) -> Duration {
        Duration::from_nanos(self.waited.load(Ordering::Relaxed))
    }

    fn check_after(&self, waited: Duration) -> Result<(), Interrupted> {
        if self.raised.load(Ordering::Relaxed) {
            return Err(Interrupted::Abandoned);
        }
        if !waited.is_zero() {
            self.waited.fetch_add(waited.as_nanos() as u64, Ordering::Relaxed);
        }
        let Some(allowed) = self.allowed else { return Ok(()) };
        let Some(started) = self.started.get() else {
            self.started.get_or_init(|| Instant::now().checked_sub(waited).unwrap_or_else(Instant::now));
            return Ok(());
        };
        let spent = Duration::from_nanos(self.spent.load(Ordering::Relaxed));
        let worked = (spent + started.elapsed()).saturating_sub(self.waited());
        if worked >= allowed { Err(Interrupted::TimeLimit(allowed)) } else { Ok(()) }
    }
}

impl Stop for Flag {
    fn flag(&self) -> &Flag {
        self
    }
}

impl<S: Stop + ?Sized> Stop for &S {
    fn flag(&self) -> &Flag {
        (**self).flag()
    }

    fn yield_slot(&self) -> Duration {
        (**self).yield_slot()
    }

    fn check_after(&self, waited: Duration) -> Result<(), Interrupted> {
        (**self).check_after(waited)
    }
}

/// A part of some work: it ends with the whole, or after a time limit of its own.
#[derive(Debug)]
pub struct Part<S> {
    whole: S,
    flag: Flag,
}

impl<S: Stop> Part<S> {
    /// A part of this work with this time limit.
    pub fn of(whole: S, allowed: Option<Duration>) -> Part<S> {
        Part { whole, flag: Flag::within(allowed) }
    }
}

impl<S: Stop> Stop for Part<S> {
    fn flag(&self) -> &Flag {
        &self.flag
    }

    fn yield_slot(&self) -> Duration {
        self.whole.yield_slot()
    }

    fn check_after(&self, waited: Duration) -> Result<(), Interrupted> {
        self.whole.check_after(waited)?;
        self.flag.check_after(waited)
    }
}
