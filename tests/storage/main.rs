//! Storage, and that nothing of it is lost: every store, the session layer above it, and processes that are killed.

#[path = "../common/mod.rs"]
mod common;

mod ages;
mod backup;
mod check;
mod disk_full;
mod fixtures;
mod freezing_proxy;
mod frozen;
mod gaps;
mod guarantees;
mod hang_ups;
mod in_memory;
mod locks;
mod migrations;
mod order;
mod outside;
mod postgres;
mod replicas;
mod sessions;
mod sqlite_file;
mod turns;
mod usage;
