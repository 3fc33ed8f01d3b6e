//! Stress below the surface: published figures, and every fault with its place. What the stresses are is tested in
//! `crates/mechanics/tests/physics/subsurface.rs`.

use serde_json::{Value, json};
use std::f64::consts::PI;
use stickslip_compute::Flag;
use stickslip_compute::computations::{DisplayOptions, compute};
use stickslip_compute::formats::Format;

use crate::json::{ball, changed, number, of};
use crate::{assert_refused, good, post, problem};

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

#[test]
fn a_history_of_three_moves_has_its_published_stress() {
    let path = json!({"displacement": [0.4, -0.25, 0.05]});
    let point = json!({"body": "second", "poisson_ratio": 0.3, "points": [[0.5, 0.3, 0.4]]});
    let asked = of(&unit_sphere(), &json!({"path": path, "subsurface": point}));
    let reply = good(post("/simulate", &asked));
    let expected = [-0.202_971_224_360_7, -0.188_421_678_403_5, -0.648_046_273_458_3];
    let sheared = [-0.012_501_917_591_47, -0.091_545_975_543_53, -0.166_739_561_424_7];
    for (name, expected) in ["xx", "yy", "zz", "xy", "yz", "xz"].into_iter().zip(expected.into_iter().chain(sheared)) {
        let found = number(&reply["subsurface"][name][0]);
        assert!((found - expected).abs() < 1e-12, "{name}: {found} instead of {expected}");
    }
    let error = number(&reply["accuracy"]["subsurface_error"]);
    assert!(error > 1e-13 && error < 1e-10 && reply["subsurface"].get("von_mises").is_none(), "{error:e}");
    // Nothing of it where it was not asked for.
    let plain = good(post("/simulate", &of(&unit_sphere(), &json!({"path": path}))));
    assert!(plain.get("subsurface").is_none() && plain["accuracy"].get("subsurface_error").is_none());
    // There is a computation of its own for it.
    let alone = compute(
        "subsurface",
        asked.to_string().as_bytes(),
        DisplayOptions::in_format(Format::Columns),
        &Flag::default(),
    );
    let alone: Value = serde_json::from_slice(&alone.unwrap()).unwrap();
    assert_eq!(alone["xz"], reply["subsurface"]["xz"]);
    // What is infinite is null.
    let cone = changed(unit_sphere(), &json!({"profile": {"type": "cone", "slope": 0.1}}));
    let fields = ["tensor", "principal", "von_mises", "max_shear", "hydrostatic"];
    let asked = json!({"path": {"displacement": [0.1]}, "subsurface": {"body": "second", "poisson_ratio": 0.3,
        "points": [[0.0, 0.0, 0.0], [0.0, 0.0, 1e-5]], "fields": fields}});
    let reply = good(post("/simulate", &of(&cone, &asked)));
    for name in ["zz", "principal_1", "von_mises", "max_shear", "hydrostatic"] {
        let column = &reply["subsurface"][name];
        assert!(column[0].is_null() && column[1].is_number(), "{name}: {column}");
    }
}
