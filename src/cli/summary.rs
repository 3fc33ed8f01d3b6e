//! A reply in words and numbers, for a terminal.

use serde_json::Value;

use stickslip_mechanics::unit_prefix;

const INDENT: usize = 2;
const NAMES: usize = 34;
/// Columns that a table of rows begins with, those of the most interest first; the others follow by their names.
const FIRST: [&str; 16] = [
    "time",
    "frequency",
    "displacement",
    "force",
    "twist",
    "torque",
    "stick_radius",
    "regime",
    "dissipated_energy",
    "displacement_amplitude",
    "force_amplitude",
    "twist_amplitude",
    "torque_amplitude",
    "secant_stiffness",
    "loss_factor",
    "radius",
];
/// Columns and rows of a table that a terminal shows; of more rows it shows the first and the last.
const COLUMNS: usize = 6;
const ROWS: usize = 24;
/// Units that descriptions state, longer ones before those that they begin with.
const UNITS: [&str; 20] = [
    "N²/m³", "W/K", "Ω·m", "N·m", "rad", "N/m²", "S", "J/m²", "Pa/N", "N/m", "m/N", "m/s", "Pa", "Hz", "kg", "N", "J",
    "m³", "m", "s",
];

/// A part of the OpenAPI document, and the document.
#[derive(Clone, Copy)]
struct Described<'a>(&'a Value, &'a Value);

impl<'a> Described<'a> {
    /// What it refers to.
    fn resolved(self) -> Described<'a> {
        let place = self.0["$ref"].as_str().and_then(|place| place.strip_prefix('#'));
        place.and_then(|place| self.1.pointer(place)).map_or(self, |part| Described(part, self.1))
    }

    /// A member, in whichever of the alternatives has it.
    fn member(self, name: &str) -> Option<Described<'a>> {
        let own = self.resolved();
        let parts = ["oneOf", "anyOf", "allOf"].into_iter().filter_map(|key| own.0[key].as_array()).flatten();
        let found = own.0["properties"].get(name).map(|member| Described(member, own.1));
        found.or_else(|| parts.chain(own.0.get("items")).find_map(|part| Described(part, own.1).member(name)))
    }

    /// The unit in its description: behind a comma, and not a part of a word or a formula.
    fn unit(self) -> &'static str {
        let text = self.0["description"].as_str().unwrap_or_default();
        let stated = text.match_indices(", ").find_map(|(place, _)| {
            let rest = &text[place + 2..];
            let unit = UNITS.into_iter().find(|unit| rest.starts_with(unit))?;
            let next = rest[unit.len()..].chars().next();
            next.is_none_or(|next| !next.is_alphanumeric() && !"/²^'′_".contains(next)).then_some(unit)
        });
        stated.unwrap_or_default()
    }
}

/// The document of a reply to a `POST` of this path as lines: numbers with six digits and the units that the OpenAPI
/// document states, rows as tables, columns by their number and range, warnings in full.
pub fn summary(reply: &Value, path: &str, document: &Value) -> String {
    let mut lines = Vec::new();
    let schema = &document["paths"][path]["post"]["responses"]["200"]["content"]["application/json"]["schema"];
    members(Some(Described(schema, document)), reply, 0, &mut lines);
    lines.push("--json prints the document.".to_owned());
    lines.join("\n")
}

fn members(described: Option<Described<'_>>, node: &Value, depth: usize, lines: &mut Vec<String>) {
    for (name, value) in node.as_object().into_iter().flatten() {
        let indent = " ".repeat(depth * INDENT);
        let (title, described) = (name.replace('_', " "), described.and_then(|part| part.member(name)));
        match value {
            Value::Object(_) => {
                lines.push(format!("{indent}{title}"));
                members(described, value, depth + 1, lines);
            }
            Value::Array(rows) if name == "warnings" => {
                let message = |row: &Value| format!("{indent}warning: {}", row["message"].as_str().unwrap_or_default());
                lines.extend(rows.iter().map(message));
            }
            Value::Array(rows) if rows.len() == 1 && rows[0].is_object() => {
                lines.push(format!("{indent}{title}"));
                members(described, &rows[0], depth + 1, lines);
            }
            Value::Array(rows) if rows.len() > 1 && rows.iter().all(is_row) => {
                lines.push(format!("{indent}{title}"));
                table(described, rows, &" ".repeat((depth + 1) * INDENT), lines);
            }
            _ => {
                let width = NAMES.saturating_sub(indent.len());
                let unit = described.map_or("", Described::unit);
                lines.push(format!("{indent}{title:width$} {}", text_of(unit, value)));
            }
        }
    }
}

/// Whether a value is a row of a table: it has members in words or numbers.
fn is_row(value: &Value) -> bool {
    value.as_object().is_some_and(|members| members.values().any(is_cell))
}

fn is_cell(value: &Value) -> bool {
    value.is_number() || value.is_string()
}

/// Rows with the same members, below their names.
fn table(described: Option<Described<'_>>, rows: &[Value], indent: &str, lines: &mut Vec<String>) {
    let members = rows[0].as_object().into_iter().flatten();
    let mut names: Vec<&str> = members.filter(|(_, cell)| is_cell(cell)).map(|(name, _)| name.as_str()).collect();
    names.sort_by_key(|name| FIRST.iter().position(|first| first == name).unwrap_or(FIRST.len()));
    names.truncate(COLUMNS);
    let half = ROWS / 2;
    let shown: Vec<&Value> = match rows.len() {
        all if all <= ROWS => rows.iter().collect(),
        all => rows[..half].iter().chain(&rows[all - half..]).collect(),
    };
    let units = names.iter().map(|name| described.and_then(|part| part.member(name)).map_or("", Described::unit));
    let columns: Vec<Vec<String>> = names
        .iter()
        .zip(units)
        .map(|(name, unit)| {
            let cells = shown.iter().map(|row| text_of(unit, &row[name]));
            std::iter::once(name.replace('_', " ")).chain(cells).collect()
        })
        .collect();
    let widths: Vec<usize> =
        columns.iter().map(|column| column.iter().map(|cell| cell.chars().count()).max().unwrap_or(0)).collect();
    for index in 0..=shown.len() {
        let cells = columns.iter().zip(&widths).map(|(column, &width)| format!("{:<width$}", column[index]));
        lines.push(format!("{indent}{}", cells.collect::<Vec<_>>().join("  ")).trim_end().to_owned());
        if index == half && shown.len() < rows.len() {
            lines.push(format!("{indent}... {} more rows: --format csv prints all", rows.len() - shown.len()));
        }
    }
}

/// A value in a line.
fn text_of(unit: &str, value: &Value) -> String {
    match value {
        Value::Null => "none".to_owned(),
        Value::Number(number) if number.is_f64() => quantity(number.as_f64().unwrap_or(f64::NAN), unit),
        Value::String(text) => text.clone(),
        Value::Array(all) => {
            let numbers = all.iter().filter_map(Value::as_f64);
            let [least, most] = [numbers.clone().reduce(f64::min), numbers.reduce(f64::max)];
            match least.zip(most) {
                Some((least, most)) => {
                    let [least, most] = [least, most].map(|value| quantity(value, unit));
                    format!("{} values, {least} to {most}", all.len())
                }
                None if all.iter().all(Value::is_string) => {
                    all.iter().filter_map(Value::as_str).collect::<Vec<_>>().join(", ")
                }
                None => format!("{} rows", all.len()),
            }
        }
        other => other.to_string(),
    }
}

/// A number with six digits, and the prefix that fits its unit.
fn quantity(value: f64, unit: &str) -> String {
    if unit.is_empty() || value == 0.0 {
        return format!("{} {unit}", six(value)).trim_end().to_owned();
    }
    let (divisor, prefix) = unit_prefix(value.abs());
    // Not every terminal has the Greek letter.
    format!("{} {}{unit}", six(value / divisor), prefix.replace('µ', "u"))
}

/// A number with at most six significant digits.
fn six(value: f64) -> String {
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    if rounded == 0.0 || (1e-4..1e7).contains(&rounded.abs()) { rounded.to_string() } else { format!("{rounded:e}") }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::summary;
    use crate::api;

    #[test]
    fn the_steps_of_a_path_are_a_table_with_their_forces() {
        let step = |index: i32| json!({"displacement": 1e-8 * f64::from(index), "force": -0.5, "regime": "stick"});
        let document = serde_json::from_str(api::document()).unwrap();
        let text_of = |steps: i32| {
            let steps: Vec<_> = (1..=steps).map(step).collect();
            summary(&json!({"steps": steps}), "/simulate", &document)
        };
        let few = text_of(3);
        for line in ["  displacement  force    regime", "  10 nm         -500 mN  stick"] {
            assert!(few.lines().any(|one| one == line), "{line} in {few}");
        }
        assert_eq!(few.lines().count(), 1 + 1 + 3 + 1, "{few}");
        let many = text_of(100);
        assert!(many.contains("  ... 76 more rows: --format csv prints all\n  890 nm"), "{many}");
        assert!(many.contains("120 nm") && !many.contains("130 nm") && many.contains("\n  1 um"), "{many}");
    }

    #[test]
    fn a_reply_is_said_in_words_and_numbers() {
        let reply = json!({
            "contact": {"contact_radius": 9.324_437_98e-5, "e_star": 2.307_692e11},
            "steps": [{"force": -1.5, "regime": "partial_slip", "memory_depth": 3}],
            "stress": {"radius": [0.0, 1e-5, 9e-5]},
            "residual": {"peaks": [{"radius": 1e-6}, {"radius": 2e-6}], "max": null, "mean": -2.5e7},
            "accuracy": {"force_error": 1.234_567_89e-16},
            "warnings": [{"code": "rigid", "message": "one body is rigid"}],
        });
        let document = serde_json::from_str(api::document()).unwrap();
        let text = summary(&reply, "/simulate", &document);
        for line in [
            "  contact radius                   93.2444 um",
            "  e star                           230.769 GPa",
            "  force                            -1.5 N",
            "  regime                           partial_slip",
            "  memory depth                     3",
            "  radius                           3 values, 0 m to 90 um",
            "    radius",
            "    1 um",
            "    2 um",
            "  max                              none",
            "  mean                             -25 MPa",
            "  force error                      1.23457e-16",
            "warning: one body is rigid",
        ] {
            assert!(text.lines().any(|one| one == line), "{line} in {text}");
        }
    }
}
