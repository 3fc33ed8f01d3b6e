//! Contacts with a shear strength: what a reply says of them, and what is refused. Their values are tested in
//! `crates/mechanics/tests/physics/shear_strength.rs`.

use std::f64::consts::PI;

use serde_json::{Value, json};

use crate::json::{ball, changed, cylinder, known_by_load_curves, number, of};
use crate::{assert_refused, good, post, problem};

/// A ball of the closed form: tau_0 = 0.2, mu = 0.3, G* = 0.8, E* = R = a = 1.
fn unit_ball() -> Value {
    json!({
        "profile": {"type": "sphere", "radius": 1.0},
        "material": {"effective": {"e_star": 1.0, "g_star": 0.8}},
        "friction": 0.3,
        "shear_strength": 0.2,
        "preload": {"contact_radius": 1.0}
    })
}

#[test]
fn a_simulation_has_the_force_of_the_closed_form_and_the_stress_of_the_law() {
    let path = json!({"displacement": [0.714_262_701_892_2, 5.0]});
    let asked = json!({"path": path, "stress": {"radii": [0.0, 0.4, 0.9]}, "residual": true});
    let reply = good(post("/simulate", &of(&unit_ball(), &asked)));
    let first = &reply["steps"][0];
    assert!((number(&first["force"]) - 0.942_084_101_235_5).abs() < 1e-10, "{first}");
    assert!((number(&first["stick_radius"]) - 0.5).abs() < 1e-10 && first["regime"] == "partial_slip");
    let limit = PI * 0.2 + 0.3 * number(&reply["contact"]["normal_force"]);
    assert!((number(&reply["contact"]["gross_slip_force"]) - limit).abs() < 1e-12);
    assert!((number(&reply["steps"][1]["force"]) - limit).abs() < 1e-12);
    for index in 0..3 {
        let of = |field: &str| number(&reply["stress"][field][index]);
        assert!((of("shear") - 0.2 - 0.3 * of("pressure")).abs() < 1e-11, "{index}");
    }
    assert!((number(&reply["residual"]["relative"]) - 1.0).abs() < 1e-9, "{}", reply["residual"]);
    assert!(number(&reply["accuracy"]["force_error"]) < 1e-11);
}

#[test]
fn a_strength_of_zero_is_coulombs_law_to_the_last_bit() {
    let asked = json!({"path": {"displacement": [1e-7, -3e-8]}, "stress": {"points": 5}, "residual": true});
    let strip = |mut reply: Value| {
        reply["accuracy"]["compute_time"] = Value::Null;
        reply
    };
    let zero = changed(ball(), &json!({"shear_strength": 0.0}));
    let [plain, zero] = [ball(), zero].map(|contact| strip(good(post("/simulate", &of(&contact, &asked)))));
    assert_eq!(plain, zero);
}

#[test]
fn what_a_shear_strength_does_not_allow_is_refused_at_its_place() {
    let path = json!({"path": {"displacement": [0.1]}});
    let place = "/contact/shear_strength";
    let with = |members: Value| changed(unit_ball(), &members);
    for strength in [json!(-1.0), json!(1e19), json!(1e-12)] {
        let contact = with(json!({"shear_strength": strength}));
        assert_refused("/simulate", &of(&contact, &path), ("invalid_input", place, "allowed"));
    }
    let solver = |rest: Value| changed(path.clone(), &rest);
    let pairs = json!({"path": {"moves": [{"displacement": [0.1, 0.0]}, {"displacement": [0.1, 0.1]}]}});
    for rest in [solver(json!({"solver": {"springs": {"count": 100}}})), pairs] {
        assert_refused(
            "/simulate",
            &of(&unit_ball(), &rest),
            ("invalid_input", place, "not available with a shear strength"),
        );
    }
    let peaks = json!({"path": {"equal_peaks": {"reversals": 4}}});
    assert_refused(
        "/simulate",
        &of(&unit_ball(), &peaks),
        ("invalid_input", place, "not available with a shear strength"),
    );
    for (route, rest) in [
        ("/cycle", json!({"drive": {"displacement": 0.1}, "best_load": {}})),
        ("/wear", json!({"drive": {"displacement": 0.1}, "hold": "indentation"})),
        ("/protocols", json!({"reversals": 4})),
    ] {
        assert_refused(
            route,
            &of(&unit_ball(), &rest),
            ("invalid_input", place, "not available with a shear strength"),
        );
    }
    let strong = |contact: Value| changed(contact, &json!({"shear_strength": 1e7}));
    let force = json!({"path": {"force": [1.0]}});
    assert_refused("/simulate", &of(&strong(cylinder()), &force), ("invalid_input", place, "line contact"));
    for (profile, _) in known_by_load_curves() {
        let contact = strong(changed(ball(), &json!({"profile": profile})));
        assert_refused("/simulate", &of(&contact, &force), ("no_stress_field", place, "load curve"));
    }
}

#[test]
fn the_load_is_constant_from_the_first_shear_on() {
    let moves = |moves: Value| of(&unit_ball(), &json!({"path": {"moves": moves}}));
    let before = json!([{"normal_force": 0.5}, {"displacement": 0.1}, {"displacement": -0.1}]);
    assert!(number(&good(post("/simulate", &moves(before)))["steps"][2]["force"]) < 0.0);
    for (load, index) in [
        (json!([{"displacement": 0.1}, {"normal_force": 0.5}]), 1),
        (json!([{"displacement": 0.1}, {"indentation": -0.5}]), 1),
        (json!([{"displacement": 0.1, "indentation": 0.8}]), 0),
        (json!([{"force": 0.1, "normal_force": 0.8}]), 0),
    ] {
        let place = format!("/path/moves/{index}");
        assert_refused("/simulate", &moves(load), ("load_must_be_constant", &place, "constant"));
    }
    let too_much = problem(post("/simulate", &moves(json!([{"force": 2.0}]))));
    assert_eq!(too_much.code, "force_exceeds_friction", "{too_much:?}");
    assert!(too_much.errors[0].exclusive_maximum.is_some_and(|limit| limit > 1.0), "{too_much:?}");
}
