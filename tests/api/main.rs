//! The contract over HTTP, and what surrounds it: access, settings, logs, metrics and traces.

#[path = "../harness/answered.rs"]
mod answered;
#[path = "../common/mod.rs"]
mod common;
#[path = "../harness/cycle_laws.rs"]
mod cycle_laws;
#[path = "../harness/cycle_requests.rs"]
mod cycle_requests;
#[path = "../harness/damage.rs"]
mod damage;
#[path = "../harness/depth_requests.rs"]
mod depth_requests;
#[path = "../harness/fit_laws.rs"]
mod fit_laws;
#[path = "../harness/fretting_laws.rs"]
mod fretting_laws;
#[path = "../harness/mod.rs"]
mod harness;
#[path = "../harness/requests.rs"]
mod requests;

mod access;
mod accuracy;
mod bad_input;
mod command_line;
mod compression;
mod computations;
mod contacts;
mod contract;
mod cycle;
mod cycles;
mod cycles_path;
mod documents;
mod events;
mod exposure;
mod faults;
mod first_key;
mod fit;
mod formats;
mod fretting;
mod fuzz_bodies;
mod fuzz_http;
mod lab_files;
mod load_curves;
mod logs;
mod metrics;
mod newest_moves;
mod observations;
mod openapi;
mod otlp;
mod pictures;
mod plane;
mod profile_fit;
mod profiles;
mod protocols;
mod settings;
mod subsurface;
mod sweeps;
mod tls;
mod unread_bodies;
mod warnings;
