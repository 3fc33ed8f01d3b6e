//! Sweeps: the same numbers as their points one by one, and every fault with its place.

use serde_json::{Value, json};
use stickslip_compute::formats::Format;
use stickslip_compute::simulation::Sweep;
use stickslip_compute::{Flag, Refusal};
use stickslip_wire::{PrepareAnew, SweepRequest, read};

use crate::json::{ball, changed, cylinder_with_bulk, known_by_load_curves, with};
use crate::{Reply, assert_refused, good, post, problem, refusal};

/// The table of a sweep, or its refusal.
pub fn swept(text: &str) -> Reply {
    let plan = read::<SweepRequest>(text.as_bytes()).and_then(|sweep| Sweep::plan(sweep, &PrepareAnew));
    let plan = plan.map_err(|rejection| refusal(Refusal::from(rejection)))?;
    let result = plan.compute(0..plan.points(), 1, &Flag::default()).unwrap();
    let blocks = result.blocks(plan.checked(), Format::Columns);
    let text: Vec<u8> = blocks.flat_map(Result::unwrap).collect();
    Ok(serde_json::from_slice(&text).unwrap())
}

/// The body of `POST /simulate` of the paper's figure 5, for 20 reversals.
fn base() -> Value {
    json!({"contact": ball(), "path": {"falling_amplitude": {"reversals": 20}}, "steps": "last", "residual": true})
}

fn sweep(axes: Value, outputs: Value) -> Value {
    json!({"base": base(), "axes": axes, "outputs": outputs})
}

fn axis(pointer: &str, key: &str, values: Value) -> Value {
    json!([{"pointer": pointer, key: values}])
}

#[test]
fn every_fault_is_named_with_its_place() {
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
        if pointer.is_empty() {
            good(post("/sweep", &body));
        } else {
            assert_refused("/sweep", &body, ("invalid_input", pointer, word));
        }
    }
    // Unchanged, not as a lenient parser would correct it.
    let refusal = problem(swept(&repeated));
    assert!(refusal.errors[0].detail.contains("duplicate field"), "{refusal:?}");
    assert!(refusal.errors[0].pointer.starts_with("/base/contact"), "{refusal:?}");
}

/// Simulates each row's point by itself, and compares to the last bit. Says how many numbers there were.
fn compare(sweep: &Value) -> (usize, usize) {
    let table = good(post("/sweep", sweep));
    let axes: Vec<&str> =
        sweep["axes"].as_array().unwrap().iter().map(|axis| axis["pointer"].as_str().unwrap()).collect();
    let (mut numbers, mut nulls) = (0, 0);
    for row in 0..table["points"].as_u64().unwrap() as usize {
        let mut point = sweep["base"].clone();
        for axis in &axes {
            point = with(point, axis, table["columns"][axis][row].clone());
        }
        let reply = good(post("/simulate", &point));
        for output in sweep["outputs"].as_array().unwrap() {
            let output = output.as_str().unwrap();
            let expected = reply.pointer(output).and_then(Value::as_f64);
            let found = &table["columns"][output][row];
            assert_eq!(found.as_f64().map(f64::to_bits), expected.map(f64::to_bits), "{output} of row {row}");
            *if expected.is_some() { &mut numbers } else { &mut nulls } += 1;
        }
    }
    (numbers, nulls)
}

fn base_of_springs() -> Value {
    let mut base = base();
    base["path"] = json!({"equal_peaks": {"reversals": 4}});
    base["solver"] = json!({"springs": {"count": 100}});
    base
}

#[test]
fn a_sweep_equals_its_points_one_by_one_bit_for_bit() {
    let three = json!({"base": base(), "axes": [
        {"pointer": "/path/falling_amplitude/reversals", "values": [1, 2, 20]},
        {"pointer": "/contact/friction", "linear": {"from": 0.1, "to": 0.7, "count": 3}},
        {"pointer": "/contact/preload/normal_force", "logarithmic": {"from": 0.001, "to": 3000, "count": 4}}
    ], "outputs": ["/residual/max", "/residual/peaks/3/radius", "/residual/peaks/3/shear", "/steps/0/elastic_energy",
        "/steps/0/memory_depth", "/contact/contact_radius", "/accuracy/stress_error"]});
    let (numbers, nulls) = compare(&three);
    assert_eq!(numbers + nulls, 36 * 7);
    assert!(nulls > 0 && nulls < 72, "a peak that some points do not reach: {nulls}");

    // A member that the base leaves out, a curved path, stresses, and states along it.
    let moves = json!([{"normal_force": 12, "force": 2}, {"displacement": 1e-8, "normal_force": 11}]);
    let curved = json!({"base": {"contact": ball(), "path": {"moves": moves}, "stress": {"points": 3}}, "axes": [
        {"pointer": "/tolerance", "logarithmic": {"from": 1e-10, "to": 1e-4, "count": 3}},
        {"pointer": "/path/moves/0/force", "linear": {"from": -2, "to": 2, "count": 3}}
    ], "outputs": ["/steps/0/displacement", "/steps/1/force", "/stress/shear/1", "/accuracy/force_error"]});
    assert_eq!(compare(&curved), (36, 0));

    // A table that no axis changes is read once; the other solver; the other law.
    let table = json!({"type": "tabulated", "r": [0.0, 1e-4, 2e-4, 3e-4], "z": [0.0, 5e-7, 2e-6, 4.5e-6]});
    let mut tabulated = json!({"contact": ball(), "path": {"displacement": [1e-8, 0.0]}});
    tabulated["contact"]["profile"] = table;
    tabulated["contact"]["preload"] = json!({"indentation": 1e-6});
    let tabulated = json!({"base": tabulated, "axes": [{"pointer": "/path/displacement/0", "linear":
        {"from": -1e-7, "to": 1e-7, "count": 5}}], "outputs": ["/steps/0/force", "/contact/max_pressure"]});
    assert_eq!(compare(&tabulated), (10, 0));
    let springs = json!({"base": base_of_springs(),
        "axes": [{"pointer": "/solver/springs/count", "values": [200, 101, 150]}],
        "outputs": ["/residual/max", "/protocol/displacement/1"]});
    assert_eq!(compare(&springs), (6, 0));
}

/// A profile that no axis changes is made once; a load curve is made anew for other bodies.
/// The pointers to all numbers of an object of a reply, and to `null` in place of one.
fn numbers_in(reply: &Value, part: &str) -> Vec<String> {
    let members = reply.pointer(part).unwrap().as_object().unwrap().iter();
    let mut found = Vec::new();
    for (name, value) in members.filter(|(name, _)| *name != "compute_time") {
        match value {
            Value::Number(_) | Value::Null => found.push(format!("{part}/{name}")),
            Value::Array(items) => found.extend((0..items.len()).map(|index| format!("{part}/{name}/{index}"))),
            _ => {}
        }
    }
    found
}

#[test]
fn every_number_that_only_some_contacts_have_can_be_an_output() {
    let body = json!({"youngs_modulus": 1.2e11, "poisson_ratio": 0.34, "resistivity": 1e-7, "conductivity": 390.0});
    let conducting = with(ball(), "/material", json!({"bodies": [body, body]}));
    let bodies = json!({"bodies": [{"youngs_modulus": 2.1e11, "poisson_ratio": 0.3}, "rigid"]});
    let of = |members: Value| changed(with(ball(), "/material", bodies.clone()), &members);
    let line = json!({"path": {"displacement": [1e-8, -1e-8]}});
    let turned = json!({"path": {"moves": [{"displacement": [1e-8, 0.0]}, {"displacement": [0.0, 1e-8]}]}});
    for (contact, rest, known) in [
        (conducting.clone(), line.clone(), "/steps/0/thermal_conductance"),
        (conducting, turned, "/steps/0/electrical_conductance"),
        (
            of(json!({"adhesion": {"work": 0.1}, "friction": 0.0, "shear_strength": 1e6})),
            line.clone(),
            "/steps/0/surface_energy",
        ),
        (
            of(json!({"prony": [{"ratio": 0.5, "time": 1.0}]})),
            json!({"path": {"moves": [{"duration": 2.0}]}}),
            "/steps/0/viscous_work",
        ),
        (of(json!({"profile": known_by_load_curves()[1].0})), line.clone(), "/contact/gross_slip_torque"),
        (of(json!({"profile": known_by_load_curves()[2].0})), line.clone(), "/contact/semi_axes/1"),
        (cylinder_with_bulk(), line, "/steps/0/stick_centre"),
    ] {
        let base = changed(json!({"contact": contact}), &rest);
        let reply = good(post("/simulate", &base));
        let parts = ["/contact", "/steps/0", "/accuracy"];
        let outputs: Vec<String> = parts.iter().flat_map(|part| numbers_in(&reply, part)).collect();
        assert!(outputs.iter().any(|output| output == known), "{known}: {outputs:?}");
        let preload = reply["contact"]["normal_force"].clone();
        let base = with(base, "/contact/preload", json!({"normal_force": preload}));
        let reply = good(post("/simulate", &base));
        for outputs in outputs.chunks(16) {
            let axes = axis("/contact/preload/normal_force", "values", json!([preload]));
            let table = good(post("/sweep", &json!({"base": base, "axes": axes, "outputs": outputs})));
            for output in outputs {
                let [swept, simulated] = [&table["columns"][output][0], reply.pointer(output).unwrap()];
                assert_eq!(swept.as_f64(), simulated.as_f64(), "{output}");
            }
        }
    }
}

#[test]
fn points_that_share_a_profile_equal_those_that_do_not() {
    let indentation: Vec<f64> = (0..=20).map(|index| 2e-7 * f64::from(index)).collect();
    let force: Vec<f64> = indentation.iter().map(|d| 3e10 * d.powf(1.5)).collect();
    let radii: Vec<f64> = (0..100).map(|index| 4e-6 * f64::from(index)).collect();
    let heights: Vec<f64> = radii.iter().map(|r| 50.0 * r * r).collect();
    let profiles = [
        json!({"type": "tabulated", "r": radii, "z": heights}),
        json!({"type": "truncated_cone", "slope": 0.05, "flat_radius": 3e-5}),
        json!({"type": "load_curve", "indentation": indentation, "normal_force": force}),
        json!({"type": "ellipsoid", "radii": [0.01, 0.004], "direction": "y"}),
    ];
    let axes = json!([
        {"pointer": "/contact/material/bodies/0/youngs_modulus", "values": [1e11, 2.1e11]},
        {"pointer": "/contact/preload/normal_force", "values": [1, 10]},
        {"pointer": "/contact/friction", "values": [0.0, 0.3]}
    ]);
    let path = json!({"moves": [{"displacement": 1e-7}, {"normal_force": 11}, {"displacement": -5e-8}]});
    let outputs = ["/steps/2/force", "/steps/2/contact_radius", "/steps/2/dissipated_energy", "/contact/indentation"];
    for profile in profiles {
        let mut contact = ball();
        contact["profile"] = profile;
        let sweep = json!({"base": {"contact": contact, "path": path}, "axes": axes, "outputs": outputs});
        assert_eq!(compare(&sweep), (32, 0));
    }

    // What the rest of the request says of the bodies, and springs under a shared profile.
    let below = json!({"body": "first", "points": [[0.0, 0.0, 1e-5]], "bulk": {"xx": 1e6}});
    let base = json!({"contact": ball(), "path": path, "subsurface": below});
    let sweep = json!({"base": base, "axes": [{"pointer": "/path/moves/0/displacement", "values": [1e-8, 2e-8]}],
        "outputs": ["/steps/0/force"]});
    assert_eq!(compare(&sweep), (2, 0));
    let mut base = base_of_springs();
    base["contact"]["profile"] = json!({"type": "tabulated", "r": radii, "z": heights});
    let sweep = json!({"base": base, "axes": [{"pointer": "/contact/friction", "values": [0.1, 0.2]}],
        "outputs": ["/residual/max"]});
    assert_eq!(compare(&sweep), (2, 0));
}

#[test]
fn figure_5_is_one_call() {
    let sweep = json!({"base": base(), "axes": [{"pointer": "/path/falling_amplitude/reversals",
        "linear": {"from": 1, "to": 100, "count": 100}}], "outputs": ["/residual/max", "/contact/max_pressure"]});
    let table = good(post("/sweep", &sweep));
    assert_eq!((&table["points"], &table["failed"], &table["failures"]), (&json!(100), &json!(0), &json!([])));
    for row in 0..100 {
        let number = |column: &str| table["columns"][column][row].as_f64().unwrap();
        assert_eq!(table["columns"]["/path/falling_amplitude/reversals"][row], json!(row + 1), "a whole number");
        let reversals = (row + 1) as f64;
        // In closed form: one reversal leaves the root of a half, more of them the cusp next to the edge.
        let expected = if row == 0 { 0.5_f64.sqrt() } else { (2.0 - 1.5_f64.sqrt()) / reversals.sqrt() };
        let found = number("/residual/max") / (0.3 * number("/contact/max_pressure"));
        assert!((found - expected).abs() < 1e-12, "{reversals}: {found} instead of {expected}");
    }
}

#[test]
fn a_point_without_an_answer_is_a_row_without_numbers_and_is_listed_as_a_failure() {
    let mut base = base();
    base["contact"]["profile"] = json!({"type": "exact_sphere", "radius": 0.01});
    base["contact"]["preload"] = json!({"indentation": 1e-6});
    let sweep = json!({"base": base, "axes": [{"pointer": "/contact/preload/indentation", "linear":
        {"from": 1e-3, "to": 1.0, "count": 250}}], "outputs": ["/residual/max", "/contact/normal_force"]});
    let table = good(post("/sweep", &sweep));
    let column = |name: &str| table["columns"][name].as_array().unwrap().clone();
    let forces = column("/contact/normal_force");
    let failed: Vec<usize> = (0..250).filter(|row| forces[*row].is_null()).collect();
    assert!(failed.len() > 100 && failed.len() < 250, "{}", failed.len());
    assert!(failed.iter().all(|row| column("/residual/max")[*row].is_null()));
    assert_eq!(table["failed"], failed.len());
    let failures = table["failures"].as_array().unwrap();
    assert_eq!(failures.len(), 100, "listed up to a bound");
    for (failure, row) in failures.iter().zip(&failed) {
        assert_eq!((&failure["index"], &failure["code"]), (&json!(row), &json!("beyond_profile")));
    }
    // As the point is refused by itself.
    let mut point = sweep["base"].clone();
    point["contact"]["preload"]["indentation"] = table["columns"]["/contact/preload/indentation"][failed[0]].clone();
    let refusal = problem(post("/simulate", &point));
    assert_eq!(failures[0]["code"], refusal.code);
    assert_eq!(failures[0]["pointer"], refusal.errors[0].pointer);
    assert_eq!(failures[0]["detail"], refusal.errors[0].detail);
}
