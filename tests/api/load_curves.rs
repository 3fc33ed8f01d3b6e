//! Stored contacts that are known by their load curve alone. The rest is tested in
//! `crates/compute/tests/documents/load_curves.rs`, their loads and radii in
//! `crates/mechanics/tests/physics/load_curves.rs`.

use serde_json::{Value, json};

use crate::common::json::known_by_load_curves;
use crate::common::{Server, ball, codes, good, number, problem, with};

fn contact(profile: Value) -> Value {
    with(ball(), "/profile", profile)
}

#[tokio::test]
async fn they_are_stored_and_moved_and_have_no_stresses() {
    let server = Server::start().await;
    for (profile, code) in known_by_load_curves() {
        let made = good(server.post("/contacts", &contact(profile.clone())).await).await;
        assert!(codes(&made).contains(&code), "{made}");
        let place = format!("/contacts/{}", made["id"].as_str().unwrap());
        let moved = good(server.post(&format!("{place}/move"), &json!({"force": 1.5})).await).await;
        assert!((number(&moved["state"]["force"]) - 1.5).abs() < 1e-12, "{moved}");
        good(server.get(&format!("{place}/definition")).await).await;
        assert_eq!(server.get(&format!("{place}/stress?points=3")).await.status(), 422);
        for (call, body) in [
            ("move", json!({"force": 1.0, "stress": {"points": 3}})),
            ("path", json!({"path": {"equal_peaks": {"reversals": 3}}})),
            ("relax", json!({"reversals": 3})),
            ("subsurface", json!({"body": "first", "points": [[0.0, 0.0, 1e-5]]})),
        ] {
            let refused = problem(server.post(&format!("{place}/{call}"), &body).await).await;
            assert_eq!((refused.status, refused.code.as_str()), (422, "no_stress_field"), "{call}");
        }
        assert_eq!(good(server.get(&place).await).await["sequence"], json!(1), "a refused move changes nothing");
    }
}

#[tokio::test]
async fn a_hundred_thousand_asperities_are_taken() {
    let server = Server::start().await;
    let gaps: Vec<f64> = (1..=100_000).map(|index| 1e-6 * f64::from(index).ln()).collect();
    let rough = contact(json!({"type": "asperities", "radius": 1e-4, "gaps": gaps}));
    let made = good(server.post("/contacts", &rough).await).await;
    let place = format!("/contacts/{}/path", made["id"].as_str().unwrap());
    let path = json!({"path": {"force": [2.0, -2.0, 1.0, 2.999]}, "steps": "last"});
    let moved = good(server.post(&place, &path).await).await;
    assert!((number(&moved["steps"][0]["force"]) - 2.999).abs() < 1e-12, "{moved}");
}
