//! A document in, a document out: what the service computes, without HTTP, storage or async. The service, its command
//! line and the Python package call it.
//!
//! [`computations`] lists the computations, each with its name, cost, table and picture, and has the moves of a
//! contact.
//!
//! [`documents`] reads the bodies of calls.
//!
//! [`simulation`] has the parts that the computations share: solvers on their paths, stresses, warnings, sweeps,
//! prepared profiles, costs.
//!
//! [`formats`] writes tables and pictures.
//!
//! Long work asks its [`Stop`] whether to continue. A [`Refusal`] gives the reason for a missing reply. The cost of
//! work is estimated in [`Nanoseconds`].

pub mod computations;
pub mod documents;
pub mod formats;
mod prelude;
mod refusal;
pub mod simulation;
mod stop;

pub use refusal::Refusal;
pub use stop::{Flag, Interrupted, LONGEST_WORK, Part, Stop, begin_work, processor_time};

/// Estimated work, nanoseconds.
pub type Nanoseconds = u64;
