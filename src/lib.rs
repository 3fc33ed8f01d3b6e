//! The service stickslip: frictional contact of two elastic bodies, exact and with all of its history, over HTTP. What
//! it computes is in `stickslip-compute`, the JSON types are in `stickslip-wire`, and what it keeps and whom it admits
//! is in `stickslip-service`, whose modules have their names here too. A module imports only from those below it here.
//!
//! [`cli`] is the command line, which the binary and the Python package call.
//!
//! [`api`] is HTTP: routes, middleware, formats, problem documents, the OpenAPI document, the page.
//!
//! [`server`] accepts connections: how many, how long a client may take, how much memory all of it may use.

pub mod api;
pub mod cli;
pub mod server;

use stickslip_service::unverified_tls;
pub use stickslip_service::{access, admission, jobs, metrics, otlp, sessions, store, tenant};
