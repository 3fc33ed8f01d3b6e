//! The operations of the OpenAPI document, and bodies that each of them takes.

use serde_json::Value;

/// The document that the service prints.
pub fn document() -> Value {
    serde_json::from_str(stickslip::api::document()).unwrap()
}

/// Method, path and description of every operation.
pub fn operations(document: &Value) -> impl Iterator<Item = (String, &str, &Value)> {
    let paths = document["paths"].as_object().unwrap().iter();
    paths.flat_map(|(path, item)| {
        let methods = item.as_object().unwrap().iter();
        methods.map(move |(method, operation)| (method.to_uppercase(), path.as_str(), operation))
    })
}

/// The name of the schema that a node refers to.
pub fn reference(node: &Value) -> Option<&str> {
    node["$ref"].as_str().map(|reference| reference.trim_start_matches("#/components/schemas/"))
}

/// The bodies that the document shows for an operation: JSON, or the text of a file as a string.
pub fn examples(document: &Value, operation: &Value) -> Vec<Value> {
    let content = &operation["requestBody"]["content"];
    let (json, file) = (&content["application/json"], &content["application/octet-stream"]);
    let named = json["examples"].as_object().into_iter().flat_map(|named| named.values().map(|one| &one["value"]));
    let found: Vec<Value> = named.chain(json.get("example")).chain(file.get("example")).cloned().collect();
    let of_schema = || reference(&json["schema"]).map(|name| &document["components"]["schemas"][name]["example"]);
    if found.is_empty() {
        of_schema().filter(|example| !example.is_null()).cloned().into_iter().collect()
    } else {
        found
    }
}

/// A path with the parameters that its operation cannot do without.
pub fn with_query(method: &str, path: &str) -> String {
    match path.rsplit('/').next() {
        Some("stress") => format!("{path}?points=3"),
        Some("cycle") if method != "POST" => format!("{path}?displacement=1e-8"),
        _ => path.to_owned(),
    }
}
