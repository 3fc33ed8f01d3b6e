//! What measured data say about a contact, and how surely.
//!
//! Everything here turns instrument data into the inputs of [`stickslip_mechanics`], with standard errors. It knows the
//! mechanics, and no HTTP, no serde and no async.
//!
//! | module | question |
//! |---|---|
//! | [`scan`] | which profile does a scan of heights show? |
//! | [`loops`] | which friction, stiffness and compliance does a measured loop show? |
//! | [`cycle_friction`] | which friction does the newest measured cycle of a contact show? |
//! | [`import`] | which numbers are in a file of an instrument, and in which units? |

pub mod cycle_friction;
pub mod import;
mod linear;
pub mod loops;
mod quadratic_programme;
mod robust;
pub mod scan;
mod steps;
