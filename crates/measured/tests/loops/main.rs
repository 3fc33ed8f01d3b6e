//! Loops of contacts that are known: does the fit find them, and does it know how surely?

mod bench;
mod faults;
mod quantised;
mod recovery;
mod statistics;
