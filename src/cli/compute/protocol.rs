//! `stickslip protocol`: the members of the body as flags.

use std::path::{Path, PathBuf};

use clap::builder::{PossibleValue, PossibleValuesParser};
use clap::{Args, Command};
use serde_json::{Map, Value, json};

use super::{Body, Flags};
use crate::cli::io::{parsed, read};
use crate::cli::refusal::Refusal;

/// Names of the API, which may be written with hyphens.
fn names(names: &[&'static str]) -> PossibleValuesParser {
    PossibleValuesParser::new(names.iter().map(|name| PossibleValue::new(*name).alias(name.replace('_', "-"))))
}

/// The body of POST /protocols, or its members as flags; a flag replaces the member of the file.
#[derive(Args)]
pub struct ProtocolFlags {
    /// A file with the definition of a contact: its profile, material, friction and preload.
    #[arg(long)]
    contact: Option<PathBuf>,
    /// Number of reversals.
    #[arg(long, conflicts_with = "target")]
    reversals: Option<usize>,
    /// Find the fewest reversals after which at most this shear stress remains, over mu times the largest pressure.
    #[arg(long)]
    target: Option<f64>,
    /// Kind of protocol.
    #[arg(long, value_parser = names(&["linear", "equal_peaks", "minimax"]))]
    kind: Option<String>,
    /// Where the path ends.
    #[arg(long, value_parser = names(&["displacement_zero", "force_zero", "free"]))]
    end: Option<String>,
    /// First displacement, m [default: that of gross slip].
    #[arg(long)]
    start: Option<f64>,
    /// Estimate the robustness against errors of the displacements: their relative standard deviation.
    #[arg(long)]
    amplitude_error: Option<f64>,
    /// Estimate the robustness against errors of the coefficient of friction: their largest relative size.
    #[arg(long)]
    friction_error: Option<f64>,
}

impl Flags for ProtocolFlags {
    fn add(command: Command) -> Command {
        Self::augment_args(command).mut_arg("file", |file| file.required(false).required_unless_present("contact"))
    }

    fn body(&self, file: Option<&Path>) -> Result<Body, Refusal> {
        Ok(Body { text: self.text(file)?, ..Body::default() })
    }
}

impl ProtocolFlags {
    /// The body: the file, with the members that flags replace.
    fn text(&self, file: Option<&Path>) -> Result<Vec<u8>, String> {
        let name = |value: &String| json!(value.replace('-', "_"));
        let flags = [
            ("reversals", self.reversals.map(|value| json!(value))),
            ("target", self.target.map(|value| json!(value))),
            ("kind", self.kind.as_ref().map(name)),
            ("end", self.end.as_ref().map(name)),
            ("start", self.start.map(|value| json!({"displacement": value}))),
        ];
        let errors = [("amplitude_error", self.amplitude_error), ("friction_error", self.friction_error)];
        let has_flags = self.contact.is_some()
            || flags.iter().any(|(_, value)| value.is_some())
            || errors.iter().any(|(_, value)| value.is_some());
        let file = file.map(read).transpose()?;
        let mut body = match file {
            // Unchanged, so that a fault is reported at its place.
            Some(file) if !has_flags => return Ok(file),
            Some(file) => parsed(&file)?,
            None => Value::Object(Map::new()),
        };
        if let Some(contact) = &self.contact {
            body["contact"] = parsed(&read(contact)?)?;
        }
        let members = body.as_object_mut().ok_or("the body is not an object")?;
        if self.reversals.is_some() || self.target.is_some() {
            members.retain(|name, _| name != "reversals" && name != "target");
        }
        let mut robustness = members.get("robustness").cloned().unwrap_or_else(|| json!({}));
        for (name, value) in errors {
            if let Some(value) = value {
                robustness[name] = json!(value);
                members.insert("robustness".to_owned(), robustness.clone());
            }
        }
        members.extend(flags.into_iter().filter_map(|(name, value)| Some((name.to_owned(), value?))));
        serde_json::to_vec(&body).map_err(|error| error.to_string())
    }
}
