//! The contract over HTTP, and what surrounds it: access, settings, logs, metrics and traces.

#[path = "../../crates/compute/tests/random/cases.rs"]
mod cases;
#[path = "../common/mod.rs"]
mod common;
#[path = "../../crates/compute/tests/random/damage.rs"]
mod damage;

mod access;
mod bad_input;
mod command_line;
mod compression;
mod computations;
mod contacts;
mod contract;
mod cycle;
mod cycles;
mod cycles_path;
mod events;
mod exposure;
mod faults;
mod first_key;
mod fit;
mod formats;
mod fretting;
mod fuzz_http;
mod lab_files;
mod limit_laws;
mod line_contacts;
mod load_curves;
mod logs;
mod metrics;
mod newest_moves;
mod observations;
mod openapi;
mod otlp;
mod pictures;
mod profile_fit;
mod protocols;
mod settings;
mod subsurface;
mod sweeps;
mod table_files;
mod tls;
mod unread_bodies;
mod viscoelastic;
mod warnings;
