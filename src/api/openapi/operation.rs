//! What an operation has beyond what its handler declares: the key that it needs, refusals, headers, formats, events
//! and examples. They follow from its facts, from its parameter `format`, and from the `ETag` of what a reader gets.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use serde_json::{Map, Value, json};
use utoipa::openapi::header::HeaderBuilder;
use utoipa::openapi::link::{Link, LinkBuilder};
use utoipa::openapi::path::{Operation, Parameter, ParameterBuilder, ParameterIn, PathItem};
use utoipa::openapi::schema::{AnyOfBuilder, ArrayBuilder, KnownFormat, ObjectBuilder, Schema, SchemaFormat, Type};
use utoipa::openapi::security::SecurityRequirement;
use utoipa::openapi::{Content, Header, Object, OpenApi, Ref, RefOr, Required, Response, ResponseBuilder};

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

/// The operations of a path, by their methods.
pub fn operations(item: &mut PathItem) -> impl Iterator<Item = (&'static str, &mut Operation)> {
    let PathItem { get, post, patch, delete, .. } = item;
    let methods = [("GET", get), ("POST", post), ("PATCH", patch), ("DELETE", delete)];
    methods.into_iter().filter_map(|(method, operation)| Some((method, operation.as_mut()?)))
}

/// Completes an operation.
pub fn complete(method: &str, path: &str, operation: &mut Operation, facts: &Facts) {
    refuse(path, operation, facts);
    let named = formats(operation);
    if !named.is_empty() {
        insert(operation, "406", refusal("Accept admits none of the formats"));
        let content = named.iter().filter(|format| **format != Format::Columns);
        ok(operation).content.extend(content.map(|format| (format.media_type().to_owned(), shown(*format).into())));
    }
    if method == "GET" && ok(operation).headers.contains_key("ETag") {
        tell_versions(operation, !named.is_empty());
    }
    let name = operation.operation_id.clone().unwrap_or_default();
    if !facts.events.is_empty() {
        let schema = AnyOfBuilder::new()
            .item(ObjectBuilder::new().schema_type(Type::String).description(Some("The lines of the events")))
            .item(event(&name, facts.events));
        if let Some(RefOr::T(content)) = ok(operation).content.get_mut("text/event-stream") {
            content.schema = Some(Schema::AnyOf(schema.build()).into());
        }
    }
    show_examples(operation, &name);
}

/// The parameter of a name.
fn parameter<'a>(operation: &'a Operation, name: &str) -> Option<&'a Parameter> {
    operation.parameters.iter().flatten().find_map(|parameter| match parameter {
        RefOr::T(parameter) if parameter.name == name => Some(parameter),
        _ => None,
    })
}

/// The formats that the parameter `format` names.
fn formats(operation: &Operation) -> Vec<Format> {
    let schema = parameter(operation, "format").and_then(|format| format.extensions.as_ref()?.get("schema"));
    let named = schema.and_then(|schema| schema["enum"].as_array());
    let is_named = |format: &Format| named.is_some_and(|named| named.iter().any(|name| name == format.name()));
    Format::ALL.into_iter().filter(is_named).collect()
}

/// Adds the refusals that an operation can meet, and the key that it needs.
fn refuse(path: &str, operation: &mut Operation, facts: &Facts) {
    let refusals = [
        (matches!(facts.role, Some(Role::Read | Role::Write)), LIMITED),
        (path.starts_with("/contacts/{"), EXPIRED),
        (parameter(operation, "If-Match").is_some(), CHANGES),
        (operation.request_body.is_some(), OF_BODIES),
        (true, facts.refusals),
    ];
    if let (true, Some(RefOr::T(body))) = (facts.optional_body, &mut operation.request_body) {
        body.required = Some(Required::False);
    }
    insert(operation, "431", Response::new(format!("The head of the request has more than {HEAD} bytes")));
    if path.contains('{') {
        insert(operation, "404", refusal("Not found"));
    }
    for (status, description) in refusals.iter().filter(|(applies, _)| *applies).flat_map(|(_, refusals)| *refusals) {
        let mut response = refusal(*description);
        if ["429", "503"].contains(status) {
            let schema = ObjectBuilder::new().schema_type(Type::Integer).minimum(Some(0));
            let seconds = HeaderBuilder::new().description(Some("Seconds to wait")).schema(Some(schema));
            response.headers.insert("Retry-After".to_owned(), seconds.build().into());
        }
        insert(operation, status, response);
    }
    let mut security = Vec::new();
    if let Some(role) = facts.role {
        let mut unknown = refusal("The request has no key, or one that is not a key of the server");
        unknown.headers.insert("WWW-Authenticate".to_owned(), text("`Bearer`").into());
        insert(operation, "401", unknown);
        insert(
            operation,
            "403",
            refusal(format!(
                "The key does not have the role `{}`, or, without keys, the request comes from another site",
                role.name()
            )),
        );
        security = vec![SecurityRequirement::new("key", [""; 0]), SecurityRequirement::default()];
    }
    operation.security = Some(security);
}

fn insert(operation: &mut Operation, status: &str, response: Response) {
    operation.responses.responses.insert(status.to_owned(), response.into());
}

/// The reply 200.
fn ok(operation: &mut Operation) -> &mut Response {
    let reply = operation.responses.responses.entry("200".to_owned());
    match reply.or_insert_with(|| Response::default().into()) {
        RefOr::T(response) => response,
        RefOr::Ref(_) => unreachable!("no operation refers to a reply of another"),
    }
}

fn refusal(description: impl Into<String>) -> Response {
    let content = Content::new(Some(Ref::from_schema_name("ProblemDocument")));
    ResponseBuilder::new().description(description).content(MEDIA_TYPE, content).build()
}

fn text(description: &str) -> Header {
    HeaderBuilder::new().description(Some(description)).build()
}

/// The content of a reply in a format other than the document.
fn shown(format: Format) -> Content {
    let string = ObjectBuilder::new().schema_type(Type::String);
    let schema: RefOr<Schema> = match format {
        Format::Rows => ArrayBuilder::new().items(Object::with_type(Type::Object)).into(),
        Format::Arrow | Format::Png => string.format(Some(SchemaFormat::KnownFormat(KnownFormat::Binary))).into(),
        _ => string.into(),
    };
    Content::new(Some(schema))
}

/// The answer 304 to a client that has the current version.
fn tell_versions(operation: &mut Operation, varies: bool) {
    let mut unchanged = Response::new("The client already has this version (If-None-Match)");
    unchanged.headers.extend(ok(operation).headers.get("ETag").map(|tag| ("ETag".to_owned(), tag.clone())));
    for reply in [&mut unchanged, ok(operation)] {
        let cache = text("`private, no-cache`: the client may cache the reply, but must ask before using it again");
        reply.headers.insert("Cache-Control".to_owned(), cache.into());
        if varies {
            let vary = text("`accept`: the reply depends on the format");
            reply.headers.insert("Vary".to_owned(), vary.into());
        }
    }
    insert(operation, "304", unchanged);
    let condition = ParameterBuilder::new()
        .name("If-None-Match")
        .parameter_in(ParameterIn::Header)
        .required(Required::False)
        .schema(Some(Object::with_type(Type::String)))
        .description(Some("The `ETag` of the version that the client has; if it is still current, the reply is 304"));
    operation.parameters.get_or_insert_default().push(condition.build().into());
}

/// A server-sent event: a text to clients that read a reply whole, and this to those that follow it.
fn event(operation: &str, data: &[&str]) -> ObjectBuilder {
    let schemas: Vec<Value> = data.iter().map(|name| json!({"$ref": format!("#/components/schemas/{name}")})).collect();
    let text = |description: &str| ObjectBuilder::new().schema_type(Type::String).description(Some(description));
    let content = [("contentMediaType", json!("application/json")), ("contentSchema", json!({"oneOf": schemas}))];
    let content = content.into_iter().collect();
    ObjectBuilder::new()
        .title(Some(format!("{operation}_event")))
        .description(Some("One event, as its lines"))
        .property("event", text("The kind of event"))
        .property("id", text("The sequence, with an event `state`"))
        .property("data", text(&format!("A `{}`", data.join("` or, in the last event, a `"))).extensions(Some(content)))
        .required("event")
        .required("data")
}

/// Adds what the program replied to the first example of each request, and to readers of the contact that it makes.
fn show_examples(operation: &mut Operation, name: &str) {
    for (status, response) in &mut operation.responses.responses {
        let example = match status.as_str() {
            "200" | "201" => EXAMPLES.get(name),
            "202" => EXAMPLES.get("get_job"),
            _ => None,
        };
        let (Some(example), RefOr::T(response)) = (example, response) else { continue };
        for (media, content) in &mut response.content {
            let is_shown = ["application/json", "text/event-stream", "text/plain"].contains(&media.as_str());
            if let (true, RefOr::T(content)) = (is_shown, content) {
                content.example = Some(example.clone());
            }
        }
    }
}

/// Adds links from a new contact or job to every operation on it.
pub fn link(document: &mut OpenApi) {
    for (status, place) in [("201", "/contacts/{id}"), ("202", "/jobs/{id}")] {
        let paths = document.paths.paths.iter_mut().filter(|(path, _)| path.starts_with(place));
        let link = |(_, operation): (_, &mut Operation)| {
            let name = operation.operation_id.clone()?;
            let link = LinkBuilder::new().operation_id(&name).parameter("id", "$response.body#/id").build();
            Some((name, RefOr::T(link)))
        };
        let links: BTreeMap<String, RefOr<Link>> =
            paths.flat_map(|(_, item)| operations(item)).filter_map(link).collect();
        for (_, operation) in document.paths.paths.values_mut().flat_map(operations) {
            if let Some(RefOr::T(made)) = operation.responses.responses.get_mut(status) {
                made.links.clone_from(&links);
            }
        }
    }
}
