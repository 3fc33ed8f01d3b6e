//! stickslip simulates the frictional contact of two elastic bodies: exactly, with all of its history, over HTTP or as a
//! library. Its modules are layers; a module imports only from those below it.
//!
//! [`simulation`] runs a checked request against the mechanics, at once or on a thread of its own.
//!
//! [`store`] saves definitions of contacts, their moves, and replies for retries. It contains no physics.
//!
//! [`sessions`] are stored contacts: a cache over the store, one writer at a time each, replay, and retries.
//!
//! [`jobs`] are sweeps over many simulations, answered at once or run after the request has been answered.
//!
//! [`access`] is access control: keys, roles and tenants.
//!
//! [`metrics`] are the counters that every layer may use.
//!
//! [`otlp`] sends spans of requests and of their parts to an OpenTelemetry collector.
//!
//! [`api`] is HTTP: the routes, the problem documents, the OpenAPI document. The binary adds the command line.

pub mod access;
pub mod admission;
pub mod api;
pub mod jobs;
pub mod metrics;
pub mod otlp;
pub mod server;
pub mod sessions;
pub mod simulation;
pub mod store;
