//! `stickslip fretting`: fatigue criteria without a server.

use std::path::PathBuf;

use clap::Args;
use clap::builder::PossibleValuesParser;
use stickslip::admission::Stop;
use stickslip::api::formats::{Format, plots, tables};
use stickslip::simulation;
use stickslip_wire::{self as wire, FrettingRequest};

use super::io::{problem, read, write};

/// The body of POST /fretting, and how to print the reply.
#[derive(Args)]
pub struct Fretting {
    /// The file, or - for standard input.
    file: PathBuf,
    /// The format; a picture is of one criterion over a `plane` or the `surface`.
    #[arg(long, value_parser = PossibleValuesParser::new(Format::ALL.map(Format::name)), default_value = "columns")]
    format: String,
}

impl Fretting {
    /// Rates the cycle and prints it.
    pub fn run(&self) -> Result<(), String> {
        let (_, setup, task) = wire::read::<FrettingRequest>(&read(&self.file)?).map_err(problem)?;
        let format = Format::named(&self.format, &Format::ALL).unwrap_or(Format::Columns);
        if format.is_plot() && !task.is_section() {
            return Err(plots::NO_RATED_SECTION.to_owned());
        }
        let reply = simulation::fretting(setup, &task, &Stop::default()).map_err(problem)?;
        let written = format.write(&reply, || plots::fretting(&reply, &task.places), || tables::fretting(&reply));
        let written = written.map_err(problem)?;
        write(|out| out.write_all(&written))
    }
}
