//! The OpenAPI document: committed, complete, and its examples work unchanged.

use crate::common;

use common::Server;
use reqwest::Method;
use serde_json::Value;

fn document() -> Value {
    serde_json::from_str(stickslip::api::document()).unwrap()
}

#[tokio::test]
async fn the_committed_document_is_the_one_that_is_served() {
    let committed = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/openapi/openapi.json")).unwrap();
    assert!(
        committed == stickslip::api::document(),
        "openapi/openapi.json is out of date: cargo run -- openapi > openapi/openapi.json"
    );
    let server = Server::start().await;
    assert_eq!(server.get("/openapi.json").await.text().await.unwrap(), committed);
}

/// The schemas that requests are made of, with all that they refer to.
fn request_schemas(document: &Value) -> Vec<(String, Value)> {
    let mut wanted: Vec<String> = operations(document)
        .filter_map(|(.., operation)| reference(&operation["requestBody"]["content"]["application/json"]["schema"]))
        .collect();
    let mut found: Vec<(String, Value)> = Vec::new();
    while let Some(name) = wanted.pop() {
        if found.iter().all(|(known, _)| *known != name) {
            let schema = document["components"]["schemas"][&name].clone();
            walk(&schema, &mut |node| wanted.extend(reference(node)));
            found.push((name, schema));
        }
    }
    found
}

fn operations(document: &Value) -> impl Iterator<Item = (&str, &str, &Value)> {
    let paths = document["paths"].as_object().unwrap().iter();
    paths.flat_map(|(path, item)| {
        item.as_object().unwrap().iter().map(move |(method, operation)| (path.as_str(), method.as_str(), operation))
    })
}

fn reference(node: &Value) -> Option<String> {
    node["$ref"].as_str().map(|reference| reference.trim_start_matches("#/components/schemas/").to_owned())
}

fn walk(node: &Value, visit: &mut dyn FnMut(&Value)) {
    visit(node);
    match node {
        Value::Object(members) => members.values().for_each(|member| walk(member, visit)),
        Value::Array(elements) => elements.iter().for_each(|element| walk(element, visit)),
        _ => {}
    }
}

#[test]
fn every_reference_leads_somewhere() {
    let document = document();
    let mut found = 0;
    walk(&document, &mut |node| {
        if let Some(reference) = node["$ref"].as_str() {
            assert!(document.pointer(reference.trim_start_matches('#')).is_some(), "{reference}");
            found += 1;
        }
    });
    assert!(found > 50, "{found}");
}

#[test]
fn every_schema_and_every_field_is_described() {
    let document = document();
    for (name, schema) in document["components"]["schemas"].as_object().unwrap() {
        assert!(schema["description"].is_string(), "{name}");
        walk(schema, &mut |node| {
            for (field, property) in node["properties"].as_object().into_iter().flatten() {
                let tag = property["enum"].as_array().is_some_and(|names| names.len() == 1);
                assert!(property["description"].is_string() || tag, "{name}.{field}");
            }
        });
    }
    for (path, method, operation) in operations(&document) {
        assert!(operation["summary"].is_string(), "{method} {path}");
        for parameter in operation["parameters"].as_array().into_iter().flatten() {
            assert!(parameter["description"].is_string(), "{method} {path} {parameter}");
        }
    }
}

#[test]
fn every_number_that_can_be_sent_has_its_range_and_every_object_is_closed() {
    for (name, schema) in request_schemas(&document()) {
        assert!(schema.is_object(), "{name}");
        for choice in schema["oneOf"].as_array().into_iter().flatten().filter(|choice| choice["allOf"].is_array()) {
            assert!(choice["unevaluatedProperties"] == false, "{name}: {choice}");
        }
        walk(&schema, &mut |node| match node["type"].as_str() {
            Some("number" | "integer") => {
                assert!(node["minimum"].is_number() && node["maximum"].is_number(), "{name}: {node}");
            }
            Some("array") => {
                let names = matches!(reference(&node["items"]).as_deref(), Some("Field" | "SubsurfaceField"));
                let bounded = node["maxItems"].is_number() || names;
                assert!(bounded, "{name}: {node}");
            }
            Some("object") => {
                // A profile's members are beside its type, and the object is closed where both are combined.
                let composed = name.ends_with("Profile");
                // The axes of a sweep put in what its base leaves out, so that only the whole can be validated.
                let base = name == "SweepRequest" && node["additionalProperties"] == true;
                assert!(composed || base || node["additionalProperties"] == false, "{name}: {node}");
            }
            _ => {}
        });
    }
}

#[tokio::test]
async fn every_example_works_unchanged() {
    let document = document();
    let server = Server::start().await;
    let mut sent = 0;
    for (path, method, operation) in operations(&document).filter(|(_, method, _)| *method == "post") {
        let content = &operation["requestBody"]["content"]["application/json"];
        let mut examples: Vec<Value> = content["examples"]
            .as_object()
            .into_iter()
            .flat_map(|named| named.values().map(|example| example["value"].clone()))
            .collect();
        examples.extend(content.get("example").cloned());
        if let Some(name) = reference(&content["schema"]) {
            examples.extend(document["components"]["schemas"][name].get("example").cloned());
        }
        assert!(!examples.is_empty(), "{path} has no example");
        for example in examples {
            let path = path.replace("{id}", &server.contact().await);
            let method: Method = method.to_uppercase().parse().unwrap();
            let response = server.send(method, &path, Some(&example.to_string()), &[]).await;
            let status = response.status();
            assert!(status.is_success(), "{path} {example}: {status} {}", response.text().await.unwrap());
            sent += 1;
        }
    }
    assert!(sent >= 10, "{sent} examples");
}
