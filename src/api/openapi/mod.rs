//! The OpenAPI document: what the attributes of handlers and types generate, completed operation by operation, and by
//! what the derived schemas cannot express.

mod base;
mod operation;
mod schemas;

use serde_json::{Map, Value};

use crate::api::facts::Routes;
use stickslip_wire::all_limits;

pub use base::base;
pub use operation::operations;

/// The text of the document with these routes.
pub fn text(Routes { document, table }: Routes) -> String {
    let mut document = document.into_openapi();
    for route in &table {
        for (method, operation) in document.paths.paths.get_mut(&route.path).into_iter().flat_map(operations) {
            if let Some((.., facts)) = route.operation(method) {
                operation::complete(method, &route.path, operation, facts);
            }
        }
    }
    operation::link(&mut document);
    let mut document = serde_json::to_value(&document).unwrap_or_default();
    write_limits(&mut document);
    schemas::write(&mut document);
    format!("{document:#}\n")
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
pub fn write_keywords(node: &mut Map<String, Value>, keywords: &Value) {
    for (name, value) in keywords.as_object().into_iter().flatten() {
        match node.get_mut(name) {
            Some(Value::Object(inner)) if value.is_object() => write_keywords(inner, value),
            _ => drop(node.insert(name.clone(), value.clone())),
        }
    }
}
