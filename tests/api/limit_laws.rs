//! Stored contacts that adhere or have a shear strength, replayed and in their history. Their values are tested in
//! `crates/mechanics/tests/physics`, and what is refused of a document in `crates/compute/tests/documents`.

use std::sync::Arc;

use serde_json::{Value, json};
use stickslip::sessions::CAPACITY;
use stickslip::store::SqliteStore;

use crate::common::{Server, good, number, problem};

#[tokio::test]
async fn contacts_under_limit_laws_are_stored_replayed_and_listed() {
    let memory = Arc::new(SqliteStore::in_memory().unwrap());
    let (cached, replayed) = (Server::with(memory.clone(), CAPACITY).await, Server::with(memory, 0).await);
    for law in [
        json!({"friction": 0.3, "shear_strength": 0.2}),
        json!({"friction": 0.0, "shear_strength": 0.2, "adhesion": {"work": 0.01}}),
        json!({"friction": 0.0, "adhesion": {"work": 0.01}}),
    ] {
        let mut body = json!({
            "profile": {"type": "sphere", "radius": 1.0},
            "material": {"effective": {"e_star": 1.0, "g_star": 0.8}},
            "preload": {"normal_force": 0.05}
        });
        body.as_object_mut().unwrap().extend(law.as_object().unwrap().clone());
        let (adheres, strong) = (law.get("adhesion").is_some(), law.get("shear_strength").is_some());
        let made = good(cached.post("/contacts", &body).await).await;
        let place = format!("/contacts/{}", made["id"].as_str().unwrap());
        let moves = format!("{place}/move");
        if adheres {
            let off = good(cached.post(&moves, &json!({"indentation": -1.0})).await).await;
            assert_eq!(off["state"]["regime"], "pulled_off", "{off}");
            assert!(number(&off["state"]["adhesion_loss"]) > 0.0);
            let pulled = good(cached.post(&moves, &json!({"normal_force": -0.04})).await).await;
            assert!((number(&pulled["state"]["normal_force"]) + 0.04).abs() < 1e-16, "{pulled}");
        } else {
            let refused = problem(cached.post(&moves, &json!({"normal_force": -0.04})).await).await;
            assert_eq!((refused.code.as_str(), &*refused.errors[0].pointer), ("invalid_input", "/normal_force"));
        }
        let twist = problem(cached.post(&moves, &json!({"twist": 0.1})).await).await;
        assert_eq!(twist.code, "invalid_input");
        if strong {
            good(cached.post(&moves, &json!({"displacement": 0.02})).await).await;
            let refused = problem(cached.post(&moves, &json!({"normal_force": 0.1})).await).await;
            assert_eq!(refused.code, "load_must_be_constant");
            let relax = problem(cached.post(&format!("{place}/relax"), &json!({"reversals": 3})).await).await;
            assert!(relax.detail.contains("not available with"), "{relax:?}");
        }
        let state = |reply: &Value| reply["state"].clone();
        let [shown, again] = [&cached, &replayed].map(|server| server.get(&place));
        assert_eq!(state(&good(shown.await).await), state(&good(again.await).await));
        let page = good(replayed.get(&format!("{place}/history")).await).await;
        for item in page["items"].as_array().unwrap() {
            assert_eq!(item["state"].get("surface_energy").is_some(), adheres, "{item}");
            assert!(item["state"].get("adhesion_loss").is_none(), "{item}");
        }
    }
}
