//! Steady cycles over HTTP: what cannot be asked for together, and a contact that they do not change. The rest is
//! tested in `crates/compute/tests/documents/cycle.rs`.

use reqwest::Method;
use serde_json::json;
use stickslip_wire::{Amplitudes, CycleDrive, Machine, WorkDensity};

use crate::common::{Server, ball, changed, good, of, problem, run, timeless, with};

#[tokio::test]
async fn a_contact_with_a_history_has_the_cycles_of_its_load_and_stays_as_it_is() {
    let server = Server::start().await;
    let id = server.contact().await;
    let contact = format!("/contacts/{id}");
    let path = json!({"path": {"moves": [{"displacement": 1e-7}, {"normal_force": 14.0}, {"displacement": -3e-8}]}});
    good(server.post(&format!("{contact}/path"), &path).await).await;
    let before = good(server.get(&contact).await).await;
    let query = "displacement=5e-8,1e-7&displacement=4e-7&machine_stiffness=2e7&harmonics=3&points=4";
    let response = server.get(&format!("{contact}/cycle?{query}")).await;
    let tag = response.headers()["etag"].to_str().unwrap().to_owned();
    let found = timeless(good(response).await);
    let loaded = with(ball(), "/preload", json!({"normal_force": 14.0}));
    let asked = json!({"drive": {"displacement": [5e-8, 1e-7, 4e-7]}, "machine": {"stiffness": 2e7}, "harmonics": 3,
        "work_density": {"points": 4}});
    assert_eq!(found, timeless(good(server.post("/cycle", &of(&loaded, &asked)).await).await));
    let drive = CycleDrive::Displacement(Amplitudes::Many(vec![5e-8, 1e-7, 4e-7]));
    let (machine, density) = (Some(Machine { stiffness: 2e7 }), WorkDensity { points: Some(4), ..Default::default() });
    let typed = server.client.contact_cycle(id.parse().unwrap(), &drive, machine, Some(3), &density).await.unwrap();
    assert_eq!(found, timeless(json!(typed)));
    assert_eq!(good(server.get(&contact).await).await, before);
    let again = server.send(Method::GET, &format!("{contact}/cycle?{query}"), None, &[("if-none-match", &tag)]).await;
    assert_eq!(again.status(), 304);
}

#[tokio::test]
async fn a_query_of_a_contact_is_refused_at_its_place() {
    let server = Server::start().await;
    let contact = format!("/contacts/{}", server.contact().await);
    for (query, code, pointer) in [
        ("", "invalid_input", "/displacement"),
        ("force=1&displacement=1e-8", "invalid_input", "/force"),
        ("force=1,3", "force_exceeds_friction", "/force/1"),
        ("displacement=1e-8,-1", "invalid_input", "/displacement/1"),
        ("displacement=1e-8&machine_stiffness=-1", "invalid_input", "/machine_stiffness"),
        ("displacement=1e-8&points=1", "invalid_input", "/points"),
        ("displacement=1e-8&phase=1", "invalid_input", "/phase"),
    ] {
        let refused = problem(server.get(&format!("{contact}/cycle?{query}")).await).await;
        assert_eq!((refused.code.as_str(), refused.errors[0].pointer.as_str()), (code, pointer), "{query} {refused:?}");
    }
}

#[tokio::test]
async fn a_map_is_asked_for_by_a_flag_too() {
    let server = Server::start().await;
    let drive = json!({"drive": {"displacement": [1e-8, 1e-7, 1e-6]}});
    let map = changed(drive.clone(), &json!({"map": {"normal_force": {"from": 1.0, "to": 100.0, "count": 3}}}));
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("cycle.json");
    std::fs::write(&file, of(&ball(), &drive).to_string()).unwrap();
    let by_flag = |map: &str| run(&["cycle", file.to_str().unwrap(), "--map", map]);
    let csv = server.post("/cycle?format=csv", &of(&ball(), &map)).await.text().await.unwrap();
    assert_eq!(String::from_utf8(by_flag("1:100:3").stdout).unwrap(), csv);
    for wrong in ["1:100", "0:1:3", "2:1:3", "1:2:1", "1:2:1001", "a:b:c"] {
        assert!(!by_flag(wrong).status.success(), "{wrong}");
    }
}
