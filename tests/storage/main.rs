//! What is stored, and that nothing of it is lost: every store, the session layer above it, and processes that die.

#[path = "../common/mod.rs"]
mod common;

mod backup;
mod check;
mod contract;
mod disk_full;
mod durability;
mod postgres;
mod promises;
mod replicas;
mod sessions;
mod sqlite_file;
