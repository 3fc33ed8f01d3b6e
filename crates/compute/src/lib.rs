//! A document in, a document out: what the service computes, without HTTP, storage or async. The service, its command
//! line and the Python package call it.
//!
//! [`computations`] are what takes a document and gives one, each with its name, cost, table and picture, in one list;
//! and the moves of a contact.
//!
//! [`simulation`] is what they share: solvers on their paths, stresses, warnings, sweeps, prepared profiles, costs.
//!
//! [`formats`] writes tables and pictures.
//!
//! Long work asks its [`Stop`] whether to go on. A [`Refusal`] says why there is no reply. What work costs is estimated
//! in [`Nanoseconds`].

pub mod computations;
pub mod formats;
mod refusal;
pub mod simulation;
mod stop;

pub use refusal::Refusal;
pub use stop::{Flag, Interrupted, LONGEST_WORK, Part, Stop};

/// Estimated nanoseconds of work.
pub type Nanoseconds = u64;
