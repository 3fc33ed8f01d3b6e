//! The limits and the form of parameters.

use serde_json::{Value, json};

use stickslip_mechanics::range;
use stickslip_wire::limits;
use stickslip_wire::session::LABEL;

use super::operations;
use crate::api::params::KEY_LENGTH;
use crate::api::query::{DEFAULT_PAGE, PAGE};
use crate::api::resources::stress::QUERY_RADII;

/// Completes the parameters of every operation.
pub fn write(document: &mut Value) {
    for (_, path, operation) in operations(document) {
        for parameter in operation.get_mut("parameters").and_then(Value::as_array_mut).into_iter().flatten() {
            write_parameter(parameter, path);
        }
        if path == "/contacts/{id}/fork" {
            operation["requestBody"]["required"] = json!(false);
        }
    }
}

/// The limits, and the form of lists and of headers.
fn write_parameter(parameter: &mut Value, path: &str) {
    let name = parameter["name"].as_str().unwrap_or_default().to_owned();
    let schema = &mut parameter["schema"];
    let is_integer = schema["type"] == "integer";
    match name.as_str() {
        "limit" => {
            set_range(schema, &PAGE);
            if !path.ends_with("/events") {
                schema["default"] = json!(DEFAULT_PAGE);
            }
        }
        "last" => {
            set_range(schema, &limits::CYCLES);
            if path.ends_with("/cycles") {
                schema["default"] = json!(DEFAULT_PAGE);
            }
        }
        "points_per_move" => set_range(schema, &limits::LOOP_POINTS),
        "points" => set_range(schema, &limits::STRESS_POINTS),
        "after" | "Last-Event-ID" if is_integer => schema["maximum"] = json!(u64::MAX),
        "If-Match" => schema["pattern"] = json!(r#"^("[0-9]{1,19}(\.[0-9a-f]{8})?"|\*)$"#),
        "Idempotency-Key" => {
            schema["minLength"] = json!(1);
            schema["maxLength"] = json!(KEY_LENGTH);
            schema["pattern"] = json!("^[!-~]+$");
        }
        "label" => schema["maxLength"] = json!(LABEL.0),
        "radii" => *schema = numbers(range::CONTACT_RADIUS.min, range::CONTACT_RADIUS.max),
        "displacement" => *schema = numbers(0.0, range::DISPLACEMENT.max),
        "force" => *schema = numbers(0.0, range::FORCE.max),
        "machine_stiffness" => {
            schema["minimum"] = json!(range::MACHINE_STIFFNESS.min);
            schema["maximum"] = json!(range::MACHINE_STIFFNESS.max);
        }
        "harmonics" => set_range(schema, &limits::HARMONICS),
        "fields" => {
            *schema = json!({"type": "array", "items": {"$ref": "#/components/schemas/Field"}, "minItems": 1});
        }
        _ => {}
    }
    if matches!(name.as_str(), "radii" | "displacement" | "force" | "fields") {
        parameter["style"] = json!("form");
        parameter["explode"] = json!(false);
    }
}

/// A list of numbers in a query.
fn numbers(least: f64, most: f64) -> Value {
    json!({"type": "array", "items": {"type": "number", "minimum": least, "maximum": most},
        "minItems": QUERY_RADII.start(), "maxItems": QUERY_RADII.end()})
}

fn set_range(schema: &mut Value, range: &std::ops::RangeInclusive<usize>) {
    schema["minimum"] = json!(range.start());
    schema["maximum"] = json!(range.end());
}
