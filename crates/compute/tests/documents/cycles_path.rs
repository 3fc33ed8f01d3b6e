//! Paths of cycles: the moves that they stand for, and what they refuse. The friction work of their loops is tested in
//! `crates/mechanics/tests/physics/cycles.rs`.

use serde_json::{Value, json};
use std::f64::consts::FRAC_1_SQRT_2;

use crate::json::{ball, changed, number, of, with};
use crate::{assert_refused, good, post};

fn simulate(path: Value) -> Value {
    good(post("/simulate", &of(&ball(), &json!({"path": path, "tolerance": 1e-6}))))
}

#[test]
fn cycles_are_the_moves_of_their_list_bit_for_bit() {
    let (a, m) = (1.1e-7, 0.3e-7);
    let (high, low) = (m + a, m - a);
    let eighths = [1.0, FRAC_1_SQRT_2, 0.0, -FRAC_1_SQRT_2, -1.0, -FRAC_1_SQRT_2, 0.0, FRAC_1_SQRT_2];
    let wave: Vec<f64> = (0..=16).map(|index| m - a * eighths[index % 8]).collect();
    let mut cases = vec![
        (json!({"displacement": a, "count": 3}), json!({"displacement": [a, -a, a, -a, a, -a, a]})),
        (json!({"displacement": a, "count": 1, "start": "down"}), json!({"displacement": [-a, a, -a]})),
        (json!({"displacement": a, "count": 2, "mean": m}), json!({"displacement": [high, low, high, low, high]})),
        (json!({"force": 1.5, "count": 2, "mean": -0.25}), json!({"force": [1.25, -1.75, 1.25, -1.75, 1.25]})),
        (
            json!({"displacement": a, "count": 2, "points_per_cycle": 8, "mean": m, "start": "down"}),
            json!({"displacement": wave}),
        ),
    ];
    let still = simulate(json!({"displacement": [0.0]}));
    let [indentation, load] = ["indentation", "normal_force"].map(|name| number(&still["contact"][name]));
    // cos(2 pi t), and the same 90 degrees later, at t = 0, 1/4, 1/2, 3/4. A load beyond zero lifts off.
    let (cosine, later) = ([1.0, 0.0, -1.0, 0.0], [0.0, -1.0, 0.0, 1.0]);
    for (tangential, a, mean) in [("displacement", 0.8e-7, 0.2e-7), ("force", 0.9, -0.3)] {
        let loads = [("indentation", 0.4 * indentation, indentation), ("normal_force", 4.0, load)];
        let lifts = ("indentation", 1.5 * indentation, indentation);
        for (normal, b, begin) in loads.into_iter().chain((tangential == "displacement").then_some(lifts)) {
            let moves: Vec<Value> = (0..=8)
                .map(|index| json!({tangential: mean + a * cosine[index % 4], normal: begin + b * later[index % 4]}))
                .collect();
            let cycles = json!({tangential: a, "mean": mean, "count": 2, "points_per_cycle": 4,
                "normal": {normal: b, "phase": 90}});
            cases.push((cycles, json!({"moves": moves})));
        }
    }
    for (cycles, list) in cases {
        let found = simulate(json!({"cycles": cycles}));
        assert_eq!(found["steps"], simulate(list)["steps"], "{cycles}");
    }
    let cycles = json!({"displacement": 1e-7, "count": 3, "normal": {"indentation": 0.1 * indentation}});
    let steps = simulate(json!({"cycles": cycles}))["steps"].as_array().unwrap().len();
    assert_eq!(steps, 1 + 3 * 64, "64 points a cycle unless they are named");
    // As many as a path has moves. A closed loop leaves no trace: the history is that of one reversal.
    let body = json!({"path": {"cycles": {"displacement": 1e-7, "count": 49_999}}, "steps": "last"});
    let many = good(post("/simulate", &of(&ball(), &body)));
    let once = simulate(json!({"displacement": [1e-7]}));
    assert_eq!(many["steps"][0]["displacement"], 1e-7);
    assert_eq!(many["steps"][0]["memory_depth"], once["steps"][0]["memory_depth"]);
}

#[test]
fn every_fault_of_cycles_is_named_at_its_place() {
    let small = json!({"profile": {"type": "exact_sphere", "radius": 1e-4}, "preload": {"indentation": 1e-7}});
    let (ball, small) = (ball(), changed(ball(), &small));
    let normal = |normal: Value| json!({"normal": normal});
    for (contact, cycles, place, word) in [
        (&ball, json!({"displacement": null}), "/displacement", "null"),
        (&ball, json!({"force": 1.0}), "/force", "exactly one"),
        (&ball, json!({"displacement": -1e-7}), "/displacement", "0 to"),
        (&ball, json!({"count": 0}), "/count", "1 to"),
        (&ball, json!({"count": 1.5}), "/count", "whole"),
        (&ball, json!({"count": 50_000}), "/count", "1 to 49999"),
        (&ball, json!({"count": 1000, "points_per_cycle": 100}), "/count", "1 to 999"),
        (&ball, json!({"count": 1563, "normal": {"normal_force": 1.0}}), "/count", "1 to 1562"),
        (&ball, json!({"points_per_cycle": 5}), "/points_per_cycle", "odd"),
        (&ball, json!({"points_per_cycle": 2}), "/points_per_cycle", "4 to 10000"),
        (&ball, json!({"start": "aside"}), "/start", "`up`"),
        (&ball, json!({"displacement": 1.0, "mean": 1e9}), "/mean", "1e9 m"),
        (&ball, json!({"speed": 1.0}), "/speed", "unknown field"),
        (&ball, normal(json!({})), "/normal", "`indentation` or `normal_force`"),
        (&ball, normal(json!({"normal_force": 1.0, "indentation": 1e-8})), "/normal/normal_force", "exactly one"),
        (&ball, normal(json!({"normal_force": 1.0, "phase": 361.0})), "/normal/phase", "degrees"),
        (&ball, normal(json!({"normal_force": 10.5})), "/normal/normal_force", "0 to 10 N"),
        (&small, normal(json!({"indentation": 2.0})), "/normal/indentation", "where the profile ends"),
    ] {
        let base = json!({"cycles": {"displacement": 1e-7, "count": 1}});
        let path = json!({"cycles": changed(base["cycles"].clone(), &cycles)});
        let code = if word == "where the profile ends" { "beyond_profile" } else { "invalid_input" };
        let body = of(contact, &json!({"path": path}));
        assert_refused("/simulate", &body, (code, &format!("/path/cycles{place}"), word));
    }
    let missing = of(&ball, &json!({"path": {"cycles": {"count": 1}}}));
    assert_refused("/simulate", &missing, ("invalid_input", "/path/cycles", "`displacement` or `force`"));
    let strong = json!({"force": 2.5, "count": 1, "normal": {"normal_force": 9.0, "phase": 90.0}});
    let strong = with(missing, "/path/cycles", strong);
    assert_refused("/simulate", &strong, ("force_exceeds_friction", "/path/cycles/force", "friction"));
}
