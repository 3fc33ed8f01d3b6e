//! Loops of contacts that are known: does the fit find them, and does it know how surely?

mod bench;
mod coverage;
mod cycle_friction;
mod faults;
mod given;
mod quantised;
mod recovery;
mod scenes;
mod statistics;
mod strength;
mod unmodelled;
