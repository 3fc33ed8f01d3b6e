//! The OpenAPI document: what the attributes of handlers and types generate, completed by what attributes cannot
//! express.

mod base;
mod refusals;
mod responses;
mod schemas;

use serde_json::{Map, Value, json};

use stickslip_wire::all_limits;

use super::computations;
use super::facts::FactsOfRoutes;

pub use base::base;

/// The text of the document, from what the attributes generate.
pub fn complete(described: &utoipa::openapi::OpenApi, facts: &FactsOfRoutes) -> String {
    let mut document = serde_json::to_value(described).unwrap_or_default();
    // A document without it is of no server at all to some tools.
    document["servers"] = json!([{"url": "/", "description": "The server that this document comes from"}]);
    computations::write(&mut document);
    write_limits(&mut document);
    schemas::write(&mut document);
    refusals::write(&mut document, facts);
    responses::write(&mut document, facts);
    format!("{document:#}\n")
}

/// Every operation with its method and path.
fn operations(document: &mut Value) -> impl Iterator<Item = (&str, &str, &mut Value)> {
    let paths = document.get_mut("paths").and_then(Value::as_object_mut);
    paths.into_iter().flatten().flat_map(|(path, methods)| {
        let methods = methods.as_object_mut().into_iter().flatten();
        methods.map(move |(method, operation)| (method.as_str(), path.as_str(), operation))
    })
}

fn write_limits(document: &mut Value) {
    for (schema, property, keywords) in all_limits() {
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
