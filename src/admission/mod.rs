//! Who gets the solver's threads, the places for requests and the memory, and for how long.

mod pool;
mod stop;

pub use pool::*;
pub use stop::*;
