//! Metrics of the service: counters, gauges and histograms of the library `prometheus`.
//!
//! Counting takes a few atomic operations, no lock and no allocation: each user of a metric keeps a handle.
//! `api/resources/metrics.rs` puts all of them on the page that Prometheus reads.

pub mod process;

use prometheus::{Histogram, HistogramOpts, IntCounter, IntGauge, Opts};

/// Buckets for durations from a tenth of a millisecond to ten seconds, s.
pub const SECONDS: &[f64] =
    &[1e-4, 2.5e-4, 5e-4, 1e-3, 2.5e-3, 5e-3, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 5.0, 10.0];
/// Buckets for durations that may be below a microsecond, s.
pub const SHORT_SECONDS: &[f64] =
    &[1e-6, 2.5e-6, 5e-6, 1e-5, 2.5e-5, 1e-4, 2.5e-4, 1e-3, 2.5e-3, 0.01, 0.025, 0.1, 0.25, 1.0, 2.5, 10.0, 25.0];
/// Buckets for sizes of batches.
pub const SIZES: &[f64] = &[1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 128.0, 256.0, 512.0];

/// The message of a panic that cannot occur, because all names are constants.
pub const OWN_NAME: &str = "the name, the labels and the buckets of a metric are constants that the format allows";

/// Defines a group of metrics: their struct, in which all of them are zero at first, and the list of them. The help
/// text of a metric is its doc comment.
#[macro_export]
macro_rules! metrics {
    ($(#[$about:meta])* pub struct $group:ident {
        $($(#[doc = $help:literal])+ $field:ident: $kind:ident = $make:ident($name:literal $(, $bounds:expr)?),)+
    }) => {
        $(#[$about])*
        #[derive(Debug)]
        pub struct $group { $($(#[doc = $help])+ pub $field: $kind,)+ }

        impl Default for $group {
            fn default() -> $group {
                $(let $field = ::prometheus::Opts::new($name, concat!($($help),+).trim_start());)+
                $group { $($field: $crate::metrics::$make($field $(, $bounds)?),)+ }
            }
        }

        impl $group {
            /// All of them, for the page that Prometheus reads.
            pub fn collectors(&self) -> Vec<Box<dyn ::prometheus::core::Collector>> {
                vec![$(Box::new(self.$field.clone()),)+]
            }
        }
    };
}

pub use metrics;

/// A number that only grows.
///
/// # Panics
/// If the format of Prometheus does not allow the name.
pub fn counter(options: Opts) -> IntCounter {
    IntCounter::with_opts(options).expect(OWN_NAME)
}

/// A number that rises and falls.
///
/// # Panics
/// As [`counter`].
pub fn gauge(options: Opts) -> IntGauge {
    IntGauge::with_opts(options).expect(OWN_NAME)
}

/// How many observations fell below each of some bounds, which rise, and their sum.
///
/// # Panics
/// As [`counter`].
pub fn histogram(options: Opts, bounds: &[f64]) -> Histogram {
    Histogram::with_opts(HistogramOpts::from(options).buckets(bounds.to_vec())).expect(OWN_NAME)
}

/// A unit of a gauge, subtracted when it is dropped.
#[must_use]
#[derive(Debug)]
pub struct Counted<'a>(&'a IntGauge);

impl<'a> Counted<'a> {
    /// Adds one to the gauge.
    pub fn by(gauge: &'a IntGauge) -> Counted<'a> {
        gauge.inc();
        Counted(gauge)
    }
}

impl Drop for Counted<'_> {
    fn drop(&mut self) {
        self.0.dec();
    }
}
