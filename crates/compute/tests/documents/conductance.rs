//! The conductance of contacts, and the bound of the coupling that is neglected.

use serde_json::{Value, json};

use crate::json::{ball, changed, cylinder, known_by_load_curves, number, of, pad, with};
use crate::profiles::families;
use crate::{assert_refused, good, post, written};
use stickslip_compute::formats::Format;

fn conducting() -> Value {
    let body = json!({"youngs_modulus": 1.2e11, "poisson_ratio": 0.34, "resistivity": 1e-7, "conductivity": 390.0});
    json!({"bodies": [body, body]})
}

fn touch() -> Value {
    json!({"path": {"moves": [{"indentation": 1e-6}, {"indentation": -1e-6}]}})
}

#[test]
fn two_bodies_have_the_resistance_of_holm() {
    let contact = changed(
        ball(),
        &json!({
            "material": conducting(), "preload": {"contact_radius": 6.875_344_335_370_708e-5}
        }),
    );
    let reply = good(post("/simulate", &of(&contact, &touch())));
    let electrical = number(&reply["contact"]["electrical_conductance"]);
    assert!((1.0 / electrical / 7.272_363_035_371e-4 - 1.0).abs() < 1e-12, "{electrical}");
    // Wiedemann and Franz by the ratio of the two: both are 4 a over a sum.
    let thermal = number(&reply["contact"]["thermal_conductance"]);
    assert!((thermal / electrical / (2e-7 / (2.0 / 390.0)) - 1.0).abs() < 1e-12);
    let [pressed, apart] = [0, 1].map(|index| &reply["steps"][index]);
    let expected = 4.0 * number(&pressed["contact_radius"]) / 2e-7;
    assert!((number(&pressed["electrical_conductance"]) / expected - 1.0).abs() < 1e-14);
    assert!(number(&apart["electrical_conductance"]) <= 0.0);
    let csv = written("/simulate", Format::Csv, Some("steps"), &of(&contact, &touch()));
    assert!(csv.lines().next().unwrap().ends_with("electrical_conductance,thermal_conductance"), "{csv}");
}

#[test]
fn every_contact_conducts_by_its_stiffness() {
    // C = 2 F_N'(d)/(E* (rho_1 + rho_2)), by differences of the load.
    let profiles = known_by_load_curves().map(|(profile, _)| profile);
    let lines = [cylinder()["profile"].clone(), pad()["profile"].clone()];
    for profile in profiles.into_iter().chain(families()).chain(lines) {
        let contact = changed(
            ball(),
            &json!({
                "profile": profile, "material": conducting(), "preload": {"indentation": 1e-6}
            }),
        );
        let moves: Vec<Value> = [1.1e-6, 1.100_1e-6, 1.099_9e-6].iter().map(|d| json!({"indentation": d})).collect();
        let reply = good(post("/simulate", &of(&contact, &json!({"path": {"moves": moves}}))));
        let load = |index: usize| number(&reply["steps"][index]["normal_force"]);
        let stiffness = (load(1) - load(2)) / 2e-10;
        let expected = 2.0 * stiffness / (number(&reply["contact"]["e_star"]) * 2e-7);
        let found = number(&reply["steps"][0]["electrical_conductance"]);
        assert!((found / expected - 1.0).abs() < 1e-6, "{profile}: {found} {expected}");
    }
}

#[test]
fn cycles_and_sweeps_have_the_conductance_of_the_load() {
    let contact = with(ball(), "/material", conducting());
    let cycle = good(post("/cycle", &of(&contact, &json!({"drive": {"displacement": [1e-8]}}))));
    let names = ["electrical_conductance", "thermal_conductance"];
    let sweep = good(post(
        "/sweep",
        &json!({
            "base": of(&contact, &json!({"path": {"displacement": [1e-8]}})),
            "axes": [{"pointer": "/contact/preload/normal_force", "values": [10.0, 80.0]}],
            "outputs": names.map(|name| json!({"pointer": format!("/steps/0/{name}"), "name": name}))
        }),
    ));
    for name in names {
        let [light, heavy] = [0, 1].map(|index| number(&sweep["columns"][name][index]));
        assert!((light / number(&cycle["contact"][name]) - 1.0).abs() < 1e-14, "{name}");
        // 4 a over a sum, and a goes as the cube root of the load.
        assert!((heavy / light - 2.0).abs() < 1e-13, "{name}");
    }
}

#[test]
fn what_one_body_alone_says_is_refused_and_nothing_said_adds_nothing() {
    let plain = good(post("/simulate", &of(&ball(), &touch())));
    assert!(plain["contact"].get("electrical_conductance").is_none());
    let one = with(ball(), "/material/bodies/0/resistivity", json!(1e-7));
    let refused = ("invalid_input", "/contact/material/bodies/0/resistivity", "both bodies");
    assert_refused("/simulate", &of(&one, &touch()), refused);
    let effective = json!({"effective": {"e_star": 1e11, "g_star": 9e10, "bodies": conducting()["bodies"]}});
    let reply = good(post("/simulate", &of(&with(ball(), "/material", effective), &touch())));
    assert!(reply["contact"]["electrical_conductance"].is_number());
    let far = with(ball(), "/material", conducting());
    let far = with(far, "/material/bodies/1/conductivity", json!(0.0));
    let refused = ("invalid_input", "/contact/material/bodies/1/conductivity", "1e-6");
    assert_refused("/simulate", &of(&far, &touch()), refused);
}

#[test]
fn the_bound_of_the_coupling_is_that_of_goodman_and_spence() {
    for (nu, ratio) in [(0.2, 1.051_276_480_485_69), (0.3, 1.028_626_663_578_71), (0.4, 1.009_416_709_863_64)] {
        let contact = with(ball(), "/material/bodies/0/poisson_ratio", json!(nu));
        let reply = good(post("/simulate", &of(&contact, &touch())));
        assert!((number(&reply["accuracy"]["coupling_bound"]) - (ratio - 1.0)).abs() < 1e-13, "{nu}");
        let warning = reply["warnings"].as_array().unwrap().iter().find(|one| one["code"] == "dundurs_beta").unwrap();
        assert!(warning["message"].as_str().unwrap().contains('%'), "{warning}");
    }
    let alike = good(post("/simulate", &of(&with(ball(), "/material", conducting()), &touch())));
    assert!(alike["accuracy"].get("coupling_bound").is_none());
    let line = changed(cylinder(), &json!({"material": ball()["material"]}));
    let reply = good(post("/simulate", &of(&line, &touch())));
    assert_eq!(reply["accuracy"]["coupling_bound"], Value::Null);
    assert!(reply["accuracy"].as_object().unwrap().contains_key("coupling_bound"));
}
