//! Adhesive contacts: what a reply says of them, and what is refused. Their values are tested in
//! `crates/mechanics/tests/physics/adhesion.rs`.

use std::f64::consts::PI;

use serde_json::{Value, json};

use crate::json::{ball, changed, cylinder, known_by_load_curves, number, of};
use crate::{assert_refused, good, post};

/// A ball of the closed form: E* = R = 1, w = 0.01.
fn unit_ball() -> Value {
    json!({
        "profile": {"type": "sphere", "radius": 1.0},
        "material": {"effective": {"e_star": 1.0, "g_star": 0.8}},
        "friction": 0.0,
        "shear_strength": 0.2,
        "adhesion": {"work": 0.01},
        "preload": {"contact_radius": 0.3}
    })
}

#[test]
fn a_simulation_has_the_values_of_the_ball_and_tells_of_the_pull_off() {
    let moves = json!([{"displacement": 0.05}, {"displacement": -0.05}]);
    let asked = json!({"path": {"moves": moves}, "stress": {"radii": [0.0, 0.15, 0.3, 0.5]}, "residual": true});
    let reply = good(post("/simulate", &of(&unit_ball(), &asked)));
    let contact = &reply["contact"];
    assert!((number(&contact["indentation"]) + 0.047_293_684_929_6).abs() < 1e-11);
    assert!((number(&contact["normal_force"]) + 0.046_376_210_957_7).abs() < 1e-11);
    assert!((number(&contact["pull_off_force"]) + 1.5 * PI * 0.01).abs() < 1e-14);
    assert!((number(&contact["gross_slip_force"]) - PI * 0.09 * 0.2).abs() < 1e-14);
    let step = &reply["steps"][0];
    assert!((number(&step["surface_energy"]) + PI * 0.09 * 0.01).abs() < 1e-15 && step["adhesion_loss"] == 0.0);
    assert!(number(&step["force"]) > 0.0 && step["regime"] == "partial_slip");
    let pressure = &reply["stress"]["pressure"];
    assert!(number(&pressure[1]) < number(&pressure[0]) && pressure[2].is_null() && pressure[3] == 0.0);

    let moves =
        json!([{"normal_force": -0.0471}, {"normal_force": -0.0472}, {"indentation": -0.001}, {"indentation": 0.0}]);
    let pressed = changed(unit_ball(), &json!({"preload": {"contact_radius": 0.5}}));
    let reply = good(post("/simulate", &of(&pressed, &json!({"path": {"moves": moves}}))));
    let regimes: Vec<&str> = (0..4).map(|step| reply["steps"][step]["regime"].as_str().unwrap()).collect();
    assert_eq!(regimes, ["stick", "pulled_off", "pulled_off", "stick"]);
    assert!(number(&reply["steps"][3]["normal_force"]) < 0.0);
    assert!(number(&reply["steps"][3]["adhesion_loss"]) > number(&reply["steps"][1]["adhesion_loss"]));
}

#[test]
fn what_adhesion_does_not_allow_is_refused_at_its_place() {
    let path = json!({"path": {"moves": [{"normal_force": 0.1}]}});
    let with = |members: Value| changed(unit_ball(), &members);
    for (work, said) in [(json!(-1.0), "allowed"), (json!(0.0), "allowed"), (json!(2e3), "allowed")] {
        let contact = with(json!({"adhesion": {"work": work}}));
        assert_refused("/simulate", &of(&contact, &path), ("invalid_input", "/contact/adhesion/work", said));
    }
    let sticky = with(json!({"friction": 0.3}));
    assert_refused("/simulate", &of(&sticky, &path), ("invalid_input", "/contact/friction", "no sense under tension"));
    for (preload, place) in [
        (json!({"normal_force": -0.05}), "/contact/preload/normal_force"),
        (json!({"indentation": -0.1}), "/contact/preload/indentation"),
        (json!({"contact_radius": 0.1}), "/contact/preload/contact_radius"),
    ] {
        let torn = with(json!({"preload": preload}));
        assert_refused("/simulate", &of(&torn, &path), ("invalid_input", place, "pulls off"));
        // Without adhesion no load pulls.
        if !place.ends_with("radius") {
            let plain = changed(ball(), &json!({"preload": preload}));
            assert_refused("/simulate", &of(&plain, &path), ("invalid_input", place, "allowed"));
        }
    }
    let pulled = json!({"path": {"moves": [{"normal_force": -1.0}]}});
    let place = "/path/moves/0/normal_force";
    assert_refused("/simulate", &of(&ball(), &pulled), ("invalid_input", place, "allowed"));
    let place = "/contact/adhesion";
    for rest in [
        json!({"path": {"displacement": [0.1]}, "solver": {"springs": {"count": 100}}}),
        json!({"path": {"moves": [{"displacement": [0.1, 0.0]}, {"displacement": [0.1, 0.1]}]}}),
        json!({"path": {"equal_peaks": {"reversals": 4}}}),
    ] {
        let refused = ("invalid_input", place, "not available with adhesion");
        assert_refused("/simulate", &of(&unit_ball(), &rest), refused);
    }
    for (route, rest) in [
        ("/cycle", json!({"drive": {"displacement": 0.1}})),
        ("/wear", json!({"drive": {"displacement": 0.1}, "hold": "indentation"})),
        ("/protocols", json!({"reversals": 4})),
    ] {
        assert_refused(route, &of(&unit_ball(), &rest), ("invalid_input", place, "not available with adhesion"));
    }
    let sticks = |contact: Value| changed(contact, &json!({"friction": 0.0, "adhesion": {"work": 0.1}}));
    assert_refused("/simulate", &of(&sticks(cylinder()), &path), ("invalid_input", place, "line contact"));
    for (profile, _) in known_by_load_curves() {
        let contact = sticks(changed(ball(), &json!({"profile": profile})));
        assert_refused("/simulate", &of(&contact, &path), ("invalid_input", place, "stress field"));
    }
    let moves = json!({"path": {"moves": [{"displacement": 0.01}, {"normal_force": 0.1}]}});
    assert_refused("/simulate", &of(&unit_ball(), &moves), ("load_must_be_constant", "/path/moves/1", "constant"));
}
