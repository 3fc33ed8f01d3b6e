//! Stress below the surface over HTTP: a published figure, and a contact that stays as it is. What the stresses are is
//! tested in `crates/mechanics/tests/physics/subsurface.rs`.

use serde_json::{Value, json};
use std::f64::consts::PI;
use stickslip_compute::Flag;
use stickslip_compute::computations::{DisplayOptions, compute};
use stickslip_compute::formats::Format;
use stickslip_wire::{BodyName, SubsurfaceRequest};

use crate::common::tables::same_numbers;
use crate::common::{Server, assert_refused, changed, codes, good, number, of, run, timeless};

/// A sphere with a = d = p_max = 1, G* = E* and mu = 0.5.
pub fn unit_sphere() -> Value {
    json!({
        "profile": {"type": "sphere", "radius": 1.0},
        "material": {"effective": {"e_star": 0.5 * PI, "g_star": 0.5 * PI}},
        "friction": 0.5,
        "preload": {"indentation": 1.0}
    })
}

#[tokio::test]
async fn a_history_of_three_moves_has_its_published_stress() {
    let server = Server::start().await;
    let path = json!({"displacement": [0.4, -0.25, 0.05]});
    let point = json!({"body": "second", "poisson_ratio": 0.3, "points": [[0.5, 0.3, 0.4]]});
    let asked = of(&unit_sphere(), &json!({"path": path, "subsurface": point}));
    let reply = good(server.post("/simulate", &asked).await).await;
    let expected = [-0.202_971_224_360_7, -0.188_421_678_403_5, -0.648_046_273_458_3];
    let sheared = [-0.012_501_917_591_47, -0.091_545_975_543_53, -0.166_739_561_424_7];
    for (name, expected) in ["xx", "yy", "zz", "xy", "yz", "xz"].into_iter().zip(expected.into_iter().chain(sheared)) {
        let found = number(&reply["subsurface"][name][0]);
        assert!((found - expected).abs() < 1e-12, "{name}: {found} instead of {expected}");
    }
    let error = number(&reply["accuracy"]["subsurface_error"]);
    assert!(error > 1e-13 && error < 1e-10 && reply["subsurface"].get("von_mises").is_none(), "{error:e}");
    // Nothing of it where it was not asked for.
    let plain = good(server.post("/simulate", &of(&unit_sphere(), &json!({"path": path}))).await).await;
    assert!(plain.get("subsurface").is_none() && plain["accuracy"].get("subsurface_error").is_none());
    // The command line has a computation of its own for it.
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("body.json");
    std::fs::write(&file, asked.to_string()).unwrap();
    let printed = run(&["subsurface", file.to_str().unwrap(), "--format", "columns"]).stdout;
    let shown = DisplayOptions::in_format(Format::Columns);
    let library = compute("subsurface", asked.to_string().as_bytes(), shown, &Flag::default()).unwrap();
    let [printed, library] = [printed, library].map(|text| timeless(serde_json::from_slice(&text).unwrap()));
    assert_eq!((&printed, &printed["xz"]), (&library, &reply["subsurface"]["xz"]));
    // What is infinite is null.
    let cone = changed(unit_sphere(), &json!({"profile": {"type": "cone", "slope": 0.1}}));
    let fields = ["tensor", "principal", "von_mises", "max_shear", "hydrostatic"];
    let asked = json!({"path": {"displacement": [0.1]}, "subsurface": {"body": "second", "poisson_ratio": 0.3,
        "points": [[0.0, 0.0, 0.0], [0.0, 0.0, 1e-5]], "fields": fields}});
    let reply = good(server.post("/simulate", &of(&cone, &asked)).await).await;
    for name in ["zz", "principal_1", "von_mises", "max_shear", "hydrostatic"] {
        let column = &reply["subsurface"][name];
        assert!(column[0].is_null() && column[1].is_number(), "{name}: {column}");
    }
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
    // Pressure and shear stress at the surface, and the bulk stress far away.
    let stress = good(server.get(&format!("{base}/stress?radii=0.5")).await).await;
    assert_eq!([at("x", 9), at("z", 9)].map(f64::to_bits), [0.5, 0.0].map(f64::to_bits));
    assert!((at("zz", 9) + number(&stress["pressure"][0])).abs() < 1e-14);
    assert!((at("xz", 9) + number(&stress["shear"][0])).abs() < 1e-14);
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
}
