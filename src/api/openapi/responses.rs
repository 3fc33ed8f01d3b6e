//! Headers, formats, examples and links of responses.

use serde_json::{Map, Value, json};

use super::operations;
use super::refusals::refusal;
use crate::api::facts::FactsOfRoutes;
use stickslip_compute::formats::Format;

/// Replies of the program by operation: `UPDATE=1 cargo test --test api shows_a_reply` prints them anew.
const EXAMPLES: &str = include_str!("../../../openapi/examples.json");

pub fn write(document: &mut Value, facts: &FactsOfRoutes) {
    let examples: Map<String, Value> = serde_json::from_str(EXAMPLES).unwrap_or_default();
    let (of_contacts, of_jobs) = (links(document, "/contacts/{id}"), links(document, "/jobs/{id}"));
    for (method, path, operation) in operations(document) {
        write_headers(&mut operation["responses"]);
        for (status, links) in [("201", &of_contacts), ("202", &of_jobs)] {
            if let Some(made) = operation["responses"].get_mut(status) {
                made["links"] = links.clone();
            }
        }
        let Some(facts) = facts.get(&method.to_uppercase(), path) else { continue };
        if !facts.formats.is_empty() {
            write_formats(operation, facts.formats);
        }
        if facts.paged {
            operation["responses"]["200"]["headers"]["Link"] =
                text("The URL of the next page (`rel=\"next\"`), if there is one");
        }
        if facts.conditional {
            write_conditional(operation, !facts.formats.is_empty());
        }
        if !facts.events.is_empty() {
            write_events(operation, facts.events);
        }
        write_example(operation, &examples);
    }
}

/// Links from a new contact or job to every operation on it.
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

fn text(description: &str) -> Value {
    json!({"description": description, "schema": {"type": "string"}})
}

/// The headers that come with a status, whatever the operation.
fn write_headers(responses: &mut Value) {
    for (status, response) in responses.as_object_mut().into_iter().flatten() {
        let header = match status.as_str() {
            "401" => ("WWW-Authenticate", text("`Bearer`")),
            "429" | "503" => {
                ("Retry-After", json!({"description": "Seconds to wait", "schema": {"type": "integer", "minimum": 0}}))
            }
            _ => continue,
        };
        response["headers"][header.0] = header.1;
    }
}

/// The answer 304 to a client that has the current version.
fn write_conditional(operation: &mut Value, varies: bool) {
    let tag = operation["responses"]["200"]["headers"]["ETag"].clone();
    operation["responses"]["304"] = json!({
        "description": "The client already has this version (If-None-Match)",
        "headers": {"ETag": tag},
    });
    for status in ["200", "304"] {
        let headers = &mut operation["responses"][status]["headers"];
        headers["Cache-Control"] =
            text("`private, no-cache`: the client may keep the reply, and asks before using it again");
        if varies {
            headers["Vary"] = text("`accept`: another format is another reply");
        }
    }
    if let Some(parameters) = operation["parameters"].as_array_mut() {
        parameters.push(json!({
            "name": "If-None-Match", "in": "header", "required": false, "schema": {"type": "string"},
            "description": "The `ETag` of the version that the client has; if it is still current, the answer is 304",
        }));
    }
}

/// The formats of a table.
fn write_formats(operation: &mut Value, formats: &[Format]) {
    let content = &mut operation["responses"]["200"]["content"];
    for format in formats.iter().filter(|format| **format != Format::Columns) {
        content[format.media_type()] = json!({"schema": match format {
            Format::Rows => json!({"type": "array", "items": {"type": "object"}}),
            Format::Arrow | Format::Png => json!({"type": "string", "format": "binary"}),
            _ => json!({"type": "string"}),
        }});
    }
    operation["responses"]["406"] = refusal("Accept admits none of the formats");
}

/// Server-sent events: a text to clients that read a reply whole, and to those that follow it, one event after the
/// other.
fn write_events(operation: &mut Value, data: &[&str]) {
    let schemas: Vec<Value> = data.iter().map(|name| json!({"$ref": format!("#/components/schemas/{name}")})).collect();
    let event = json!({
        "title": operation["operationId"].as_str().unwrap_or_default().to_owned() + "_event",
        "description": "One event, by its lines",
        "type": "object",
        "required": ["event", "data"],
        "properties": {
            "event": {"type": "string", "description": "The kind of event"},
            "id": {"type": "string", "description": "The sequence, with an event `state`"},
            "data": {
                "type": "string",
                "description": format!("A `{}`", data.join("` or, in the last event, a `")),
                "contentMediaType": "application/json",
                "contentSchema": {"oneOf": schemas},
            },
        },
    });
    let text = json!({"type": "string", "description": "The lines of the events"});
    operation["responses"]["200"]["content"]["text/event-stream"]["schema"] = json!({"anyOf": [text, event]});
}

/// Adds what the program replied to the first example of each request, and to readers of the contact that it makes.
fn write_example(operation: &mut Value, examples: &Map<String, Value>) {
    let name = operation["operationId"].as_str().unwrap_or_default().to_owned();
    for (status, response) in operation["responses"].as_object_mut().into_iter().flatten() {
        let example = match status.as_str() {
            "200" | "201" => examples.get(&name),
            "202" => examples.get("get_job"),
            _ => None,
        };
        let content = response.get_mut("content").and_then(Value::as_object_mut);
        for (media, content) in content.into_iter().flatten() {
            let is_shown = ["application/json", "text/event-stream", "text/plain"].contains(&media.as_str());
            if let Some(example) = example.filter(|_| is_shown) {
                content["example"] = example.clone();
            }
        }
    }
}
