//! The service stickslip: frictional contact of two elastic bodies, exact and with all of its history, over HTTP. What
//! it computes is in `stickslip-compute`, the JSON types are in `stickslip-wire`. A module imports only from those
//! below it here.
//!
//! [`cli`] is the command line, which the binary and the Python package call.
//!
//! [`api`] is HTTP: routes, middleware, formats, problem documents, the OpenAPI document, the page.
//!
//! [`server`] accepts connections: how many, how long a client may take, how much memory all of it may use.
//!
//! [`access`] is access control: keys, roles and tenants.
//!
//! [`jobs`] are sweeps over many simulations, at once or beyond the request that asks for them.
//!
//! [`sessions`] are the stored contacts with their history: a cache over the store, one writer at a time each, replay,
//! retries.
//!
//! [`admission`] gives permits for solver threads, places and memory, and ends work that takes too long or is not
//! waited for.
//!
//! [`store`] stores what must survive: definitions, moves, snapshots, jobs, and replies for retries. It knows no
//! physics.
//!
//! [`metrics`] are counters, gauges and histograms; [`otlp`] sends traces; a [`tenant`] is whom keys, quotas and what
//! is stored belong to. Every module may use them, and TLS to servers that need not be verified.

pub mod access;
pub mod admission;
pub mod api;
pub mod cli;
pub mod jobs;
pub mod metrics;
pub mod otlp;
pub mod server;
pub mod sessions;
pub mod store;
pub mod tenant;
mod unverified_tls;
