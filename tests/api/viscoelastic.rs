//! Stored contacts of bodies with memory: their path in time, its events, and their replay. Their values are tested in
//! `crates/mechanics/tests/physics`, and what is refused of a document in `crates/compute/tests/documents`.

use std::pin::pin;
use std::sync::Arc;

use futures::StreamExt as _;
use serde_json::{Value, json};
use stickslip::sessions::CAPACITY;
use stickslip::store::SqliteStore;
use stickslip_wire::client::Event;
use uuid::Uuid;

use crate::common::{PATIENCE, Server, changed, good, of, problem, run};

fn rubber() -> Value {
    json!({
        "profile": {"type": "sphere", "radius": 0.01},
        "material": {"bodies": [{"youngs_modulus": 3e6, "poisson_ratio": 0.5}, "rigid"]},
        "friction": 0.8, "prony": [{"ratio": 0.4, "time": 0.01}, {"ratio": 0.3, "time": 1.0}],
        "preload": {"indentation": 1e-4}
    })
}

#[tokio::test]
async fn each_event_of_a_contact_with_memory_has_its_time_and_its_work() {
    let store = Arc::new(SqliteStore::in_memory().unwrap());
    let (cached, replayed) = (Server::with(store.clone(), CAPACITY).await, Server::with(store, 0).await);
    let made = good(cached.post("/contacts", &rubber()).await).await;
    let id: Uuid = serde_json::from_value(made["id"].clone()).unwrap();
    let place = format!("/contacts/{id}");
    let mut events = pin!(replayed.client.events(id, Some(0)).await.unwrap());
    let path = json!({"path": {"displacement": [5e-5, -5e-5, 0.0], "duration": 0.01}, "steps": "all"});
    let along = good(cached.post(&format!("{place}/path"), &path).await).await;
    good(cached.post(&format!("{place}/move"), &json!({"duration": 5.0})).await).await;
    let pressed = json!({"normal_force": 1e-3, "duration": 0.5});
    let last = good(cached.post(&format!("{place}/move"), &pressed).await).await;
    let (mut work, mut seen) = (0.0, Vec::new());
    for (sequence, time) in [(1, 0.01), (2, 0.02), (3, 0.03), (4, 5.03), (5, 5.53)] {
        let event = tokio::time::timeout(PATIENCE, events.next()).await.expect("no event came");
        let Event::State(event) = event.unwrap().unwrap() else { panic!("the events ended") };
        let state = event.state;
        assert_eq!(event.sequence, sequence);
        assert!((state.time.unwrap() - time).abs() < 1e-12 && state.viscous_work.unwrap() >= work, "{state:?}");
        assert!(event.step.unwrap().duration.is_some(), "{event:?}");
        work = state.viscous_work.unwrap();
        seen.push(state);
    }
    let shown = |state: &stickslip_wire::State| serde_json::to_value(state).unwrap();
    assert_eq!(along["steps"], json!(seen[..3].iter().map(shown).collect::<Vec<_>>()));
    assert_eq!(last["state"], shown(&seen[4]));
    assert!(work > 0.0 && last["state"]["normal_force"] == 1e-3, "{last}");
    // The same contact where nothing is cached, and its history.
    let [one, other] = [&cached, &replayed].map(|server| server.get(&place));
    assert_eq!(good(one.await).await["state"], good(other.await).await["state"]);
    let page = good(replayed.get(&format!("{place}/history")).await).await;
    let states: Vec<&Value> = page["items"].as_array().unwrap().iter().map(|item| &item["state"]).collect();
    assert_eq!(states, seen.iter().map(shown).collect::<Vec<_>>().iter().collect::<Vec<_>>());
}

#[tokio::test]
async fn what_a_contact_with_memory_lacks_is_refused_by_name_and_moves_nothing() {
    let server = Server::start().await;
    let made = good(server.post("/contacts", &rubber()).await).await;
    let place = format!("/contacts/{}", made["id"].as_str().unwrap());
    good(server.post(&format!("{place}/move"), &json!({"displacement": 1e-5, "duration": 0.1})).await).await;
    let before = good(server.get(&place).await).await;
    for (route, body) in [
        ("relax", json!({"reversals": 4})),
        ("path", json!({"path": {"equal_peaks": {"reversals": 4}}})),
        ("path", json!({"path": {"equal_peaks": {"reversals": 4}, "duration": 0.1}})),
        ("observations", json!({"observations": [{"displacement": 1e-5, "force": 0.0}]})),
        ("move", json!({"displacement": 0.0, "stress": {"points": 3}})),
    ] {
        let refused = problem(server.post(&format!("{place}/{route}"), &body).await).await;
        let text = format!("{route}: {refused:?}");
        assert_eq!(refused.code, "invalid_input", "{text}");
        assert!(refused.errors.iter().any(|fault| fault.detail.contains("memory")), "{text}");
    }
    for query in ["stress?points=3", "cycle?displacement=1e-5", "sliders?count=4"] {
        let reply = server.get(&format!("{place}/{query}")).await;
        if reply.status() != 404 {
            let refused = problem(reply).await;
            assert!(refused.status < 500 && format!("{refused:?}").contains("memory"), "{query}: {refused:?}");
        }
    }
    // Elastic bodies take no time.
    let elastic = json!({"path": {"displacement": [1e-7], "duration": 1.0}});
    let mut body = rubber();
    body.as_object_mut().unwrap().remove("prony");
    let ball = good(server.post("/contacts", &body).await).await;
    let moves = format!("/contacts/{}/path", ball["id"].as_str().unwrap());
    let refused = problem(server.post(&moves, &elastic).await).await;
    assert_eq!((refused.code.as_str(), &*refused.errors[0].pointer), ("invalid_input", "/path/duration"));
    assert_eq!(good(server.get(&place).await).await, before);
}

#[tokio::test]
async fn frequencies_are_asked_for_by_a_flag_too() {
    let server = Server::start().await;
    let drive = json!({"drive": {"displacement": [1e-5, 1e-4]}});
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("cycle.json");
    std::fs::write(&file, of(&rubber(), &drive).to_string()).unwrap();
    let by_flag = |hertz: &str| run(&["cycle", file.to_str().unwrap(), "--frequency", hertz]);
    let body = changed(of(&rubber(), &drive), &json!({"frequency": [0.5, 5.0]}));
    let csv = server.post("/cycle?format=csv", &body).await.text().await.unwrap();
    assert!(csv.starts_with("frequency,normal_force,"), "{csv}");
    assert_eq!(String::from_utf8(by_flag("0.5,5").stdout).unwrap(), csv);
    for wrong in ["0", "-1", "a", "0.5,0"] {
        assert!(!by_flag(wrong).status.success(), "{wrong}");
    }
    assert!(!run(&["cycle", file.to_str().unwrap(), "--frequency", "1", "--map", "1:2:3"]).status.success());
}
