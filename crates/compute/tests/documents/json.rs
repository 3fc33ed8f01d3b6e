//! Documents of requests and replies: what tests make, change and read.

#![allow(dead_code, reason = "each test program uses a part of it")]

use serde_json::{Value, json};

/// The contact of the examples.
pub fn ball() -> Value {
    json!({
        "profile": {"type": "sphere", "radius": 0.01},
        "material": {"bodies": [{"youngs_modulus": 2.1e11, "poisson_ratio": 0.3}, "rigid"]},
        "friction": 0.3,
        "preload": {"normal_force": 10.0}
    })
}

/// A body: a contact, and members beside it.
pub fn of(contact: &Value, rest: &Value) -> Value {
    changed(json!({"contact": contact}), rest)
}

/// A body with these members added or replaced.
pub fn changed(mut body: Value, members: &Value) -> Value {
    body.as_object_mut().unwrap().extend(members.as_object().unwrap().clone());
    body
}

/// A body with the value at a pointer set.
pub fn with(mut body: Value, pointer: &str, value: Value) -> Value {
    let (parent, name) = pointer.rsplit_once('/').unwrap();
    let place = body.pointer_mut(parent).unwrap();
    match name.parse::<usize>() {
        Ok(index) => place[index] = value,
        Err(_) => place[name] = value,
    }
    body
}

/// A document without the times that it took to compute.
pub fn timeless(mut document: Value) -> Value {
    match &mut document {
        Value::Object(members) => {
            members.remove("compute_time");
            members.values_mut().for_each(|member| *member = timeless(member.take()));
        }
        Value::Array(elements) => elements.iter_mut().for_each(|element| *element = timeless(element.take())),
        _ => {}
    }
    document
}

/// The codes of the warnings of a reply.
pub fn codes(reply: &Value) -> Vec<&str> {
    let warnings = reply.get("warnings").and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
    warnings.iter().map(|warning| warning["code"].as_str().unwrap()).collect()
}

pub fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// All values of a document with their pointers, the document itself first; of an array those of its first two
/// elements.
pub fn nodes(value: &Value) -> Vec<(String, &Value)> {
    let mut all = vec![(String::new(), value)];
    let inner: Vec<(String, &Value)> = match value {
        Value::Object(members) => members.iter().map(|(name, member)| (name.clone(), member)).collect(),
        Value::Array(elements) => elements.iter().take(2).enumerate().map(|(at, one)| (at.to_string(), one)).collect(),
        _ => Vec::new(),
    };
    for (name, inner) in inner {
        all.extend(nodes(inner).into_iter().map(|(below, node)| (format!("/{name}{below}"), node)));
    }
    all
}
