//! `stickslip fit`: friction and stiffness from a measured loop without a server.

use std::path::PathBuf;

use clap::Args;
use clap::builder::PossibleValuesParser;
use stickslip::admission::Stop;
use stickslip::api::formats::{Format, plots, tables};
use stickslip::simulation;
use stickslip_wire::fit::{FitParameter, FitUnits, ForceUnit, KnownValue, KnownValues, LoopStart, MeasuredLoop};
use stickslip_wire::profile_fit::LengthUnit;
use stickslip_wire::{self as wire, ContactDefinition, Document as _, FitRequest};

use super::io::{json, print, problem, read, write};
use super::table::Table;

/// What is free if the command line does not say.
const USUALLY_FREE: [FitParameter; 3] = [FitParameter::Friction, FitParameter::GStar, FitParameter::ForceOffset];

/// A measured loop, and how to print what it says.
#[derive(Args)]
pub struct Fit {
    /// The file, or - for standard input: columns of displacement and force as text, or the body of POST /fit.
    file: PathBuf,
    /// A file with the definition of the contact, for a file of columns.
    #[arg(long)]
    contact: Option<PathBuf>,
    /// The column of displacements, by its number or its name in the header; without it the one that is called so, or the first.
    #[arg(long, value_name = "COLUMN")]
    displacement: Option<String>,
    /// The column of forces, likewise; the second.
    #[arg(long, value_name = "COLUMN")]
    force: Option<String>,
    /// The column of times, s, if there is one.
    #[arg(long, value_name = "COLUMN")]
    time: Option<String>,
    /// The unit of displacements.
    #[arg(long, value_parser = PossibleValuesParser::new(LengthUnit::ALL.map(LengthUnit::symbol)), default_value = "m")]
    displacement_unit: String,
    /// The unit of forces.
    #[arg(long, value_parser = PossibleValuesParser::new(ForceUnit::ALL.map(ForceUnit::symbol)), default_value = "N")]
    force_unit: String,
    /// The load, N, if it is not that of the contact.
    #[arg(long)]
    normal_force: Option<f64>,
    /// How the record begins: `steady` in a cycle that has been repeated before, `virgin` with a contact that was never moved.
    #[arg(long, value_parser = PossibleValuesParser::new(["steady", "virgin"]))]
    start: Option<String>,
    /// What is to be determined, separated by commas: friction, g_star and force_offset if left out.
    #[arg(long, value_delimiter = ',', value_parser = PossibleValuesParser::new(FitParameter::ALL.map(FitParameter::name)))]
    free: Vec<String>,
    /// What is known in SI units, such as machine_compliance=5e-8+-5e-9, separated by commas.
    #[arg(long, value_delimiter = ',', value_parser = known)]
    known: Vec<(FitParameter, KnownValue)>,
    /// Print the fitted contact alone, for POST /contacts.
    #[arg(long, conflicts_with = "format")]
    only_contact: bool,
    /// The format of the reply.
    #[arg(long, value_parser = PossibleValuesParser::new(Format::ALL.map(Format::name)), default_value = "columns")]
    format: String,
}

impl Fit {
    /// Fits the loop and prints what it says.
    pub fn run(&self) -> Result<(), String> {
        let content = read(&self.file)?;
        let request = if content.trim_ascii_start().starts_with(b"{") {
            wire::parse::<FitRequest>(&content).map_err(problem)?
        } else {
            self.of_columns(&content)?
        };
        let task = request.check().map_err(problem)?;
        let reply = simulation::fit_loops(task, &Stop::default()).map_err(problem)?;
        if self.only_contact {
            return print(json(&reply.contact));
        }
        let format = Format::named(&self.format, &Format::ALL).unwrap_or(Format::Columns);
        let written = format.write(&reply, || plots::loop_fit(&reply), || tables::loop_fit(&reply));
        let written = written.map_err(problem)?;
        write(|out| out.write_all(&written))
    }

    fn of_columns(&self, content: &[u8]) -> Result<FitRequest, String> {
        let contact =
            self.contact.as_ref().ok_or("a file of columns needs --contact FILE, the definition of the contact")?;
        let contact = wire::parse::<ContactDefinition>(&read(contact)?).map_err(problem)?;
        // Headers of instruments may hold any bytes; numbers are plain.
        let measured = self
            .measured(&String::from_utf8_lossy(content))
            .map_err(|error| format!("{}: {error}", self.file.display()))?;
        let named = |name: &String| FitParameter::ALL.into_iter().find(|one| one.name() == name);
        let free: Vec<FitParameter> = self.free.iter().filter_map(named).collect();
        let mut known = KnownValues::default();
        for (parameter, value) in &self.known {
            *known.entry(*parameter) = Some(*value);
        }
        Ok(FitRequest {
            contact,
            loops: vec![measured],
            units: Some(FitUnits {
                displacement: LengthUnit::ALL.into_iter().find(|unit| unit.symbol() == self.displacement_unit),
                force: ForceUnit::ALL.into_iter().find(|unit| unit.symbol() == self.force_unit),
            }),
            free: if free.is_empty() { USUALLY_FREE.to_vec() } else { free },
            known: Some(known),
            noise: None,
        })
    }

    /// The loop in a text of columns; a row that lacks one of its numbers is a gap.
    fn measured(&self, text: &str) -> Result<MeasuredLoop, String> {
        let table = Table::parse(text)?;
        let column = |name: &str| {
            table.column(name).ok_or_else(|| {
                let names = table.names().last().map_or("no names".to_owned(), |names| names.join(", "));
                format!("there is no column `{name}` among {} columns with {names}", table.width())
            })
        };
        let [displacement, force] = match (&self.displacement, &self.force) {
            (None, None) if table.width() == 2 && table.column("force").is_none() => [0, 1],
            (displacement, force) => [
                column(displacement.as_deref().unwrap_or("displacement"))?,
                column(force.as_deref().unwrap_or("force"))?,
            ],
        };
        let time = self.time.as_deref().map(column).transpose()?;
        let rows = table.rows.iter().filter_map(|row| {
            let time = time.map_or(Some(None), |time| row[time].map(Some))?;
            Some((row[displacement]?, row[force]?, time))
        });
        let mut measured = MeasuredLoop {
            displacement: Vec::new(),
            force: Vec::new(),
            time: time.map(|_| Vec::new()),
            normal_force: self.normal_force,
            start: self
                .start
                .as_deref()
                .map(|start| if start == "virgin" { LoopStart::Virgin } else { LoopStart::Steady }),
            weight: None,
        };
        for (displacement, force, time) in rows {
            measured.displacement.push(displacement);
            measured.force.push(force);
            measured.time.iter_mut().zip(time).for_each(|(times, time)| times.push(time));
        }
        Ok(measured)
    }
}

/// What `NAME=VALUE` or `NAME=VALUE+-ERROR` says.
fn known(text: &str) -> Result<(FitParameter, KnownValue), String> {
    let said = || format!("`{text}` is not NAME=VALUE or NAME=VALUE+-STANDARD_ERROR");
    let (name, rest) = text.split_once('=').ok_or_else(said)?;
    let parameter = FitParameter::ALL.into_iter().find(|one| one.name() == name.trim());
    let parameter = parameter
        .ok_or_else(|| format!("`{name}` is none of {}", FitParameter::ALL.map(FitParameter::name).join(", ")))?;
    let number = |text: &str| text.trim().parse::<f64>().map_err(|_| said());
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
        for (text, said) in [("friction", "is not NAME"), ("mu=1", "none of friction"), ("drift=1+-x", "is not NAME")] {
            assert!(known(text).unwrap_err().contains(said), "{text}");
        }
    }
}
