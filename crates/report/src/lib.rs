//! Speed against error of the solvers, the figures of the paper, and plots.
//!
//! [`benchmark`] measures speed against error, with a reference solver of its own. [`figures`] draws the figures of
//! Kraft & Pohrt (2016). [`plot`] draws panels and charts, as SVG and PNG.

pub mod benchmark;
pub mod figures;
pub mod plot;
