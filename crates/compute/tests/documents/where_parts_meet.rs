//! Flats, rims and edges where the parts of a sum meet, or an annulus is thin: replies have the values of closed forms.

use serde_json::{Value, json};

use crate::json::{changed, number};
use crate::{assert_refused, good, post};

fn contact(profile: &Value, friction: f64, preload: &Value) -> Value {
    let material = json!({"effective": {"e_star": 1.2e11, "g_star": 1e11}});
    json!({"contact": {"profile": profile, "material": material, "friction": friction, "preload": preload}})
}

fn sum(one: Value, other: Value) -> Value {
    json!({"type": "sum", "parts": [one, other]})
}

fn punch() -> Value {
    json!({"type": "flat_punch", "radius": 1e-4})
}

/// A punch ends within the flat of the other part: the sum is that punch.
#[test]
fn a_punch_within_a_flat_is_a_punch() {
    let profile = sum(punch(), json!({"type": "truncated_cone", "slope": 0.05, "flat_radius": 5e-4}));
    // F = 2 E* a d.
    for preload in [json!({"normal_force": 24.0}), json!({"indentation": 1e-6})] {
        let path = json!({"path": {"displacement": [1e-8, 1e-6]}});
        let reply = good(post("/simulate", &changed(contact(&profile, 0.3, &preload), &path)));
        for (found, right) in [
            (&reply["contact"]["normal_force"], 24.0),
            (&reply["contact"]["indentation"], 1e-6),
            (&reply["steps"][1]["force"], 7.2),
        ] {
            assert!((number(found) / right - 1.0).abs() < 1e-14, "{preload}: {found} in place of {right}");
        }
    }
}

/// A rim outside a rounded part carries an infinite pressure.
#[test]
fn the_pressure_at_a_rim_of_a_part_is_infinite() {
    for part in [
        json!({"type": "rounded_punch", "flat_radius": 5e-5, "edge_radius": 0.01}),
        json!({"type": "rounded_cone", "slope": 0.05, "tip_radius": 5e-5}),
    ] {
        let request = contact(&sum(part.clone(), punch()), 0.3, &json!({"indentation": 1e-5}));
        let asked = json!({"path": {"displacement": [1e-7, 0.0]}, "residual": true});
        let reply = good(post("/simulate", &changed(request, &asked)));
        assert!(reply["contact"]["max_pressure"].is_null(), "{part}: {}", reply["contact"]);
    }
}

/// Round bodies and lines have no common axis, whichever is named first.
#[test]
fn a_line_in_a_sum_is_refused_at_its_place() {
    let sphere = json!({"type": "sphere", "radius": 0.01});
    for line in [
        json!({"type": "cylinder", "radius": 0.05, "length": 0.01}),
        json!({"type": "rounded_pad", "flat_half_width": 5e-5, "edge_radius": 0.01, "length": 0.01}),
    ] {
        for (profile, pointer) in [
            (sum(line.clone(), sphere.clone()), "/contact/profile/parts/0"),
            (sum(sphere.clone(), line.clone()), "/contact/profile/parts/1"),
        ] {
            let asked = json!({"path": {"displacement": [1e-7]}});
            let body = changed(contact(&profile, 0.3, &json!({"normal_force": 10.0})), &asked);
            assert_refused("/simulate", &body, ("invalid_input", pointer, "sum"));
        }
    }
}

/// The annulus beside a flat may be some roundings of its radius wide: no sample exceeds the extrema of the same reply.
#[test]
fn extrema_on_a_thin_annulus_are_not_below_a_sample() {
    let profile = json!({"type": "truncated_sphere", "radius": 0.05, "flat_radius": 0.01});
    for load in [0.1, 0.3] {
        let request = contact(&profile, 0.5, &json!({"normal_force": load}));
        let radii = json!([0.0, 5e-3, 9e-3, 9.9e-3, 9.99e-3, 9.999e-3]);
        let path = json!({"moves": [{"force": 0.25 * load}]});
        let asked = json!({"path": path, "stress": {"radii": radii}, "residual": true});
        let reply = good(post("/simulate", &changed(request, &asked)));
        // An infinite value, `null` in a document, is above every number.
        let max = reply["residual"]["max"].as_f64().unwrap_or(f64::INFINITY);
        for shear in reply["stress"]["shear"].as_array().unwrap() {
            assert!(number(shear) <= max, "{load} N: {shear} above {max}");
        }
    }
}
