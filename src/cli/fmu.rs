//! `stickslip fmu`: a contact as an FMU, for co-simulation by FMI 2.0.

mod zip;

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;
use serde_json::{Value, json};
use sha2::{Digest as _, Sha256};
use stickslip_compute::Refusal;
use stickslip_compute::documents::Parse as _;
use stickslip_mechanics::profile::families;
use stickslip_mechanics::range::{FRICTION, Range};
use stickslip_mechanics::{Contact, Error, Move, Normal};
use stickslip_wire::{CreateRequest, Document as _};

use super::command_error::CommandError;
use super::io::{json as pretty, read};
use crate::api;

/// The name of the wrapper in the archive, which masters look for.
const IDENTIFIER: &str = "stickslip_fmu";
const LIBRARY: &str = "libstickslip_fmu.so";
/// What is in front of each file of the wrapper's source, which the library carries; its name and a line feed follow.
const SOURCE: &[u8] = b"\0stickslip-fmu-source:";

/// The contact, and where the archive goes.
#[derive(Args)]
pub struct Fmu {
    /// File with the definition of a contact, the body of POST /contacts, or - for standard input.
    file: PathBuf,
    /// The archive to write.
    #[arg(long)]
    out: PathBuf,
    /// Take the indentation as an input, in place of the normal force.
    #[arg(long)]
    indentation: bool,
    /// The wrapper library [default: libstickslip_fmu.so beside this program].
    #[arg(long)]
    library: Option<PathBuf>,
}

/// A variable of modelDescription.xml.
struct Variable {
    name: String,
    about: String,
    unit: &'static str,
    causality: &'static str,
    start: Option<f64>,
    range: Option<Range>,
}

impl Fmu {
    /// Writes the archive.
    pub fn run(self) -> Result<(), String> {
        self.write().map_err(|error| error.message(false))
    }

    fn write(self) -> Result<(), CommandError> {
        let text = read(&self.file)?;
        let request = CreateRequest::parse(&text).map_err(Refusal::from)?;
        let definition = json!(request);
        let setup = request.check().map_err(Refusal::from)?.setup;
        let refused = |error: Error| format!("this contact is not available as an FMU: {error}");
        let contact = Contact::new(setup).map_err(refused)?;
        contact.check_elastic("an FMU").map_err(refused)?;
        // One whose load cannot change is refused here and not by each master.
        let press = Some(Normal::Indentation(contact.indentation()));
        contact.clone().apply(&Move { normal: press, ..Move::default() }).map_err(refused)?;

        let library = self.library.map_or_else(beside, Ok)?;
        let binary = std::fs::read(&library).map_err(|error| {
            let build = "cargo build --release --package stickslip-fmu";
            format!("cannot read {}: {error}; `{build}` builds the library, --library names it", library.display())
        })?;
        let load = if self.indentation { "indentation" } else { "normal_force" };
        let parameters = parameters(&definition);
        let pointers: Vec<&String> = parameters.iter().map(|(pointer, _)| pointer).collect();
        let digest = Sha256::digest(format!("{} {load} {definition}", env!("CARGO_PKG_VERSION")));
        let guid = format!("{{{}}}", const_hex::encode(&digest[..16]));
        let resources = json!({ "guid": guid, "load": load, "definition": definition, "parameters": pointers });
        let mut variables = variables(&contact, self.indentation);
        variables.extend(parameters.into_iter().map(|(_, variable)| variable));

        let platform = if cfg!(target_arch = "x86_64") { "linux64" } else { "aarch64-linux" };
        let mut files = vec![
            ("modelDescription.xml".to_owned(), description(&guid, &variables).into_bytes()),
            (format!("binaries/{platform}/{IDENTIFIER}.so"), binary.clone()),
            ("resources/stickslip.json".to_owned(), pretty(&resources).into_bytes()),
        ];
        files.extend(sources(&binary));
        let out = &self.out;
        std::fs::write(out, zip::archive(&files))
            .map_err(|error| format!("cannot write {}: {error}", out.display()))?;
        Ok(())
    }
}

/// The library beside this program.
fn beside() -> Result<PathBuf, String> {
    let program = std::env::current_exe().map_err(|error| format!("this program does not know its folder: {error}"))?;
    Ok(program.with_file_name(LIBRARY))
}

/// The source of the wrapper, as the library carries it.
fn sources(library: &[u8]) -> Vec<(String, Vec<u8>)> {
    let starts = (0..library.len().saturating_sub(SOURCE.len())).filter(|at| library[*at..].starts_with(SOURCE));
    let files = starts.filter_map(|at| {
        let text = library[at + SOURCE.len()..].split(|byte| *byte == 0).next()?;
        let end = text.iter().position(|byte| *byte == b'\n')?;
        let name = std::str::from_utf8(&text[..end]).ok()?;
        Some((format!("sources/{name}"), text[end + 1..].to_vec()))
    });
    files.collect()
}

/// The numbers of a definition that may be set before a run, each with its place there.
fn parameters(definition: &Value) -> Vec<(String, Variable)> {
    let parameter = |name: &str, about: &str, range: Range, pointer: String| {
        let start = definition.pointer(&pointer).and_then(Value::as_f64);
        let (name, about, unit) = (name.to_owned(), about.to_owned(), range.unit);
        (pointer, Variable { name, about, unit, causality: "parameter", start, range: Some(range) })
    };
    let about = described("ContactDefinition", "friction");
    let friction = parameter("friction", &about, FRICTION, "/friction".to_owned());
    let family = families().iter().find(|family| definition["profile"]["type"] == family.name);
    let of_family = family.into_iter().flat_map(|family| family.parameters);
    let of_profile =
        of_family.map(|each| parameter(each.name, each.about, each.range, format!("/profile/{}", each.name)));
    [friction].into_iter().chain(of_profile).filter(|(_, variable)| variable.start.is_some()).collect()
}

/// Inputs and outputs, in the order that the wrapper knows.
fn variables(contact: &Contact, by_indentation: bool) -> Vec<Variable> {
    let state = contact.state();
    let variable = |name: &str, of: &str, unit, start: Option<f64>| Variable {
        name: name.to_owned(),
        about: described("State", of),
        unit,
        causality: if start.is_some() { "input" } else { "output" },
        start,
        range: None,
    };
    let (load, answer) = if by_indentation {
        (
            variable("indentation", "indentation", "m", Some(state.indentation)),
            ("normal_force_out", "normal_force", "N"),
        )
    } else {
        (
            variable("normal_force", "normal_force", "N", Some(state.normal_force)),
            ("indentation_out", "indentation", "m"),
        )
    };
    vec![
        variable("displacement", "displacement", "m", Some(0.0)),
        load,
        variable("force", "force", "N", None),
        variable(answer.0, answer.1, answer.2, None),
        variable("dissipated_energy", "dissipated_energy", "J", None),
        variable("elastic_energy", "elastic_energy", "J", None),
        variable("stick_radius", "stick_radius", "m", None),
    ]
}

/// What the OpenAPI document says of a member.
fn described(schema: &str, member: &str) -> String {
    let document: Value = serde_json::from_str(api::document()).unwrap_or_default();
    let text = document["components"]["schemas"][schema]["properties"][member]["description"].as_str();
    text.unwrap_or(member).split_whitespace().collect::<Vec<_>>().join(" ")
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// modelDescription.xml of FMI 2.0.
fn description(guid: &str, variables: &[Variable]) -> String {
    let version = env!("CARGO_PKG_VERSION");
    let mut xml = format!(
        r#"<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="stickslip contact" guid="{guid}" version="{version}"
    description="The frictional contact of two elastic bodies, with its slip history"
    generationTool="stickslip {version}" variableNamingConvention="flat" numberOfEventIndicators="0">
  <CoSimulation modelIdentifier="{IDENTIFIER}" canHandleVariableCommunicationStepSize="true"
      canGetAndSetFMUstate="true" canSerializeFMUstate="true"/>
  <UnitDefinitions>
    <Unit name="m"><BaseUnit m="1"/></Unit>
    <Unit name="N"><BaseUnit kg="1" m="1" s="-2"/></Unit>
    <Unit name="J"><BaseUnit kg="1" m="2" s="-2"/></Unit>
  </UnitDefinitions>
  <ModelVariables>
"#
    );
    for (reference, variable) in variables.iter().enumerate() {
        let Variable { name, about, unit, causality, start, range } = variable;
        let variability = if *causality == "parameter" { "fixed" } else { "continuous" };
        let unit = if ["m", "N", "J"].contains(unit) { format!(r#" unit="{unit}""#) } else { String::new() };
        let range = range.map_or(String::new(), |range| format!(r#" min="{:e}" max="{:e}""#, range.min, range.max));
        let start = start.map_or(String::new(), |start| format!(r#" start="{start:e}""#));
        let about = escaped(about);
        writeln!(
            xml,
            r#"    <ScalarVariable name="{name}" valueReference="{reference}" causality="{causality}"
        variability="{variability}" description="{about}"><Real{unit}{range}{start}/></ScalarVariable>"#
        )
        .ok();
    }
    let outputs = (1..).zip(variables).filter(|(_, variable)| variable.causality == "output");
    let unknowns: String = outputs.map(|(index, _)| format!("<Unknown index=\"{index}\"/>")).collect();
    write!(
        xml,
        "  </ModelVariables>\n  <ModelStructure>\n    <Outputs>{unknowns}</Outputs>\n    \
         <InitialUnknowns>{unknowns}</InitialUnknowns>\n  </ModelStructure>\n</fmiModelDescription>\n"
    )
    .ok();
    xml
}
