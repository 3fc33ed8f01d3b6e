//! The service as a process: admission, hostile clients, overload, and its dependencies.

#[path = "../common/mod.rs"]
mod common;

mod admission;
mod hostile_http;
mod overload;
