//! The service as a process: admission, hostile clients, overload, and its dependencies.

#[path = "../common/mod.rs"]
mod common;

mod admission;
mod demo;
mod drain;
mod fairness;
mod hostile_http;
mod largest;
mod memory;
mod overload;
mod profiles;
mod quotas;
mod searches;
mod signals;
mod slow_clients;
mod stops;
