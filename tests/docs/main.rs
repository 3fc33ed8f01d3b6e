//! The documentation and what it promises: examples, generated clients, dashboards and the report.

#[path = "../common/mod.rs"]
mod common;

mod clients;
mod dashboards;
mod docs;
mod examples;
mod node;
mod page_forms;
mod progress;
mod python;
mod reference;
mod report;
mod system_service;
mod version;
