//! stickslip simulates the frictional contact of two elastic bodies: exactly, with all of its history, over HTTP or as a
//! library. It is built in floors; a module imports only from those below it.
//!
//! [`mechanics`] is the physics: plain numbers in SI units, no JSON, no threads, no network.
//!
//! [`figures`] draws the figures of the paper that all this follows, by way of the same engine.
//!
//! [`report`] measures speed against error, with a reference of its own.
//!
//! [`wire`] has the JSON types, and their checked conversion into those of the mechanics: parse once, then trust.
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
//! [`metrics`] are the counters that every floor may use, and the page that shows them.
//!
//! [`otlp`] makes traces of the log, for OpenTelemetry.
//!
//! [`client`] is a typed client for the service.
//!
//! [`api`] is HTTP: the routes, the problem documents, the OpenAPI document. The binary adds the command line.

pub mod access;
pub mod api;
pub mod client;
pub mod figures;
pub mod jobs;
pub mod mechanics;
pub mod metrics;
pub mod otlp;
mod plot;
pub mod report;
pub mod sessions;
pub mod simulation;
pub mod store;
pub mod wire;
