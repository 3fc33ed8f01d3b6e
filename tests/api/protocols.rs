//! Protocols over HTTP: what is promised is what comes, from any history, in as few reversals as there are. That no
//! path leaves less is tested in `crates/mechanics/tests/physics/{minimax,protocols,protocol_search}.rs`.

use reqwest::Method;
use serde_json::{Value, json};

use crate::common::{Server, ball, changed, good, number, of, problem, run, timeless, with};

fn table() -> Value {
    let radii: Vec<f64> = (0..=30).map(|index| 2e-4 * f64::from(index) / 30.0).collect();
    let heights: Vec<f64> = radii.iter().map(|r| 50.0 * r * r * (1.0 + 3000.0 * r)).collect();
    let profile = json!({"type": "tabulated", "r": radii, "z": heights});
    changed(ball(), &json!({"profile": profile, "preload": {"contact_radius": 1e-4}}))
}

/// A stored contact with a history of moves back and forth at different indentations.
async fn moved_at_random(server: &Server, contact: &Value, moves: u32) -> String {
    let made = good(server.post("/contacts", contact).await).await;
    let (full, depth) = (number(&made["contact"]["gross_slip_displacement"]), number(&made["contact"]["indentation"]));
    let step = |index: u32| {
        let turn = (f64::from(index) * 2.399).sin();
        match index % 5 {
            0 => json!({"indentation": depth * (1.0 + 0.2 * turn)}),
            1 => json!({"displacement": 3.0 * full * turn}),
            _ => json!({"displacement": 0.7 * full * turn}),
        }
    };
    let (id, path) = (made["id"].as_str().unwrap().to_owned(), (1..=moves).map(step).collect::<Vec<_>>());
    good(server.post(&format!("/contacts/{id}/path"), &json!({"path": {"moves": path}})).await).await;
    id
}

async fn found(server: &Server, contact: &Value, asked: Value) -> Value {
    good(server.post("/protocols", &of(contact, &asked)).await).await
}

#[tokio::test]
async fn relaxing_leaves_what_was_predicted_whatever_the_history() {
    let server = Server::start().await;
    let pasts = [(ball(), 3, "displacement_zero"), (ball(), 17, "force_zero"), (ball(), 23, "free")];
    for (contact, moves, end) in pasts.into_iter().chain([(table(), 17, "displacement_zero")]) {
        let id = moved_at_random(&server, &contact, moves).await;
        let here = format!("/contacts/{id}");
        let before = good(server.get(&here).await).await;
        let asked = json!({"reversals": 6, "end": end, "steps": "all"});
        let relax = async |asked: &Value| good(server.post(&format!("{here}/relax"), asked).await).await;
        let shown = relax(&with(asked.clone(), "/dry_run", json!(true))).await;
        assert_eq!(good(server.get(&here).await).await, before, "a dry run changes nothing");
        let named = json!({"reversals": 6, "end": end, "start": {"contact_id": id}});
        let asked_for = good(server.post("/protocols", &named).await).await;
        let done = relax(&asked).await;
        assert_eq!((&shown["dry_run"], &done["dry_run"]), (&json!(true), &json!(false)));
        for member in ["path", "residual", "largest", "force", "dissipated_energy", "start"] {
            assert_eq!(shown[member], done[member], "{member}");
            assert_eq!(asked_for[member], done[member], "{member}");
        }
        assert_eq!(shown["steps"], done["steps"]);
        let now = good(server.get(&here).await).await;
        let made = done["path"]["displacement"].as_array().unwrap().len() as u64;
        assert_eq!(now["sequence"].as_u64().unwrap(), before["sequence"].as_u64().unwrap() + made);
        assert_eq!(now["sequence"], done["sequence"]);
        assert_eq!(&now["state"], done["steps"].as_array().unwrap().last().unwrap());
        let left = good(server.get(&format!("{here}/stress?points=2&residual=true")).await).await;
        assert_eq!(left["residual"], done["residual"], "after {moves} moves");
        // As little as from a contact that has never moved, at least.
        let fresh = with(contact, "/preload", json!({"indentation": before["state"]["indentation"]}));
        let fresh = found(&server, &fresh, json!({"reversals": 6, "end": end})).await;
        let (left, usual) = (number(&done["largest"]), number(&fresh["largest"]));
        assert!(left <= usual * (1.0 + 1e-6), "{end}: {left} {usual}");
    }
    // One that has never moved is left alone.
    let id = server.contact().await;
    let done = good(server.post(&format!("/contacts/{id}/relax"), &json!({"reversals": 5})).await).await;
    assert!(done["start"]["stroke"] == "stay" && number(&done["largest"]).abs() <= 0.0, "{done}");
}

#[tokio::test]
async fn relaxing_is_all_or_nothing_under_a_condition_and_repeatable() {
    let server = Server::start().await;
    let id = moved_at_random(&server, &ball(), 4).await;
    let path = format!("/contacts/{id}/relax");
    let send = async |body: &str, headers: &[(&str, &str)]| server.send(Method::POST, &path, Some(body), headers).await;
    let body = r#"{"reversals":3}"#;
    for body in [r#"{"reversals":3,"dry_run":true}"#, body] {
        assert_eq!(problem(send(body, &[("if-match", "\"3\"")]).await).await.code, "stale_sequence");
    }
    let keyed = [("idempotency-key", "once"), ("if-match", "\"4\"")];
    let first = good(send(body, &keyed).await).await;
    assert_eq!(first, good(send(body, &keyed).await).await);
    assert_eq!(good(server.get(&format!("/contacts/{id}")).await).await["sequence"], first["sequence"]);
    assert_eq!(problem(send(r#"{"reversals":2}"#, &keyed).await).await.code, "idempotency_key_reused");
    // Apart there is nothing to move against.
    good(server.post(&format!("/contacts/{id}/move"), &json!({"indentation": -1e-6})).await).await;
    for body in [body, r#"{"reversals":3,"dry_run":true}"#, r#"{"reversals":3,"kind":"equal_peaks"}"#] {
        let refusal = problem(send(body, &[]).await).await;
        assert_eq!((refusal.status, refusal.code.as_str()), (409, "conflict"), "{body}");
        assert!(refusal.detail.contains("lifted off") && refusal.errors.is_empty(), "{refusal:?}");
    }
}

#[tokio::test]
async fn a_contact_that_is_named_must_be_there_and_fit() {
    let server = Server::start().await;
    let lives = json!({"contact_id": server.contact().await});
    let friction = |friction: f64| with(ball(), "/friction", json!(friction));
    for (body, pointer) in [
        (of(&ball(), &json!({"reversals": 3, "start": {"contact_id": "x"}})), "/start/contact_id"),
        (of(&friction(0.4), &json!({"reversals": 3, "start": lives})), "/contact"),
        (json!({"reversals": 3}), "/contact"),
        (json!({"reversals": 3, "start": lives, "robustness": {"friction_error": 0.1}}), "/robustness/friction_error"),
    ] {
        let refused = problem(server.post("/protocols", &body).await).await;
        let found: Vec<&str> = refused.errors.iter().map(|error| error.pointer.as_str()).collect();
        assert_eq!((refused.status, found), (422, vec![pointer]), "{body}: {refused:?}");
    }
    let nobody = json!({"reversals": 3, "start": {"contact_id": "018f0000-0000-7000-8000-000000000000"}});
    assert_eq!(problem(server.post("/protocols", &nobody).await).await.code, "contact_not_found");
    found(&server, &ball(), json!({"reversals": 3, "start": lives})).await;
}

#[test]
fn flags_of_the_command_line_make_the_same_request() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, value: &Value| {
        let path = folder.path().join(name);
        std::fs::write(&path, value.to_string()).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let asked = of(&ball(), &json!({"reversals": 3, "kind": "equal_peaks", "end": "force_zero"}));
    let (body, contact) = (write("body.json", &asked), write("contact.json", &ball()));
    let printed = |arguments: &[&str]| -> Value { timeless(serde_json::from_slice(&run(arguments).stdout).unwrap()) };
    let flags = ["--contact", &contact, "--reversals", "3", "--kind", "equal-peaks", "--end", "force-zero"];
    assert_eq!(printed(&[&["protocol"], &flags[..]].concat()), printed(&["protocol", &body]));
    let refused = run(&["protocol", "--contact", &contact]);
    assert!(!refused.status.success() && String::from_utf8_lossy(&refused.stderr).contains("/reversals"));
}
