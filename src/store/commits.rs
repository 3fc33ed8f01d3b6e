//! Metrics of a store that commits.

use std::time::Duration;

use crate::metrics::{Counter, Gauge, Histogram, SECONDS, SIZES};

/// The changes that a store makes, and the transactions in which it makes them.
#[derive(Debug)]
pub struct Commits {
    /// The kind of store.
    pub store: &'static str,
    /// Changes that somebody waits for.
    pub pending: Gauge,
    /// How many changes a transaction made.
    pub size: Histogram,
    /// How long a transaction took until it was durable, s.
    pub time: Histogram,
    /// Transactions that failed.
    pub failed: Counter,
}

impl Commits {
    /// Nothing counted yet.
    #[must_use]
    pub fn new(store: &'static str) -> Commits {
        let (size, time) = (Histogram::new(SIZES), Histogram::new(SECONDS));
        Commits { store, pending: Gauge::default(), size, time, failed: Counter::default() }
    }

    /// Counts a transaction that is durable.
    pub fn committed(&self, changes: usize, time: Duration) {
        self.size.observe(changes as f64);
        self.time.observe_time(time);
    }
}
