//! What an operation has beyond what its handler declares: the key that it needs, refusals, headers, formats, events
//! and examples. They follow from its facts, from its parameter `format`, and from the `ETag` of what a reader gets.

use std::sync::LazyLock;

use serde_json::{Map, Value, json};

use crate::access::Role;
use crate::api::facts::{Facts, Refusal};
use crate::api::problem::MEDIA_TYPE;
use crate::server::connection_limits::HEAD;
use stickslip_compute::formats::Format;

/// Of what is computed or stored.
const LIMITED: &[Refusal] = &[
    ("429", "The quota of the client is used up; try again after Retry-After"),
    ("422", "The request is invalid, or the mechanics has no answer to it"),
    ("503", "The server is busy; try again after Retry-After"),
];
/// Of a stored contact.
const EXPIRED: &[Refusal] = &[("410", "The contact was idle for so long that it has expired")];
/// Of a change of a stored contact.
const CHANGES: &[Refusal] = &[
    ("409", "The state of the contact forbids this"),
    ("412", "The contact has another sequence, or another label, than If-Match gives"),
];
/// Of every operation with a body.
const OF_BODIES: &[Refusal] = &[
    ("400", "The body is not valid JSON"),
    ("408", "The body did not arrive in time"),
    ("413", "The body is too large"),
    ("415", "The body is not declared as a media type that the operation takes"),
];

/// Replies of the program by operation: `UPDATE=1 cargo test --test api shows_a_reply` prints them anew.
static EXAMPLES: LazyLock<Map<String, Value>> =
    LazyLock::new(|| serde_json::from_str(include_str!("../../../openapi/examples.json")).unwrap_or_default());

/// Completes an operation.
pub fn complete(method: &str, path: &str, operation: &mut Value, facts: &Facts) {
    refuse(path, operation, facts);
    let named = parameters(operation).filter(|parameter| parameter["name"] == "format");
    let named: Vec<Value> = named.filter_map(|format| format["schema"]["enum"].as_array()).flatten().cloned().collect();
    if !named.is_empty() {
        operation["responses"]["406"] = refusal("Accept admits none of the formats");
        for format in Format::ALL.iter().filter(|format| **format != Format::Columns) {
            if named.contains(&json!(format.name())) {
                operation["responses"]["200"]["content"][format.media_type()] = json!({"schema": schema(*format)});
            }
        }
    }
    if method == "GET" && operation["responses"]["200"]["headers"]["ETag"].is_object() {
        tell_versions(operation, !named.is_empty());
    }
    let name = operation["operationId"].as_str().unwrap_or_default().to_owned();
    if !facts.events.is_empty() {
        let lines = json!({"type": "string", "description": "The lines of the events"});
        operation["responses"]["200"]["content"]["text/event-stream"]["schema"] =
            json!({"anyOf": [lines, event(&name, facts.events)]});
    }
    show_examples(operation, &name);
}

fn parameters(operation: &Value) -> impl Iterator<Item = &Value> {
    operation["parameters"].as_array().into_iter().flatten()
}

/// Adds the refusals that an operation can meet, and the key that it needs.
fn refuse(path: &str, operation: &mut Value, facts: &Facts) {
    let is_conditional = parameters(operation).any(|parameter| parameter["name"] == "If-Match");
    let refusals = [
        (matches!(facts.role, Some(Role::Read | Role::Write)), LIMITED),
        (path.starts_with("/contacts/{"), EXPIRED),
        (is_conditional, CHANGES),
        (operation["requestBody"].is_object(), OF_BODIES),
        (true, facts.refusals),
    ];
    if facts.optional_body {
        operation["requestBody"]["required"] = json!(false);
    }
    operation["security"] = facts.role.map_or(json!([]), |_| json!([{"key": []}, {}]));
    let responses = &mut operation["responses"];
    responses["431"] = json!({"description": format!("The head of the request has more than {HEAD} bytes")});
    if path.contains('{') {
        responses["404"] = refusal("Not found");
    }
    for (status, description) in refusals.iter().filter(|(applies, _)| *applies).flat_map(|(_, refusals)| *refusals) {
        responses[*status] = refusal(description);
        if ["429", "503"].contains(status) {
            let seconds = json!({"type": "integer", "minimum": 0});
            responses[*status]["headers"] =
                json!({"Retry-After": {"description": "Seconds to wait", "schema": seconds}});
        }
    }
    if let Some(role) = facts.role {
        responses["401"] = refusal("The request has no key, or one that is not a key of the server");
        responses["401"]["headers"] = json!({"WWW-Authenticate": text("`Bearer`")});
        responses["403"] = refusal(&format!(
            "The key does not have the role `{}`, or, without keys, the request comes from another site",
            role.name()
        ));
    }
}

fn refusal(description: &str) -> Value {
    let document = json!({"schema": {"$ref": "#/components/schemas/ProblemDocument"}});
    json!({"description": description, "content": {MEDIA_TYPE: document}})
}

/// A header that is a text.
fn text(description: &str) -> Value {
    json!({"description": description, "schema": {"type": "string"}})
}

/// The schema of a reply in a format other than the document.
fn schema(format: Format) -> Value {
    match format {
        Format::Rows => json!({"type": "array", "items": {"type": "object"}}),
        Format::Arrow | Format::Png => json!({"type": "string", "format": "binary"}),
        _ => json!({"type": "string"}),
    }
}

/// The answer 304 to a client that has the current version.
fn tell_versions(operation: &mut Value, varies: bool) {
    let responses = &mut operation["responses"];
    let unchanged = "The client already has this version (If-None-Match)";
    responses["304"] = json!({
        "description": unchanged, "headers": {"ETag": responses["200"]["headers"]["ETag"]}
    });
    for status in ["200", "304"] {
        let headers = &mut responses[status]["headers"];
        headers["Cache-Control"] =
            text("`private, no-cache`: the client may cache the reply, but must ask before using it again");
        if varies {
            headers["Vary"] = text("`accept`: the reply depends on the format");
        }
    }
    let condition = "The `ETag` of the version that the client has; if it is still current, the reply is 304";
    if let Some(parameters) = operation["parameters"].as_array_mut() {
        parameters.push(json!({
            "name": "If-None-Match", "in": "header", "required": false, "description": condition,
            "schema": {"type": "string"}
        }));
    }
}

/// A server-sent event: a text to clients that read a reply whole, and this to those that follow it.
fn event(operation: &str, data: &[&str]) -> Value {
    let schemas: Vec<Value> = data.iter().map(|name| json!({"$ref": format!("#/components/schemas/{name}")})).collect();
    json!({
        "type": "object",
        "title": format!("{operation}_event"),
        "description": "One event, as its lines",
        "required": ["event", "data"],
        "properties": {
            "event": {"type": "string", "description": "The kind of event"},
            "id": {"type": "string", "description": "The sequence, with an event `state`"},
            "data": {
                "type": "string",
                "description": format!("A `{}`", data.join("` or, in the last event, a `")),
                "contentMediaType": "application/json",
                "contentSchema": {"oneOf": schemas}
            }
        }
    })
}

/// Adds what the program replied to the first example of each request, and to readers of the contact that it makes.
fn show_examples(operation: &mut Value, name: &str) {
    for (status, name) in [("200", name), ("201", name), ("202", "get_job")] {
        for media in ["application/json", "text/event-stream", "text/plain"] {
            let content = operation.pointer_mut(&format!("/responses/{status}/content/{}", media.replace('/', "~1")));
            if let Some((content, example)) = content.zip(EXAMPLES.get(name)) {
                content["example"] = example.clone();
            }
        }
    }
}

/// Adds links from a new contact or job to every operation on it.
pub fn link(paths: &mut Map<String, Value>) {
    for (status, place) in [("201", "/contacts/{id}"), ("202", "/jobs/{id}")] {
        let items = paths.iter().filter(|(path, _)| path.starts_with(place));
        let names = items.filter_map(|(_, item)| item.as_object()).flat_map(Map::values);
        let link = |name: &str| json!({"operationId": name, "parameters": {"id": "$response.body#/id"}});
        let links: Map<String, Value> = names
            .filter_map(|operation| operation["operationId"].as_str())
            .map(|name| (name.to_owned(), link(name)))
            .collect();
        for operation in paths.values_mut().filter_map(Value::as_object_mut).flat_map(Map::values_mut) {
            if let Some(made) = operation["responses"].get_mut(status) {
                made["links"] = json!(links);
            }
        }
    }
}
