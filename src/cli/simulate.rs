//! `stickslip simulate`: one request without a server.

use std::fs::File;
use std::io::{self, Read as _};
use std::path::Path;

use stickslip::admission::Stop;
use stickslip::api::Problem;
use stickslip::simulation;
use stickslip_wire::{self as wire, SimulateRequest};

use super::print;

/// Reads the body of `POST /simulate` and prints the reply.
pub fn simulate(file: &Path) -> Result<(), String> {
    let body = read(file)?;
    let reply = wire::read::<SimulateRequest>(&body)
        .map_err(Problem::from)
        .and_then(|simulation| Ok(simulation::simulate(&simulation, &Stop::default())?))
        .map_err(|problem| json(&problem.document("command line")))?;
    print(json(&reply))
}

/// The content of a file, or of standard input for `-`.
pub fn read(file: &Path) -> Result<Vec<u8>, String> {
    let mut body = Vec::new();
    let read = if file.as_os_str() == "-" {
        io::stdin().lock().read_to_end(&mut body)
    } else {
        File::open(file).and_then(|mut file| file.read_to_end(&mut body))
    };
    read.map(|_| body).map_err(|error| format!("cannot read {}: {error}", file.display()))
}

/// A value as JSON for people.
pub fn json(value: &impl serde::Serialize) -> String {
    serde_json::to_string_pretty(value).unwrap_or_else(|error| error.to_string())
}
