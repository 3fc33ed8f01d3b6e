//! `stickslip cycle`: steady cycles without a server.

use std::path::Path;

use stickslip::admission::Stop;
use stickslip::simulation;
use stickslip_wire::{self as wire, CycleRequest};

use super::io::{json, print, problem, read};

/// Reads the body of `POST /cycle` and prints the reply.
pub fn cycle(file: &Path) -> Result<(), String> {
    let (_, setup, task) = wire::read::<CycleRequest>(&read(file)?).map_err(problem)?;
    let (_, reply) = simulation::cycle_of(setup, &task, &Stop::default()).map_err(problem)?;
    print(json(&reply))
}
