//! Admission: slots on solver threads, permits for requests and memory, quotas of clients, time limits, cancellation.

mod client;
mod fair_scheduler;
mod memory;
mod pool;
mod quota;
mod stop;

pub use client::Client;
pub use fair_scheduler::{INTERACTIVE, Kind, SLICE, SolverSlot};
pub use memory::*;
pub use pool::*;
pub use quota::*;
pub use stop::*;
