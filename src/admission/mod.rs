//! Admission: turns on solver threads, permits for places and memory, quotas of clients, time limits and cancellation.

mod client;
mod memory;
mod pool;
mod quota;
mod stop;
mod turnstile;

pub use client::Client;
pub use memory::*;
pub use pool::*;
pub use quota::*;
pub use stop::*;
pub use turnstile::{INTERACTIVE, Kind, SLICE, Turn};
