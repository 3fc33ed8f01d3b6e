//! What the derived schemas cannot say: which members exclude each other, and which values between the limits are left
//! out. Generated clients and testers rely on it.

use serde_json::{Map, Value, json};

use stickslip_mechanics::range;
use stickslip_wire::fit::FitParameter;

pub fn write(document: &mut Value) {
    if let Some(Value::Object(schemas)) = document.pointer_mut("/components/schemas") {
        close_choices(schemas);
        write_profiles(schemas);
        write_titles(schemas);
        write_exclusions(schemas);
        write_gaps(schemas);
        schemas.values_mut().for_each(describe_defaults);
    }
}

/// Puts the defaults of members into their descriptions: a member with the keyword `default` counts as always there for
/// generators of clients, which then ask for it in requests.
fn describe_defaults(schema: &mut Value) {
    let members = schema.get_mut("properties").and_then(Value::as_object_mut);
    for member in members.into_iter().flatten().filter_map(|(_, member)| member.as_object_mut()) {
        let Some(default) = member.remove("default") else { continue };
        let text = member.get("description").and_then(Value::as_str).unwrap_or_default().trim_end();
        let text = format!("{text} Default: {}.", default.as_str().map_or_else(|| default.to_string(), str::to_owned));
        member.insert("description".to_owned(), Value::String(text.trim_start().to_owned()));
    }
}

/// Closes the alternatives: a choice with one key allows no second one.
fn close_choices(schemas: &mut Map<String, Value>) {
    for alternative in schemas.values_mut().filter_map(|schema| schema.get_mut("oneOf")?.as_array_mut()).flatten() {
        if alternative["type"] == "object" {
            alternative["additionalProperties"] = json!(false);
        } else if alternative["allOf"].is_array() {
            // What its parts contain counts too.
            alternative["unevaluatedProperties"] = json!(false);
        }
    }
}

/// The `type` of each profile inside it, so that the choice is by reference alone: generators lose one that is
/// composed.
fn write_profiles(schemas: &mut Map<String, Value>) {
    let mut names = Map::new();
    let choices = schemas["Profile"]["oneOf"].as_array_mut().map(std::mem::take).unwrap_or_default();
    let mut references = Vec::new();
    for choice in &choices {
        let place = &choice["allOf"][0]["$ref"];
        let tag = &choice["allOf"][1]["properties"]["type"];
        let name = place.as_str().and_then(|place| place.rsplit('/').next()).unwrap_or_default();
        let (Some(schema), Some(value)) = (schemas.get_mut(name), tag["enum"][0].as_str()) else { continue };
        schema["properties"]["type"] = tag.clone();
        schema["properties"]["type"]["description"] = json!("The name of this shape.");
        if let Some(required) = schema["required"].as_array_mut() {
            required.push(json!("type"));
        }
        schema["additionalProperties"] = json!(false);
        names.insert(value.to_owned(), place.clone());
        references.push(json!({"$ref": place}));
    }
    schemas["Profile"]["oneOf"] = json!(references);
    schemas["Profile"]["discriminator"] = json!({"propertyName": "type", "mapping": names});
}

/// Names for choices by one key: they become names of types.
fn write_titles(schemas: &mut Map<String, Value>) {
    for (name, schema) in schemas {
        for choice in schema.get_mut("oneOf").and_then(Value::as_array_mut).into_iter().flatten() {
            let key = choice["properties"].as_object().and_then(|members| members.keys().next());
            if let Some(key) = key {
                let words = key.split('_').map(|word| word[..1].to_uppercase() + &word[1..]);
                choice["title"] = json!(name.clone() + &words.collect::<String>());
            }
        }
    }
}

/// Members that exclude each other, or of which one is required. It is said with `not`, because that is the one form
/// that generators of types ignore rather than fail on.
fn write_exclusions(schemas: &mut Map<String, Value>) {
    let have = |names: &[&str]| json!({"required": names});
    let none = |names: &[&str]| {
        let each: Vec<Value> = names.iter().map(|name| have(&[name])).collect();
        json!({"not": {"anyOf": each}})
    };
    let targets = ["displacement", "force", "indentation", "normal_force"];
    let step = json!([have(&targets[..2]), have(&targets[2..]), none(&targets)]);
    let places = ["points", "radii"];
    let places = json!([have(&places), none(&places)]);
    schemas["StressRequest"]["properties"]["fields"]["minItems"] = json!(1);
    // Axes may put in what the base of a sweep leaves out.
    schemas["SweepRequest"]["properties"]["base"]["additionalProperties"] = json!(true);
    let aims = ["reversals", "target"];
    let aims = json!([have(&aims), none(&aims)]);
    // The contact may be left out only if `start` names a stored one.
    let named = json!({"required": ["start"], "properties": {"start": {"required": ["contact_id"],
        "description": "One that names a contact."}}});
    let nowhere = json!({"not": {"anyOf": [have(&["contact"]), named]}});
    // Without friction there is nothing to reduce, and no loop to fit.
    let friction = json!({"maximum": 0, "description": "None."});
    let contact = json!({"required": ["friction"], "properties": {"friction": friction},
        "description": "One without friction."});
    let frictionless = json!({"required": ["contact"], "properties": {"contact": contact}});
    let protocol = json!([aims[0], aims[1], nowhere, frictionless.clone()]);
    let one_of = |names: &[&str]| json!([have(names), none(names)]);
    let (cycles, oscillation) = (one_of(&targets[..2]), one_of(&targets[2..]));
    for (schema, wrong) in [
        ("Move", &step),
        ("MoveRequest", &step),
        ("StressRequest", &places),
        ("WorkDensity", &places),
        ("RelaxRequest", &aims),
        ("ProtocolRequest", &protocol),
        ("CyclicPath", &cycles),
        ("NormalOscillation", &oscillation),
    ] {
        schemas[schema]["not"] = json!({"anyOf": wrong});
    }
    schemas["FitRequest"]["not"] = frictionless;
}

/// Quantities that are either zero or not too small, counts that are even, and ranges of one use of a type.
fn write_gaps(schemas: &mut Map<String, Value>) {
    let gap = |least: f64| json!({"exclusiveMinimum": 0, "exclusiveMaximum": least});
    for schema in ["ContactDefinition", "CreateRequest", "ScanLoad"] {
        schemas[schema]["properties"]["friction"]["not"] = gap(range::MIN_POSITIVE_FRICTION);
    }
    schemas["CyclicPath"]["properties"]["points_per_cycle"]["multipleOf"] = json!(2);
    for parameter in FitParameter::ALL {
        let range = parameter.range();
        let value = json!({"not": {"minimum": range.min, "maximum": range.max}, "description": "Out of its range."});
        schemas["KnownValues"]["properties"][parameter.name()]["not"] =
            json!({"required": ["value"], "properties": {"value": value}});
    }
    // No place is above the surface.
    schemas["SubsurfacePlane"]["properties"]["z"]["items"]["minimum"] = json!(0);
    for choice in schemas["Preload"]["oneOf"].as_array_mut().into_iter().flatten() {
        if let Some(force) = choice["properties"].get_mut("normal_force") {
            force["not"] = gap(range::MIN_POSITIVE_NORMAL_FORCE);
        }
    }
}
