//! Routes that several modules treat in a way of their own.

/// The metrics.
pub const METRICS: &str = "/metrics";
/// The page.
pub const PAGE: &str = "/";
/// The files of the page.
pub const PAGE_FILES: &str = "/page/{name}";
