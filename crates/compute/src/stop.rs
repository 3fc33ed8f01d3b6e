//! Whom long work asks whether to go on: cancellation and time limits.

use std::cell::Cell;
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

    /// Lets other work go first where it shares the threads.
    fn yield_slot(&self) {}

    /// Ends the work if the flag is raised.
    ///
    /// # Errors
    /// [`Interrupted::Abandoned`] if no client waits for the result any more, [`Interrupted::TimeLimit`] if the time is
    /// up.
    fn check(&self) -> Result<(), Interrupted> {
        self.yield_slot();
        self.check_after(worked())
    }

    /// As [`Stop::check`], after so much more processor time for this work.
    ///
    /// # Errors
    /// As [`Stop::check`].
    fn check_after(&self, worked: Duration) -> Result<(), Interrupted> {
        self.flag().check_after(worked)
    }
}

/// How long work goes on before its processor time is read again: a call of the system, while a look at the clock is
/// none.
const INTERVAL: Duration = Duration::from_millis(1);

thread_local! {
    /// When the processor time of this thread was last counted for its work, and what it was then.
    static COUNTED: Cell<Option<(Instant, Duration)>> = const { Cell::new(None) };
}

/// Work begins on this thread: what the thread has done before is none of it. It counts from its first check on.
pub fn begin_work() {
    COUNTED.set(None);
}

/// The processor time of this thread since it was last counted.
fn worked() -> Duration {
    let (now, counted) = (Instant::now(), COUNTED.get());
    if counted.is_some_and(|(last, _)| now.duration_since(last) < INTERVAL) {
        return Duration::ZERO;
    }
    let time = processor_time();
    COUNTED.set(Some((now, time)));
    counted.map_or(Duration::ZERO, |(_, last)| time.saturating_sub(last))
}

/// The processor time of this thread.
#[cfg(unix)]
pub fn processor_time() -> Duration {
    use rustix::time::{ClockId, clock_gettime};

    Duration::try_from(clock_gettime(ClockId::ThreadCPUTime)).unwrap_or_default()
}

/// The time of this thread, where the system is not asked for its processor time.
#[cfg(not(unix))]
pub fn processor_time() -> Duration {
    thread_local! {
        static BEGIN: Instant = Instant::now();
    }
    BEGIN.with(Instant::elapsed)
}

/// A flag that is raised by another thread, or once the allowed work is used up. The default flag has no time limit.
#[derive(Debug, Default)]
pub struct Flag {
    raised: AtomicBool,
    allowed: Option<Duration>,
    // Nanoseconds of processor time that count for the time limit: what waits for a thread, or yields, takes none.
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

    fn check_after(&self, worked: Duration) -> Result<(), Interrupted> {
        if self.raised.load(Ordering::Relaxed) {
            return Err(Interrupted::Abandoned);
        }
        let Some(allowed) = self.allowed else { return Ok(()) };
        let worked = worked.as_nanos() as u64;
        let before = if worked > 0 {
            self.spent.fetch_add(worked, Ordering::Relaxed)
        } else {
            self.spent.load(Ordering::Relaxed)
        };
        if Duration::from_nanos(before + worked) >= allowed { Err(Interrupted::TimeLimit(allowed)) } else { Ok(()) }
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

    fn yield_slot(&self) {
        (**self).yield_slot();
    }

    fn check_after(&self, worked: Duration) -> Result<(), Interrupted> {
        (**self).check_after(worked)
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

    fn yield_slot(&self) {
        self.whole.yield_slot();
    }

    fn check_after(&self, worked: Duration) -> Result<(), Interrupted> {
        self.whole.check_after(worked)?;
        self.flag.check_after(worked)
    }
}
