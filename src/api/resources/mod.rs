//! The resources, one file each.

pub mod contacts;
pub mod cycle;
pub mod cycles;
pub mod events;
pub mod files;
pub mod history;
pub mod hysteresis_loop;
pub mod jobs;
pub mod materials;
pub mod meta;
pub mod metrics;
mod move_series;
pub mod moves;
pub mod observations;
pub mod page;
mod prelude;
pub mod residual;
pub mod stress;
pub mod subsurface;
pub mod sweep;
