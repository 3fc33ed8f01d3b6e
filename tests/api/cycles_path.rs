//! Paths of cycles: the moves that they stand for, the friction work of their loops, and what they refuse.

use std::f64::consts::FRAC_1_SQRT_2;

use crate::common;

use common::{Server, ball, problem};
use reqwest::Method;
use serde_json::{Value, json};

async fn simulate(server: &Server, contact: &Value, path: Value) -> Value {
    let reply = server.post("/simulate", &json!({"contact": contact, "path": path, "tolerance": 1e-6})).await;
    assert_eq!(reply.status(), 200, "{path}: {}", reply.text().await.unwrap());
    reply.json().await.unwrap()
}

fn numbers(reply: &Value, name: &str) -> Vec<f64> {
    reply["steps"].as_array().unwrap().iter().map(|state| state[name].as_f64().unwrap()).collect()
}

/// Asserts that cycles have the states of a list, bit for bit.
async fn assert_moves(server: &Server, contact: &Value, cycles: Value, list: Value) {
    let found = simulate(server, contact, json!({"cycles": cycles})).await;
    let listed = simulate(server, contact, list).await;
    assert_eq!(found["steps"], listed["steps"], "{cycles}");
}

#[tokio::test]
async fn cycles_are_the_moves_of_their_list_bit_for_bit() {
    let server = Server::start().await;
    let (a, m) = (1.1e-7, 0.3e-7);
    let (high, low) = (m + a, m - a);
    for (cycles, list) in [
        (json!({"displacement": a, "count": 3}), json!({"displacement": [a, -a, a, -a, a, -a, a]})),
        (json!({"displacement": a, "count": 1, "start": "down"}), json!({"displacement": [-a, a, -a]})),
        (
            json!({"displacement": a, "count": 2, "start": "up", "mean": m}),
            json!({"displacement": [high, low, high, low, high]}),
        ),
        (json!({"displacement": a, "count": 1, "start": "down", "mean": m}), json!({"displacement": [low, high, low]})),
        (json!({"force": 1.5, "count": 2, "mean": -0.25}), json!({"force": [1.25, -1.75, 1.25, -1.75, 1.25]})),
    ] {
        assert_moves(&server, &ball(), cycles, list).await;
    }
    let eighths = [1.0, FRAC_1_SQRT_2, 0.0, -FRAC_1_SQRT_2, -1.0, -FRAC_1_SQRT_2, 0.0, FRAC_1_SQRT_2];
    let wave: Vec<f64> = (0..=16).map(|index| m - a * eighths[index % 8]).collect();
    let cycles = json!({"displacement": a, "count": 2, "points_per_cycle": 8, "mean": m, "start": "down"});
    assert_moves(&server, &ball(), cycles, json!({"displacement": wave})).await;
}

#[tokio::test]
async fn an_oscillating_load_is_that_of_its_list_bit_for_bit() {
    let server = Server::start().await;
    let still = simulate(&server, &ball(), json!({"displacement": [0.0]})).await;
    let indentation = still["contact"]["indentation"].as_f64().unwrap();
    let load = still["contact"]["normal_force"].as_f64().unwrap();
    // cos(2 pi t), and the same 90 degrees later, at t = 0, 1/4, 1/2, 3/4.
    let (cosine, later) = ([1.0, 0.0, -1.0, 0.0], [0.0, -1.0, 0.0, 1.0]);
    for (tangential, a, mean) in [("displacement", 0.8e-7, 0.2e-7), ("force", 0.9, -0.3)] {
        for (normal, b, begin) in [("indentation", 0.4 * indentation, indentation), ("normal_force", 4.0, load)] {
            let moves: Vec<Value> = (0..=8)
                .map(|index| json!({tangential: mean + a * cosine[index % 4], normal: begin + b * later[index % 4]}))
                .collect();
            let cycles = json!({tangential: a, "mean": mean, "count": 2, "points_per_cycle": 4,
                "normal": {normal: b, "phase": 90}});
            assert_moves(&server, &ball(), cycles, json!({"moves": moves})).await;
        }
    }
    let cycles = json!({"displacement": 1e-7, "count": 3, "normal": {"indentation": 0.1 * indentation}});
    let reply = simulate(&server, &ball(), json!({"cycles": cycles})).await;
    assert_eq!(numbers(&reply, "force").len(), 1 + 3 * 64, "64 points a cycle unless they are named");
}

#[tokio::test]
async fn a_load_oscillates_about_that_of_the_contact_when_the_path_begins() {
    let server = Server::start().await;
    let (one, other) = (server.contact().await, server.contact().await);
    for id in [&one, &other] {
        let reply = server.post(&format!("/contacts/{id}/move"), &json!({"normal_force": 20.0})).await;
        assert_eq!(reply.status(), 200);
    }
    let post = async |id: &str, path: Value| server.post(&format!("/contacts/{id}/path"), &json!({"path": path})).await;
    let cycles = |size: f64| {
        json!({"cycles": {"displacement": 1e-7, "count": 1, "points_per_cycle": 4,
        "normal": {"normal_force": size}}})
    };
    // More than the load at the beginning, though less than three times the preload.
    let refused = problem(post(&one, cycles(21.0)).await).await;
    assert_eq!((refused.status, refused.code.as_str()), (422, "invalid_input"));
    assert_eq!(refused.errors[0].pointer, "/path/cycles/normal/normal_force");
    assert!(refused.errors[0].detail.contains("0 to 20 N"), "{refused:?}");

    let moved: Value = post(&one, cycles(15.0)).await.json().await.unwrap();
    assert_eq!(moved["sequence"], 6, "the refused path has left no move");
    let moves = [(1e-7, 35.0), (0.0, 20.0), (-1e-7, 5.0), (0.0, 20.0), (1e-7, 35.0)]
        .map(|(displacement, load)| json!({"displacement": displacement, "normal_force": load}));
    let listed: Value = post(&other, json!({"moves": moves})).await.json().await.unwrap();
    assert_eq!(moved["steps"], listed["steps"]);
}

#[tokio::test]
async fn the_work_of_each_cycle_is_that_of_the_chord_of_the_load() {
    let server = Server::start().await;
    let (radius, e_star, g_star, friction, depth) = (0.02_f64, 1.2e11, 0.9e11, 0.4, 3e-6);
    let contact = json!({"profile": {"type": "sphere", "radius": radius}, "friction": friction,
        "material": {"effective": {"e_star": e_star, "g_star": g_star}}, "preload": {"indentation": depth}});
    let ratio = friction * e_star / g_star;
    let load = |y: f64| 4.0 / 3.0 * e_star * radius.sqrt() * y.powf(1.5);
    let below = |y: f64| 8.0 / 15.0 * e_star * radius.sqrt() * y.powf(2.5);
    for (part, mean) in [(0.2, 0.0), (0.6, 0.1), (0.95, -0.4)] {
        let amplitude = part * ratio * depth;
        // A loop of this amplitude slips from the edge down to this indentation.
        let core = depth - amplitude / ratio;
        let chord = 0.5 * (depth - core) * (load(depth) + load(core)) - (below(depth) - below(core));
        let expected = 8.0 * friction * ratio * chord;
        let cycles = json!({"displacement": amplitude, "mean": mean * ratio * depth, "count": 5});
        let turns = simulate(&server, &contact, json!({"cycles": cycles})).await;
        let mut finer = cycles.clone();
        finer["points_per_cycle"] = json!(10);
        let points = simulate(&server, &contact, json!({"cycles": finer})).await;
        for (reply, per_cycle) in [(&turns, 2), (&points, 10)] {
            let lost = numbers(reply, "dissipated_energy");
            assert_eq!(lost.len(), 1 + 5 * per_cycle);
            for begin in (1..5).map(|cycle| cycle * per_cycle) {
                let work = lost[begin + per_cycle] - lost[begin];
                assert!((work / expected - 1.0).abs() < 1e-11, "{part} from {begin}: {work:e}, and not {expected:e}");
            }
        }
        // Points between the turns change nothing there.
        for name in ["displacement", "force", "dissipated_energy", "elastic_energy"] {
            let (few, many) = (numbers(&turns, name), numbers(&points, name));
            for (index, turn) in few.iter().enumerate() {
                assert!((many[5 * index] - turn).abs() <= 1e-12 * turn.abs(), "{name} at the turn {index}");
            }
        }
    }
}

#[tokio::test]
async fn the_work_under_an_oscillating_load_is_that_of_the_scaled_problem() {
    // d = 1 + 0.2 sin t and W = 0.3 sin(t + phi) on a ball of the radius 1: the integral of q dW over a cycle, from
    // elsewhere.
    const WORK: [(f64, f64); 3] = [(0.0, 0.0054460663), (45.0, 0.0094410809), (90.0, 0.0196853445)];
    const POINTS: usize = 4000;
    let server = Server::start().await;
    let (e_star, g_star, friction) = (1.5, 0.8, 0.4);
    let contact = json!({"profile": {"type": "sphere", "radius": 1.0}, "friction": friction,
        "material": {"effective": {"e_star": e_star, "g_star": g_star}}, "preload": {"indentation": 1.0}});
    let ratio: f64 = friction * e_star / g_star;
    for (phase, scaled) in WORK {
        // The displacement leads in that problem, and is the cosine here.
        let cycles = json!({"displacement": 0.3 * ratio, "count": 3, "points_per_cycle": POINTS,
            "normal": {"indentation": 0.2, "phase": -phase}});
        let reply = simulate(&server, &contact, json!({"cycles": cycles})).await;
        let lost = numbers(&reply, "dissipated_energy");
        let work = lost[3 * POINTS] - lost[2 * POINTS];
        let expected = 2.0 * g_star * ratio * ratio * scaled;
        assert!((work / expected - 1.0).abs() < 2e-6, "{phase} degrees: {work:e}, and not {expected:e}");
    }
}

#[tokio::test]
async fn an_indentation_below_zero_lifts_off() {
    let server = Server::start().await;
    let cycles = json!({"displacement": 1e-7, "count": 1, "points_per_cycle": 4, "normal": {"indentation": 1e-3}});
    let reply = simulate(&server, &ball(), json!({"cycles": cycles})).await;
    let regimes: Vec<&Value> = reply["steps"].as_array().unwrap().iter().map(|state| &state["regime"]).collect();
    assert_eq!(regimes.iter().filter(|regime| **regime == "separated").count(), 1, "{regimes:?}");
    assert_eq!(regimes[2], "separated", "{regimes:?}");
}

#[tokio::test]
async fn every_fault_of_cycles_is_named_at_its_place() {
    let server = Server::start().await;
    let mut small = ball();
    small["profile"] = json!({"type": "exact_sphere", "radius": 1e-4});
    small["preload"] = json!({"indentation": 1e-7});
    let ball = ball();
    let with = |normal: Value| json!({"displacement": 1e-7, "count": 1, "normal": normal});
    for (contact, cycles, place, word) in [
        (&ball, json!({"count": 1}), "", "`displacement` or `force`"),
        (&ball, json!({"count": 1, "displacement": 1e-7, "force": 1.0}), "/force", "exactly one"),
        (&ball, json!({"count": 1, "displacement": -1e-7}), "/displacement", "0 to"),
        (&ball, json!({"count": 1, "force": -1.0}), "/force", "0 to"),
        (&ball, json!({"count": 1, "displacement": null}), "/displacement", "null"),
        (&ball, json!({"displacement": 1e-7}), "/count", "missing"),
        (&ball, json!({"displacement": 1e-7, "count": 0}), "/count", "1 to"),
        (&ball, json!({"displacement": 1e-7, "count": 1.5}), "/count", "whole"),
        (&ball, json!({"displacement": 1e-7, "count": 50_000}), "/count", "1 to 49999"),
        (&ball, json!({"displacement": 1e-7, "count": 1000, "points_per_cycle": 100}), "/count", "1 to 999"),
        (&ball, json!({"displacement": 1e-7, "count": 1563, "normal": {"normal_force": 1.0}}), "/count", "1 to 1562"),
        (&ball, json!({"displacement": 1e-7, "count": 1, "points_per_cycle": 5}), "/points_per_cycle", "odd"),
        (&ball, json!({"displacement": 1e-7, "count": 1, "points_per_cycle": 2}), "/points_per_cycle", "4 to 10000"),
        (&ball, json!({"displacement": 1e-7, "count": 1, "start": "aside"}), "/start", "`up`"),
        (&ball, json!({"displacement": 1.0, "count": 1, "mean": 1e9}), "/mean", "1e9 m"),
        (&ball, json!({"force": 1.0, "count": 1, "mean": -1e21}), "/mean", "1e20 N"),
        (&ball, json!({"displacement": 1e-7, "count": 1, "speed": 1.0}), "/speed", "unknown field"),
        (&ball, with(json!({})), "/normal", "`indentation` or `normal_force`"),
        (&ball, with(json!({"normal_force": 1.0, "indentation": 1e-8})), "/normal/normal_force", "exactly one"),
        (&ball, with(json!({"indentation": -1e-8})), "/normal/indentation", "0 to"),
        (&ball, with(json!({"normal_force": 1.0, "phase": 361.0})), "/normal/phase", "degrees"),
        (&ball, with(json!({"normal_force": 1.0, "speed": 1.0})), "/normal/speed", "unknown field"),
        (&ball, with(json!({"normal_force": 10.5})), "/normal/normal_force", "0 to 10 N"),
        (&small, with(json!({"indentation": 2.0})), "/normal/indentation", "where the profile ends"),
        (&ball, json!({"force": 3.5, "count": 1}), "/force", "friction holds"),
        (
            &ball,
            json!({"force": 2.5, "count": 1, "normal": {"normal_force": 9.0, "phase": 90.0}}),
            "/force",
            "friction holds",
        ),
    ] {
        let body = json!({"contact": contact, "path": {"cycles": cycles}});
        let refused = problem(server.post("/simulate", &body).await).await;
        assert_eq!(refused.status, 422, "{cycles}: {refused:?}");
        let code = if word == "friction holds" {
            "force_exceeds_friction"
        } else if word == "where the profile ends" {
            "beyond_profile"
        } else {
            "invalid_input"
        };
        assert_eq!(refused.code, code, "{cycles}: {refused:?}");
        assert_eq!(refused.errors[0].pointer, format!("/path/cycles{place}"), "{cycles}: {refused:?}");
        assert!(refused.errors[0].detail.contains(word), "{cycles}: {refused:?}");
    }
    let body = json!({"contact": ball, "path": {"cycles": with(json!({"normal_force": 1.0, "phase": 12.5}))}});
    for phase in ["1e999", "-1e999", "null", "\"NaN\""] {
        let body = body.to_string().replace("12.5", phase);
        let refused = problem(server.send(Method::POST, "/simulate", Some(&body), &[]).await).await;
        let found = (refused.status, refused.errors[0].pointer.as_str());
        assert_eq!(found, (422, "/path/cycles/normal/phase"), "{phase}");
    }
}

#[tokio::test]
async fn as_many_cycles_as_a_path_has_moves_are_made() {
    let server = Server::start().await;
    let cycles = json!({"displacement": 1e-7, "count": 49_999});
    let body = json!({"contact": ball(), "path": {"cycles": cycles}, "steps": "last"});
    let reply: Value = server.post("/simulate", &body).await.json().await.unwrap();
    assert_eq!(reply["steps"][0]["displacement"], 1e-7);
    // A closed loop leaves no trace: the history is that of one reversal.
    let once = simulate(&server, &ball(), json!({"displacement": [1e-7]})).await;
    assert_eq!(reply["steps"][0]["memory_depth"], once["steps"][0]["memory_depth"]);
}

#[tokio::test]
async fn a_sweep_varies_the_numbers_of_cycles() {
    let server = Server::start().await;
    let base = |amplitude: f64, count: usize| {
        json!({"contact": ball(), "steps": "last",
            "path": {"cycles": {"displacement": amplitude, "count": count}}})
    };
    let work = "/steps/0/dissipated_energy";
    let sweep = json!({"base": base(1e-7, 1), "outputs": [work], "axes": [
        {"pointer": "/path/cycles/displacement", "values": [0.0, 0.5e-7, 1e-7]},
        {"pointer": "/path/cycles/count", "linear": {"from": 1, "to": 3, "count": 3}},
    ]});
    let table: Value = server.post("/sweep", &sweep).await.json().await.unwrap();
    for (row, (amplitude, count)) in
        [0.0, 0.5e-7, 1e-7].into_iter().flat_map(|size| [1, 2, 3].map(|count| (size, count))).enumerate()
    {
        let alone: Value = server.post("/simulate", &base(amplitude, count)).await.json().await.unwrap();
        assert_eq!(&table["columns"][work][row], alone.pointer(work).unwrap(), "{amplitude:e}, {count}");
    }
    let mut negative = sweep.clone();
    negative["axes"][0]["values"] = json!([-1e-7, 1e-7]);
    let refused = problem(server.post("/sweep", &negative).await).await;
    assert_eq!((refused.status, refused.errors[0].pointer.as_str()), (422, "/axes/0"));
}
