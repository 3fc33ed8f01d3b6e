//! The OpenAPI document: what the handlers and types say of themselves, and the limits and refusals common to many.

mod describe;

use std::sync::OnceLock;

use serde_json::{Map, Value, json};
use utoipa::{IntoParams, OpenApi};
use uuid::Uuid;

use crate::access::Role;
use stickslip_mechanics::range::{self, Range};
use stickslip_wire::limits::Keywords as _;
use stickslip_wire::{EndEvent, JobEndEvent, ProblemDocument, limits, profile};

use crate::api::limits as server;
use crate::api::middleware::access_control::{Need, need};
use crate::api::problem::MEDIA_TYPE;

/// The contact in the path.
#[derive(IntoParams)]
#[into_params(parameter_in = Path)]
#[expect(dead_code, reason = "described here, read by `ContactId`")]
pub struct ContactPath {
    /// The identifier of the contact.
    id: Uuid,
}

/// The condition under which a contact is changed.
#[derive(IntoParams)]
#[into_params(parameter_in = Header)]
#[expect(dead_code, reason = "described here, read by `Expected`")]
pub struct IfMatch {
    /// The sequence that the contact must be at, in quotes; else nothing is done, and the answer is 412.
    #[param(rename = "If-Match", nullable = false)]
    if_match: Option<String>,
}

/// The name of a request that may have to be repeated.
#[derive(IntoParams)]
#[into_params(parameter_in = Header)]
#[expect(dead_code, reason = "described here, read by `Command`")]
pub struct IdempotencyKey {
    /// A name of your choice for this request. A repetition with the same name and body within 24 hours changes nothing and
    /// gets the first reply again; with another body it is refused.
    #[param(rename = "Idempotency-Key", nullable = false)]
    idempotency_key: Option<String>,
}

#[derive(OpenApi)]
#[openapi(
    info(title = "stickslip"),
    components(schemas(ProblemDocument, EndEvent, JobEndEvent)),
    tags(
        (name = "simulation", description = "A path from beginning to end, in one call"),
        (name = "protocols", description = "How to move so that little shear stress remains"),
        (name = "contacts", description = "Contacts that live on the server and remember"),
        (name = "jobs", description = "Sweeps that go on after they have been asked for"),
        (name = "service", description = "Health, and this document")
    )
)]
struct Base;

/// The document before the handlers add themselves.
pub fn base() -> utoipa::openapi::OpenApi {
    let mut base = Base::openapi();
    base.info.description = Some(introduction());
    base.components.get_or_insert_default().schemas.extend(profile::schemas());
    base
}

fn introduction() -> String {
    format!(
        "Frictional contact of two elastic bodies, with memory: tangential displacement, force, slip and stress along any \
         path, exactly. All quantities are in SI units. Positive displacement gives positive force and positive shear stress. \
         Numbers that are infinite are `null`.\n\nEvery refusal is a problem document (RFC 9457, `{MEDIA_TYPE}`) with a JSON \
         pointer to each fault. A failed call changes nothing, and a read never does.\n\nLimits: a body has at most {} bytes, \
         a path {} moves, a stress request {} radii, the memory of a contact {} pieces, a page {} items; the \
         springs of the spring foundation times moves and stress points are at most {}.",
        server::BODY,
        limits::PATH_MOVES.end(),
        limits::STRESS_POINTS.end(),
        limits::MEMORY_DEPTH,
        server::PAGE.end(),
        limits::SPRING_STEPS,
    )
}

/// The document, as `/openapi.json` serves it and `stickslip openapi` prints it.
pub fn document() -> &'static str {
    static DOCUMENT: OnceLock<String> = OnceLock::new();
    DOCUMENT.get_or_init(|| {
        let mut document = serde_json::to_value(super::described().get_openapi()).unwrap_or_default();
        write_limits(&mut document);
        close_choices(&mut document);
        write_parameters(&mut document);
        write_refusals(&mut document);
        write_keys(&mut document);
        describe::write(&mut document);
        format!("{document:#}\n")
    })
}

/// The limits of the members of profiles.
fn profile_limits() -> Vec<(&'static str, &'static str, Value)> {
    let column = |range: Range| limits::Numbers(limits::TABLE_POINTS, range).keywords();
    let numbers = profile::NUMBERS.iter().map(|&(schema, member, range)| (schema, member, range.keywords()));
    numbers
        .chain([
            ("TabulatedProfile", "r", column(range::TABLE_RADIUS)),
            ("TabulatedProfile", "z", column(range::TABLE_HEIGHT)),
            ("SumProfile", "parts", limits::Items(limits::SUM_PARTS).keywords()),
        ])
        .collect()
}

fn write_limits(document: &mut Value) {
    for (schema, property, keywords) in limits::all().into_iter().chain(profile_limits()) {
        if let Some(schema) = document.pointer_mut(&format!("/components/schemas/{schema}")) {
            visit_property(schema, property, &|node| write_keywords(node, &keywords));
        }
    }
}

/// Calls `visit` on every property of this name, however deep the schema hides it in alternatives.
fn visit_property(node: &mut Value, property: &str, visit: &dyn Fn(&mut Map<String, Value>)) {
    match node {
        Value::Object(members) => {
            if let Some(Value::Object(found)) = members.get_mut("properties").and_then(|all| all.get_mut(property)) {
                visit(found);
            }
            members.values_mut().for_each(|member| visit_property(member, property, visit));
        }
        Value::Array(elements) => elements.iter_mut().for_each(|element| visit_property(element, property, visit)),
        _ => {}
    }
}

/// Adds keywords to a schema, and those of `items` to the schema of its elements.
fn write_keywords(node: &mut Map<String, Value>, keywords: &Value) {
    for (name, value) in keywords.as_object().into_iter().flatten() {
        match node.get_mut(name) {
            Some(Value::Object(inner)) if value.is_object() => write_keywords(inner, value),
            _ => drop(node.insert(name.clone(), value.clone())),
        }
    }
}

/// A choice with one key takes no second one.
fn close_choices(document: &mut Value) {
    let Some(Value::Object(schemas)) = document.pointer_mut("/components/schemas") else {
        return;
    };
    for alternative in schemas.values_mut().filter_map(|schema| schema.get_mut("oneOf")?.as_array_mut()).flatten() {
        if alternative["type"] == "object" {
            alternative["additionalProperties"] = json!(false);
        } else if alternative["allOf"].is_array() {
            // What stands in its parts counts too.
            alternative["unevaluatedProperties"] = json!(false);
        }
    }
}

/// The limits of what stands outside the body.
fn write_parameters(document: &mut Value) {
    let Some(Value::Object(paths)) = document.get_mut("paths") else {
        return;
    };
    let operations = paths.values_mut().filter_map(Value::as_object_mut).flat_map(Map::values_mut);
    for operation in operations {
        for parameter in operation.get_mut("parameters").and_then(Value::as_array_mut).into_iter().flatten() {
            let limit = match parameter["name"].as_str() {
                Some("limit") => server::PAGE.keywords(),
                Some("points_per_move") => limits::LOOP_POINTS.keywords(),
                Some("points") => limits::STRESS_POINTS.keywords(),
                Some("Idempotency-Key") => limits::Characters(server::KEY_LENGTH).keywords(),
                _ => continue,
            };
            let page = parameter["name"] == "limit";
            if let Some(schema) = parameter["schema"].as_object_mut() {
                write_keywords(schema, &limit);
                if page {
                    schema.insert("default".to_owned(), json!(server::DEFAULT_PAGE));
                }
            }
        }
        // A fork needs no body.
        if operation["operationId"] == "fork" {
            operation["requestBody"]["required"] = json!(false);
        }
    }
}

/// Which key an operation needs, where the server has keys at all.
fn write_keys(document: &mut Value) {
    let roles = Role::ALL.map(|role| format!("`{}`", role.name())).join(", ");
    document["components"]["securitySchemes"] = json!({"key": {
        "type": "http", "scheme": "bearer",
        "description": format!("A key of the server, where it has keys. Each has one role or several out of {roles}; the first \
            includes the second. A key shows the contacts of its tenant alone."),
    }});
    let Some(Value::Object(paths)) = document.get_mut("paths") else {
        return;
    };
    for (path, operations) in paths {
        let Value::Object(operations) = operations else { continue };
        for (method, operation) in operations {
            let Need::Key(role) = need(&method.to_uppercase(), path) else { continue };
            operation["security"] = json!([{"key": []}, {}]);
            let refusals = [
                ("401", "There is no key with the request, or none that the server knows".to_owned()),
                ("403", format!("The key does not have the role `{}`", role.name())),
            ];
            for (status, description) in refusals {
                operation["responses"][status] = refusal(&description);
            }
        }
    }
}

/// A refusal as a response.
pub(super) fn refusal(description: &str) -> Value {
    let schema = json!({"$ref": "#/components/schemas/ProblemDocument"});
    json!({"description": description, "content": {MEDIA_TYPE: {"schema": schema}}})
}

/// Adds to every operation the refusals that it can meet.
fn write_refusals(document: &mut Value) {
    let Some(Value::Object(paths)) = document.get_mut("paths") else {
        return;
    };
    for (path, operations) in paths {
        let Value::Object(operations) = operations else { continue };
        for (method, operation) in operations {
            let job = path.starts_with("/jobs");
            let changes = ["/move", "/path", "/relax"].iter().any(|end| path.ends_with(end));
            let changes_contact = changes || (method == "delete" && !job);
            let defines_contact = ["/simulate", "/accuracy", "/protocols", "/sweep"].contains(&path.as_str());
            let about_contacts = path.starts_with("/contacts") || defines_contact || job;
            let refusals = [
                (method == "post", "400", "The body is not JSON"),
                (path.contains('{') || path == "/protocols", "404", "There is no such thing"),
                (path.contains("/{id}") && !job, "410", "The contact was idle for so long that it has expired"),
                (method == "post", "408", "The body did not arrive in time"),
                (changes_contact, "409", "The state of the contact forbids this"),
                (changes_contact, "412", "The contact is not at the sequence given in If-Match"),
                (path.ends_with("/result"), "409", "The job has not ended, or has failed"),
                (path == "/sweep", "429", "The tenant has as many jobs as it may; try again after Retry-After"),
                (method == "post", "413", "The body is too large"),
                (method == "post", "415", "The body is not declared as application/json"),
                (about_contacts, "422", "The request is invalid, or the mechanics has no answer to it"),
                (about_contacts || path == "/readyz", "503", "The server is busy; try again after Retry-After"),
            ];
            for (_, status, description) in refusals.into_iter().filter(|(applies, ..)| *applies) {
                operation["responses"][status] = refusal(description);
            }
        }
    }
}
