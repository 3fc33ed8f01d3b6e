//! The OpenAPI document: committed, complete, and its examples work unchanged.

use jiff::Timestamp;
use reqwest::Method;
use serde_json::{Value, json};
use uuid::Uuid;

use crate::common::json::nodes;
use crate::common::openapi::{document, examples, operations, reference};
use crate::common::{Server, problem, until};

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
    let schema = |operation: &Value| operation["requestBody"]["content"]["application/json"]["schema"].clone();
    let mut wanted: Vec<String> =
        operations(document).filter_map(|(.., operation)| Some(reference(&schema(operation))?.to_owned())).collect();
    let mut found: Vec<(String, Value)> = Vec::new();
    while let Some(name) = wanted.pop() {
        if found.iter().all(|(known, _)| *known != name) {
            let schema = document["components"]["schemas"][&name].clone();
            walk(&schema, &mut |node| wanted.extend(reference(node).map(str::to_owned)));
            found.push((name, schema));
        }
    }
    found
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
    for (method, path, operation) in operations(&document) {
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
                let names = matches!(reference(&node["items"]), Some("Field" | "SubsurfaceField"));
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
    let (server, document) = (Server::start().await, document());
    for (method, path, operation) in operations(&document) {
        let examples = examples(&document, operation);
        assert!(method != "POST" || !examples.is_empty(), "{path} has no example");
        for example in examples {
            let path = path.replace("{id}", &server.contact().await);
            let response = sent(&server, &method, &path, &example).await;
            let status = response.status();
            assert!(status.is_success(), "{path} {example}: {status} {}", response.text().await.unwrap());
        }
    }
}

/// Whether a schema allows a value, as far as members, alternatives and ranges of numbers go.
fn allows(document: &Value, schema: &Value, value: &Value) -> bool {
    let allowed = |schema: &Value| allows(document, schema, value);
    let all = |name: &str| schema[name].as_array().into_iter().flatten();
    let number = |name: &str| schema[name].as_f64().zip(value.as_f64());
    let named = schema["properties"].as_object();
    reference(schema).is_none_or(|name| allowed(&document["components"]["schemas"][name]))
        && all("required").all(|name| value.get(name.as_str().unwrap()).is_some())
        && named.into_iter().flatten().all(|(name, member)| {
            value.get(name).filter(|inner| !inner.is_null()).is_none_or(|inner| allows(document, member, inner))
        })
        && value.as_object().is_none_or(|members| {
            schema["additionalProperties"] != false
                || members.keys().all(|name| named.is_some_and(|named| named.contains_key(name)))
        })
        && value.as_array().into_iter().flatten().all(|item| allows(document, &schema["items"], item))
        && (schema["enum"].is_null() || all("enum").any(|one| one == value))
        && all("allOf").all(allowed)
        && ["anyOf", "oneOf"].iter().all(|name| schema[*name].is_null() || all(name).any(allowed))
        && (schema["not"].is_null() || !allowed(&schema["not"]))
        && number("minimum").is_none_or(|(end, sent)| sent >= end)
        && number("maximum").is_none_or(|(end, sent)| sent <= end)
        && number("exclusiveMinimum").is_none_or(|(end, sent)| sent > end)
        && number("exclusiveMaximum").is_none_or(|(end, sent)| sent < end)
}

/// The ends of the ranges of numbers in a document, but of the counts, which may be too much work.
fn ends(document: &Value) -> Vec<f64> {
    let mut ends = vec![0.0];
    walk(document, &mut |node| {
        if node["type"] == "number" {
            ends.extend([&node["minimum"], &node["maximum"]].into_iter().filter_map(Value::as_f64));
        }
    });
    ends.sort_by(f64::total_cmp);
    ends.dedup();
    ends
}

#[tokio::test]
async fn what_is_refused_for_one_number_alone_is_not_allowed_by_the_document() {
    let document = document();
    let (server, ends) = (Server::start().await, ends(&document["components"]["schemas"]));
    let contact = server.contact().await;
    let (mut sent, mut allowed_and_refused) = (0, Vec::new());
    for (_, path, operation) in operations(&document).filter(|(method, ..)| method == "POST") {
        let content = &operation["requestBody"]["content"]["application/json"];
        for example in examples(&document, operation).iter().filter(|example| example.is_object()) {
            for (place, _) in nodes(example).into_iter().filter(|(_, value)| value.is_f64()) {
                let with = |end: f64| {
                    let mut body = example.clone();
                    *body.pointer_mut(&place).unwrap() = json!(end);
                    body
                };
                let allowed: Vec<f64> =
                    ends.iter().copied().filter(|end| allows(&document, &content["schema"], &with(*end))).collect();
                for end in
                    [allowed.first(), allowed.iter().find(|end| **end == 0.0), allowed.last()].into_iter().flatten()
                {
                    let response = server.post(&path.replace("{id}", &contact), &with(*end)).await;
                    sent += 1;
                    if response.status() != 422 {
                        continue;
                    }
                    let refusal = problem(response).await;
                    allowed_and_refused.extend(refusal.errors.into_iter().filter(|fault| {
                        let of_itself = fault.detail.contains(&format!(" = {end:?} is out of range"))
                            || fault.detail.contains(&format!(" = {end} is out of range"))
                            || ["is invalid: ", "lies above", "without friction"]
                                .iter()
                                .any(|text| fault.detail.contains(text));
                        // What a target reaches depends on the profile.
                        fault.pointer == place && of_itself && place != "/target"
                    }));
                }
            }
        }
    }
    assert!(sent > 200, "{sent}");
    assert!(allowed_and_refused.is_empty(), "{allowed_and_refused:#?}");
}

/// A client that may try again is told when.
#[test]
fn every_refusal_that_passes_says_when_to_try_again() {
    let document = document();
    let mut found = 0;
    for (method, path, operation) in operations(&document) {
        for status in ["429", "503"] {
            let response = &operation["responses"][status];
            if response.is_object() {
                assert!(response["headers"]["Retry-After"].is_object(), "{method} {path} {status}");
                found += 1;
            }
        }
    }
    assert!(found > 70, "{found}");
}

/// A reply without what differs from call to call: identifiers, instants, and measured times.
fn settle(name: &str, value: &mut Value) {
    match value {
        Value::Object(members) => members.iter_mut().for_each(|(name, member)| settle(name, member)),
        Value::Array(elements) => elements.iter_mut().for_each(|element| settle(name, element)),
        Value::Number(number) if number.is_f64() && name.ends_with("time") => *value = json!(1e-5),
        Value::String(text) if text.parse::<Timestamp>().is_ok() => *value = json!("2026-01-01T00:00:00Z"),
        Value::String(text) => {
            let fixed =
                |part| if Uuid::parse_str(part).is_ok() { "019b7700-0000-7000-8000-000000000000" } else { part };
            *value = json!(text.split('/').map(fixed).collect::<Vec<_>>().join("/"));
        }
        _ => {}
    }
}

/// Whether two replies are the same but for the last digits of numbers, which depend on the machine.
fn is_alike(one: &Value, other: &Value) -> bool {
    match (one, other) {
        (Value::Object(one), Value::Object(other)) => {
            one.keys().eq(other.keys()) && one.iter().all(|(name, member)| is_alike(member, &other[name]))
        }
        (Value::Array(one), Value::Array(other)) => {
            one.len() == other.len() && one.iter().zip(other).all(|(one, other)| is_alike(one, other))
        }
        (Value::Number(one), Value::Number(other)) => {
            let [one, other] = [one, other].map(|number| number.as_f64().unwrap());
            (one - other).abs() <= 1e-6 * one.abs().max(other.abs())
        }
        _ => one == other,
    }
}

/// The response to a body, which is JSON or the text of a file.
async fn sent(server: &Server, method: &str, path: &str, body: &Value) -> reqwest::Response {
    let method: Method = method.parse().unwrap();
    let Value::String(file) = body else { return server.send(method, path, Some(&body.to_string()), &[]).await };
    let call = server.http.request(method, format!("{}{path}", server.base));
    call.header("content-type", "application/octet-stream").body(file.clone()).send().await.unwrap()
}

/// The reply to the first example of an operation, by a server of its own.
async fn shown_reply(document: &Value, method: &str, path: &str, operation: &Value) -> Value {
    let server = Server::start().await;
    let mut id = server.contact().await;
    let body = |text: &str| serde_json::from_str::<Value>(text).unwrap();
    let post = async |method: &str, path: &str, example: &Value| {
        let response = sent(&server, method, path, example).await;
        assert!(response.status().is_success(), "{path}");
        body(&response.text().await.unwrap())
    };
    if path.starts_with("/jobs") {
        let mut sweep = document["components"]["schemas"]["SweepRequest"]["example"].clone();
        sweep["job"] = json!(true);
        sweep["axes"] = json!([{"pointer": "/contact/friction", "values": [0.1, 0.2, 0.3]}]);
        id = post("POST", "/sweep", &sweep).await["id"].as_str().unwrap().to_owned();
        let job = format!("/jobs/{id}");
        until("the job ends", async || {
            (body(&server.get(&job).await.text().await.unwrap())["state"] != "running").then_some(())
        })
        .await;
    } else if path.contains("{id}") {
        post("POST", &format!("/contacts/{id}/path"), &json!({"path": {"displacement": [1e-7, -1e-7, 1e-7]}})).await;
    }
    let query = match operation["operationId"].as_str().unwrap() {
        "get_stress" => "?points=3",
        "get_loop" => "?points_per_move=2",
        "get_steady_cycle" => "?displacement=1e-7",
        "watch_contact" => "?limit=1",
        _ => "",
    };
    if let Some(example) = examples(document, operation).first().filter(|_| method == "POST") {
        return post(method, &path.replace("{id}", &id), example).await;
    }
    let text = server.get(&format!("{}{query}", path.replace("{id}", &id))).await.text().await.unwrap();
    match operation["operationId"].as_str().unwrap() {
        "watch_contact" | "watch_job" => {
            let line = |line: &str| match line.strip_prefix("data: ") {
                Some(data) => {
                    let mut data = body(data);
                    settle("", &mut data);
                    format!("data: {data}\n")
                }
                None => format!("{line}\n"),
            };
            json!(text.lines().map(line).collect::<String>())
        }
        "get_metrics" => {
            let lines = text.lines().filter(|line| line.contains("stickslip_moves_total"));
            json!(lines.map(|line| format!("{line}\n")).collect::<String>())
        }
        _ => body(&text),
    }
}

/// Every operation that replies with something shows what: its own example is made by the program. Its schema holds it
/// (`the_linters_have_nothing_to_say`). `UPDATE=1` writes them anew.
#[tokio::test]
async fn every_operation_shows_a_reply_of_the_program() {
    let document = document();
    let mut shown = serde_json::Map::new();
    for (method, path, operation) in operations(&document) {
        let name = operation["operationId"].as_str().unwrap();
        let responses = operation["responses"].as_object().unwrap();
        let (_, found) = responses.iter().find(|(status, _)| status.starts_with('2')).unwrap();
        let Some(content) = found["content"].as_object() else {
            assert_eq!(method, "DELETE");
            continue;
        };
        // The document itself, and what is written beside its handler.
        if ["get_openapi", "check_health", "check_readiness", "get_problem"].contains(&name) {
            continue;
        }
        let content =
            ["application/json", "text/event-stream", "text/plain"].iter().find_map(|kind| content.get(*kind));
        let mut reply = shown_reply(&document, &method, path, operation).await;
        settle("", &mut reply);
        if std::env::var_os("UPDATE").is_none() {
            let example = &content.unwrap()["example"];
            assert!(is_alike(&reply, example), "{name}: run this test with UPDATE=1\n{reply}\n{example}");
        }
        shown.insert(name.to_owned(), reply);
    }
    assert!(shown.len() > 25, "{}", shown.len());
    if std::env::var_os("UPDATE").is_some() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/openapi/examples.json");
        std::fs::write(path, format!("{:#}\n", Value::Object(shown))).unwrap();
    }
}
