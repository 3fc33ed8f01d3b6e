//! Speed against error of the solvers, and the figures of the paper.
//!
//! [`benchmark`] measures speed against error, with a reference solver of its own. [`figures`] draws the figures of
//! Kraft & Pohrt (2016). [`rings`] does both for motion in the plane.

pub mod benchmark;
pub mod figures;
pub mod rings;
