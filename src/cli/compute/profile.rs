//! `stickslip profile`: a scan in columns of text.

use std::path::{Path, PathBuf};

use crate::computations::files;
use clap::builder::PossibleValuesParser;
use clap::{Args, Command};
use stickslip_measured::import::ScanHints;
use stickslip_wire::profile_fit::{LengthUnit, ScanLoad, ScanOrientation, Smoothing};
use stickslip_wire::{self as wire, ProfileFitRequest};

use super::{Body, Flags, Only};
use crate::cli::io::{json, read};
use crate::cli::refusal::Refusal;

/// What a file of columns leaves open.
#[derive(Args)]
pub struct ProfileFlags {
    /// The unit of places in a file of columns; without it the one that the header names, or m.
    #[arg(long, value_parser = PossibleValuesParser::new(LengthUnit::ALL.map(LengthUnit::name)))]
    lateral: Option<String>,
    /// The unit of heights in a file of columns, likewise.
    #[arg(long, value_parser = PossibleValuesParser::new(LengthUnit::ALL.map(LengthUnit::name)))]
    height: Option<String>,
    /// The distance of neighbours in a matrix of heights, in the unit of places.
    #[arg(long)]
    spacing: Option<f64>,
    /// A file with the `material`, `friction` and `preload` under which to compute the contact of a file of columns.
    #[arg(long)]
    load: Option<PathBuf>,
    /// Print the profile alone, for the definition of a contact.
    #[arg(long, conflicts_with = "format")]
    only_profile: bool,
}

impl Flags for ProfileFlags {
    fn add(command: Command) -> Command {
        let help = "The file, or - for standard input: two columns (x, z) or three (x, y, z) of text, a matrix of \
                    heights, or the body of POST /profiles/fit";
        Self::augment_args(command).mut_arg("file", |file| file.help(help))
    }

    fn body(&self, file: Option<&Path>) -> Result<Body, Refusal> {
        let file = file.unwrap_or(Path::new("-"));
        let content = read(file)?;
        let is_json = content.trim_ascii_start().starts_with(b"{");
        let only = self.only_profile.then_some(Only::Profile);
        if is_json {
            return Ok(Body { text: content, only, ..Body::default() });
        }
        let (request, reading) = self.of_columns(&content, file)?;
        Ok(Body { text: json(&request).into_bytes(), only, reading, ..Body::default() })
    }
}

impl ProfileFlags {
    fn of_columns(&self, content: &[u8], file: &Path) -> Result<(ProfileFitRequest, Vec<String>), Refusal> {
        let unit = |symbol: &Option<String>| files::length(symbol.as_deref()?);
        let hints =
            ScanHints { lateral: unit(&self.lateral), height: unit(&self.height), spacing: self.spacing, most: 0 };
        let found = files::scan(content, hints).map_err(|error| Refusal::of_file(file, error))?;
        let load = |file: &PathBuf| Ok::<_, Refusal>(wire::parse::<ScanLoad>(&read(file)?)?);
        let load = self.load.as_ref().map(load).transpose()?;
        let request = ProfileFitRequest {
            scan: found.scan,
            units: Some(found.units),
            orientation: Some(ScanOrientation::Auto),
            centre: None,
            level: None,
            smoothing: Some(Smoothing::Auto),
            load,
        };
        Ok((request, found.preview.reading))
    }
}
