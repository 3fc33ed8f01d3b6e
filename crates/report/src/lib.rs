//! Speed against error of the solvers, and the figures of the paper.
//!
//! [`benchmark`] measures speed against error, with a reference solver of its own. [`figures`] draws the figures of
//! Kraft & Pohrt (2016).

pub mod benchmark;
pub mod figures;
