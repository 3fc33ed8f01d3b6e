//! What the derived schemas cannot say: which members exclude each other, and which values between the limits are left
//! out. Generated clients and testers rely on it.

use serde_json::{Map, Value, json};

use stickslip_mechanics::range;
use stickslip_wire::fit::FitParameter;

pub fn write(document: &mut Value) {
    if let Some(Value::Object(schemas)) = document.pointer_mut("/components/schemas") {
        write_choices(schemas);
        write_profiles(schemas);
        super::write_keywords(schemas, &additions());
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

/// Closes the alternatives, and names them by the key that chooses, the first that is required: the names become names
/// of types.
fn write_choices(schemas: &mut Map<String, Value>) {
    for (name, schema) in schemas {
        for choice in schema.get_mut("oneOf").and_then(Value::as_array_mut).into_iter().flatten() {
            if choice["type"] == "object" {
                choice["additionalProperties"] = json!(false);
            } else if choice["allOf"].is_array() {
                // What its parts contain counts too.
                choice["unevaluatedProperties"] = json!(false);
            }
            let needed = |key: &&String| choice["required"].as_array().is_some_and(|all| all.contains(&json!(key)));
            let members = choice["properties"].as_object();
            let key = members.and_then(|members| members.keys().find(needed).or_else(|| members.keys().next()));
            if let Some(key) = key {
                let words = key.split('_').map(|word| word[..1].to_uppercase() + &word[1..]);
                choice["title"] = json!(name.clone() + &words.collect::<String>());
            }
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

/// What the derived schemas leave out, to be merged into them: members that exclude each other, or of which one is
/// required; quantities that are either zero or not too small; counts that are even; and ranges of one use of a type.
/// Exclusions are said with `not`, because that is the one form that generators of types ignore rather than fail on.
fn additions() -> Value {
    let have = |names: &[&str]| json!({"required": names});
    let none = |names: &[&str]| {
        let each: Vec<Value> = names.iter().map(|name| have(&[name])).collect();
        json!({"not": {"anyOf": each}})
    };
    let one_of = |names: &[&str]| json!({"anyOf": [have(names), none(names)]});
    let targets = ["displacement", "force", "indentation", "normal_force"];
    let step = json!({"anyOf": [have(&targets[..2]), have(&targets[2..]), none(&targets)]});
    let (places, aims) = (one_of(&["points", "radii"]), one_of(&["reversals", "target"]));
    // The contact may be left out only if `start` names a stored one.
    let named = json!({"required": ["start"], "properties": {"start": {"required": ["contact_id"],
        "description": "One that names a contact."}}});
    let nowhere = json!({"not": {"anyOf": [have(&["contact"]), named]}});
    // Without friction there is nothing to reduce, and no loop to fit.
    let friction = json!({"maximum": 0, "description": "None."});
    let contact = json!({"required": ["friction"], "properties": {"friction": friction},
        "description": "One without friction."});
    let frictionless = json!({"required": ["contact"], "properties": {"contact": contact}});
    let protocol = json!({"anyOf": [aims["anyOf"][0], aims["anyOf"][1], nowhere, frictionless]});
    let gap = |least: f64| json!({"not": {"exclusiveMinimum": 0, "exclusiveMaximum": least}});
    let friction = json!({"properties": {"friction": gap(range::MIN_POSITIVE_FRICTION)}});
    let known = FitParameter::ALL.into_iter().map(|parameter| {
        let range = parameter.range();
        let value = json!({"not": {"minimum": range.min, "maximum": range.max}, "description": "Out of its range."});
        (parameter.name().to_owned(), json!({"not": {"required": ["value"], "properties": {"value": value}}}))
    });
    let known: Map<String, Value> = known.collect();
    json!({
        "ContactDefinition": friction,
        "CreateRequest": friction,
        "ScanLoad": friction,
        "CyclicPath": {"properties": {"points_per_cycle": {"multipleOf": 2}}, "not": one_of(&targets[..2])},
        "FitRequest": {"not": frictionless},
        "KnownValues": {"properties": known},
        "Move": {"not": step},
        "MoveRequest": {"not": step},
        "NormalOscillation": {"not": one_of(&targets[2..])},
        "ProtocolRequest": {"not": protocol},
        "RelaxRequest": {"not": aims},
        "StressRequest": {"properties": {"fields": {"minItems": 1}}, "not": places},
        // No place is above the surface.
        "SubsurfacePlane": {"properties": {"z": {"items": {"minimum": 0}}}},
        // Axes may put in what the base of a sweep leaves out.
        "SweepRequest": {"properties": {"base": {"additionalProperties": true}}},
        "WorkDensity": {"not": places},
    })
}

/// Forces of a preload are either zero or not too small.
fn write_gaps(schemas: &mut Map<String, Value>) {
    for choice in schemas["Preload"]["oneOf"].as_array_mut().into_iter().flatten() {
        if let Some(force) = choice["properties"].get_mut("normal_force") {
            force["not"] = json!({"exclusiveMinimum": 0, "exclusiveMaximum": range::MIN_POSITIVE_NORMAL_FORCE});
        }
    }
}
