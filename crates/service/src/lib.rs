//! What the service stickslip keeps and whom it admits, without HTTP: `stickslip` puts HTTP and the command line on
//! top, and what is computed is in `stickslip-compute`.
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
//! [`mod@metrics`] are counters, gauges and histograms; [`otlp`] sends traces; a [`tenant`] is whom keys, quotas and
//! what is stored belong to. Every module may use them, and TLS to servers that need not be verified,
//! [`unverified_tls`].
//!
//! A module imports only from those below it here; jobs and contacts know nothing of each other.

pub mod access;
pub mod admission;
pub mod jobs;
pub mod metrics;
pub mod otlp;
pub mod sessions;
pub mod store;
pub mod tenant;
pub mod unverified_tls;
