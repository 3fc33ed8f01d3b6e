//! What the engine is held against, and drawn by.
//!
//! [`benchmark`] measures speed against error, with a reference of its own. [`figures`] draws the figures of the paper that all
//! this follows. [`plot`] makes panels and charts, as SVG and PNG.

pub mod benchmark;
pub mod figures;
pub mod plot;
