//! stickslip simulates the frictional contact of two elastic bodies: exactly, with all of its history, over HTTP or as a
//! library. It is built in floors; a module imports only from those below it.
//!
//! [`simulation`] runs a checked request against the mechanics, at once or on a thread of its own.
//!
//! [`store`] keeps what must survive: definitions, moves, and replies that a retry is owed. It knows no physics.
//!
//! [`sessions`] are contacts that live: a cache over the store, one writer at a time each, replay, and retries.
//!
//! [`jobs`] are sweeps over many simulations, at once or beyond the request that asks for them.
//!
//! [`access`] says who may do what: keys, roles and tenants.
//!
//! [`metrics`] are the counters that every floor may use.
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
