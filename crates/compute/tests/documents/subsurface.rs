//! Stress below the surface: every fault with its place. What the stresses are is tested in
//! `crates/mechanics/tests/physics/subsurface.rs`.

use serde_json::{Value, json};
use std::f64::consts::PI;

use crate::json::{ball, changed, of};
use crate::{assert_refused, post, problem};

/// A sphere with a = d = p_max = 1, G* = E* and mu = 0.5.
pub fn unit_sphere() -> Value {
    json!({
        "profile": {"type": "sphere", "radius": 1.0},
        "material": {"effective": {"e_star": 0.5 * PI, "g_star": 0.5 * PI}},
        "friction": 0.5,
        "preload": {"indentation": 1.0}
    })
}

#[test]
fn every_fault_is_named_with_its_place() {
    let plane =
        |members: Value| json!({"points": null, "plane": changed(json!({"normal": "y", "offset": 0.0}), &members)});
    let (x, z) = (json!([0.0, 1e-4, 5]), json!([0.0, 1e-4, 5]));
    for (changes, pointer, detail) in [
        (json!({"body": "second"}), "/body", "rigid"),
        (json!({"poisson_ratio": 0.2}), "/poisson_ratio", "contradicts"),
        (json!({"points": [[0.0, 0.0, -1e-9]]}), "/points/0/2", "above the surface"),
        (json!({"points": []}), "/points", "1 to 1000000"),
        (json!({"fields": []}), "/fields", "von_mises"),
        (json!({"fields": ["tresca"]}), "/fields/0", "max_shear"),
        (json!({"line": {"from": [0.0, 0.0, 0.0], "to": [0.0, 0.0, 1e-4], "count": 5}}), "", "one of"),
        (json!({"bulk": {"xx": 1e30}}), "/bulk/xx", "allowed is"),
        (plane(json!({"x": [0.0, 0.0, 5], "z": z})), "/plane/x/1", ""),
        (plane(json!({"x": [0.0, 1e-4, 1], "z": z})), "/plane/x/2", ""),
        (plane(json!({"x": [0.0, 1e-4, 2.5], "z": z})), "/plane/x/2", ""),
        (plane(json!({"z": z})), "/plane/x", ""),
        (plane(json!({"normal": "z", "offset": -1e-5, "x": x, "y": z})), "/plane/offset", ""),
        (plane(json!({"x": x, "z": [-1e-4, 1e-4, 5]})), "/plane/z/0", ""),
        (plane(json!({"x": x, "y": x, "z": z})), "/plane/y", ""),
        (plane(json!({"x": [0.0, 1e-4, 1001], "z": [0.0, 1e-4, 1000]})), "/plane", ""),
    ] {
        let mut below = changed(json!({"body": "first", "points": [[0.0, 0.0, 1e-5]]}), &changes);
        below.as_object_mut().unwrap().retain(|_, value| !value.is_null());
        let asked = of(&ball(), &json!({"path": {"displacement": [1e-8]}, "subsurface": below}));
        let refused = problem(post("/simulate", &asked));
        assert_eq!(refused.errors[0].pointer, format!("/subsurface{pointer}"), "{changes}");
        assert!(refused.errors[0].detail.contains(detail), "{changes}: {refused:?}");
    }
    let below =
        json!({"path": {"displacement": [1e-8]}, "subsurface": {"body": "first", "points": [[0.0, 0.0, 1e-5]]}});
    let springs = changed(below.clone(), &json!({"solver": {"springs": {"count": 100}}}));
    assert_refused("/simulate", &of(&ball(), &springs), ("invalid_input", "/subsurface", ""));
    let unknown = ("invalid_input", "/subsurface/poisson_ratio", "");
    assert_refused("/simulate", &of(&unit_sphere(), &below), unknown);
}
