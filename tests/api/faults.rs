//! Faults of every kind in every member of every example of the document: each is refused at its place, and none has
//! a list of its own.

use reqwest::Method;
use serde_json::{Value, json};

use crate::common::json::nodes;
use crate::common::openapi::{document, examples, operations};
use crate::common::{Server, problem};

/// Members that may be anything: a sweep is checked as a whole, with the values of its axes put in.
const FREE: [&str; 2] = ["/base", "/axes"];

/// Values that a member of this kind can never have. `null` is no label, and a height that was not measured.
fn wrong(place: &str, value: &Value) -> Vec<Value> {
    let of_another_kind = match value {
        Value::Number(_) => json!("NaN"),
        Value::Bool(_) => json!(7),
        _ => json!(true),
    };
    let mut all = vec![of_another_kind, json!({"colour": {}})];
    let is_height = place.contains("/z/");
    if !is_height && !place.ends_with("/z") && !place.ends_with("/label") {
        all.push(Value::Null);
    }
    match value {
        // Larger than any range: every number of a request has one, except a missing height.
        Value::Number(_) if !is_height => all.extend([json!(1e300), json!(-1e300)]),
        // No character that ends a text in a database is in any word or label.
        Value::String(_) => all.push(json!("before\0after")),
        _ => {}
    }
    all
}

#[tokio::test]
async fn every_fault_in_every_example_is_refused_at_its_place() {
    let (server, document) = (Server::start().await, document());
    let contact = server.contact().await;
    let (mut tried, mut wrongly) = (0, Vec::new());
    for (method, path, operation) in operations(&document) {
        for example in examples(&document, operation).into_iter().filter(Value::is_object) {
            let method: Method = method.parse().unwrap();
            let path = path.replace("{id}", &contact);
            // It names the member, or what that cannot be together with.
            let refused = async |body: &str, place: &str| {
                let response = server.send(method.clone(), &path, Some(body), &[]).await;
                let status = response.status();
                if status != 422 {
                    return Err(format!("{status} for {place} of {path} {body:.300}"));
                }
                let refused = problem(response).await;
                let named = refused.errors.iter().any(|fault| fault.pointer.starts_with(place));
                let told = refused.errors.iter().all(|fault| !fault.detail.is_empty());
                if named && told && refused.code == "invalid_input" {
                    Ok(())
                } else {
                    Err(format!("{place} of {path} {body:.300}: {refused:?}"))
                }
            };
            for (place, value) in nodes(&example) {
                if FREE.iter().any(|free| place.starts_with(free)) {
                    continue;
                }
                let changed = |new: Value| {
                    let mut body = example.clone();
                    *body.pointer_mut(&place).unwrap() = new;
                    body.to_string()
                };
                for new in wrong(&place, value) {
                    wrongly.extend(refused(&changed(new), &place).await.err());
                    tried += 1;
                }
                if value.is_number() {
                    // A number that no double can hold is JSON, and out of range.
                    let body = changed(json!("here")).replace("\"here\"", "-1e999");
                    wrongly.extend(refused(&body, &place).await.err());
                }
                if let Value::Object(members) = value {
                    let mut more = members.clone();
                    more.insert("colour".to_owned(), json!(1));
                    wrongly.extend(refused(&changed(Value::Object(more)), &place).await.err());
                }
            }
        }
    }
    assert!(tried > 1_000 && wrongly.is_empty(), "{} of {tried}: {wrongly:#?}", wrongly.len());
    assert_eq!(server.client.contact(contact.parse().unwrap()).await.unwrap().sequence, 0, "nothing has changed");
}
