//! `stickslip profile`: a profile from a scan without a server.

use std::path::PathBuf;

use clap::Args;
use clap::builder::PossibleValuesParser;
use stickslip::admission::Stop;
use stickslip::api::formats::{Format, plots, tables};
use stickslip::simulation;
use stickslip_wire::profile_fit::{LengthUnit, ScanLoad, ScanOrientation, ScanUnits, Smoothing};
use stickslip_wire::{self as wire, Document as _, ProfileFitRequest};

use super::io::{json, print, problem, read, write};
use super::scan_table;

/// A scan, and how to print what it says.
#[derive(Args)]
pub struct Profile {
    /// The file, or - for standard input: two columns (x, z) or three (x, y, z) of text, or the body of POST /profiles/fit.
    file: PathBuf,
    /// The unit of places in a file of columns.
    #[arg(long, value_parser = PossibleValuesParser::new(LengthUnit::ALL.map(LengthUnit::symbol)), default_value = "m")]
    lateral: String,
    /// The unit of heights in a file of columns.
    #[arg(long, value_parser = PossibleValuesParser::new(LengthUnit::ALL.map(LengthUnit::symbol)), default_value = "m")]
    height: String,
    /// A file with the `material`, `friction` and `preload` under which to compute the contact of a file of columns.
    #[arg(long)]
    load: Option<PathBuf>,
    /// Print the profile alone, for the definition of a contact.
    #[arg(long, conflicts_with = "format")]
    only_profile: bool,
    /// The format of the reply.
    #[arg(long, value_parser = PossibleValuesParser::new(Format::ALL.map(Format::name)), default_value = "columns")]
    format: String,
}

impl Profile {
    /// Fits the profile and prints it.
    pub fn run(&self) -> Result<(), String> {
        let content = read(&self.file)?;
        let request = if content.trim_ascii_start().starts_with(b"{") {
            wire::parse::<ProfileFitRequest>(&content).map_err(problem)?
        } else {
            self.of_columns(&content)?
        };
        let task = request.check().map_err(problem)?;
        let reply = simulation::fit_profile(task, &Stop::default()).map_err(problem)?;
        if self.only_profile {
            return print(json(&reply.profile));
        }
        let format = Format::named(&self.format, &Format::ALL).unwrap_or(Format::Columns);
        let written = format.write(&reply, || plots::profile_fit(&reply), || tables::profile_fit(&reply));
        let written = written.map_err(problem)?;
        write(|out| out.write_all(&written))
    }

    fn of_columns(&self, content: &[u8]) -> Result<ProfileFitRequest, String> {
        // Headers of instruments may hold any bytes; numbers are plain.
        let scan = scan_table::parse(&String::from_utf8_lossy(content))
            .map_err(|error| format!("{}: {error}", self.file.display()))?;
        let unit = |symbol: &str| LengthUnit::ALL.into_iter().find(|unit| unit.symbol() == symbol);
        let units = ScanUnits { lateral: unit(&self.lateral), height: unit(&self.height) };
        let load = self.load.as_ref().map(|file| wire::parse::<ScanLoad>(&read(file)?).map_err(problem)).transpose()?;
        Ok(ProfileFitRequest {
            scan,
            units: Some(units),
            orientation: Some(ScanOrientation::Auto),
            centre: None,
            level: None,
            smoothing: Some(Smoothing::Auto),
            load,
        })
    }
}
