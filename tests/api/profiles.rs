//! Every profile over HTTP: the promises of the API that depend on the shape.

use serde_json::{Value, json};
use stickslip_mechanics::profile::{self, Family};

use crate::common::{Server, changed, good, problem, with};

fn request(profile: &Value, preload: &Value) -> Value {
    json!({
        "contact": {
            "profile": profile,
            "material": {"effective": {"e_star": 1.15e11, "g_star": 8.5e10}},
            "friction": 0.3,
            "preload": preload
        },
        "path": {"falling_amplitude": {"reversals": 6}},
        "steps": "last"
    })
}

fn families() -> Vec<Value> {
    let radii: Vec<f64> = (0..=100).map(|index| 1e-5 * f64::from(index)).collect();
    let heights: Vec<f64> = radii.iter().map(|r| r * r / 0.02).collect();
    let of_family = |family: &&Family| {
        family.parameters.iter().fold(json!({"type": family.name}), |mut document, parameter| {
            document[parameter.name] = json!(parameter.example);
            document
        })
    };
    let mut all: Vec<Value> = profile::families().iter().map(of_family).collect();
    all.push(json!({"type": "tabulated", "r": radii, "z": heights}));
    all.push(json!({"type": "sum", "parts": [{"type": "sphere", "radius": 0.02}, {"type": "cone", "slope": 0.01}]}));
    all
}

#[tokio::test]
async fn limiting_cases_are_the_same_for_both_solvers() {
    let server = Server::start().await;
    let small = json!({"type": "exact_sphere", "radius": 1e-4});
    let small = request(&small, &json!({"indentation": 1e-7}));
    for (moves, place) in [
        (json!([{"displacement": 0.0}, {"indentation": 1.0}]), "/path/moves/1"),
        (json!([{"normal_force": -1e9, "relative": true}]), "/path/moves/0/normal_force"),
        (json!([{"indentation": 2e-7}, {"displacement": 0.0}, {"normal_force": 1e17}]), "/path/moves/2"),
        // The first fault counts, whichever it is.
        (json!([{"force": 1e9}, {"indentation": 1.0}]), "/path/moves/0"),
    ] {
        let mut pointers = Vec::new();
        for solver in [json!("exact"), json!({"springs": {"count": 50}})] {
            let body = changed(small.clone(), &json!({"path": {"moves": moves}, "solver": solver}));
            let refused = problem(server.post("/simulate", &body).await).await;
            pointers.push((refused.status, refused.errors[0].pointer.clone()));
        }
        assert!(pointers[0].1.starts_with(place) && pointers[0] == pointers[1], "{moves}: {pointers:?}");
    }
    // Without friction the surface stays behind, and a zero has no sign.
    let sphere = request(&families()[0], &json!({"normal_force": 10.0}));
    for friction in [0.0, 0.3] {
        let smooth = with(sphere.clone(), "/contact/friction", json!(friction));
        for solver in [json!("exact"), json!({"springs": {"count": 50}})] {
            let fields = json!({"points": 3, "fields": ["slip", "displacement"]});
            let asked = json!({"path": {"displacement": [1.0, -0.25]}, "stress": fields, "solver": solver});
            let reply = good(server.post("/simulate", &changed(smooth.clone(), &asked)).await).await;
            let stays = reply["stress"]["slip"] == json!([-0.25, -0.25, -0.25])
                && reply["stress"]["displacement"] == json!([0.0, 0.0, 0.0]);
            assert_eq!(stays, friction == 0.0, "{solver}: {reply}");
        }
        let still = changed(smooth.clone(), &json!({"path": {"displacement": [0.0, -0.0]}, "steps": "all"}));
        let text = server.post("/simulate", &still).await.text().await.unwrap();
        assert!(!text.contains("\"force\":-0.0"), "{text}");
        let text = server.post("/contacts", &smooth["contact"]).await.text().await.unwrap();
        assert!(text.contains("\"id\"") && !text.contains("-0.0"), "{text}");
    }
}
