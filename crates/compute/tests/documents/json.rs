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

/// A cylinder, aluminium on aluminium: p0 = 160 MPa: a = 0.385 mm.
pub fn cylinder() -> Value {
    let body = json!({"youngs_modulus": 7.4e10, "poisson_ratio": 0.33});
    json!({
        "profile": {"type": "cylinder", "radius": 0.05, "length": 0.01, "reference_length": 0.1},
        "material": {"bodies": [body, body]},
        "friction": 0.6,
        "preload": {"normal_force": 968.466409034}
    })
}

/// The cylinder on a specimen that is pulled along.
pub fn cylinder_with_bulk() -> Value {
    changed(cylinder(), &json!({"bulk": {"body": "second", "stress_per_force": 198_251.584_37}}))
}

/// A pad of the same bodies.
pub fn pad() -> Value {
    let pad = json!({"type": "rounded_pad", "flat_half_width": 5e-4, "edge_radius": 0.05, "length": 0.01});
    with(with(cylinder(), "/profile", pad), "/preload", json!({"contact_radius": 8e-4}))
}

/// A profile that is known by its measured load curve.
pub fn load_curve(indentation: Value, force: Value) -> Value {
    json!({"type": "load_curve", "indentation": indentation, "normal_force": force})
}

/// A profile of each kind that is known by its load curve alone, and the code of its warning.
pub fn known_by_load_curves() -> [(Value, &'static str); 3] {
    let indentation: Vec<f64> = (0..=20).map(|index| 2e-7 * f64::from(index)).collect();
    let force: Vec<f64> = indentation.iter().map(|d| 3e10 * d.powf(1.5)).collect();
    [
        (
            json!({"type": "asperities", "radii": [1e-3, 2e-3, 3e-3], "gaps": [0.0, -1e-7, 3e-6]}),
            "interaction_neglected",
        ),
        (load_curve(json!(indentation), json!(force)), "load_curve_alone"),
        (json!({"type": "ellipsoid", "radii": [0.01, 0.004], "direction": "y"}), "elliptic_slip"),
    ]
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
