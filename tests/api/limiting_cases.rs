//! Limiting cases: moves that either solver refuses, contacts without friction, and zeros without a sign.

use crate::common;

use common::{Server, ball};
use serde_json::{Value, json};

async fn post(server: &Server, path: &str, body: &Value) -> (u16, String) {
    let reply = server.post(path, body).await;
    (reply.status().as_u16(), reply.text().await.unwrap())
}

#[tokio::test]
async fn springs_refuse_a_move_where_the_exact_solver_does() {
    let server = Server::start().await;
    let mut small = ball();
    small["profile"] = json!({"type": "exact_sphere", "radius": 1e-4});
    small["preload"] = json!({"indentation": 1e-7});
    for (moves, place) in [
        (json!([{"displacement": 0.0}, {"indentation": 1.0}]), "/path/moves/1"),
        (json!([{"normal_force": -1e9, "relative": true}]), "/path/moves/0/normal_force"),
        (json!([{"indentation": 2e-7}, {"displacement": 0.0}, {"normal_force": 1e17}]), "/path/moves/2"),
        // The first fault counts, whichever it is.
        (json!([{"force": 1e9}, {"indentation": 1.0}]), "/path/moves/0"),
    ] {
        let mut pointers = Vec::new();
        for solver in [json!("exact"), json!({"springs": {"count": 50}})] {
            let body = json!({"contact": small, "path": {"moves": moves}, "solver": solver});
            let (status, text) = post(&server, "/simulate", &body).await;
            assert_eq!(status, 422, "{text}");
            let problem: Value = serde_json::from_str(&text).unwrap();
            pointers.push(problem["errors"][0]["pointer"].as_str().unwrap().to_owned());
        }
        assert!(pointers[0].starts_with(place), "{moves}: {pointers:?}");
        assert_eq!(pointers[0], pointers[1], "{moves}");
    }
}

#[tokio::test]
async fn without_friction_the_surface_stays_behind() {
    let server = Server::start().await;
    let mut smooth = ball();
    smooth["friction"] = json!(0.0);
    for solver in [json!("exact"), json!({"springs": {"count": 50}})] {
        let body = json!({
            "contact": smooth,
            "path": {"displacement": [1.0, -0.25]},
            "stress": {"points": 3, "fields": ["slip", "displacement"]},
            "solver": solver
        });
        let (status, text) = post(&server, "/simulate", &body).await;
        assert_eq!(status, 200, "{text}");
        let reply: Value = serde_json::from_str(&text).unwrap();
        assert_eq!(reply["stress"]["slip"], json!([-0.25, -0.25, -0.25]), "{solver}");
        assert_eq!(reply["stress"]["displacement"], json!([0.0, 0.0, 0.0]), "{solver}");
    }
}

#[tokio::test]
async fn a_zero_has_no_sign() {
    let server = Server::start().await;
    let mut smooth = ball();
    smooth["friction"] = json!(0.0);
    for contact in [ball(), smooth] {
        let (status, text) = post(&server, "/contacts", &contact).await;
        assert_eq!(status, 201, "{text}");
        assert!(!text.contains("-0.0"), "{text}");
        let still = json!({"contact": contact, "path": {"displacement": [0.0, -0.0]}});
        let (status, text) = post(&server, "/simulate", &still).await;
        assert_eq!(status, 200, "{text}");
        assert!(!text.contains("\"force\":-0.0"), "{text}");
    }
}
