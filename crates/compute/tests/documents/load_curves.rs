//! Contacts that are known by their load curve alone: what they reply, what they have no stresses for, and what is no
//! such profile. Their loads and radii are tested in `crates/mechanics/tests/physics/load_curves.rs`.

use serde_json::{Value, json};

use crate::json::{ball, changed, codes, known_by_load_curves, load_curve, number, of, with};
use crate::{assert_refused, good, post, problem};

fn contact(profile: Value) -> Value {
    with(ball(), "/profile", profile)
}

fn ellipsoid(radii: Value) -> Value {
    json!({"type": "ellipsoid", "radii": radii, "direction": "x"})
}

/// Asserts that a contact is refused wherever it is simulated.
fn refused(contact: &Value, expected: (&str, &str, &str)) {
    assert_refused("/simulate", &of(contact, &json!({"path": {"displacement": [0.0]}})), expected);
}

#[test]
fn what_is_no_such_profile_is_refused_at_its_place() {
    let rough = |members: Value| changed(json!({"type": "asperities"}), &members);
    let curve = |d: [f64; 3], force: [f64; 3]| load_curve(json!(d), json!(force));
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

#[test]
fn they_are_cycled_and_swept_and_have_no_stresses() {
    let path = json!({"displacement": [1e-7]});
    let point = json!({"body": "first", "points": [[0.0, 0.0, 1e-5]]});
    for (profile, code) in known_by_load_curves() {
        let body = of(&contact(profile.clone()), &json!({"drive": {"displacement": 1e-7}, "harmonics": 3}));
        let cycled = good(post("/cycle", &body));
        assert!(number(&cycled["cycles"][0]["dissipated_energy"]) > 0.0 && codes(&cycled).contains(&code), "{cycled}");
        let base = of(&contact(profile.clone()), &json!({"path": path, "steps": "last"}));
        let axes = json!([{"pointer": "/contact/friction", "values": [0.1, 0.2]}]);
        good(post("/sweep", &json!({"base": base, "axes": axes, "outputs": ["/steps/0/force"]})));
        let named = format!("`{}`", profile["type"].as_str().unwrap());
        for (call, body, at) in [
            ("/simulate", json!({"path": path, "stress": {"points": 3}}), "/stress"),
            ("/simulate", json!({"path": path, "residual": true}), "/residual"),
            ("/simulate", json!({"path": path, "subsurface": point}), "/subsurface"),
            ("/simulate", json!({"path": {"equal_peaks": {"reversals": 3}}}), "/path/equal_peaks"),
            ("/accuracy", json!({"path": path}), "/contact/profile"),
            ("/protocols", json!({"reversals": 3}), "/contact/profile"),
            ("/cycle", json!({"drive": {"displacement": 1e-7}, "work_density": {"points": 3}}), "/work_density"),
            (
                "/fretting",
                changed(point.clone(), &json!({"path": path, "criteria": {"crossland": {"alpha": 0.3}}})),
                "/contact/profile",
            ),
            ("/wear", json!({"drive": {"displacement": 1e-8}, "hold": "indentation"}), "/contact/profile"),
        ] {
            let body = of(&contact(profile.clone()), &body);
            let refused = problem(post(call, &body));
            assert_eq!((refused.code.as_str(), refused.errors[0].pointer.as_str()), ("no_stress_field", at), "{call}");
            assert!(refused.detail.contains(&named), "{refused:?}");
        }
        let springs = json!({"path": path, "solver": {"springs": {"count": 100}}});
        assert_refused("/simulate", &of(&contact(profile.clone()), &springs), ("invalid_input", "/solver", ""));
        let sum = contact(json!({"type": "sum", "parts": [{"type": "sphere", "radius": 0.01}, profile]}));
        let refused = problem(post("/simulate", &of(&sum, &json!({"path": path}))));
        assert_eq!(refused.errors[0].pointer, "/contact/profile/parts/1", "{refused:?}");
    }
    // Semi-axes are along x and along y.
    for (radii, is_longer) in [([0.01, 0.004], true), ([0.004, 0.01], false)] {
        let body = of(&contact(ellipsoid(json!(radii))), &json!({"path": path}));
        let axes = &good(post("/simulate", &body))["contact"]["semi_axes"];
        assert_eq!(number(&axes[0]) > number(&axes[1]), is_longer, "{axes}");
    }
}
