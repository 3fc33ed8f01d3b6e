//! What surrounds every handler, one layer a file.

pub mod access_control;
pub mod request_log;
pub mod request_metrics;
pub mod security_headers;
