//! Whoever connects without the page: generated clients, examples, dashboards.

#[path = "../common/mod.rs"]
mod common;

mod clients;
mod dashboards;
mod docs;
mod examples;
mod python;
mod report;
