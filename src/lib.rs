//! stickslip simulates the frictional contact of two elastic bodies: exactly, with all of its history. It is built in
//! floors; a module imports only from those below it.
//!
//! [`mechanics`] is the physics: plain numbers in SI units, no JSON, no threads, no network.

pub mod mechanics;
