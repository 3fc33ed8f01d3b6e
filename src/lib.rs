//! stickslip simulates the frictional contact of two elastic bodies: exactly, with all of its history. It is built in
//! floors; a module imports only from those below it.
//!
//! [`mechanics`] is the physics: plain numbers in SI units, no JSON, no threads, no network.
//!
//! [`figures`] draws the figures of the paper that all this follows, by way of the same engine.

pub mod figures;
pub mod mechanics;
