//! `stickslip subsurface`: the stress below the surface without a server.

use std::path::PathBuf;

use clap::Args;
use clap::builder::PossibleValuesParser;
use stickslip::admission::Stop;
use stickslip::api::formats::{Format, plots, tables};
use stickslip::simulation;
use stickslip_wire::{self as wire, SimulateRequest, Steps};

use super::io::{problem, read, write};

/// The body of POST /simulate with its member `subsurface`, and how to print what that asks for.
#[derive(Args)]
pub struct Subsurface {
    /// The file, or - for standard input.
    file: PathBuf,
    /// The format; a picture is of one of `von_mises`, `max_shear` and `hydrostatic` over a `plane` or the `surface`.
    #[arg(long, value_parser = PossibleValuesParser::new(Format::ALL.map(Format::name)), default_value = "csv")]
    format: String,
}

impl Subsurface {
    /// Computes the stress after the last move and prints it.
    pub fn run(&self) -> Result<(), String> {
        let mut simulation = wire::read::<SimulateRequest>(&read(&self.file)?).map_err(problem)?;
        (simulation.steps, simulation.stress, simulation.residual) = (Steps::Last, None, false);
        let format = Format::named(&self.format, &Format::ALL).unwrap_or(Format::Csv);
        let Some(task) = simulation.subsurface.clone() else {
            return Err("the file asks for no stress below the surface: give the member `subsurface`".to_owned());
        };
        if format.is_plot() && !task.is_section() {
            return Err(plots::NO_SECTION.to_owned());
        }
        let reply = simulation::simulate(&simulation, &Stop::default()).map_err(problem)?;
        let stress = reply.subsurface.unwrap_or_default();
        let written = format.write(&stress, || plots::section(&stress, &task), || tables::subsurface(&stress));
        let written = written.map_err(problem)?;
        write(|out| out.write_all(&written))
    }
}
