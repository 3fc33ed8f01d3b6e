//! `stickslip profile`: a scan in columns of text.

use std::path::{Path, PathBuf};

use clap::Args;
use stickslip_compute::Refusal;
use stickslip_compute::computations::files;
use stickslip_measured::import::Mapping;
use stickslip_wire::profile_fit::{ScanLoad, ScanOrientation, Smoothing};
use stickslip_wire::{self as wire, Profile, ProfileFitRequest};

use super::{Body, Flags, QueryFlags, ReplyPart, member};
use crate::api::ScanFileQuery;
use crate::cli::command_error::CommandError;
use crate::cli::io::read;

/// The flags for what a file of columns leaves open.
#[derive(Args)]
#[command(mut_arg("file", |file| file.help("The file, or - for standard input: two columns (x, z) or three (x, y, z) \
    of text, a matrix of heights, or the body of POST /profiles/fit")))]
pub struct ProfileFlags {
    #[command(flatten)]
    hints: QueryFlags<ScanFileQuery>,
    /// A file with `material`, `friction` and `preload`, for which to compute the contact of a file of columns.
    #[arg(long)]
    load: Option<PathBuf>,
    /// Print only the profile, for the definition of a contact.
    #[arg(long, conflicts_with = "format")]
    only_profile: bool,
}

impl Flags for ProfileFlags {
    fn body(self, file: Option<&Path>) -> Result<Body, CommandError> {
        let only = self.only_profile.then_some::<ReplyPart>(|reply| member::<Profile>(reply, "profile"));
        Ok(Body { only, ..Body::of_file(file, |content, file| self.of_columns(content, file))? })
    }
}

impl ProfileFlags {
    fn of_columns(self, content: &[u8], file: &Path) -> Result<(ProfileFitRequest, Vec<String>), CommandError> {
        let mapping = Mapping::try_from(self.hints.0.map_err(Refusal::from)?);
        let mapping = mapping.map_err(|error| CommandError::of_file(file, error))?;
        let found = files::scan(content, &mapping, &|| true).map_err(|error| CommandError::of_file(file, error))?;
        let load = |file: PathBuf| Ok::<_, CommandError>(wire::parse::<ScanLoad>(&read(&file)?)?);
        let load = self.load.map(load).transpose()?;
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
