//! The service as a process: hostile clients, overload, and what it is made of.

#[path = "../common/mod.rs"]
mod common;

mod hostile_http;
mod overload;
