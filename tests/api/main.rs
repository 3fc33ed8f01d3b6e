//! The contract over HTTP, and what surrounds it: access, settings, logs, metrics and traces.

#[path = "../common/mod.rs"]
mod common;

mod access;
mod accuracy;
mod bad_input;
mod contract;
mod corners;
mod events;
mod exposure;
mod formats;
mod logs;
mod metrics;
mod openapi;
mod otlp;
mod profiles;
mod protocols;
mod sessions;
mod settings;
mod warnings;
