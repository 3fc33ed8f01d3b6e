//! Traces for OpenTelemetry: a span for each request, with spans of its parts, sent to a collector.
//!
//! All spans have the target [`SPANS`]. Without a collector no filter admits it, and a span costs a check of a flag.

#[cfg(not(feature = "otlp"))]
mod absent;
#[cfg(feature = "otlp")]
mod export;

#[cfg(not(feature = "otlp"))]
pub use absent::{Exporter, layer, set_parent};
#[cfg(feature = "otlp")]
pub use export::{Exporter, layer, parent, set_parent};

/// The target of all spans that are sent; the log leaves it out.
pub const SPANS: &str = "stickslip::spans";
/// The name of the span of a request, the parent of the others.
pub const REQUEST: &str = "request";

/// A span of a part of a request, such as `store`.
#[macro_export]
macro_rules! part {
    ($name:literal) => {
        tracing::info_span!(target: $crate::otlp::SPANS, $name)
    };
}
pub use part;
