//! `stickslip protocol`: the members of the body as flags.

use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser};
use serde_json::{Map, Value, json};

use super::{Body, Flags};
use crate::cli::command_error::CommandError;
use crate::cli::io::{parsed, read};

/// Names of the API, which may be written with hyphens.
fn names(names: &[&'static str]) -> PossibleValuesParser {
    PossibleValuesParser::new(names.iter().map(|name| PossibleValue::new(*name).alias(name.replace('_', "-"))))
}

/// The body of POST /protocols, or its members as flags; a flag replaces the member of the file.
#[derive(Args)]
#[command(mut_arg("file", |file| file.required(false).required_unless_present("contact")))]
pub struct ProtocolFlags {
    /// A file with the definition of a contact: its profile, material, friction and preload.
    #[arg(long)]
    contact: Option<PathBuf>,
    /// Number of reversals.
    #[arg(long, conflicts_with = "target")]
    reversals: Option<usize>,
    /// Find the fewest reversals after which at most this shear stress remains, relative to mu times the largest
    /// pressure.
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
    /// Estimate the robustness against random errors of the displacements with this relative standard deviation.
    #[arg(long)]
    amplitude_error: Option<f64>,
    /// Estimate the robustness against errors of the coefficient of friction up to this relative size.
    #[arg(long)]
    friction_error: Option<f64>,
}

impl Flags for ProtocolFlags {
    fn body(self, file: Option<&Path>) -> Result<Body, CommandError> {
        let word = |word: &Option<String>| json!(word.as_ref().map(|word| word.replace('-', "_")));
        let contact = self.contact.as_ref().map(|contact| parsed(&read(contact)?)).transpose()?;
        let flags = given([
            ("contact", json!(contact)),
            ("reversals", json!(self.reversals)),
            ("target", json!(self.target)),
            ("kind", word(&self.kind)),
            ("end", word(&self.end)),
            ("start", self.start.map_or(Value::Null, |start| json!({"displacement": start}))),
        ]);
        let errors =
            given([("amplitude_error", json!(self.amplitude_error)), ("friction_error", json!(self.friction_error))]);
        let mut body = match file.map(read).transpose()? {
            // Unchanged, so that a fault is reported at its place.
            Some(text) if flags.is_empty() && errors.is_empty() => return Ok(Body { text, ..Body::default() }),
            Some(text) => parsed(&text)?,
            None => json!({}),
        };
        let members = body.as_object_mut().ok_or_else(|| "the body must be a JSON object".to_owned())?;
        if flags.contains_key("reversals") || flags.contains_key("target") {
            members.retain(|name, _| name != "reversals" && name != "target");
        }
        if !errors.is_empty()
            && let Value::Object(robustness) = members.entry("robustness").or_insert_with(|| json!({}))
        {
            robustness.extend(errors);
        }
        members.extend(flags);
        Ok(Body { text: body.to_string().into_bytes(), ..Body::default() })
    }
}

/// The members of the body that flags give.
fn given<const N: usize>(flags: [(&str, Value); N]) -> Map<String, Value> {
    flags.into_iter().filter(|(_, value)| !value.is_null()).map(|(name, value)| (name.to_owned(), value)).collect()
}
