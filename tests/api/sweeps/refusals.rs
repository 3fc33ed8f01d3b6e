//! Refusals of sweeps, with the place of the fault.

use serde_json::{Value, json};

use super::base;
use crate::common::{Server, problem};

fn sweep(axes: Value, outputs: Value) -> Value {
    json!({"base": base(), "axes": axes, "outputs": outputs})
}

fn axis(pointer: &str, key: &str, values: Value) -> Value {
    json!([{"pointer": pointer, key: values}])
}

#[tokio::test]
async fn every_fault_is_named_with_its_place() {
    let server = Server::start().await;
    let friction = || axis("/contact/friction", "values", json!([0.1, 0.2]));
    let called = |name: &str| json!([{"pointer": "/contact/friction", "name": name, "values": [0.1, 0.2]}]);
    let named = |pointer: &str, name: &str| json!({"pointer": pointer, "name": name});
    let reversals = "/path/falling_amplitude/reversals";
    let max = || json!(["/residual/max"]);
    let span = |from: f64, to: f64, count: usize| json!({"from": from, "to": to, "count": count});
    let changed = |pointer: &str, value: Value| {
        let mut changed = sweep(friction(), max());
        *changed.pointer_mut(pointer).unwrap() = value;
        changed
    };
    let many = json!([
        {"pointer": "/contact/friction", "linear": span(0.1, 0.2, 2000)},
        {"pointer": "/contact/preload/normal_force", "linear": span(1.0, 2.0, 2000)}
    ]);
    let twice = json!([friction()[0], friction()[0]]);
    let mut repeated = sweep(friction(), max()).to_string();
    repeated = repeated.replacen("\"friction\":0.3", "\"friction\":0.3,\"friction\":0.3", 1);
    let outputs: Vec<String> = (0..17).map(|index| format!("/steps/{index}/force")).collect();
    let cases = [
        // Axes.
        (sweep(json!([]), max()), "/axes", "1 to 3"),
        (sweep(axis("contact/friction", "values", json!([0.1])), max()), "/axes/0/pointer", "JSON pointer"),
        (sweep(axis("/contact/colour", "values", json!([0.1])), max()), "/axes/0/pointer", "unknown field"),
        (sweep(axis("/contact/none/x", "values", json!([0.1])), max()), "/axes/0/pointer", "no number there"),
        (sweep(axis("/contact/profile/type", "values", json!([0.1])), max()), "/axes/0/pointer", "no number there"),
        (sweep(axis("/contact", "values", json!([0.1])), max()), "/axes/0/pointer", "no number there"),
        (sweep(axis("/stress", "values", json!([0.1])), max()), "/axes/0/pointer", "expected an object"),
        (sweep(twice, max()), "/axes/1/pointer", "same pointer"),
        (sweep(json!([{"pointer": "/contact/friction"}]), max()), "/axes/0", "one key"),
        (sweep(axis("/contact/friction", "random", json!([0.1])), max()), "/axes/0/random", "unknown field"),
        (sweep(axis("/contact/friction", "values", json!([])), max()), "/axes/0/values", "1 to 10000"),
        (sweep(axis("/contact/friction", "values", json!(["x"])), max()), "/axes/0/values/0", "a number"),
        (sweep(axis("/contact/friction", "linear", span(0.0, 1.0, 1)), max()), "/axes/0/linear/count", "2 to"),
        (sweep(axis("/contact/friction", "logarithmic", span(0.0, 1.0, 3)), max()), "/axes/0/logarithmic", "positive"),
        (sweep(axis("/contact/friction", "logarithmic", span(-1.0, 1.0, 3)), max()), "/axes/0/logarithmic", "positive"),
        // Values out of the range of their field, fractions where whole numbers are wanted.
        (sweep(axis("/contact/friction", "values", json!([0.1, -0.1, 0.2])), max()), "/axes/0", "-0.1 is out of range"),
        (sweep(axis("/contact/friction", "linear", span(0.1, 101.0, 9)), max()), "/axes/0", "101.0 is out of range"),
        (sweep(axis(reversals, "linear", span(1.0, 10.0, 4)), max()), "", ""),
        (sweep(axis(reversals, "linear", span(1.0, 10.0, 5)), max()), "/axes/0", "value 1 is 3.25"),
        (sweep(axis(reversals, "logarithmic", span(1.0, 1000.0, 4)), max()), "", ""),
        (sweep(axis(reversals, "logarithmic", span(1.0, 1000.0, 5)), max()), "/axes/0", "list the values"),
        (sweep(axis(reversals, "values", json!([0, 1])), max()), "/axes/0", "0 is out of range"),
        (sweep(axis(reversals, "values", json!([-1, 1])), max()), "/axes/0", "-1"),
        // Too much.
        (sweep(many, max()), "/axes", "4000000 points"),
        (sweep(friction(), json!(outputs)), "/outputs", "1 to 16"),
        // Outputs.
        (sweep(friction(), json!(["residual"])), "/outputs/0", "JSON pointer"),
        (sweep(friction(), json!(["/residual/max", "/residual/max"])), "/outputs/1", "same pointer"),
        (sweep(friction(), json!(["/residual"])), "/outputs/0", "no number there"),
        (sweep(friction(), json!(["/residual/largest"])), "/outputs/0", "no such member"),
        (sweep(friction(), json!(["/accuracy/solver"])), "/outputs/0", "no number there"),
        (sweep(friction(), json!(["/stress/shear/0"])), "/outputs/0", "no such member"),
        (sweep(friction(), json!(["/steps/1/force"])), "/outputs/0", "no such member"),
        (sweep(friction(), json!(["/residual/peaks/900/shear"])), "", ""),
        // Names of columns.
        (sweep(friction(), json!([named("/residual/max", "largest")])), "", ""),
        (sweep(called("mu"), json!([named("/residual/max", "largest")])), "", ""),
        (sweep(called("1st"), max()), "/axes/0/name", "a letter"),
        (sweep(called("mu,2"), max()), "/axes/0/name", "a letter"),
        (sweep(called("\u{3bc}"), max()), "/axes/0/name", "a letter"),
        (sweep(called(&"m".repeat(64)), max()), "", ""),
        (sweep(called(&"m".repeat(65)), max()), "/axes/0/name", "64"),
        (
            sweep(json!([{"pointer": "/contact/friction", "name": null, "values": [0.1]}]), max()),
            "/axes/0/name",
            "null",
        ),
        (sweep(friction(), json!([named("/residual/max", "")])), "/outputs/0/name", "a letter"),
        (sweep(friction(), json!([named("/residual/max", "/residual/max")])), "/outputs/0/name", "a letter"),
        (sweep(called("mu"), json!([named("/residual/max", "mu")])), "/outputs/0/name", "same name"),
        (sweep(friction(), json!([{"pointer": "/residual/max"}])), "/outputs/0/name", "missing"),
        (
            sweep(friction(), json!([{"pointer": "/residual/max", "name": "a", "unit": "Pa"}])),
            "/outputs/0/unit",
            "unknown",
        ),
        (sweep(friction(), json!([3])), "/outputs/0", "a JSON pointer"),
        (sweep(friction(), json!([named("residual", "largest")])), "/outputs/0/pointer", "JSON pointer"),
        (sweep(friction(), json!([named("/residual/largest", "largest")])), "/outputs/0/pointer", "no such member"),
        (
            sweep(friction(), json!(["/residual/max", named("/residual/max", "b")])),
            "/outputs/1/pointer",
            "same pointer",
        ),
        // The base.
        (changed("/base/contact/profile", json!({"type": "sphere"})), "/base/contact/profile/radius", "missing"),
        (changed("/base/contact/preload", json!({"normal_force": -1})), "/base/contact/preload/normal_force", "range"),
        (changed("/base/path", json!({"wave": [1]})), "/base/path", "falling_amplitude"),
        (changed("/base", json!([])), "/axes/0/pointer", "no number there"),
        (changed("/base/residual", json!(1)), "/base/residual", "true or false"),
        (serde_json::from_str(&repeated).unwrap(), "", ""),
    ];
    for (body, pointer, word) in cases {
        let response = server.post("/sweep", &body).await;
        if pointer.is_empty() {
            assert_eq!(response.status(), 200, "{body}: {}", response.text().await.unwrap());
            continue;
        }
        let refusal = problem(response).await;
        assert_eq!((refusal.status, refusal.code.as_str()), (422, "invalid_input"), "{body}: {refusal:?}");
        assert_eq!(refusal.errors[0].pointer, pointer, "{body}: {refusal:?}");
        assert!(refusal.errors[0].detail.contains(word), "{body}: {refusal:?}");
    }
    // Unchanged, not as a lenient parser would correct it.
    let raw = server.http.post(format!("{}/sweep", server.base)).header("content-type", "application/json");
    let refusal = problem(raw.body(repeated).send().await.unwrap()).await;
    assert!(refusal.errors[0].detail.contains("duplicate field"), "{refusal:?}");
    assert!(refusal.errors[0].pointer.starts_with("/base/contact"), "{refusal:?}");
    let unknown = problem(server.post("/sweep?colour=1", &sweep(friction(), max())).await).await;
    assert_eq!(unknown.errors[0].pointer, "/colour");
}

#[tokio::test]
async fn more_work_than_a_server_takes_on_is_refused_as_such() {
    let server = Server::start().await;
    let mut huge = sweep(
        axis("/contact/friction", "linear", json!({"from": 0.1, "to": 0.2, "count": 2_000_000})),
        json!(["/residual/max"]),
    );
    huge["base"]["path"]["falling_amplitude"]["reversals"] = json!(16_000);
    let refusal = problem(server.post("/sweep", &huge).await).await;
    assert_eq!((refusal.status, refusal.code.as_str()), (422, "too_much_work"));
    // A job of a few of its points states the time of each that the refusal states.
    let stated = refusal.detail.split(" s a point").next().unwrap().rsplit(' ').next().unwrap();
    huge["axes"] = axis("/contact/friction", "values", json!([0.1, 0.2, 0.15]));
    huge["job"] = json!(true);
    let made: Value = server.post("/sweep", &huge).await.json().await.unwrap();
    assert_eq!(made["point_time"], stated.parse::<f64>().unwrap(), "{}", refusal.detail);
    assert_eq!(refusal.errors[0].pointer, "/axes");
}
