//! Stored contacts that adhere, have a shear strength or are twisted, replayed and in their history. Their values are
//! tested in
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

#[tokio::test]
async fn a_twisted_contact_is_stored_replayed_listed_and_drawn() {
    let memory = Arc::new(SqliteStore::in_memory().unwrap());
    let (cached, replayed) = (Server::with(memory.clone(), CAPACITY).await, Server::with(memory, 0).await);
    let body = json!({
        "profile": {"type": "sphere", "radius": 1.0},
        "material": {"effective": {"e_star": 1.0, "g_star": 0.8, "shear_modulus": 0.5}},
        "friction": 0.4,
        "preload": {"indentation": 0.5}
    });
    let made = good(cached.post("/contacts", &body).await).await;
    let place = format!("/contacts/{}", made["id"].as_str().unwrap());
    let moves = format!("{place}/move");
    let first =
        good(cached.post(&moves, &json!({"twist": 0.1, "stress": {"points": 5, "fields": ["hoop"]}})).await).await;
    assert!(number(&first["state"]["torque"]) > 0.0 && number(&first["stress"]["hoop"][2]) > 0.0, "{first}");
    assert_eq!((first["state"].get("displacement"), first["state"].get("force")), (None, None));
    let path = json!({"path": {"torque": [-0.01, 0.01]}});
    let second = good(cached.post(&format!("{place}/path"), &path).await).await;
    assert!((number(&second["steps"][0]["torque"]) + 0.01).abs() < 1e-15, "{second}");
    let shift = problem(cached.post(&moves, &json!({"displacement": 0.1})).await).await;
    assert_eq!(shift.code, "twist_with_shift");
    for (call, body) in [
        ("relax", json!({"reversals": 3})),
        ("observations", json!({"observations": [{"displacement": 0.1, "force": 0.1}]})),
    ] {
        let refused = problem(cached.post(&format!("{place}/{call}"), &body).await).await;
        assert!(["invalid_input", "twist_with_shift"].contains(&refused.code.as_str()), "{call}: {refused:?}");
    }
    let both = problem(cached.post(&moves, &json!({"twist": 0.1, "force": 0.1})).await).await;
    assert_eq!((both.code.as_str(), &*both.errors[0].pointer), ("twist_with_shift", "/force"));
    let much = problem(cached.post(&moves, &json!({"torque": 1.0})).await).await;
    assert_eq!(much.code, "force_exceeds_friction");
    let [shown, again] = [&cached, &replayed].map(|server| server.get(&place));
    assert_eq!(good(shown.await).await["state"], good(again.await).await["state"]);
    let stress = good(replayed.get(&format!("{place}/stress?points=5&fields=pressure,hoop")).await).await;
    assert!(number(&stress["hoop"][1]) != 0.0, "{stress}");

    // Its steady cycles are those of its definition.
    let cycle = good(replayed.get(&format!("{place}/cycle?twist=0.1,0.2&harmonics=2")).await).await;
    let same = json!({"contact": body, "drive": {"twist": [0.1, 0.2]}, "harmonics": 2});
    assert_eq!(cycle["cycles"], good(cached.post("/cycle", &same).await).await["cycles"]);
    for (query, pointer) in
        [("twist=0.1&torque=0.01", "/torque"), ("torque=0.01&points=5", "/points"), ("", "/displacement")]
    {
        let refused = problem(replayed.get(&format!("{place}/cycle?{query}")).await).await;
        assert_eq!(refused.errors[0].pointer, pointer, "{refused:?}");
    }

    good(cached.post(&moves, &json!({"indentation": -0.1})).await).await;
    good(cached.post(&moves, &json!({"indentation": 0.5})).await).await;
    good(cached.post(&moves, &json!({"displacement": 0.1})).await).await;
    let page = good(replayed.get(&format!("{place}/history")).await).await;
    let items = page["items"].as_array().unwrap();
    for (index, twisted) in [true, true, true, false, false, false].into_iter().enumerate() {
        assert_eq!(items[index]["state"].get("twist").is_some(), twisted, "{}", items[index]);
        assert_eq!(items[index]["state"].get("force").is_some(), !twisted, "{}", items[index]);
    }
    assert_eq!(items[1]["move"], json!({"torque": -0.01}));
    assert_eq!(items[1]["state"], second["steps"][0]);
    let table = replayed.get(&format!("{place}/history?format=csv")).await.text().await.unwrap();
    let names: Vec<&str> = table.lines().next().unwrap().split(',').collect();
    let cell = |row: usize, name: &str| {
        let column = names.iter().position(|known| *known == name).unwrap();
        table.lines().nth(row).unwrap().split(',').nth(column).unwrap().to_owned()
    };
    for (row, [force, torque]) in [(2, [false, true]), (6, [true, false])] {
        assert_eq!([!cell(row, "force").is_empty(), !cell(row, "torque").is_empty()], [force, torque], "{table}");
    }
    // Torque over angle, with points on the way, that of lifting off included.
    let drawn = good(replayed.get(&format!("{place}/loop?points_per_move=4")).await).await;
    let torques = drawn["torque"].as_array().unwrap();
    assert_eq!(torques.iter().filter(|torque| !torque.is_null()).count(), 15, "{drawn}");
    assert_eq!(drawn["force"].as_array().unwrap().iter().filter(|force| force.is_null()).count(), 15, "{drawn}");
    let svg = replayed.get(&format!("{place}/loop?last=4&format=svg")).await.text().await.unwrap();
    assert!(svg.contains("torque M") && svg.contains("angle of twist"), "{svg}");
}
