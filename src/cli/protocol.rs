//! `stickslip protocol`: one protocol without a server.

use std::path::PathBuf;

use clap::Args;
use serde_json::{Map, Value, json};
use stickslip::admission::Stop;
use stickslip::api::problem::{Code, Problem};
use stickslip::simulation;
use stickslip_wire::protocol::ProtocolSubject;
use stickslip_wire::{self as wire, ProtocolReply, ProtocolRequest};

use super::io::{json, print, problem, read};

/// The body of POST /protocols, or its members as flags; a flag replaces the member of the file.
#[derive(Args)]
pub struct Protocol {
    /// A file with the body of POST /protocols, or - for standard input.
    #[arg(required_unless_present = "contact")]
    file: Option<PathBuf>,
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
    #[arg(long, value_parser = ["linear", "equal-peaks", "minimax"])]
    kind: Option<String>,
    /// Where the path ends.
    #[arg(long, value_parser = ["displacement-zero", "force-zero", "free"])]
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

impl Protocol {
    /// Finds the protocol and prints the reply.
    pub fn run(self) -> Result<(), String> {
        let (subject, task) = wire::read::<ProtocolRequest>(&self.body()?).map_err(problem)?;
        let ProtocolSubject::Virgin(made, first) = subject else {
            return Err(problem(Problem::at(Code::InvalidInput, "/start/contact_id", "needs a running service")));
        };
        let reply: ProtocolReply =
            simulation::protocol_for(&made.1, first, &task, &Stop::default()).map_err(problem)?;
        print(json(&reply))
    }

    /// The body: the file, with the members that flags replace.
    fn body(&self) -> Result<Vec<u8>, String> {
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
        let file = self.file.as_deref().map(read).transpose()?;
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

fn parsed(text: &[u8]) -> Result<Value, String> {
    serde_json::from_slice(text).map_err(|error| format!("not JSON: {error}"))
}
