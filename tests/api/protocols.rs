//! Protocols over HTTP: what is promised is what comes, from any history, in as few reversals as there are.

use crate::common;

use common::{Server, ball, good, number, of, problem, run};
use reqwest::Method;
use serde_json::{Value, json};

fn table() -> Value {
    let radii: Vec<f64> = (0..=30).map(|index| 2e-4 * f64::from(index) / 30.0).collect();
    let heights: Vec<f64> = radii.iter().map(|r| 50.0 * r * r * (1.0 + 3000.0 * r)).collect();
    let mut contact = ball();
    contact["profile"] = json!({"type": "tabulated", "r": radii, "z": heights});
    contact["preload"] = json!({"contact_radius": 1e-4});
    contact
}

/// A stored contact with a history of moves back and forth at different indentations.
async fn wandered(server: &Server, contact: &Value, moves: u32) -> String {
    let made = good(server.post("/contacts", contact).await).await;
    let (full, depth) = (number(&made["contact"]["gross_slip_displacement"]), number(&made["contact"]["indentation"]));
    let moves: Vec<Value> = (1..=moves)
        .map(|index| {
            let turn = (f64::from(index) * 2.399).sin();
            match index % 5 {
                0 => json!({"indentation": depth * (1.0 + 0.2 * turn)}),
                1 => json!({"displacement": 3.0 * full * turn}),
                _ => json!({"displacement": 0.7 * full * turn}),
            }
        })
        .collect();
    let id = made["id"].as_str().unwrap().to_owned();
    if !moves.is_empty() {
        good(server.post(&format!("/contacts/{id}/path"), &json!({"path": {"moves": moves}})).await).await;
    }
    id
}

#[tokio::test]
async fn the_path_of_a_protocol_leaves_the_predicted_stress_in_simulate() {
    let server = Server::start().await;
    for contact in [ball(), table()] {
        for kind in ["linear", "equal_peaks", "minimax"] {
            for end in ["displacement_zero", "force_zero", "free"] {
                let asked = of(&contact, &json!({"reversals": 4, "kind": kind, "end": end}));
                let found = good(server.post("/protocols", &asked).await).await;
                let again = json!({"contact": contact, "path": found["path"], "residual": true});
                let again = good(server.post("/simulate", &again).await).await;
                assert_eq!(found["residual"], again["residual"], "{kind} {end}");
                assert_eq!(found["path"]["displacement"].as_array().unwrap().len(), 5);
                let last = again["steps"].as_array().unwrap().last().unwrap().clone();
                assert_eq!((&found["force"], &found["displacement"]), (&last["force"], &last["displacement"]));
                assert_eq!(found["dissipated_energy"], last["dissipated_energy"]);
                let (limit, full) = (
                    number(&found["contact"]["gross_slip_force"]),
                    number(&found["contact"]["gross_slip_displacement"]),
                );
                match end {
                    "displacement_zero" => assert!(number(&last["displacement"]).abs() <= 0.0, "{last}"),
                    "force_zero" => assert!(number(&last["force"]).abs() < 1e-12 * limit, "{last}"),
                    _ => {}
                }
                assert!((number(&found["path"]["displacement"][0]) / full - 1.0).abs() < 1e-14);
                assert!(found["comparison"].get(kind).is_none() && found["comparison"].as_object().unwrap().len() == 2);
                for (other, outcome) in found["comparison"].as_object().unwrap() {
                    let better = number(&outcome["largest"]) >= number(&found["largest"]) * (1.0 - 1e-8);
                    assert!(kind != "minimax" || better, "{other} {end}: {found}");
                }
            }
        }
    }
}

#[tokio::test]
async fn a_target_takes_the_fewest_reversals_that_reach_it() {
    let server = Server::start().await;
    for (kind, target) in [("minimax", 0.4007), ("linear", 0.2), ("equal_peaks", 0.15), ("minimax", 0.9)] {
        let ask = |rest: Value| {
            let body = of(&ball(), &rest);
            let server = &server;
            async move { good(server.post("/protocols", &body).await).await }
        };
        let found = ask(json!({"target": target, "kind": kind, "end": "free"})).await;
        let reversals = found["reversals"].as_u64().unwrap();
        assert!(number(&found["relative"]) <= target);
        if reversals > 1 {
            let fewer = ask(json!({"reversals": reversals - 1, "kind": kind, "end": "free"})).await;
            assert!(number(&fewer["relative"]) > target, "{kind} {target}: {reversals}");
        }
    }
    let refused =
        problem(server.post("/protocols", &of(&ball(), &json!({"target": 1e-4, "kind": "linear"}))).await).await;
    assert_eq!((refused.code.as_str(), refused.errors[0].pointer.as_str()), ("invalid_input", "/target"));
    assert!(refused.errors[0].detail.contains("200 reversals"), "{refused:?}");
}

#[tokio::test]
async fn relaxing_leaves_what_was_predicted_whatever_the_history() {
    let server = Server::start().await;
    let ball_pasts = vec![(3, "displacement_zero"), (17, "force_zero"), (23, "free")];
    let table_pasts = vec![(17, "displacement_zero")];
    for (contact, pasts) in [(ball(), ball_pasts), (table(), table_pasts)] {
        for (moves, end) in pasts {
            let id = wandered(&server, &contact, moves).await;
            let before = good(server.get(&format!("/contacts/{id}")).await).await;
            let path = format!("/contacts/{id}/relax");
            let asked = json!({"reversals": 6, "end": end, "steps": "all"});
            let mut dry = asked.clone();
            dry["dry_run"] = json!(true);
            let shown = good(server.post(&path, &dry).await).await;
            assert_eq!(good(server.get(&format!("/contacts/{id}")).await).await, before, "a dry run changes nothing");
            let named = json!({"reversals": 6, "end": end, "start": {"contact_id": id}});
            let asked_for = good(server.post("/protocols", &named).await).await;
            let done = good(server.post(&path, &asked).await).await;
            assert_eq!(shown["dry_run"], true);
            assert_eq!(done["dry_run"], false);
            for member in ["path", "residual", "largest", "force", "dissipated_energy", "start"] {
                assert_eq!(shown[member], done[member], "{member}");
                assert_eq!(asked_for[member], done[member], "{member}");
            }
            assert_eq!(shown["steps"], done["steps"]);
            let now = good(server.get(&format!("/contacts/{id}")).await).await;
            let made = done["path"]["displacement"].as_array().unwrap().len() as u64;
            assert_eq!(now["sequence"].as_u64().unwrap(), before["sequence"].as_u64().unwrap() + made);
            assert_eq!(now["sequence"], done["sequence"]);
            assert_eq!(&now["state"], done["steps"].as_array().unwrap().last().unwrap());
            let left = good(server.get(&format!("/contacts/{id}/stress?points=2&residual=true")).await).await;
            assert_eq!(left["residual"], done["residual"], "after {moves} moves");
            // As little as from a contact that has never moved, at least.
            let mut fresh = contact.clone();
            fresh["preload"] = json!({"indentation": before["state"]["indentation"]});
            let fresh = good(server.post("/protocols", &of(&fresh, &json!({"reversals": 6, "end": end}))).await).await;
            let (found, usual) = (number(&done["largest"]), number(&fresh["largest"]));
            assert!(found <= usual * (1.0 + 1e-6), "{end}: {found} {usual}");
        }
    }
}

#[tokio::test]
async fn a_contact_that_has_never_moved_is_left_alone() {
    let server = Server::start().await;
    let id = server.contact().await;
    let done = good(server.post(&format!("/contacts/{id}/relax"), &json!({"reversals": 5})).await).await;
    assert_eq!(done["start"]["stroke"], "stay");
    assert!(number(&done["largest"]).abs() <= 0.0);
}

#[tokio::test]
async fn relaxing_is_all_or_nothing_under_a_condition_and_repeatable() {
    let server = Server::start().await;
    let id = wandered(&server, &ball(), 4).await;
    let path = format!("/contacts/{id}/relax");
    let body = json!({"reversals": 3}).to_string();
    for dry in [json!({"reversals": 3, "dry_run": true}).to_string(), body.clone()] {
        let stale = problem(server.send(Method::POST, &path, Some(&dry), &[("if-match", "\"3\"")]).await).await;
        assert_eq!(stale.code, "stale_sequence");
    }
    let keyed = [("idempotency-key", "once"), ("if-match", "\"4\"")];
    let first = good(server.send(Method::POST, &path, Some(&body), &keyed).await).await;
    let second = good(server.send(Method::POST, &path, Some(&body), &keyed).await).await;
    assert_eq!(first, second);
    let now = good(server.get(&format!("/contacts/{id}")).await).await;
    assert_eq!(now["sequence"], first["sequence"]);
    let other = problem(server.send(Method::POST, &path, Some(r#"{"reversals":2}"#), &keyed).await).await;
    assert_eq!(other.code, "idempotency_key_reused");
}

#[tokio::test]
async fn what_is_lifted_off_has_nothing_to_relax() {
    let server = Server::start().await;
    let id = wandered(&server, &ball(), 2).await;
    let lift = json!({"indentation": -1e-6}).to_string();
    good(server.send(Method::POST, &format!("/contacts/{id}/move"), Some(&lift), &[]).await).await;
    for body in [r#"{"reversals":3}"#, r#"{"reversals":3,"dry_run":true}"#, r#"{"reversals":3,"kind":"equal_peaks"}"#] {
        let refusal = problem(server.send(Method::POST, &format!("/contacts/{id}/relax"), Some(body), &[]).await).await;
        assert_eq!((refusal.status, refusal.code.as_str()), (409, "conflict"), "{body}");
        assert!(refusal.detail.contains("lifted off") && refusal.errors.is_empty(), "{refusal:?}");
    }
}

#[tokio::test]
async fn robustness_is_the_same_for_the_same_seed_and_grows_with_the_error() {
    let server = Server::start().await;
    let ask = |errors: Value| {
        let body = of(&ball(), &json!({"reversals": 10, "kind": "linear", "robustness": errors}));
        let server = &server;
        async move { good(server.post("/protocols", &body).await).await }
    };
    let errors = json!({"amplitude_error": 0.02, "samples": 100, "seed": 7});
    let (one, two) = (ask(errors.clone()).await, ask(errors).await);
    assert_eq!(one["robustness"], two["robustness"]);
    let other = ask(json!({"amplitude_error": 0.02, "samples": 100, "seed": 8})).await;
    assert_ne!(one["robustness"], other["robustness"]);
    let gap = (number(&one["robustness"]["mean"]) - number(&other["robustness"]["mean"])).abs();
    let error = number(&one["robustness"]["standard_error"]) + number(&other["robustness"]["standard_error"]);
    assert!(gap < 4.0 * error, "{gap} {error}");
    assert!(number(&one["robustness"]["percentile_95"]) >= number(&one["robustness"]["mean"]));
    let exact = ask(json!({"samples": 5})).await;
    assert!((number(&exact["robustness"]["mean"]) - number(&exact["relative"])).abs() < 1e-12);
    let rough = ask(json!({"amplitude_error": 0.05, "friction_error": 0.1, "samples": 100})).await;
    let worse = |reply: &Value| number(&reply["robustness"]["mean"]) - number(&reply["relative"]);
    assert!(worse(&rough) > worse(&one) && worse(&one) > 0.0, "{} {}", worse(&rough), worse(&one));
    assert!(rough["comparison"]["minimax"]["robustness"]["mean"].is_number());
}

#[tokio::test]
async fn every_fault_has_its_pointer() {
    let server = Server::start().await;
    let id = server.contact().await;
    let (mut smooth, mut loose, mut deep) = (ball(), ball(), ball());
    smooth["friction"] = json!(0.0);
    loose["preload"] = json!({"normal_force": 0.0});
    deep["friction"] = json!(0.4);
    let lives = json!({"contact_id": id});
    for (body, pointer) in [
        (of(&ball(), &json!({"kind": "linear"})), "/reversals"),
        (of(&ball(), &json!({"reversals": 3, "target": 0.1})), "/target"),
        (of(&ball(), &json!({"reversals": 0})), "/reversals"),
        (of(&ball(), &json!({"reversals": 201})), "/reversals"),
        (of(&ball(), &json!({"target": 0.0})), "/target"),
        (of(&ball(), &json!({"reversals": 3, "kind": "best"})), "/kind"),
        (of(&ball(), &json!({"reversals": 3, "end": "nowhere"})), "/end"),
        (of(&ball(), &json!({"reversals": 3, "start": {"displacement": 0.0}})), "/start/displacement"),
        (of(&ball(), &json!({"reversals": 3, "start": {"contact_id": "x"}})), "/start/contact_id"),
        (of(&ball(), &json!({"reversals": 3, "robustness": {"samples": 1}})), "/robustness/samples"),
        (of(&ball(), &json!({"reversals": 3, "robustness": {"amplitude_error": -0.1}})), "/robustness/amplitude_error"),
        (of(&ball(), &json!({"reversals": 3, "robustness": {"seed": 1u64 << 60}})), "/robustness/seed"),
        (of(&smooth, &json!({"reversals": 3})), "/contact/friction"),
        (of(&loose, &json!({"reversals": 3})), "/contact/preload"),
        (of(&deep, &json!({"reversals": 3, "start": lives})), "/contact"),
        (json!({"reversals": 3}), "/contact"),
        (json!({"reversals": 3, "start": lives, "robustness": {"friction_error": 0.1}}), "/robustness/friction_error"),
    ] {
        let refused = problem(server.post("/protocols", &body).await).await;
        let found: Vec<&str> = refused.errors.iter().map(|error| error.pointer.as_str()).collect();
        assert_eq!((refused.status, found), (422, vec![pointer]), "{body}: {refused:?}");
    }
    // Apart there is nothing to move against.
    good(server.post(&format!("/contacts/{id}/move"), &json!({"indentation": -1e-6})).await).await;
    let refused = problem(server.post(&format!("/contacts/{id}/relax"), &json!({"reversals": 3})).await).await;
    assert!(refused.status == 409 && refused.detail.contains("lifted off"), "{refused:?}");
    let nobody = json!({"reversals": 3, "start": {"contact_id": "018f0000-0000-7000-8000-000000000000"}});
    assert_eq!(problem(server.post("/protocols", &nobody).await).await.code, "contact_not_found");
    let said = of(&ball(), &json!({"reversals": 3, "start": {"contact_id": server.contact().await}}));
    good(server.post("/protocols", &said).await).await;
}

#[tokio::test]
async fn where_the_stress_is_infinite_the_reply_says_what_is_made_small_instead() {
    let server = Server::start().await;
    let mut cone = ball();
    cone["profile"] = json!({"type": "cone", "slope": 0.01});
    let found = good(server.post("/protocols", &of(&cone, &json!({"reversals": 8}))).await).await;
    let edge = number(&found["contact"]["contact_radius"]);
    assert!((number(&found["judged"]["from_radius"]) / edge - 0.1).abs() < 1e-12);
    assert_eq!(found["judged"]["pressure"], "mean");
    assert!(found["residual"]["max"].is_null() && found["largest"].is_number());
    assert!(found["judged"]["objective"].as_str().unwrap().contains("infinite"));
    for (name, outcome) in found["comparison"].as_object().unwrap() {
        assert!(number(&outcome["largest"]) > number(&found["largest"]), "{name}");
    }
    let mut punch = ball();
    punch["profile"] = json!({"type": "flat_punch", "radius": 1e-4});
    for end in ["displacement_zero", "force_zero", "free"] {
        let found = good(server.post("/protocols", &of(&punch, &json!({"reversals": 3, "end": end}))).await).await;
        assert!(number(&found["relative"]) < 1e-12, "{end}: {found}");
        assert!(found["judged"]["objective"].as_str().unwrap().contains("edge"));
    }
}

#[tokio::test]
async fn the_command_line_says_what_the_service_says() {
    let server = Server::start().await;
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, value: &Value| {
        let path = folder.path().join(name);
        std::fs::write(&path, value.to_string()).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let asked = of(&ball(), &json!({"reversals": 3, "kind": "equal_peaks", "end": "force_zero"}));
    let served = good(server.post("/protocols", &asked).await).await;
    let (body, contact) = (write("body.json", &asked), write("contact.json", &ball()));
    let flags = ["--contact", &contact, "--reversals", "3", "--kind", "equal-peaks", "--end", "force-zero"];
    for arguments in [vec!["protocol", &body], [vec!["protocol"], flags.to_vec()].concat()] {
        let output = run(&arguments);
        assert!(output.status.success(), "{output:?}");
        let printed: Value = serde_json::from_slice(&output.stdout).unwrap();
        for member in ["path", "residual", "comparison", "judged", "force"] {
            assert_eq!(printed[member], served[member], "{member}");
        }
    }
    let refused = run(&["protocol", "--contact", &contact]);
    assert!(
        !refused.status.success() && String::from_utf8_lossy(&refused.stderr).contains("/reversals"),
        "{refused:?}"
    );
}

fn steel(profile: &Value) -> Value {
    let material = json!({"effective": {"e_star": 1e11, "g_star": 8e10}});
    json!({"profile": profile, "material": material, "friction": 0.3, "preload": {"indentation": 3e-6}})
}

/// On a parabola the best from a part of gross slip is the best from gross slip, 0.6 after one reversal, times the root
/// of that part. The residual of every reply says by itself what it is relative to.
#[tokio::test]
async fn a_small_start_and_a_live_history_are_relaxed_as_far_as_can_be() {
    let server = Server::start().await;
    let ball = steel(&json!({"type": "sphere", "radius": 0.01}));
    let asked = of(&ball, &json!({"reversals": 1, "end": "free", "start": {"displacement": 2.25e-7}}));
    let found = good(server.post("/protocols", &asked).await).await;
    let best = 0.6 * 0.2_f64.sqrt();
    assert!((number(&found["relative"]) - best).abs() < 1e-6, "{found}");
    let body = json!({"path": {"displacement": found["path"]["displacement"]}, "residual": true});
    let simulated = good(server.post("/simulate", &of(&ball, &body)).await).await;
    assert!((number(&simulated["residual"]["relative"]) - best).abs() < 1e-6, "{simulated}");

    let id = wandered(&server, &steel(&json!({"type": "power_law", "exponent": 1.5, "coefficient": 1.0})), 0).await;
    good(server.post(&format!("/contacts/{id}/move"), &json!({"displacement": 9e-7})).await).await;
    let there = good(server.get(&format!("/contacts/{id}/stress?points=2&residual=true")).await).await;
    assert!((number(&there["residual"]["relative"]) - 0.6294).abs() < 1e-4, "{there}");
    let asked = json!({"reversals": 1, "end": "force_zero"});
    let relaxed = good(server.post(&format!("/contacts/{id}/relax"), &asked).await).await;
    assert!(number(&relaxed["residual"]["relative"]) < 0.31842, "{relaxed}");
}
