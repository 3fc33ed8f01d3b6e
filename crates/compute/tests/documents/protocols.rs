//! Protocols: what is promised is what comes, in as few reversals as there are. That no path leaves less is tested in
//! `crates/mechanics/tests/physics/{minimax,protocols,protocol_search}.rs`.

use serde_json::{Value, json};

use crate::json::{ball, changed, number, of, with};
use crate::{good, post, problem};

fn table() -> Value {
    let radii: Vec<f64> = (0..=30).map(|index| 2e-4 * f64::from(index) / 30.0).collect();
    let heights: Vec<f64> = radii.iter().map(|r| 50.0 * r * r * (1.0 + 3000.0 * r)).collect();
    let profile = json!({"type": "tabulated", "r": radii, "z": heights});
    changed(ball(), &json!({"profile": profile, "preload": {"contact_radius": 1e-4}}))
}

fn found(contact: &Value, asked: Value) -> Value {
    good(post("/protocols", &of(contact, &asked)))
}

#[test]
fn the_path_of_a_protocol_leaves_the_predicted_stress_in_simulate() {
    for contact in [ball(), table()] {
        for kind in ["linear", "equal_peaks", "minimax"] {
            for end in ["displacement_zero", "force_zero", "free"] {
                let found = found(&contact, json!({"reversals": 4, "kind": kind, "end": end}));
                let again = of(&contact, &json!({"path": found["path"], "residual": true}));
                let again = good(post("/simulate", &again));
                assert_eq!(found["residual"], again["residual"], "{kind} {end}");
                assert_eq!(found["path"]["displacement"].as_array().unwrap().len(), 5);
                let last = again["steps"].as_array().unwrap().last().unwrap();
                for name in ["force", "displacement", "dissipated_energy"] {
                    assert_eq!(found[name], last[name], "{name}");
                }
                let limit = number(&found["contact"]["gross_slip_force"]);
                match end {
                    "displacement_zero" => assert!(number(&last["displacement"]).abs() <= 0.0, "{last}"),
                    "force_zero" => assert!(number(&last["force"]).abs() < 1e-12 * limit, "{last}"),
                    _ => {}
                }
                let others = found["comparison"].as_object().unwrap();
                assert!(others.len() == 2 && !others.contains_key(kind), "{others:?}");
                let least = number(&found["largest"]) * (1.0 - 1e-8);
                let is_best = others.values().all(|other| number(&other["largest"]) >= least);
                assert!(kind != "minimax" || is_best, "{end}: {found}");
            }
        }
    }
    // Where the stress is infinite the reply says what is made small instead.
    let cone = with(ball(), "/profile", json!({"type": "cone", "slope": 0.01}));
    let reply = found(&cone, json!({"reversals": 8}));
    let from = number(&reply["judged"]["from_radius"]) / number(&reply["contact"]["contact_radius"]);
    assert!((from - 0.1).abs() < 1e-12 && reply["judged"]["pressure"] == "mean", "{reply}");
    assert!(reply["residual"]["max"].is_null() && reply["largest"].is_number());
    assert!(reply["judged"]["objective"].as_str().unwrap().contains("infinite"));
    let punch = with(ball(), "/profile", json!({"type": "flat_punch", "radius": 1e-4}));
    let reply = found(&punch, json!({"reversals": 3}));
    assert!(number(&reply["relative"]) < 1e-12, "{reply}");
    assert!(reply["judged"]["objective"].as_str().unwrap().contains("edge"));
}

#[test]
fn a_target_takes_the_fewest_reversals_that_reach_it() {
    for (kind, target) in [("minimax", 0.4007), ("linear", 0.2), ("equal_peaks", 0.15), ("minimax", 0.9)] {
        let ask = |rest: Value| found(&ball(), changed(rest, &json!({"kind": kind, "end": "free"})));
        let reply = ask(json!({"target": target}));
        let reversals = reply["reversals"].as_u64().unwrap();
        assert!(number(&reply["relative"]) <= target);
        if reversals > 1 {
            let fewer = ask(json!({"reversals": reversals - 1}));
            assert!(number(&fewer["relative"]) > target, "{kind} {target}: {reversals}");
        }
    }
}

#[test]
fn robustness_is_the_same_for_the_same_seed_and_grows_with_the_error() {
    let ask = |errors: Value| found(&ball(), json!({"reversals": 10, "kind": "linear", "robustness": errors}));
    let seeded = |seed: u32| json!({"amplitude_error": 0.02, "samples": 100, "seed": seed});
    let (one, two, other) = (ask(seeded(7)), ask(seeded(7)), ask(seeded(8)));
    assert!(one["robustness"] == two["robustness"] && one["robustness"] != other["robustness"]);
    let sum = |name: &str, sign: f64| number(&one["robustness"][name]) + sign * number(&other["robustness"][name]);
    assert!(sum("mean", -1.0).abs() < 4.0 * sum("standard_error", 1.0), "{one} {other}");
    assert!(number(&one["robustness"]["percentile_95"]) >= number(&one["robustness"]["mean"]));
    let exact = ask(json!({"samples": 5}));
    assert!((number(&exact["robustness"]["mean"]) - number(&exact["relative"])).abs() < 1e-12);
    let rough = ask(json!({"amplitude_error": 0.05, "friction_error": 0.1, "samples": 100}));
    let worse = |reply: &Value| number(&reply["robustness"]["mean"]) - number(&reply["relative"]);
    assert!(worse(&rough) > worse(&one) && worse(&one) > 0.0, "{} {}", worse(&rough), worse(&one));
    assert!(rough["comparison"]["minimax"]["robustness"]["mean"].is_number());
}

#[test]
fn every_fault_has_its_pointer() {
    let friction = |friction: f64| with(ball(), "/friction", json!(friction));
    let loose = with(ball(), "/preload", json!({"normal_force": 0.0}));
    for (contact, asked, pointer) in [
        (&ball(), json!({"kind": "linear"}), "/reversals"),
        (&ball(), json!({"reversals": 3, "target": 0.1}), "/target"),
        (&ball(), json!({"target": 1e-4, "kind": "linear"}), "/target"),
        (&ball(), json!({"reversals": 201}), "/reversals"),
        (&ball(), json!({"reversals": 3, "end": "nowhere"}), "/end"),
        (&ball(), json!({"reversals": 3, "start": {"displacement": 0.0}}), "/start/displacement"),
        (&ball(), json!({"reversals": 3, "robustness": {"samples": 1}}), "/robustness/samples"),
        (&ball(), json!({"reversals": 3, "robustness": {"amplitude_error": -0.1}}), "/robustness/amplitude_error"),
        (&ball(), json!({"reversals": 3, "robustness": {"seed": 1u64 << 60}}), "/robustness/seed"),
        (&friction(0.0), json!({"reversals": 3}), "/contact/friction"),
        (&loose, json!({"reversals": 3}), "/contact/preload"),
    ] {
        let refused = problem(post("/protocols", &of(contact, &asked)));
        let found: Vec<&str> = refused.errors.iter().map(|error| error.pointer.as_str()).collect();
        assert_eq!((refused.status, found), (422, vec![pointer]), "{asked}: {refused:?}");
    }
}

#[test]
fn an_annulus_as_thin_as_a_rounding_of_its_radius_has_a_protocol_or_is_refused() {
    let sphere = json!({"type": "truncated_sphere", "radius": 0.05, "flat_radius": 0.01});
    let cone = json!({"type": "truncated_cone", "slope": 0.05, "flat_radius": 0.01});
    for (profile, load) in [(&sphere, 0.1), (&sphere, 0.3), (&cone, 1e-9), (&cone, 1e-6)] {
        let contact = json!({
            "profile": profile, "material": {"effective": {"e_star": 1.2e11, "g_star": 1e11}}, "friction": 0.5,
            "preload": {"normal_force": load}
        });
        // The reply compares the path with those of the other laws.
        for end in ["force_zero", "displacement_zero", "free"] {
            let asked = json!({"contact": contact, "kind": "minimax", "reversals": 3, "end": end});
            match post("/protocols", &asked) {
                Ok(reply) => {
                    let moves = reply["path"]["displacement"].as_array().unwrap().len();
                    assert!((1..=5).contains(&moves), "{asked}: {moves} moves");
                }
                Err(refused) => assert_eq!(refused.status, 422, "{asked}"),
            }
        }
    }
}
