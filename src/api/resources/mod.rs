//! The resources, one file each.

pub mod accuracy;
pub mod contacts;
pub mod cycle;
pub mod cycles;
pub mod events;
pub mod fit;
pub mod fretting;
pub mod history;
pub mod hysteresis_loop;
pub mod jobs;
pub mod meta;
pub mod metrics;
pub mod moves;
pub mod observations;
pub mod page;
pub mod profile_fit;
pub mod protocols;
pub mod simulate;
pub mod stress;
pub mod subsurface;
pub mod sweep;
mod whole_history;
