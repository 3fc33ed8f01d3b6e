//! Cancellation and time limits of work on another thread.

use std::sync::Arc;
use std::time::Duration;

use stickslip_compute::{Flag, Stop};

use super::fair_scheduler;

/// What the work for a request asks whether to go on. Work on the blocking pool outlives the handler that asked for it;
/// this ends it. At a check the work also yields to others that are next.
#[derive(Clone, Debug)]
pub struct Deadline(Arc<Flag>);

/// Raises the flag when dropped: held by a handler, it does so when the client hangs up.
#[derive(Debug)]
#[must_use]
pub struct StopOnDrop(Deadline);

impl Deadline {
    /// One that ends the work when the guard is dropped, or when it has taken `allowed` in all, of which `spent` was
    /// before.
    pub fn within(allowed: Duration, spent: Duration) -> (Deadline, StopOnDrop) {
        let (deadline, guard) = Deadline::of(Flag::within(Some(allowed)));
        deadline.flag().charge(spent);
        (deadline, guard)
    }

    /// One that ends the work when the guard is dropped, and not before.
    pub fn unbounded() -> (Deadline, StopOnDrop) {
        Deadline::of(Flag::default())
    }

    /// One that never ends the work.
    pub(super) fn none() -> Deadline {
        Deadline(Arc::default())
    }

    fn of(flag: Flag) -> (Deadline, StopOnDrop) {
        let deadline = Deadline(Arc::new(flag));
        (deadline.clone(), StopOnDrop(deadline))
    }
}

impl Stop for Deadline {
    fn flag(&self) -> &Flag {
        &self.0
    }

    fn yield_slot(&self) {
        fair_scheduler::yield_slot();
    }
}

impl Drop for StopOnDrop {
    fn drop(&mut self) {
        self.0.0.raise();
    }
}
