//! Numbers that tell how the service is doing: counters, gauges and histograms.
//!
//! To count something takes a few atomic operations, no lock and no memory: what is counted is a field of whatever counts it,
//! and has no name there. Names are given where the numbers are shown, in `api/metrics.rs`, in the way of [`page`].

pub mod page;
pub mod process;

use std::sync::atomic::{AtomicI64, AtomicU64, Ordering::Relaxed};
use std::time::Duration;

/// Bounds for what takes from a tenth of a millisecond to ten seconds, s.
pub const SECONDS: &[f64] =
    &[1e-4, 2.5e-4, 5e-4, 1e-3, 2.5e-3, 5e-3, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 5.0, 10.0];
/// Bounds for what may take less than a microsecond, s.
pub const SHORT_SECONDS: &[f64] =
    &[1e-6, 2.5e-6, 5e-6, 1e-5, 2.5e-5, 1e-4, 2.5e-4, 1e-3, 2.5e-3, 0.01, 0.025, 0.1, 0.25, 1.0, 2.5, 10.0, 25.0];
/// Bounds for how many go together.
pub const SIZES: &[f64] = &[1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 128.0, 256.0, 512.0];

/// A number that only grows.
#[derive(Debug, Default)]
pub struct Counter(AtomicU64);

impl Counter {
    /// Adds to it.
    pub fn add(&self, count: u64) {
        self.0.fetch_add(count, Relaxed);
    }

    /// What it has come to.
    #[must_use]
    pub fn get(&self) -> u64 {
        self.0.load(Relaxed)
    }
}

/// How many there are of something that comes and goes.
#[derive(Debug, Default)]
pub struct Gauge(AtomicI64);

/// One of those that a [`Gauge`] counts, until it is dropped.
#[must_use]
#[derive(Debug)]
pub struct Stay<'a>(&'a Gauge);

impl Gauge {
    /// One more, until the guard is dropped.
    pub fn enter(&self) -> Stay<'_> {
        self.0.fetch_add(1, Relaxed);
        Stay(self)
    }

    /// How many there are.
    #[must_use]
    pub fn get(&self) -> i64 {
        self.0.load(Relaxed)
    }
}

impl Drop for Stay<'_> {
    fn drop(&mut self) {
        self.0.0.fetch_sub(1, Relaxed);
    }
}

/// How many observations fell below each of some bounds, and their sum.
#[derive(Debug)]
pub struct Histogram {
    bounds: &'static [f64],
    // One for each bound, and one for what lies beyond the last.
    counts: Box<[AtomicU64]>,
    // The bits of an f64.
    sum: AtomicU64,
}

impl Histogram {
    /// An empty one with these bounds, which rise.
    #[must_use]
    pub fn new(bounds: &'static [f64]) -> Histogram {
        let counts = (0..=bounds.len()).map(|_| AtomicU64::new(0)).collect();
        Histogram { bounds, counts, sum: AtomicU64::new(0) }
    }

    /// Counts an observation.
    pub fn observe(&self, value: f64) {
        let place = self.bounds.iter().position(|bound| value <= *bound).unwrap_or(self.bounds.len());
        self.counts[place].fetch_add(1, Relaxed);
        let add = |sum: u64| Some((f64::from_bits(sum) + value).to_bits());
        // It is never refused, as it always has a new value.
        let _ = self.sum.fetch_update(Relaxed, Relaxed, add);
    }

    /// Counts a time, in seconds.
    pub fn observe_time(&self, time: Duration) {
        self.observe(time.as_secs_f64());
    }

    /// How many observations there were.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.counts.iter().map(|count| count.load(Relaxed)).sum()
    }

    /// Their sum.
    #[must_use]
    pub fn sum(&self) -> f64 {
        f64::from_bits(self.sum.load(Relaxed))
    }

    /// The bounds, each with the count of the observations up to it; the last bound is infinite.
    fn cumulated(&self) -> impl Iterator<Item = (f64, u64)> {
        let bounds = self.bounds.iter().copied().chain([f64::INFINITY]);
        bounds.zip(&self.counts).scan(0, |below, (bound, count)| {
            *below += count.load(Relaxed);
            Some((bound, *below))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{Gauge, Histogram};

    #[test]
    fn an_observation_on_a_bound_counts_as_below_it() {
        let histogram = Histogram::new(&[1.0, 2.0]);
        [0.5, 1.0, 1.5, 2.0, 3.0].into_iter().for_each(|value| histogram.observe(value));
        assert_eq!(histogram.cumulated().collect::<Vec<_>>(), [(1.0, 2), (2.0, 4), (f64::INFINITY, 5)]);
        assert_eq!((histogram.count(), histogram.sum().to_bits()), (5, 8.0_f64.to_bits()));
    }

    #[test]
    fn whoever_enters_leaves_even_by_a_panic() {
        let gauge = Gauge::default();
        let caught = std::panic::catch_unwind(|| {
            let _stay = gauge.enter();
            assert_eq!(gauge.get(), 2, "not yet");
        });
        assert!(caught.is_err());
        assert_eq!(gauge.get(), 0);
    }
}
