//! Every field of every reply with its unit and its equations: tables that the site has, from the specification and the
//! table of `openapi/equations_of_fields.md`.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use serde_json::Value;

use crate::common::openapi::{document, operations, reference as name_of};
use crate::docs::anchor;
use crate::equations::{FieldRow, FieldTable, equations, is_end_of};
use crate::python::file;

/// The units of the fields of replies, longer ones before those that they begin with.
const UNITS: [&str; 22] = [
    "N²/m³",
    "W/(m·K)",
    "W/K",
    "Ω·m",
    "N·m",
    "rad",
    "m³",
    "J/m²",
    "Pa/N",
    "N/m²",
    "N/m",
    "m/N",
    "m/s",
    "m^(1−n)",
    "Pa",
    "Hz",
    "N",
    "J",
    "S",
    "m",
    "s",
    "degrees",
];
/// What fields write that take their unit from the one that they belong to.
const OF_ANOTHER: [&str; 2] = ["in the unit of ", "in the SI unit of "];

/// A field of a reply.
struct Row {
    /// Where it is, such as `a.b[].c`.
    place: String,
    /// Its unit, if it is a number and states one.
    unit: Option<String>,
    is_number: bool,
    meaning: String,
}

/// The schemas of replies, and which of them have a section of their own.
struct Reference<'a> {
    schemas: &'a serde_json::Map<String, Value>,
    /// The requests by the schemas of their replies, in the order of the document.
    requests: Vec<(&'a str, Vec<String>)>,
    /// Schemas that several fields refer to.
    parts: BTreeSet<&'a str>,
    equations: FieldTable,
}

/// The members of a node that can have further fields, without its example.
fn children(node: &Value) -> Box<dyn Iterator<Item = &Value> + '_> {
    match node {
        Value::Object(members) => Box::new(members.iter().filter(|(name, _)| *name != "example").map(|(_, it)| it)),
        Value::Array(elements) => Box::new(elements.iter()),
        _ => Box::new(std::iter::empty()),
    }
}

fn collect_references<'a>(node: &'a Value, found: &mut Vec<&'a str>) {
    found.extend(name_of(node));
    children(node).for_each(|child| collect_references(child, found));
}

/// What a schema is one of.
fn alternatives(schema: &Value) -> impl Iterator<Item = &Value> {
    ["oneOf", "anyOf"].into_iter().flat_map(|list| schema[list].as_array().into_iter().flatten())
}

/// The names that a schema allows.
fn names(schema: &Value) -> impl Iterator<Item = String> {
    schema["enum"].as_array().into_iter().flatten().map(|name| format!("`{}`", name.as_str().unwrap()))
}

/// Whether a schema is a list of names, or at most two numbers: a field shows these itself.
fn is_spelled_out(schema: &Value) -> bool {
    let plain = |field: &Value| field["properties"].is_null() && number_kind(field) == Some("number");
    let fields = schema["properties"].as_object();
    schema["enum"].is_array() || fields.is_some_and(|all| all.len() <= 2 && all.values().all(plain))
}

/// The description in one line, fit for a cell of a table.
fn description(node: &Value) -> String {
    node["description"].as_str().unwrap_or_default().replace('\n', " ").replace('|', "\\|")
}

/// The unit that a description states: after a comma, or as that of another field, or none as a pure number.
fn stated_unit(text: &str) -> Option<String> {
    if let Some(rest) = OF_ANOTHER.iter().find_map(|words| text.split_once(words).map(|(_, rest)| rest)) {
        let sentence = rest.split(". ").next().unwrap_or_default();
        let named = sentence.split([',', ';', ':']).next().unwrap_or_default();
        return Some(format!("that of {}", named.trim_end_matches('.')));
    }
    units_after_commas(text).next().map(str::to_owned)
}

fn units_after_commas(text: &str) -> impl Iterator<Item = &'static str> {
    text.match_indices(", ").filter_map(|(at, comma)| {
        let rest = &text[at + comma.len()..];
        if rest.starts_with("a pure number") || rest.starts_with("pure numbers") {
            return Some("1");
        }
        let ends = |tail: &str| !tail.starts_with(|next: char| next.is_alphanumeric() || "/²^_'′".contains(next));
        UNITS.into_iter().find(|unit| rest.strip_prefix(unit).is_some_and(ends))
    })
}

/// The kind of the numbers that a field holds, directly or in arrays and maps.
fn number_kind(node: &Value) -> Option<&str> {
    let kinds = match &node["type"] {
        Value::Array(kinds) => kinds.iter().filter_map(Value::as_str).collect(),
        kind => Vec::from_iter(kind.as_str()),
    };
    match kinds.into_iter().find(|kind| *kind != "null")? {
        "array" => number_kind(&node["items"]),
        "object" => number_kind(&node["additionalProperties"]),
        kind => ["number", "integer"].into_iter().find(|number| *number == kind),
    }
}

impl<'a> Reference<'a> {
    fn new(document: &'a Value) -> Reference<'a> {
        let schemas = document["components"]["schemas"].as_object().unwrap();
        let mut requests: Vec<(&str, Vec<String>)> = Vec::new();
        for (method, path, operation) in operations(document) {
            let replies = operation["responses"].as_object().unwrap().iter();
            for (status, reply) in replies.filter(|(status, _)| status.starts_with('2')) {
                let note = if *status == "202" { ", as a job" } else { "" };
                let mut named = Vec::new();
                collect_references(&reply["content"], &mut named);
                for schema in named {
                    let request = format!("`{method} {path}`{note}");
                    match requests.iter_mut().find(|(known, _)| *known == schema) {
                        Some((_, all)) => all.push(request),
                        None => requests.push((schema, vec![request])),
                    }
                }
            }
        }
        requests.push(("ProblemDocument", vec!["every refusal".to_owned()]));
        let replies: Vec<&str> = requests.iter().map(|(schema, _)| *schema).collect();
        let mut uses: BTreeMap<&str, usize> = BTreeMap::new();
        let mut seen = BTreeSet::new();
        let mut waiting = replies.clone();
        while let Some(name) = waiting.pop() {
            if seen.insert(name) {
                let mut named = Vec::new();
                collect_references(&schemas[name], &mut named);
                // An alternative has its fields in a section, even if it is one of this schema alone.
                named.extend(alternatives(&schemas[name]).filter_map(name_of));
                named.iter().for_each(|name| *uses.entry(name).or_default() += 1);
                waiting.extend(named);
            }
        }
        let is_shared = |(name, count): (&'a str, usize)| {
            let is_part = (count > 1 || replies.contains(&name)) && !is_spelled_out(&schemas[name]);
            is_part.then_some(name)
        };
        let parts = uses.into_iter().filter_map(is_shared).collect();
        Reference { schemas, requests, parts, equations: FieldTable::new() }
    }

    /// A schema by a link to its section.
    fn link(&self, name: &str) -> String {
        format!("[{name}](#{})", name.to_lowercase())
    }

    /// Appends the fields of a schema.
    fn fields(&self, schema: &'a Value, place: &str, unit: Option<&str>, rows: &mut Vec<Row>) {
        for (name, field) in schema["properties"].as_object().into_iter().flatten() {
            let dot = if place.is_empty() { "" } else { "." };
            self.field(field, &format!("{place}{dot}{name}"), &description(field), unit, rows);
        }
        let all = schema["allOf"].as_array().into_iter().flatten();
        for inline in all.chain(alternatives(schema)) {
            match name_of(inline) {
                Some(name) if self.parts.contains(name) => {}
                Some(name) => self.fields(&self.schemas[name], place, unit, rows),
                None => self.fields(inline, place, unit, rows),
            }
        }
    }

    /// What a schema is made of beside its own fields: names, alternatives, and the fields of others.
    fn composition(&self, schema: &Value) -> String {
        let is_part = |choice: &&Value| name_of(choice).is_some_and(|name| self.parts.contains(name));
        let (parts, inline): (Vec<&Value>, Vec<&Value>) = alternatives(schema).partition(is_part);
        let inline: Vec<&Value> =
            inline.into_iter().map(|choice| name_of(choice).map_or(choice, |name| &self.schemas[name])).collect();
        let mut one_of: Vec<String> = names(schema).chain(inline.iter().flat_map(|choice| names(choice))).collect();
        one_of.extend(parts.into_iter().filter_map(name_of).map(|name| self.link(name)));
        if inline.iter().any(|choice| choice["properties"].is_object()) {
            one_of.push(if one_of.is_empty() { "the fields below" } else { "an object" }.to_owned());
        }
        let mut text = String::new();
        if !one_of.is_empty() {
            write!(text, " One of {}.", one_of.join(", ")).unwrap();
        }
        for name in schema["allOf"].as_array().into_iter().flatten().filter_map(name_of) {
            write!(text, " Has the fields of {}.", self.link(name)).unwrap();
        }
        text
    }

    /// Appends a field, and those within it unless they have a section of their own.
    fn field(&self, node: &'a Value, place: &str, said: &str, unit: Option<&str>, rows: &mut Vec<Row>) {
        let inner = match &node["type"] {
            Value::String(kind) if kind == "array" => Some((&node["items"], "[]")),
            Value::String(kind) if kind == "object" && node["additionalProperties"].is_object() => {
                Some((&node["additionalProperties"], ".{name}"))
            }
            _ => None,
        };
        if let Some((inner, mark)) = inner {
            return self.field(inner, &format!("{place}{mark}"), said, unit, rows);
        }
        let kind = number_kind(node);
        let own = stated_unit(said);
        let shown = match (&own, unit, kind) {
            (_, _, Some("integer")) => Some("count".to_owned()),
            (Some(own), Some(of), Some(_)) if own == "that of the quantity" => Some(of.to_owned()),
            // An object of numbers of several units.
            (_, _, None) if units_after_commas(said).count() > 1 => None,
            (own, ..) => own.clone(),
        };
        let mut meaning = said.to_owned();
        let schema = name_of(node).map(|name| (name, &self.schemas[name]));
        let section = schema.filter(|(name, _)| self.parts.contains(name));
        match section {
            Some((name, _)) => write!(meaning, " Fields: {}.", self.link(name)).unwrap(),
            None => meaning.push_str(&self.composition(schema.map_or(node, |(_, schema)| schema))),
        }
        rows.push(Row { place: place.to_owned(), unit: shown, is_number: kind.is_some(), meaning });
        match (section, schema) {
            (Some(_), _) => {}
            (None, Some((_, schema))) => self.fields(schema, place, own.as_deref(), rows),
            (None, None) => self.fields(node, place, unit, rows),
        }
    }

    /// The headings under which the fields of a schema are: its name, and the requests that it is the reply of.
    fn headings<'b>(&'b self, name: &'b str) -> Vec<&'b str> {
        let of = |request: &'b String| request.split('`').nth(1).unwrap_or(request);
        let requests = self.requests.iter().filter(|(schema, _)| *schema == name);
        requests.flat_map(|(_, all)| all.iter().map(of)).chain([name]).collect()
    }

    /// The rows of a schema.
    fn rows(&self, name: &str) -> Vec<Row> {
        let mut rows = Vec::new();
        self.fields(&self.schemas[name], "", None, &mut rows);
        rows
    }

    /// The section of a schema under its heading.
    fn section(&self, name: &'a str) -> String {
        let schema = &self.schemas[name];
        let mut text = format!("{}{}\n\n", description(schema), self.composition(schema));
        let rows = self.rows(name);
        if !rows.is_empty() {
            text.push_str("| field | unit | [equation](equations.md) | |\n|---|---|---|---|\n");
            for Row { place, unit, meaning, .. } in rows {
                let numbers = self.equations.equations_of(&self.headings(name), &place).unwrap_or_default();
                let numbers: Vec<String> = numbers.iter().map(usize::to_string).collect();
                let (unit, numbers) = (unit.unwrap_or_default(), numbers.join(", "));
                writeln!(text, "| `{place}` | {unit} | {numbers} | {meaning} |").unwrap();
            }
            text.push('\n');
        }
        text
    }

    /// The page after its introduction.
    fn page(&self) -> String {
        let mut text = String::from("## Replies by request\n\n");
        for (schema, requests) in &self.requests {
            let section = match self.parts.contains(schema) {
                true => format!("The reply is a {}.\n\n", self.link(schema)),
                false => self.section(schema),
            };
            write!(text, "### {}\n\n{section}", requests.join(", ")).unwrap();
        }
        text.push_str("## Parts of several replies\n\n");
        for name in &self.parts {
            write!(text, "### {name}\n\n{}", self.section(name)).unwrap();
        }
        text.truncate(text.trim_end().len());
        text.push('\n');
        text
    }
}

/// The tables of the page, which the site alone has: `UPDATE=1` writes them where it reads them.
#[test]
fn the_page_of_reference_is_printed_from_the_specification() {
    let document = document();
    let reference = Reference::new(&document);
    let tables = reference.page();
    let headings: BTreeSet<String> = tables.lines().filter(|line| line.starts_with('#')).map(anchor).collect();
    let links: BTreeSet<&str> = tables.split("](#").skip(1).map(|rest| rest.split(')').next().unwrap()).collect();
    assert!(links.len() > 20 && links.iter().all(|link| headings.contains(*link)), "{links:?} {headings:?}");
    if std::env::var_os("UPDATE").is_some() {
        std::fs::create_dir_all(file("site/.cache")).unwrap();
        std::fs::write(file("site/.cache/reference.md"), tables).unwrap();
    }
}

#[test]
fn every_number_of_a_reply_states_its_unit() {
    let document = document();
    let reference = Reference::new(&document);
    let mut numbers = 0;
    for name in reference.requests.iter().map(|(name, _)| name).chain(&reference.parts) {
        for row in reference.rows(name).iter().filter(|row| row.is_number) {
            assert!(row.unit.is_some(), "{name}: {} has no unit: {}", row.place, row.meaning);
            numbers += 1;
        }
    }
    assert!(numbers > 200, "{numbers}");
}

/// Against the contract of the service, by hand.
#[test]
fn the_reference_knows_the_units_of_the_contract() {
    let document = document();
    let reference = Reference::new(&document);
    for (schema, place, unit) in [
        ("State", "force", "N"),
        ("State", "memory_depth", "count"),
        ("Figures", "semi_axes[]", "m"),
        ("Residual", "peaks[].shear", "Pa"),
        ("Residual", "relative", "1"),
        ("Stress", "pressure[]", "Pa"),
        ("Cycle", "secant_stiffness", "N/m"),
        ("ProfileFitReply", "contact.max_pressure.standard_error", "Pa"),
        ("ProfileFitReply", "tilt.x", "1"),
        ("ProfileFitReply", "centre.y", "m"),
        ("FrettingReply", "ruiz_tension", "N²/m³"),
        ("Rating", "values[]", "that of the criterion"),
        ("ElasticBody", "youngs_modulus", "Pa"),
        ("CycleReply", "cycles[].harmonics[].in_phase", "that of the response"),
        ("FitReply", "correlations.{name}.{name}", "1"),
        ("PowerLawProfile", "coefficient", "m^(1−n)"),
    ] {
        let rows = reference.rows(schema);
        let row = rows.iter().find(|row| row.place == place).unwrap_or_else(|| panic!("{schema}: {place}"));
        assert_eq!(row.unit.as_deref(), Some(unit), "{schema}: {place}");
    }
}

/// Counts need no equation.
#[test]
fn every_number_of_a_reply_is_in_the_table_of_equations_and_every_line_of_it_is_of_a_reply() {
    let (document, count) = (document(), equations().len());
    let reference = Reference::new(&document);
    let sections: BTreeSet<&str> =
        reference.requests.iter().map(|(name, _)| *name).chain(reference.parts.iter().copied()).collect();
    let sections: Vec<(Vec<&str>, Vec<Row>)> =
        sections.into_iter().map(|name| (reference.headings(name), reference.rows(name))).collect();
    for (headings, rows) in &sections {
        for row in rows.iter().filter(|row| row.is_number && row.unit.as_deref() != Some("count")) {
            let numbers = reference.equations.equations_of(headings, &row.place);
            let numbers = numbers.unwrap_or_else(|| panic!("{headings:?}: {} is not in the table", row.place));
            assert!(numbers.iter().all(|number| *number <= count), "{headings:?}: {}: {numbers:?}", row.place);
        }
    }
    for FieldRow { heading, field, .. } in &reference.equations.rows {
        let mut rows =
            sections.iter().filter(|(headings, _)| headings.contains(&&**heading)).flat_map(|(_, rows)| rows);
        assert!(rows.any(|row| is_end_of(field, &row.place)), "{heading} has no {field:?}");
    }
}
