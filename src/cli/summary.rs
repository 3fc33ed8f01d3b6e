//! A reply in words and numbers, for a terminal.

use serde_json::Value;

use stickslip_mechanics::unit_prefix;

const INDENT: usize = 2;
const NAMES: usize = 34;
/// Units by the last words of a name after that of the object around it; the first that fits.
const UNITS: [(&str, &str); 22] = [
    ("_error", ""),
    ("sliding_ratio", ""),
    ("loss_factor", ""),
    ("radius_of_curvature", "m"),
    ("gross_slip_force", "N"),
    ("stiffness", "N/m"),
    ("energy", "J"),
    ("force_amplitude", "N"),
    ("force", "N"),
    ("radius", "m"),
    ("displacement_amplitude", "m"),
    ("displacement", "m"),
    ("indentation", "m"),
    ("pressure", "Pa"),
    ("shear", "Pa"),
    ("residual_centre", "Pa"),
    ("residual_max", "Pa"),
    ("residual_mean", "Pa"),
    ("residual_min", "Pa"),
    ("e_star", "Pa"),
    ("g_star", "Pa"),
    ("compute_time", "s"),
];

/// The document of a reply as lines: numbers with six digits, columns by their number and range, warnings in full.
pub fn summary(reply: &Value) -> String {
    let mut lines = Vec::new();
    members("", reply, 0, &mut lines);
    lines.push("--json prints the document.".to_owned());
    lines.join("\n")
}

fn members(around: &str, node: &Value, depth: usize, lines: &mut Vec<String>) {
    for (name, value) in node.as_object().into_iter().flatten() {
        let indent = " ".repeat(depth * INDENT);
        let title = name.replace('_', " ");
        match value {
            Value::Object(_) => {
                lines.push(format!("{indent}{title}"));
                members(name, value, depth + 1, lines);
            }
            Value::Array(rows) if name == "warnings" => {
                let message = |row: &Value| format!("{indent}warning: {}", row["message"].as_str().unwrap_or_default());
                lines.extend(rows.iter().map(message));
            }
            Value::Array(rows) if rows.len() == 1 && rows[0].is_object() => {
                lines.push(format!("{indent}{title}"));
                members(name, &rows[0], depth + 1, lines);
            }
            _ => {
                let width = NAMES.saturating_sub(indent.len());
                lines.push(format!("{indent}{title:width$} {}", text_of(&format!("{around}_{name}"), value)));
            }
        }
    }
}

/// A value in a line.
fn text_of(name: &str, value: &Value) -> String {
    match value {
        Value::Null => "none".to_owned(),
        Value::Number(number) if number.is_f64() => quantity(number.as_f64().unwrap_or(f64::NAN), unit(name)),
        Value::String(text) => text.clone(),
        Value::Array(all) => {
            let numbers = all.iter().filter_map(Value::as_f64);
            let [least, most] = [numbers.clone().reduce(f64::min), numbers.reduce(f64::max)];
            match least.zip(most) {
                Some((least, most)) => {
                    let [least, most] = [least, most].map(|value| quantity(value, unit(name)));
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

fn unit(name: &str) -> &'static str {
    UNITS.iter().find(|(end, _)| name.ends_with(end)).map_or("", |(_, unit)| unit)
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
        let text = summary(&reply);
        for line in [
            "  contact radius                   93.2444 um",
            "  e star                           230.769 GPa",
            "  force                            -1.5 N",
            "  regime                           partial_slip",
            "  memory depth                     3",
            "  radius                           3 values, 0 m to 90 um",
            "  peaks                            2 rows",
            "  max                              none",
            "  mean                             -25 MPa",
            "  force error                      1.23457e-16",
            "warning: one body is rigid",
        ] {
            assert!(text.lines().any(|one| one == line), "{line} in {text}");
        }
    }
}
