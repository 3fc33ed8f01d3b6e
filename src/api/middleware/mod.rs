//! What is around every handler, one file each.

pub mod access_control;
pub mod compression;
pub mod request_log;
pub mod security_headers;
