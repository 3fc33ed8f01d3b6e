//! The resources, one file each.

pub mod accuracy;
pub mod contacts;
pub mod events;
pub mod jobs;
pub mod meta;
pub mod metrics;
pub mod moves;
pub mod page;
pub mod protocols;
pub mod reads;
pub mod simulate;
pub mod sweep;
