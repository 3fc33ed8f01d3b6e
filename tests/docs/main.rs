//! The documentation and what it promises: examples, generated clients and dashboards.

#[path = "../common/mod.rs"]
mod common;

mod clients;
mod dashboards;
mod docs;
mod equations;
mod examples;
mod fmu;
mod node;
mod page_forms;
mod printed;
mod progress;
mod python;
mod reference;
mod reference_suite;
mod system_service;
mod version;
