//! Stress below the surface of a contact, which stays as it is. What the stresses are is tested in
//! `crates/mechanics/tests/physics/subsurface.rs`.

use serde_json::{Value, json};
use std::f64::consts::PI;
use stickslip_wire::{BodyName, SubsurfaceRequest};

use crate::common::tables::same_numbers;
use crate::common::{Server, assert_refused, changed, codes, good, number, of, run};

/// A sphere with a = d = p_max = 1, G* = E* and mu = 0.5.
fn unit_sphere() -> Value {
    json!({
        "profile": {"type": "sphere", "radius": 1.0},
        "material": {"effective": {"e_star": 0.5 * PI, "g_star": 0.5 * PI}},
        "friction": 0.5,
        "preload": {"indentation": 1.0}
    })
}

#[tokio::test]
async fn a_contact_tells_its_stress_and_stays_as_it_is() {
    let server = Server::start().await;
    let id = good(server.post("/contacts", &unit_sphere()).await).await["id"].clone();
    let base = format!("/contacts/{}", id.as_str().unwrap());
    let path = json!({"path": {"displacement": [0.4, -0.25, 0.05]}});
    good(server.post(&format!("{base}/path"), &path).await).await;
    let place = format!("{base}/subsurface");
    let plane = json!({"normal": "y", "offset": 0.0, "x": [-1.0, 1.0, 5], "z": [0.0, 1.0, 3]});
    let body = json!({
        "body": "second", "poisson_ratio": 0.3, "plane": plane,
        "fields": ["tensor", "principal", "von_mises", "max_shear", "hydrostatic"], "bulk": {"xx": 1.0}
    });
    let response = server.post(&place, &body).await;
    assert_eq!(response.headers()["etag"], "\"3\"");
    let reply = good(response).await;
    let at = |name: &str, row: usize| number(&reply[name][row]);
    // The last axis changes fastest.
    let places: Vec<_> = (0..4).map(|row| [at("x", row), at("z", row)]).collect();
    assert_eq!(places, [[-1.0, 0.0], [-1.0, 0.5], [-1.0, 1.0], [-0.5, 0.0]]);
    for row in 0..15 {
        let trace = ["xx", "yy", "zz"].map(|name| at(name, row)).iter().sum::<f64>();
        let [a, b, c] = ["principal_1", "principal_2", "principal_3"].map(|name| at(name, row));
        assert!((a + b + c - trace).abs() < 1e-12 && a >= b && b >= c);
        assert!((at("hydrostatic", row) - trace / 3.0).abs() < 1e-12);
        assert!((at("max_shear", row) - 0.5 * (a - c)).abs() < 1e-12);
        let mises = (0.5 * ((a - b).powi(2) + (b - c).powi(2) + (c - a).powi(2))).sqrt();
        assert!((at("von_mises", row) - mises).abs() < 1e-12);
    }
    assert!(codes(&reply).contains(&"bulk_shift_neglected"), "{reply}");
    // On the axis the pressure has no shear, and the two bodies are dragged in opposite directions.
    let asked = json!({"body": "first", "poisson_ratio": 0.3, "points": [[0.0, 0.0, 0.5]]});
    let first: SubsurfaceRequest = serde_json::from_value(asked).unwrap();
    let second = SubsurfaceRequest { body: BodyName::Second, ..first.clone() };
    let id = id.as_str().unwrap().parse().unwrap();
    let mut shears = Vec::new();
    for request in [first, second] {
        shears.push(server.client.subsurface(id, &request).await.unwrap().stress.xz.unwrap()[0].unwrap());
    }
    assert!(shears[0].to_bits() == (-shears[1]).to_bits() && shears[0].abs() > 1e-3);
    let mut written = Vec::new();
    for format in ["rows", "csv", "ndjson", "arrow"] {
        written.push(server.post(&format!("{place}?format={format}"), &body).await.bytes().await.unwrap());
    }
    assert_eq!(same_numbers(&written[0], &written[1], &written[2], &written[3]).1.len(), 15);
    let tensor = json!({"body": "second", "poisson_ratio": 0.3, "plane": plane});
    assert_refused(&server, &format!("{place}?format=svg"), &tensor, ("invalid_input", "/fields", "")).await;
    assert_eq!(good(server.get(&base).await).await["sequence"], 3);
    // The command line has a computation of its own for it.
    let file = tempfile::NamedTempFile::new().unwrap();
    let asked = changed(path, &json!({"subsurface": body}));
    std::fs::write(&file, of(&unit_sphere(), &asked).to_string()).unwrap();
    let printed = run(&["subsurface", file.path().to_str().unwrap(), "--format", "columns"]).stdout;
    assert_eq!(serde_json::from_slice::<Value>(&printed).unwrap()["xz"], reply["xz"]);
}
