//! Stress below the surface over HTTP: published figures, every fault with its place, all formats, and a contact that
//! stays as it is.

use std::f64::consts::PI;

use crate::common;

use common::{Server, ball, good, number, of, problem};
use serde_json::{Value, json};
use stickslip_wire::{BodyName, SubsurfaceRequest};

/// A sphere with a = d = p_max = 1, G* = E* and mu = 0.5.
pub fn unit_sphere() -> Value {
    json!({
        "profile": {"type": "sphere", "radius": 1.0},
        "material": {"effective": {"e_star": 0.5 * PI, "g_star": 0.5 * PI}},
        "friction": 0.5,
        "preload": {"indentation": 1.0}
    })
}

const NAMES: [&str; 6] = ["xx", "yy", "zz", "xy", "yz", "xz"];

#[tokio::test]
async fn a_history_of_three_moves_has_its_published_stress() {
    let server = Server::start().await;
    let asked = json!({
        "path": {"displacement": [0.4, -0.25, 0.05]},
        "subsurface": {"body": "second", "poisson_ratio": 0.3, "points": [[0.5, 0.3, 0.4]]}
    });
    let reply = good(server.post("/simulate", &of(&unit_sphere(), &asked)).await).await;
    let expected = [
        -0.202_971_224_360_7,
        -0.188_421_678_403_5,
        -0.648_046_273_458_3,
        -0.012_501_917_591_47,
        -0.091_545_975_543_53,
        -0.166_739_561_424_7,
    ];
    for (name, expected) in NAMES.into_iter().zip(expected) {
        let found = number(&reply["subsurface"][name][0]);
        assert!((found - expected).abs() < 1e-12, "{name}: {found} instead of {expected}");
    }
    let error = number(&reply["accuracy"]["subsurface_error"]);
    assert!(error > 1e-13 && error < 1e-10, "{error:e}");
    assert!(reply["subsurface"].get("von_mises").is_none());
    // Nothing of it where it was not asked for.
    let plain =
        good(server.post("/simulate", &of(&unit_sphere(), &json!({"path": {"displacement": [0.4]}}))).await).await;
    assert!(plain.get("subsurface").is_none() && plain["accuracy"].get("subsurface_error").is_none());
}

#[tokio::test]
async fn a_contact_tells_its_stress_and_stays_as_it_is() {
    let server = Server::start().await;
    let id = good(server.post("/contacts", &unit_sphere()).await).await["id"].clone();
    let base = format!("/contacts/{}", id.as_str().unwrap());
    for target in [0.4, -0.25, 0.05] {
        good(server.post(&format!("{base}/move"), &json!({"displacement": target})).await).await;
    }
    let place = format!("{base}/subsurface");
    let body = json!({
        "body": "second", "poisson_ratio": 0.3,
            "plane": {"normal": "y", "offset": 0.0, "x": [-1.0, 1.0, 5], "z": [0.0, 1.0, 3]},
        "fields": ["tensor", "principal", "von_mises", "max_shear", "hydrostatic"], "bulk": {"xx": 1.0}
    });
    let response = server.post(&place, &body).await;
    assert_eq!(response.headers()["etag"], "\"3\"");
    let reply = good(response).await;
    let at = |name: &str, row: usize| number(&reply[name][row]);
    // The last axis changes fastest.
    assert_eq!(
        (0..4).map(|row| [at("x", row), at("z", row)]).collect::<Vec<_>>(),
        [[-1.0, 0.0], [-1.0, 0.5], [-1.0, 1.0], [-0.5, 0.0]]
    );
    for row in 0..15 {
        let [xx, yy, zz] = ["xx", "yy", "zz"].map(|name| at(name, row));
        let trace = xx + yy + zz;
        let principal = ["principal_1", "principal_2", "principal_3"].map(|name| at(name, row));
        assert!((principal.iter().sum::<f64>() - trace).abs() < 1e-12);
        assert!(principal[0] >= principal[1] && principal[1] >= principal[2]);
        assert!((at("hydrostatic", row) - trace / 3.0).abs() < 1e-12);
        assert!((at("max_shear", row) - 0.5 * (principal[0] - principal[2])).abs() < 1e-12);
        let [a, b, c] = principal;
        let mises = (0.5 * ((a - b).powi(2) + (b - c).powi(2) + (c - a).powi(2))).sqrt();
        assert!((at("von_mises", row) - mises).abs() < 1e-12);
    }
    // Pressure and shear stress at the surface, and the bulk stress far away.
    let stress = good(server.get(&format!("{base}/stress?radii=0.5")).await).await;
    let surface = 9;
    assert_eq!([at("x", surface), at("z", surface)].map(f64::to_bits), [0.5, 0.0].map(f64::to_bits));
    assert!((at("zz", surface) + number(&stress["pressure"][0])).abs() < 1e-14);
    assert!((at("xz", surface) + number(&stress["shear"][0])).abs() < 1e-14);
    let codes: Vec<_> = reply["warnings"].as_array().unwrap().iter().map(|warning| warning["code"].clone()).collect();
    assert!(codes.contains(&json!("bulk_shift_neglected")), "{codes:?}");
    assert_eq!(good(server.get(&base).await).await["sequence"], 3);

    let request = SubsurfaceRequest {
        body: BodyName::First,
        poisson_ratio: Some(0.3),
        points: Some(vec![[0.0, 0.0, 0.5]]),
        line: None,
        plane: None,
        surface: None,
        fields: None,
        bulk: None,
    };
    let first = server.client.subsurface(id.as_str().unwrap().parse().unwrap(), &request).await.unwrap();
    let second = SubsurfaceRequest { body: BodyName::Second, ..request };
    let second = server.client.subsurface(id.as_str().unwrap().parse().unwrap(), &second).await.unwrap();
    // On the axis the pressure has no shear, and the two bodies are dragged in opposite directions.
    let shear = |reply: &stickslip_wire::SubsurfaceReply| reply.stress.xz.as_ref().unwrap()[0].unwrap();
    assert_eq!(shear(&first).to_bits(), (-shear(&second)).to_bits());
    assert!(shear(&first).abs() > 1e-3);
}

#[tokio::test]
async fn all_formats_have_the_same_numbers_and_a_section_can_be_drawn() {
    let server = Server::start().await;
    let id = good(server.post("/contacts", &ball()).await).await["id"].clone();
    let place = format!("/contacts/{}/subsurface", id.as_str().unwrap());
    let plane = json!({"normal": "y", "offset": 0.0, "x": [-1e-4, 1e-4, 3], "z": [0.0, 1e-4, 2]});
    let body = json!({"body": "first", "plane": plane, "fields": ["von_mises"]});
    let columns = good(server.post(&place, &body).await).await;
    let rows = good(server.post(&format!("{place}?format=rows"), &body).await).await;
    let rows = rows.as_array().unwrap();
    assert_eq!(rows.len(), 6);
    for (index, row) in rows.iter().enumerate() {
        for name in ["x", "y", "z", "von_mises"] {
            assert_eq!(row[name], columns[name][index]);
        }
    }
    let csv = server.post(&format!("{place}?format=csv"), &body).await.text().await.unwrap();
    assert!(csv.starts_with("x,y,z,von_mises\n") && csv.lines().count() == 7);
    for (format, start) in [("svg", &b"<svg"[..]), ("png", &b"\x89PNG"[..]), ("arrow", &b"\xff\xff\xff\xff"[..])] {
        let written = server.post(&format!("{place}?format={format}"), &body).await;
        assert_eq!(written.status(), 200);
        assert!(written.bytes().await.unwrap().starts_with(start), "{format}");
    }
    let tensor = json!({"body": "first", "plane": plane});
    let refused = problem(server.post(&format!("{place}?format=svg"), &tensor).await).await;
    assert_eq!(refused.errors[0].pointer, "/fields");
}

#[tokio::test]
async fn what_is_infinite_is_null() {
    let server = Server::start().await;
    let contact = json!({
        "profile": {"type": "cone", "slope": 0.1}, "material": {"effective": {"e_star": 1e9, "g_star": 1e9}},
        "friction": 0.5, "preload": {"indentation": 1e-4}
    });
    let asked = json!({
        "path": {"displacement": [1e-5]}, "steps": "last",
        "subsurface": {"body": "second", "poisson_ratio": 0.3, "points": [[0.0, 0.0, 0.0], [0.0, 0.0, 1e-9]],
            "fields": ["tensor", "principal", "von_mises", "max_shear", "hydrostatic"]}
    });
    let reply = good(server.post("/simulate", &of(&contact, &asked)).await).await;
    for name in ["zz", "principal_1", "von_mises", "max_shear", "hydrostatic"] {
        let column = &reply["subsurface"][name];
        assert!(column[0].is_null() && column[1].is_number(), "{name}: {column}");
    }
}

#[tokio::test]
async fn every_fault_is_named_with_its_place() {
    let server = Server::start().await;
    let cases = [
        (json!({"body": "second"}), "/subsurface/body", "rigid"),
        (json!({"poisson_ratio": 0.2}), "/subsurface/poisson_ratio", "contradicts"),
        (json!({"points": [[0.0, 0.0, -1e-9]]}), "/subsurface/points/0/2", "above the surface"),
        (json!({"points": []}), "/subsurface/points", "1 to 1000000"),
        (json!({"points": null}), "/subsurface/points", ""),
        (json!({"fields": []}), "/subsurface/fields", "von_mises"),
        (json!({"fields": ["tresca"]}), "/subsurface/fields/0", "max_shear"),
        (json!({"line": {"from": [0.0, 0.0, 0.0], "to": [0.0, 0.0, 1e-4], "count": 5}}), "/subsurface", "one of"),
        (json!({"bulk": {"xx": 1e30}}), "/subsurface/bulk/xx", "allowed is"),
    ];
    for (change, pointer, detail) in cases {
        let mut subsurface = json!({"body": "first", "points": [[0.0, 0.0, 1e-5]]});
        subsurface.as_object_mut().unwrap().extend(change.as_object().unwrap().clone());
        let asked = json!({"path": {"displacement": [1e-8]}, "subsurface": subsurface});
        let refused = problem(server.post("/simulate", &of(&ball(), &asked)).await).await;
        assert_eq!(refused.errors[0].pointer, pointer, "{change}");
        assert!(refused.errors[0].detail.contains(detail), "{change}: {}", refused.errors[0].detail);
    }
    let planes = [
        (json!({"normal": "y", "offset": 0.0, "x": [0.0, 0.0, 5], "z": [0.0, 1e-4, 5]}), "/x/1"),
        (json!({"normal": "y", "offset": 0.0, "x": [0.0, 1e-4, 1], "z": [0.0, 1e-4, 5]}), "/x/2"),
        (json!({"normal": "y", "offset": 0.0, "x": [0.0, 1e-4, 2.5], "z": [0.0, 1e-4, 5]}), "/x/2"),
        (json!({"normal": "y", "offset": 0.0, "z": [0.0, 1e-4, 5]}), "/x"),
        (json!({"normal": "z", "offset": -1e-5, "x": [0.0, 1e-4, 5], "y": [0.0, 1e-4, 5]}), "/offset"),
        (json!({"normal": "y", "offset": 0.0, "x": [0.0, 1e-4, 5], "z": [-1e-4, 1e-4, 5]}), "/z/0"),
        (json!({"normal": "y", "offset": 0.0, "x": [0.0, 1e-4, 5], "y": [0.0, 1e-4, 5], "z": [0.0, 1e-4, 5]}), "/y"),
        (json!({"normal": "y", "offset": 0.0, "x": [0.0, 1e-4, 1001], "z": [0.0, 1e-4, 1000]}), ""),
    ];
    for (plane, place) in planes {
        let asked = json!({"path": {"displacement": [1e-8]}, "subsurface": {"body": "first", "plane": plane}});
        let refused = problem(server.post("/simulate", &of(&ball(), &asked)).await).await;
        assert_eq!(refused.errors[0].pointer, format!("/subsurface/plane{place}"), "{plane}");
    }
    let springs = json!({
        "path": {"displacement": [1e-8]}, "solver": {"springs": {"count": 100}},
        "subsurface": {"body": "first", "points": [[0.0, 0.0, 1e-5]]}
    });
    let refused = problem(server.post("/simulate", &of(&ball(), &springs)).await).await;
    assert_eq!(refused.errors[0].pointer, "/subsurface");
    let unknown =
        json!({"path": {"displacement": [0.1]}, "subsurface": {"body": "first", "points": [[0.0, 0.0, 0.1]]}});
    let refused = problem(server.post("/simulate", &of(&unit_sphere(), &unknown)).await).await;
    assert_eq!(refused.errors[0].pointer, "/subsurface/poisson_ratio");
}
