//! `stickslip cycle`: steady cycles without a server, and fretting maps.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::str::FromStr;

use clap::Args;
use stickslip::admission::Stop;
use stickslip::simulation::{self, Timer};
use stickslip_mechanics::Setup;
use stickslip_wire::cycle::CycleTask;
use stickslip_wire::{self as wire, CycleRequest, Faults, FrettingMap, JsonPath, LoadSpan};

use super::io::{json, print, problem, read};

/// The columns of a map.
const HEADER: &str =
    "normal_force,displacement_amplitude,force_amplitude,regime,stick_radius,dissipated_energy,loss_factor";

/// The body of POST /cycle, and what to make of it.
#[derive(Args)]
pub struct Cycle {
    /// The file, or - for standard input.
    file: PathBuf,
    /// Print a fretting map instead of the reply: a line of CSV for each amplitude under each of these normal forces, N,
    /// as `from:to:count`, evenly spaced in their logarithm.
    #[arg(long, value_name = "FROM:TO:COUNT")]
    map: Option<Loads>,
}

/// The loads of a map as the command line has them.
#[derive(Clone, Copy)]
struct Loads(FrettingMap);

impl FromStr for Loads {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Loads, &'static str> {
        let parts: Vec<&str> = text.split(':').collect();
        let read = || {
            let [from, to, count] = parts[..] else { return None };
            Some(LoadSpan { from: from.parse().ok()?, to: to.parse().ok()?, count: count.parse().ok()? })
        };
        let sound = |map: &FrettingMap| {
            let mut faults = Faults::default();
            map.check(1, JsonPath::Root, &mut faults);
            faults.is_empty()
        };
        let map = read().map(|normal_force| FrettingMap { normal_force }).filter(sound);
        map.map(Loads).ok_or("from:to:count is needed, with 0 < from < to in N and 2 to 1000 loads")
    }
}

impl Cycle {
    /// Computes the cycles and prints them.
    pub fn run(&self) -> Result<(), String> {
        let (_, setup, task) = wire::read::<CycleRequest>(&read(&self.file)?).map_err(problem)?;
        if let Some(Loads(loads)) = self.map {
            return print(map(setup, &task, loads)?.trim_end());
        }
        let (_, reply) = simulation::cycle_of(setup, &task, &Stop::default()).map_err(problem)?;
        print(json(&reply))
    }
}

/// The cycles of a contact under each of the loads.
fn map(setup: Setup, task: &CycleTask, loads: FrettingMap) -> Result<String, String> {
    let mut lines = format!("{HEADER}\n");
    let stop = Stop::default();
    let contact = simulation::contact(setup, "/contact").map_err(problem)?;
    for load in loads.loads() {
        let reply = simulation::cycles_under(&contact, load, task, Timer::start(), &stop).map_err(problem)?;
        for cycle in reply.cycles {
            let loss = cycle.loss_factor.map(|loss| loss.to_string()).unwrap_or_default();
            let (u, f, c) = (cycle.displacement_amplitude, cycle.force_amplitude, cycle.stick_radius);
            let (regime, work) = (cycle.regime.name(), cycle.dissipated_energy);
            // A text can be written to without end.
            let _ = writeln!(lines, "{load},{u},{f},{regime},{c},{work},{loss}");
        }
    }
    Ok(lines)
}
