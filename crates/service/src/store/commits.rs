//! Metrics of a store that commits.

use std::time::{Duration, Instant};

use parking_lot::Mutex;
use prometheus::{Histogram, IntCounter, IntGauge, Opts};

use crate::metrics::{Counted, SECONDS, SIZES, counter, gauge, histogram};

/// The changes that a store makes, and the transactions in which it makes them.
#[derive(Debug)]
pub struct Commits {
    /// Changes whose callers wait.
    pub pending: IntGauge,
    /// How many changes a transaction made.
    pub size: Histogram,
    /// How long a transaction took until it was durable, s.
    pub time: Histogram,
    /// Transactions that failed.
    pub failed: IntCounter,
    /// When a transaction was last durable, or, if that is later, the first of the waiting changes arrived.
    progress: Mutex<Instant>,
}

impl Commits {
    /// The metrics of this kind of store, all zero.
    pub fn new(store: &'static str) -> Commits {
        let named = |name, help| Opts::new(name, help).const_label("store", store);
        let help = "Changes that wait for their transaction, or are in it.";
        let pending = gauge(named("stickslip_store_pending_changes", help));
        let size = histogram(named("stickslip_commit_changes", "Changes in a transaction."), SIZES);
        let help = "Time of a transaction of the store, until it is durable.";
        let time = histogram(named("stickslip_commit_seconds", help), SECONDS);
        let failed = counter(named("stickslip_commit_failures_total", "Transactions that failed."));
        Commits { pending, size, time, failed, progress: Mutex::new(Instant::now()) }
    }

    /// Counts a change whose caller waits, until the result is dropped.
    pub fn wait(&self) -> Counted<'_> {
        if self.pending.get() == 0 {
            self.progressed();
        }
        Counted::by(&self.pending)
    }

    /// Counts a transaction that is durable.
    pub fn committed(&self, changes: usize, time: Duration) {
        self.progressed();
        self.size.observe(changes as f64);
        self.time.observe(time.as_secs_f64());
    }

    /// Notes a transaction that is durable, and that made no change.
    pub fn progressed(&self) {
        *self.progress.lock() = Instant::now();
    }

    /// For how long changes have waited while no transaction became durable.
    pub fn stalled(&self) -> Duration {
        let progress = *self.progress.lock();
        if self.pending.get() == 0 { Duration::ZERO } else { progress.elapsed() }
    }
}
