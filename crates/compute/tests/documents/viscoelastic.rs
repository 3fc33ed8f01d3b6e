//! Contacts of bodies with memory: what a reply says of them, and what is refused. Their values are tested in
//! `crates/mechanics/tests/physics/viscoelastic.rs`.

use serde_json::{Value, json};

use crate::json::{ball, changed, cylinder, known_by_load_curves, number, of, timeless};
use crate::{assert_refused, good, post};

fn rubber() -> Value {
    json!({
        "profile": {"type": "sphere", "radius": 0.01},
        "material": {"bodies": [{"youngs_modulus": 3e6, "poisson_ratio": 0.5}, "rigid"]},
        "friction": 0.8,
        "prony": [{"ratio": 0.4, "time": 0.01}, {"ratio": 0.3, "time": 1.0}],
        "preload": {"indentation": 1e-4}
    })
}

fn moves(contact: &Value, moves: Value) -> Value {
    of(contact, &json!({"path": {"moves": moves}}))
}

#[test]
fn a_path_in_time_relaxes_and_states_its_springs() {
    let body = moves(&rubber(), json!([{"duration": 1.0}, {"displacement": 2e-5, "duration": 0.01}, {"duration": 5}]));
    let reply = good(post("/simulate", &body));
    let left = |time: f64| 0.3 + 0.4 * (-time / 0.01).exp() + 0.3 * (-time).exp();
    let at_once = number(&reply["contact"]["normal_force"]);
    let held = number(&reply["steps"][0]["normal_force"]);
    let error = number(&reply["accuracy"]["force_error"]);
    assert!((held / at_once - left(1.0)).abs() < error && error < 1e-5, "{held} {error}");
    let [before, after] = [1, 2].map(|index| number(&reply["steps"][index]["force"]));
    assert!(after > 0.0 && after < 0.7 * before, "{before} {after}");
    let last = &reply["steps"][2];
    assert!((number(&last["time"]) - 6.01).abs() < 1e-12 && number(&last["viscous_work"]) > 0.0, "{last}");
    let accuracy = &reply["accuracy"];
    assert_eq!(accuracy["solver"], "springs");
    assert!(number(&accuracy["count"]) > 100.0 && number(&accuracy["steps"]) > 3.0, "{accuracy}");
    assert_eq!(reply["warnings"].as_array().unwrap().iter().filter(|one| one["code"] == "beyond_annulus").count(), 0);
}

#[test]
fn elastic_bodies_have_neither_time_nor_viscous_work() {
    let path = json!([{"displacement": 1e-7}]);
    let plain = timeless(good(post("/simulate", &moves(&ball(), path))));
    let timed = json!([{"displacement": 1e-7, "duration": 0.0}]);
    assert_eq!(plain, timeless(good(post("/simulate", &moves(&ball(), timed)))));
    assert!(plain["steps"][0].get("time").is_none() && plain["steps"][0].get("viscous_work").is_none());
}

#[test]
fn what_memory_does_not_allow_is_refused_at_its_place() {
    let wait = json!([{"duration": 1.0}]);
    let place = "/contact/prony";
    let with = |members: Value| changed(rubber(), &members);
    let refused = |contact: &Value, place: &str, text: &str| {
        assert_refused("/simulate", &moves(contact, wait.clone()), ("invalid_input", place, text));
    };
    let term = |ratio: f64, time: f64| json!({"ratio": ratio, "time": time});
    refused(&with(json!({"prony": []})), place, "1");
    refused(&with(json!({"prony": vec![term(0.01, 1.0); 17]})), place, "16");
    refused(&with(json!({"prony": [term(0.7, 1.0), term(0.4, 2.0)]})), place, "at most 1");
    refused(&with(json!({"prony": [term(-0.1, 1.0)]})), "/contact/prony/0/ratio", "out of range");
    refused(&with(json!({"prony": [term(0.1, 0.0)]})), "/contact/prony/0/time", "out of range");
    let steel = json!({"youngs_modulus": 2.1e11, "poisson_ratio": 0.3});
    let rubbers = json!({"youngs_modulus": 3e6, "poisson_ratio": 0.5});
    refused(&with(json!({"material": {"bodies": [rubbers, steel]}})), place, "alike");
    good(post("/simulate", &moves(&with(json!({"material": {"bodies": [rubbers, rubbers]}})), wait.clone())));
    refused(&with(json!({"shear_strength": 1e4})), place, "memory");
    refused(&changed(cylinder(), &json!({"prony": [term(0.1, 1.0)]})), place, "line contact");
    for (profile, _) in known_by_load_curves() {
        let contact = changed(ball(), &json!({"profile": profile, "prony": [term(0.1, 1.0)]}));
        assert_refused("/simulate", &moves(&contact, wait.clone()), ("no_stress_field", place, "load curve"));
    }
    refused(&ball(), "/path/moves/0/duration", "memory");
    let fluid = with(json!({"prony": [term(1.0, 1.0)]}));
    let held = json!([{"normal_force": 0.1, "duration": 1.0}]);
    assert_refused("/simulate", &moves(&fluid, held), ("invalid_input", "/path/moves/0/duration", "flows"));
    good(post("/simulate", &moves(&fluid, wait.clone())));

    let path = json!({"path": {"displacement": [1e-5]}});
    let asked = |rest: Value| of(&rubber(), &changed(path.clone(), &rest));
    for rest in [
        json!({"stress": {"points": 5}}),
        json!({"residual": true}),
        json!({"solver": {"springs": {"count": 100}}}),
        json!({"path": {"equal_peaks": {"reversals": 4}}}),
        json!({"path": {"moves": [{"displacement": [1e-5, 0.0]}, {"displacement": [1e-5, 1e-5]}]}}),
    ] {
        assert_refused("/simulate", &asked(rest), ("invalid_input", place, "not available for bodies with memory"));
    }
    for (route, rest) in [
        ("/cycle", json!({"drive": {"displacement": 1e-5}})),
        ("/wear", json!({"drive": {"displacement": 1e-5}, "hold": "indentation"})),
        ("/protocols", json!({"reversals": 4})),
        ("/sliders", json!({"count": 4})),
    ] {
        assert_refused(route, &of(&rubber(), &rest), ("invalid_input", place, "not available for bodies with memory"));
    }
    let pairs = json!([{"displacement": [1e-7, 1e-7], "duration": 1.0}]);
    assert_refused("/simulate", &moves(&ball(), pairs), ("invalid_input", "/path/moves/0/duration", "in the plane"));
}
