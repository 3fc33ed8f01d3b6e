//! The middleware around every handler, one layer per file.

pub mod access_control;
pub mod compression;
pub mod request_log;
pub mod security_headers;
