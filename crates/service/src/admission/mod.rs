//! Admission: slots on solver threads, permits for requests and memory, quotas of clients, time limits, cancellation.

mod admitted;
mod client;
mod deadline;
mod fair_scheduler;
mod memory;
mod pool;
mod quota;

pub use admitted::{Admission, UnderWay};
pub use client::Client;
pub use deadline::{Deadline, StopOnDrop};
pub use fair_scheduler::{INTERACTIVE, Kind, SLICE, SolverSlot};
pub use memory::*;
pub use pool::*;
pub use quota::*;
