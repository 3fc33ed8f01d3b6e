//! What the OpenAPI document says beyond the attributes of handlers: formats, headers, links, lists in a query, and which
//! members exclude each other. Generated clients and testers go by it.

use serde_json::{Map, Value, json};

use stickslip_mechanics::range;

use crate::api::formats::Format;
use crate::api::limits as server;
use crate::api::openapi::refusal;

/// Writes all of it.
pub fn write(document: &mut Value) {
    if let Some(Value::Object(schemas)) = document.pointer_mut("/components/schemas") {
        write_profiles(schemas);
        write_titles(schemas);
        write_exclusions(schemas);
        write_gaps(schemas);
    }
    let (links, of_jobs) = (links(document, "/contacts/{id}"), links(document, "/jobs/{id}"));
    let Some(Value::Object(paths)) = document.get_mut("paths") else {
        return;
    };
    for (path, operations) in paths {
        for operation in operations.as_object_mut().into_iter().flat_map(Map::values_mut) {
            let parameters = operation.get_mut("parameters").and_then(Value::as_array_mut);
            parameters.into_iter().flatten().for_each(write_parameter);
            write_headers(&mut operation["responses"]);
            operation["responses"]["431"] = json!({"description": format!("The head of the request has more than {} bytes", crate::server::limits::HEAD)});
            if let Some(made) = operation["responses"].get_mut("201") {
                made["links"] = links.clone();
            }
            if let Some(begun) = operation["responses"].get_mut("202") {
                begun["links"] = of_jobs.clone();
            }
        }
        if ["/stress", "/history", "/loop"].iter().any(|end| path.ends_with(end)) {
            write_formats(&mut operations["get"], &Format::ALL);
            write_known(&mut operations["get"], true);
        }
        match path.as_str() {
            "/contacts/{id}" => write_known(&mut operations["get"], false),
            "/sweep" => write_formats(&mut operations["post"], &Format::TABLES),
            "/jobs/{id}/result" => write_formats(&mut operations["get"], &Format::TABLES),
            "/contacts/{id}/events" => write_events(&mut operations["get"]),
            _ => {}
        }
    }
}

/// The `type` of each profile inside it, so that the choice is by reference alone: generators lose one that is composed.
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

/// What stands in the way of each other, or of which one must be there. Generators of types pass over `not`, and over nothing
/// else that could say so.
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
    // A contact may be left out only beside the name of one that lives.
    let named = json!({"required": ["start"], "properties": {"start": {"required": ["contact_id"],
        "description": "One that names a contact."}}});
    let nowhere = json!({"not": {"anyOf": [have(&["contact"]), named]}});
    let protocol = json!([aims[0], aims[1], nowhere]);
    for (schema, wrong) in [
        ("Move", &step),
        ("MoveRequest", &step),
        ("StressRequest", &places),
        ("RelaxRequest", &aims),
        ("ProtocolRequest", &protocol),
    ] {
        schemas[schema]["not"] = json!({"anyOf": wrong});
    }
}

/// Quantities that are nought, or not too small.
fn write_gaps(schemas: &mut Map<String, Value>) {
    let gap = |least: f64| json!({"exclusiveMinimum": 0, "exclusiveMaximum": least});
    for schema in ["ContactDefinition", "CreateRequest"] {
        schemas[schema]["properties"]["friction"]["not"] = gap(range::MIN_POSITIVE_FRICTION);
    }
    for choice in schemas["Preload"]["oneOf"].as_array_mut().into_iter().flatten() {
        if let Some(force) = choice["properties"].get_mut("normal_force") {
            force["not"] = gap(range::MIN_POSITIVE_NORMAL_FORCE);
        }
    }
}

/// From a contact that has just been made, or a job, to all that can be done with it.
fn links(document: &Value, place: &str) -> Value {
    let paths = document["paths"].as_object().into_iter().flatten();
    let operations = paths
        .filter(|(path, _)| path.starts_with(place))
        .filter_map(|(_, operations)| operations.as_object())
        .flat_map(Map::values);
    let link = |operation: &Value| {
        let name = operation["operationId"].as_str()?.to_owned();
        let link = json!({"operationId": name, "parameters": {"id": "$response.body#/id"}});
        Some((name, link))
    };
    Value::Object(operations.filter_map(link).collect())
}

/// The form of what is more than a number or a word.
fn write_parameter(parameter: &mut Value) {
    let items = match parameter["name"].as_str() {
        Some("If-Match") => return parameter["schema"]["pattern"] = json!(r#"^("[0-9]{1,19}"|\*)$"#),
        Some("Idempotency-Key") => {
            parameter["schema"]["minLength"] = json!(1);
            return parameter["schema"]["pattern"] = json!("^[!-~]+$");
        }
        Some("radii") => {
            let (least, most) = (range::CONTACT_RADIUS.min, range::CONTACT_RADIUS.max);
            json!({"type": "array", "items": {"type": "number", "minimum": least, "maximum": most},
                "minItems": server::QUERY_RADII.start(), "maxItems": server::QUERY_RADII.end()})
        }
        Some("fields") => {
            json!({"type": "array", "items": {"$ref": "#/components/schemas/Field"}, "minItems": 1})
        }
        Some("after" | "Last-Event-ID") if parameter["schema"]["type"] == "integer" => {
            return parameter["schema"]["maximum"] = json!(u64::MAX);
        }
        _ => return,
    };
    parameter["schema"] = items;
    parameter["style"] = json!("form");
    parameter["explode"] = json!(false);
}

/// The headers that come with a status, whatever the operation.
fn write_headers(responses: &mut Value) {
    let text = |description: &str| json!({"description": description, "schema": {"type": "string"}});
    for (status, response) in responses.as_object_mut().into_iter().flatten() {
        let header = match status.as_str() {
            "401" => ("WWW-Authenticate", text("`Bearer`")),
            "503" => {
                ("Retry-After", json!({"description": "Seconds to wait", "schema": {"type": "integer", "minimum": 0}}))
            }
            _ => continue,
        };
        response["headers"][header.0] = header.1;
    }
}

/// The answer to those who have the present version already.
fn write_known(operation: &mut Value, varies: bool) {
    let text = |description: &str| json!({"description": description, "schema": {"type": "string"}});
    let tag = operation["responses"]["200"]["headers"]["ETag"].clone();
    operation["responses"]["304"] = json!({
        "description": "The client has this version already, as its If-None-Match says",
        "headers": {"ETag": tag},
    });
    for status in ["200", "304"] {
        let headers = &mut operation["responses"][status]["headers"];
        headers["Cache-Control"] = text("`private, no-cache`: keep it, and ask whether it is still so");
        if varies {
            headers["Vary"] = text("`accept`: another format is another reply");
        }
    }
    if let Some(parameters) = operation["parameters"].as_array_mut() {
        parameters.push(json!({
            "name": "If-None-Match", "in": "header", "required": false, "schema": {"type": "string"},
            "description": "The `ETag` of the version at hand: if it is still the present one, the answer is 304",
        }));
    }
}

/// The formats of a table.
fn write_formats(operation: &mut Value, formats: &[Format]) {
    let names: Vec<_> = formats.iter().map(|format| format.name()).collect();
    for parameter in operation["parameters"].as_array_mut().into_iter().flatten() {
        if parameter["name"] == "format" {
            parameter["schema"]["enum"] = json!(names);
        }
    }
    let content = &mut operation["responses"]["200"]["content"];
    for format in formats.iter().filter(|format| **format != Format::Columns) {
        content[format.media_type()] = json!({"schema": match format {
            Format::Rows => json!({"type": "array", "items": {"type": "object"}}),
            Format::Arrow | Format::Png => json!({"type": "string", "format": "binary"}),
            _ => json!({"type": "string"}),
        }});
    }
    if ["history", "loop"].iter().any(|name| operation["operationId"] == *name) {
        operation["responses"]["200"]["headers"]["Link"] = json!({
            "description": "The place of the next page, `rel=\"next\"`, if there is one", "schema": {"type": "string"},
        });
    }
    operation["responses"]["406"] = refusal("Accept admits none of the formats");
}

/// A server-sent event, by its lines.
fn write_events(operation: &mut Value) {
    let data = |name: &str| json!({"$ref": format!("#/components/schemas/{name}")});
    operation["responses"]["200"]["content"]["text/event-stream"]["schema"] = json!({
        "description": "One event: the lines `event`, `id` and `data`",
        "type": "object",
        "required": ["event", "data"],
        "properties": {
            "event": {"type": "string", "enum": ["state", "end"], "description": "What it tells of"},
            "id": {"type": "string", "description": "The sequence, with an event `state`"},
            "data": {
                "type": "string",
                "description": "What it tells: a `StateEvent`, or an `EndEvent` with the last one",
                "contentMediaType": "application/json",
                "contentSchema": {"oneOf": [data("StateEvent"), data("EndEvent")]},
            },
        },
    });
}
