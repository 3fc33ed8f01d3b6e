//! Admission: permits for solver threads, places and memory, time limits and cancellation.

mod pool;
mod stop;

pub use pool::*;
pub use stop::*;
