//! `stickslip protocol`: one protocol without a server.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
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
    #[arg(long)]
    kind: Option<KindName>,
    /// Where the path ends.
    #[arg(long)]
    end: Option<End>,
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

#[derive(Clone, Copy, ValueEnum)]
enum KindName {
    Linear,
    EqualPeaks,
    Minimax,
}

#[derive(Clone, Copy, ValueEnum)]
enum End {
    DisplacementZero,
    ForceZero,
    Free,
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
        let file = self.file.as_deref().map(read).transpose()?;
        let mut body = match file {
            // Unchanged, so that a fault is reported at its place.
            Some(file) if !self.has_flags() => return Ok(file),
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
        let name = |value: clap::builder::PossibleValue| json!(value.get_name().replace('-', "_"));
        let mut robustness = members.get("robustness").cloned().unwrap_or_else(|| json!({}));
        for (name, value) in [("amplitude_error", self.amplitude_error), ("friction_error", self.friction_error)] {
            if let Some(value) = value {
                robustness[name] = json!(value);
                members.insert("robustness".to_owned(), robustness.clone());
            }
        }
        let flags = [
            ("reversals", self.reversals.map(|value| json!(value))),
            ("target", self.target.map(|value| json!(value))),
            ("kind", self.kind.and_then(|kind| kind.to_possible_value()).map(name)),
            ("end", self.end.and_then(|end| end.to_possible_value()).map(name)),
            ("start", self.start.map(|value| json!({"displacement": value}))),
        ];
        members.extend(flags.into_iter().filter_map(|(name, value)| Some((name.to_owned(), value?))));
        serde_json::to_vec(&body).map_err(|error| error.to_string())
    }

    fn has_flags(&self) -> bool {
        let numbers = [self.target, self.start, self.amplitude_error, self.friction_error];
        self.contact.is_some()
            || self.reversals.is_some()
            || self.kind.is_some()
            || self.end.is_some()
            || numbers.iter().any(Option::is_some)
    }
}

fn parsed(text: &[u8]) -> Result<Value, String> {
    serde_json::from_slice(text).map_err(|error| format!("not JSON: {error}"))
}
