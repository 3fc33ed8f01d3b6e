//! `stickslip simulate`: a simulation without a server.

use std::path::Path;

use stickslip::admission::Stop;
use stickslip::simulation;
use stickslip_wire::{self as wire, SimulateRequest};

use super::io::{json, print, problem, read};

/// Reads the body of `POST /simulate` and prints the reply.
pub fn simulate(file: &Path) -> Result<(), String> {
    let simulation = wire::read::<SimulateRequest>(&read(file)?).map_err(problem)?;
    print(json(&simulation::simulate(&simulation, &Stop::default()).map_err(problem)?))
}
