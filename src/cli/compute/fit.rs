//! `stickslip fit`: a measured loop in columns of text.

use std::path::{Path, PathBuf};

use clap::Args;
use stickslip_compute::Refusal;
use stickslip_compute::computations::files;
use stickslip_measured::import::Mapping;
use stickslip_wire::fit::{FitParameter, KnownValue, KnownValues, LoopStart, MeasuredLoop};
use stickslip_wire::{self as wire, ContactDefinition, FitRequest};

use super::{Body, Flags, QueryFlags, ReplyPart, member, one_of};
use crate::api::LoopFileQuery;
use crate::cli::command_error::CommandError;
use crate::cli::io::read;

/// The flags for what a file of columns leaves open.
#[derive(Args)]
#[command(mut_arg("file", |file| file.help("The file, or - for standard input: columns of displacement and force as \
    text, or the body of POST /fit")))]
pub struct FitFlags {
    /// A file with the definition of the contact, for a file of columns.
    #[arg(long)]
    contact: Option<PathBuf>,
    #[command(flatten)]
    hints: QueryFlags<LoopFileQuery>,
    /// The load, N, if it is not in the file and not that of the contact.
    #[arg(long)]
    normal_force: Option<f64>,
    /// How the record begins: `steady` within a cycle that was repeated before, `virgin` with a contact that was never
    /// moved.
    #[arg(long, value_parser = one_of(&LoopStart::ALL, LoopStart::name))]
    start: Option<LoopStart>,
    /// Quantities to determine, separated by commas [default: what the loop determines].
    #[arg(long, value_delimiter = ',', value_parser = one_of(&FitParameter::ALL, FitParameter::name))]
    free: Vec<FitParameter>,
    /// Known values in SI units, such as machine_compliance=5e-8+-5e-9, separated by commas.
    #[arg(long, value_delimiter = ',', value_parser = known)]
    known: Vec<(FitParameter, KnownValue)>,
    /// Print only the fitted contact, for POST /contacts.
    #[arg(long, conflicts_with = "format")]
    only_contact: bool,
}

impl Flags for FitFlags {
    fn body(self, file: Option<&Path>) -> Result<Body, CommandError> {
        let only = self.only_contact.then_some::<ReplyPart>(|reply| member::<ContactDefinition>(reply, "contact"));
        Ok(Body { only, ..Body::of_file(file, |content, file| self.of_columns(content, file))? })
    }
}

impl FitFlags {
    fn of_columns(self, content: &[u8], file: &Path) -> Result<(FitRequest, Vec<String>), CommandError> {
        let contact = self
            .contact
            .ok_or_else(|| "a file of columns needs --contact FILE, the definition of the contact".to_owned())?;
        let contact = wire::parse::<ContactDefinition>(&read(&contact)?)?;
        let mapping = Mapping::try_from(self.hints.0.map_err(Refusal::from)?);
        let mapping = mapping.map_err(|error| CommandError::of_file(file, error))?;
        let found =
            files::measured_loop(content, &mapping, &|| true).map_err(|error| CommandError::of_file(file, error))?;
        let normal_force = self.normal_force.or(found.measured.normal_force);
        let measured = MeasuredLoop { normal_force, start: self.start, ..found.measured };
        let mut known = KnownValues::default();
        for (parameter, value) in self.known {
            *known.entry(parameter) = Some(value);
        }
        let request = FitRequest {
            contact,
            loops: vec![measured],
            units: Some(found.units),
            free: (!self.free.is_empty()).then_some(self.free),
            known: Some(known),
            noise: None,
        };
        Ok((request, found.preview.reading))
    }
}

/// The name and the known value in `NAME=VALUE` or `NAME=VALUE+-ERROR`.
fn known(text: &str) -> Result<(FitParameter, KnownValue), String> {
    let malformed = || format!("`{text}` is not NAME=VALUE or NAME=VALUE+-STANDARD_ERROR");
    let (name, rest) = text.split_once('=').ok_or_else(malformed)?;
    let parameter = FitParameter::ALL.into_iter().find(|one| one.name() == name.trim());
    let parameter = parameter
        .ok_or_else(|| format!("`{name}` is not one of {}", FitParameter::ALL.map(FitParameter::name).join(", ")))?;
    let number = |text: &str| text.trim().parse::<f64>().map_err(|_| malformed());
    let (value, error) = rest.split_once("+-").map_or((rest, None), |(value, error)| (value, Some(error)));
    Ok((parameter, KnownValue { value: number(value)?, standard_error: error.map(number).transpose()? }))
}

#[cfg(test)]
mod tests {
    use super::{FitParameter, known};

    #[test]
    fn what_is_known_has_a_value_and_perhaps_an_error() {
        let (parameter, value) = known("machine_compliance=5e-8+-5e-9").unwrap();
        assert_eq!(parameter, FitParameter::MachineCompliance);
        assert_eq!((value.value.to_bits(), value.standard_error), (5e-8_f64.to_bits(), Some(5e-9)));
        assert_eq!(known("friction=-1").unwrap().1.standard_error, None);
        for (text, expected) in
            [("friction", "is not NAME"), ("mu=1", "not one of friction"), ("drift=1+-x", "is not NAME")]
        {
            assert!(known(text).unwrap_err().contains(expected), "{text}");
        }
    }
}
