//! Sweeps of uncertain inputs against closed forms of linear models and products.

use serde_json::{Value, json};

use crate::json::{ball, changed, number, with};
use crate::{assert_refused, good, post};

fn sweep(base: &Value, inputs: Value, outputs: Value, samples: usize) -> Value {
    json!({"base": base, "inputs": inputs, "outputs": outputs, "samples": samples, "seed": 7})
}

/// Asserts that a number is that expected within four of its standard errors, which are not far too large.
fn near(found: &Value, error: &Value, expected: f64, largest_error: f64) {
    let (found, error) = (number(found), number(error));
    assert!((found - expected).abs() <= 4.0 * error + 1e-15, "{found} +- {error} is not {expected}");
    assert!(error <= largest_error, "{error}");
}

#[test]
fn a_ball_has_the_stiffness_that_its_inputs_allow() {
    // 2 G* a ~ E^(2/3) (F R)^(1/3): 1 % of load, 2 % of radius and 3 % of the modulus are 2.1343747 %, to first order.
    let contact = with(ball(), "/friction", json!(100.0));
    let base = json!({"contact": contact, "path": {"displacement": [1e-12]}});
    let normal = |pointer: &str, value: f64| json!({"pointer": pointer, "normal": {"standard_uncertainty": value}});
    let inputs = json!([
        normal("/contact/preload/normal_force", 0.1),
        normal("/contact/profile/radius", 2e-4),
        normal("/contact/material/bodies/0/youngs_modulus", 6.3e9)
    ]);
    let reply = good(post("/sweep", &sweep(&base, inputs, json!(["/steps/0/force"]), 10_000)));
    assert_eq!((&reply["points"], &reply["failed"]), (&json!(50_000), &json!(0)));
    let output = &reply["outputs"][0];
    let mean = number(&output["mean"]);
    let relative = number(&output["standard_uncertainty"]) / mean;
    let error = number(&output["standard_uncertainty_error"]) / mean;
    // The second order of the distributions adds some 1e-5.
    assert!((relative - 0.021_343_747).abs() < 3.0 * error + 2e-5 && error < 2e-4, "{relative} +- {error}");
    let [low, high] = [0, 1].map(|end| number(&output["interval"][end]) / mean);
    assert!((low - (1.0 - 1.96 * 0.021_34)).abs() < 1.5e-3 && (high - (1.0 + 1.96 * 0.021_34)).abs() < 1.5e-3);
    let share = &output["shares"]["/contact/material/bodies/0/youngs_modulus"];
    near(&share["value"], &share["standard_error"], 4.0 / 4.555_555_6, 0.01);
}

#[test]
fn shares_are_those_of_a_sum_and_of_a_product() {
    let base = json!({
        "contact": with(ball(), "/preload", json!({"indentation": 2e-6})),
        "path": {"moves": [{"indentation": 1e-6, "relative": true}]}
    });
    let uniform = |from: f64, to: f64| json!({"from": from, "to": to});
    let inputs = json!([
        {"pointer": "/contact/preload/indentation", "name": "first", "uniform": uniform(1e-6, 3e-6)},
        {"pointer": "/path/moves/0/indentation", "name": "second", "uniform": uniform(0.5e-6, 1.5e-6)}
    ]);
    let sum = good(post("/sweep", &sweep(&base, inputs, json!(["/steps/0/indentation"]), 1_000)));
    let output = &sum["outputs"][0];
    near(&output["mean"], &output["mean_error"], 3e-6, 3e-8);
    for (name, share) in [("first", 0.8), ("second", 0.2)] {
        near(&output["shares"][name]["value"], &output["shares"][name]["standard_error"], share, 0.06);
    }
    // mu F_N, with 20 % of each: the variances of first order are equal, and a part belongs to both.
    let base = json!({"contact": ball(), "path": {"displacement": [0.0]}});
    let inputs = json!([
        {"pointer": "/contact/friction", "normal": {"mean": 0.5, "standard_uncertainty": 0.1}},
        {"pointer": "/contact/preload/normal_force", "normal": {"standard_uncertainty": 2.0}}
    ]);
    let product = good(post("/sweep", &sweep(&base, inputs, json!(["/contact/gross_slip_force"]), 1_000)));
    let output = &product["outputs"][0];
    let variance = 2.0 * 0.04 + 0.04 * 0.04;
    near(&output["standard_uncertainty"], &output["standard_uncertainty_error"], 5.0 * f64::sqrt(variance), 0.1);
    for name in ["/contact/friction", "/contact/preload/normal_force"] {
        near(&output["shares"][name]["value"], &output["shares"][name]["standard_error"], 0.04 / variance, 0.06);
    }
}

#[test]
fn one_steel_in_two_places_is_one_input_and_a_seed_fixes_the_reply() {
    let steel = json!({"youngs_modulus": 2.1e11, "poisson_ratio": 0.3});
    let contact = changed(ball(), &json!({"material": {"bodies": [steel, steel]}}));
    let base = json!({"contact": contact, "path": {"displacement": [0.0]}});
    let places = ["/contact/material/bodies/0/youngs_modulus", "/contact/material/bodies/1/youngs_modulus"];
    let one = json!([{"pointers": places, "name": "steel", "normal": {"standard_uncertainty": 2.1e9}}]);
    let body = sweep(&base, one, json!([{"pointer": "/contact/e_star", "name": "e_star"}]), 500);
    let reply = good(post("/sweep", &body));
    let output = &reply["outputs"][0];
    // 1 % of the one modulus is 1 % of E*.
    let relative = number(&output["standard_uncertainty"]) / number(&output["mean"]);
    assert!((relative - 0.01).abs() < 1.5e-3, "{relative}");
    near(&output["shares"]["steel"]["value"], &output["shares"]["steel"]["standard_error"], 1.0, 1e-6);
    assert_eq!(reply, good(post("/sweep", &body)));
    assert_ne!(reply, good(post("/sweep", &with(body, "/seed", json!(8)))));
}

#[test]
fn samples_out_of_range_fail_alone_and_faults_have_their_places() {
    let base = json!({"contact": ball(), "path": {"displacement": [0.0]}});
    let outputs = || json!(["/contact/gross_slip_force"]);
    let wide = json!([{"pointer": "/contact/friction", "normal": {"standard_uncertainty": 0.3}}]);
    let reply = good(post("/sweep", &sweep(&base, wide.clone(), outputs(), 100)));
    let failed = number(&reply["failed"]);
    assert!(failed > 10.0 && failed < 200.0 && reply["warnings"][0]["code"] == "points_failed", "{reply}");
    let of = |input: Value| sweep(&base, json!([input]), outputs(), 100);
    let friction = json!({"pointer": "/contact/friction", "uniform": {"from": 0.1, "to": 0.2}});
    let changed_by = |members: Value| of(changed(friction.clone(), &members));
    for (body, pointer, words) in [
        (changed(of(friction.clone()), &json!({"axes": []})), "/axes", "1 to 3"),
        (json!({"base": base, "outputs": outputs()}), "", "`axes`, `inputs`"),
        (changed_by(json!({"pointers": ["/contact/friction"]})), "/inputs/0", "one of"),
        (changed_by(json!({"normal": {"standard_uncertainty": 0.1}})), "/inputs/0", "one of"),
        (changed_by(json!({"uniform": {"from": 0.2, "to": 0.1}})), "/inputs/0/uniform/to", "above"),
        (changed_by(json!({"pointer": "/contact/profile/type"})), "/inputs/0", "no number"),
        (changed_by(json!({"pointer": "contact"})), "/inputs/0/pointer", "JSON pointer"),
        (sweep(&base, json!([friction, friction]), outputs(), 100), "/inputs/1", "same pointer"),
        (with(of(friction.clone()), "/samples", json!(5)), "/samples", "16"),
        (of(json!({"pointer": "/contact/friction", "uniform": {"from": -2.0, "to": -1.0}})), "/inputs/0", "0 to 100"),
    ] {
        assert_refused("/sweep", &body, ("invalid_input", pointer, words));
    }
    let axes = json!([{"pointer": "/contact/friction", "values": [0.1]}]);
    let body = json!({"base": base, "axes": axes, "outputs": outputs(), "seed": 1});
    assert_refused("/sweep", &body, ("invalid_input", "/seed", "inputs"));
}
