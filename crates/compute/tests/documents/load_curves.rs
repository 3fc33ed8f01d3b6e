//! Contacts that are known by their load curve alone: what is no such profile is refused. Their loads and radii are
//! tested in `crates/mechanics/tests/physics/load_curves.rs`.

use serde_json::{Value, json};

use crate::assert_refused;
use crate::json::{ball, changed, of, with};

fn contact(profile: Value) -> Value {
    with(ball(), "/profile", profile)
}

fn ellipsoid(radii: Value) -> Value {
    json!({"type": "ellipsoid", "radii": radii, "direction": "x"})
}

fn curve(indentation: Value, force: Value) -> Value {
    json!({"type": "load_curve", "indentation": indentation, "normal_force": force})
}

/// Asserts that a contact is refused wherever it is simulated.
fn refused(contact: &Value, expected: (&str, &str, &str)) {
    assert_refused("/simulate", &of(contact, &json!({"path": {"displacement": [0.0]}})), expected);
}

#[test]
fn what_is_no_such_profile_is_refused_at_its_place() {
    let rough = |members: Value| changed(json!({"type": "asperities"}), &members);
    let curve = |d: [f64; 3], force: [f64; 3]| curve(json!(d), json!(force));
    for (profile, place) in [
        (rough(json!({"gaps": [0.0]})), ""),
        (rough(json!({"radius": 1.0, "radii": [1.0], "gaps": [0.0]})), ""),
        (rough(json!({"radii": [1.0, 2.0], "gaps": [0.0]})), "/gaps"),
        (rough(json!({"radius": 1.0, "gaps": []})), "/gaps"),
        (rough(json!({"radii": [-1.0], "gaps": [0.0]})), "/radii/0"),
        (rough(json!({"radius": 1.0, "gaps": ["NaN"]})), "/gaps/0"),
        (rough(json!({"radius": 1.0, "gaps": vec![0; 1_000_001]})), "/gaps"),
        (json!({"type": "load_curve", "indentation": [0.0, 1e-6], "normal_force": [0.0, 1.0]}), "/indentation"),
        (json!({"type": "load_curve", "indentation": [0, 1, 2], "normal_force": [0, 1, 2, 3]}), "/normal_force"),
        (curve([1e-7, 1e-6, 2e-6], [0.0, 1.0, 2.0]), "/indentation/0"),
        (curve([0.0, 1e-6, 2e-6], [0.1, 1.0, 2.0]), "/normal_force/0"),
        (curve([0.0, 2e-6, 1e-6], [0.0, 1.0, 2.0]), "/indentation/2"),
        (curve([0.0, 1e-6, 2e-6], [0.0, 1.0, 1.9]), "/normal_force/2"),
        (curve([0.0, 1e-6, 2e-6], [0.0, 0.0, 1.9]), "/normal_force/1"),
        (ellipsoid(json!([1.0])), "/radii"),
        (ellipsoid(json!([1.0, 2.0, 3.0])), "/radii"),
        (ellipsoid(json!([1.0, 1e-7])), "/radii"),
        (json!({"type": "ellipsoid", "radii": [1.0, 1.0], "direction": "z"}), "/direction"),
        (json!({"type": "ellipsoid", "radii": [1.0, 1.0]}), "/direction"),
    ] {
        let place = format!("/contact/profile{place}");
        refused(&contact(profile), ("invalid_input", &place, ""));
    }
    let moduli = json!({"effective": {"e_star": 1e11, "g_star": 8e10}});
    let unknown = with(contact(ellipsoid(json!([0.01, 0.02]))), "/material", moduli);
    refused(&unknown, ("invalid_input", "/contact/material/effective", ""));
    let beyond = contact(curve([0.0, 1e-6, 2e-6], [0.0, 1.0, 3.0]));
    refused(&beyond, ("beyond_profile", "/contact/preload/normal_force", ""));
}
