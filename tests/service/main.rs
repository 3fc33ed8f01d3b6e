//! The service as a process: hostile clients, overload, and its dependencies.

#[path = "../common/mod.rs"]
mod common;

mod hostile_http;
mod overload;
