//! Fatigue criteria over HTTP: published figures, what follows from them, every fault with its place, and all formats.

use crate::common;

use crate::subsurface::unit_sphere;
use common::{Server, ball, good, number, of, problem};
use serde_json::json;

#[tokio::test]
async fn a_cycle_in_partial_slip_has_its_published_values() {
    let server = Server::start().await;
    let asked = json!({
        // W = 0.6 d up and down.
        "path": {"cycles": {"displacement": 0.3, "count": 2}},
        "body": "second", "poisson_ratio": 0.3, "points": [[-0.98, 0.0, 0.02], [0.0, 0.0, 0.5]],
        "criteria": {"crossland": {"alpha": 0.0, "limit": 0.6}, "dang_van": {"alpha": 0.3}}, "tolerance": 1e-8,
        "stress_paths": [0]
    });
    let reply = good(server.post("/fretting", &of(&unit_sphere(), &asked)).await).await;
    let crossland = number(&reply["crossland"]["values"][0]);
    assert!((crossland - 0.303_364_330_750).abs() < 1e-8, "{crossland}");
    let dang_van = number(&reply["dang_van"]["values"][0]);
    assert!((dang_van - 0.313_215_178_853).abs() < 1e-8, "{dang_van}");
    let largest = &reply["crossland"]["largest"];
    assert_eq!((&largest["point"], number(&largest["value"])), (&json!([-0.98, 0.0, 0.02]), crossland));
    assert!((number(&reply["crossland"]["margin"]) - 0.6 / crossland).abs() < 1e-12);
    assert!(reply["dang_van"].get("margin").is_none() && reply.get("findley").is_none());
    assert!(number(&reply["change"]) <= 1e-8);
    assert!(number(&largest["error"]) <= 1e-8 * crossland);
    // The stresses over the cycle are those of the same path by themselves, at the instants that the place took.
    let path = &reply["stress_paths"][0];
    let instants = reply["instants"].as_u64().unwrap() as usize;
    let end = path["part"].as_array().unwrap().iter().rposition(|part| part == &json!(1.0)).unwrap();
    let of_move = |step: usize| path["move"].as_array().unwrap().iter().filter(|at| **at == json!(step)).count();
    assert_eq!((0..4).map(of_move).max(), Some(instants));
    let asked = json!({
        "path": {"displacement": [0.3, -0.3, 0.3]}, "steps": "last",
        "subsurface": {"body": "second", "poisson_ratio": 0.3, "points": [[-0.98, 0.0, 0.02]]}
    });
    let alone = good(server.post("/simulate", &of(&unit_sphere(), &asked)).await).await;
    for name in ["xx", "yy", "zz", "xy", "yz", "xz"] {
        let (one, other) = (number(&path[name][end]), number(&alone["subsurface"][name][0]));
        assert!((one - other).abs() < 1e-12, "{name}: {one} {other}");
    }
}

#[tokio::test]
async fn the_friction_work_of_the_surface_is_that_of_the_steady_cycle() {
    let server = Server::start().await;
    let radii = [0.0, 3e-5, 5.5e-5, 6e-5, 6.5e-5];
    let points: Vec<_> = radii.iter().map(|r| json!([0.8 * r, 0.6 * r, 0.0])).collect();
    let asked = json!({
        "path": {"displacement": [1e-7, -1e-7]}, "body": "first", "points": points,
        "criteria": {"friction_work": {}, "ruiz": {}, "swt": {}}
    });
    let reply = good(server.post("/fretting", &of(&ball(), &asked)).await).await;
    let asked = json!({"drive": {"displacement": 1e-7}, "work_density": {"radii": radii}});
    let cycle = good(server.post("/cycle", &of(&ball(), &asked)).await).await;
    let density = &cycle["cycles"][0]["friction_work"]["density"];
    let largest = number(&density[3]);
    for index in 0..radii.len() {
        let (one, other) = (number(&reply["friction_work"]["values"][index]), number(&density[index]));
        assert!((one - other).abs() < 1e-9 * largest, "{index}: {one:e} {other:e}");
    }
    // Where nothing slips Ruiz's parameters are zero.
    assert_eq!((&reply["ruiz"]["values"][0], &reply["ruiz_tension"]["values"][0]), (&json!(0.0), &json!(0.0)));
    assert!(number(&reply["ruiz"]["values"][3]) > 0.0 && number(&reply["swt"]["largest"]["value"]) > 0.0);
    let plane: Vec<f64> = reply["swt"]["largest"]["plane"].as_array().unwrap().iter().map(number).collect();
    assert!((plane.iter().map(|part| part * part).sum::<f64>() - 1.0).abs() < 1e-12);
}

#[tokio::test]
async fn the_friction_work_of_a_cycle_that_lifts_off_adds_up_to_what_a_lap_dissipates() {
    let server = Server::start().await;
    let lap = [
        json!({"displacement": 1e-7}),
        json!({"indentation": -1e-8}),
        json!({"displacement": 0.0}),
        json!({"indentation": 4e-7}),
    ];
    // Rings of equal area; the contact is never larger than at the preload.
    let (rings, reach) = (400_u32, 7e-5_f64);
    let area = std::f64::consts::PI * reach * reach / f64::from(rings);
    let radius = |ring: u32| reach * ((f64::from(ring) + 0.5) / f64::from(rings)).sqrt();
    let points: Vec<_> = (0..rings).map(|ring| json!([0.6 * radius(ring), 0.8 * radius(ring), 0.0])).collect();
    let asked = json!({
        "path": {"moves": lap}, "body": "first", "points": points, "criteria": {"friction_work": {}}, "tolerance": 1e-4
    });
    let reply = good(server.post("/fretting", &of(&ball(), &asked)).await).await;
    let values = reply["friction_work"]["values"].as_array().unwrap();
    let work: f64 = values.iter().map(|value| area * number(value)).sum();
    let twice = [lap.clone(), lap].concat();
    let laps = json!({"path": {"moves": twice}});
    let path = good(server.post("/simulate", &of(&ball(), &laps)).await).await;
    let done = |step: usize| number(&path["steps"][step]["dissipated_energy"]);
    assert_eq!(path["steps"][5]["regime"], "separated");
    let expected = done(7) - done(3);
    assert!((work / expected - 1.0).abs() < 5e-3, "{work:e} {expected:e}");
}

#[tokio::test]
async fn a_bulk_stress_far_away_is_all_that_there_is() {
    let server = Server::start().await;
    let asked = json!({
        "path": {"displacement": [1e-9, -1e-9]}, "body": "first", "points": [[0.0, 0.0, 1.0]],
        "bulk": {"mean": 5e7, "amplitude": 1e8, "phase": 0.0},
        "criteria": {"crossland": {"alpha": 0.3}, "findley": {"k": 0.0}, "fatemi_socie": {"k": 0.0, "yield": 3e8}},
        "tolerance": 1e-6
    });
    let reply = good(server.post("/fretting", &of(&ball(), &asked)).await).await;
    // Tension that swings by s along one axis: sqrt(J2a) = s/sqrt(3), and the shear amplitude is s/2.
    let crossland = number(&reply["crossland"]["values"][0]);
    assert!((crossland / (1e8 / 3.0_f64.sqrt() + 0.3 * 1.5e8 / 3.0) - 1.0).abs() < 1e-6, "{crossland}");
    assert!((number(&reply["findley"]["values"][0]) / 5e7 - 1.0).abs() < 1e-6);
    assert!((number(&reply["fatemi_socie"]["values"][0]) / (5e7 * 2.6 / 2.1e11) - 1.0).abs() < 1e-6);
    let codes: Vec<_> = reply["warnings"].as_array().unwrap().iter().map(|warning| warning["code"].clone()).collect();
    assert!(codes.contains(&json!("bulk_shift_neglected")), "{codes:?}");
}

/// The codes of the warnings of a reply.
fn codes(reply: &serde_json::Value) -> Vec<&str> {
    let pages = include_str!("../../docs/warnings.md");
    let codes: Vec<&str> =
        reply["warnings"].as_array().unwrap().iter().map(|warning| warning["code"].as_str().unwrap()).collect();
    for code in &codes {
        assert!(pages.contains(&format!("\n## {code}\n")), "docs/warnings.md has nothing on {code}");
    }
    codes
}

#[tokio::test]
async fn the_worst_places_of_a_body_are_found_without_a_grid() {
    let server = Server::start().await;
    let mut asked = json!({
        "path": {"displacement": [1e-7, -1e-7]}, "body": "first",
        "criteria": {"crossland": {"alpha": 0.3, "limit": 3e8}, "dang_van": {"alpha": 0.3}, "friction_work": {}}
    });
    let reply = good(server.post("/fretting", &of(&ball(), &asked)).await).await;
    assert_eq!(reply["x"].as_array().unwrap().len(), 3);
    assert!(number(&reply["change"]) <= 2e-3, "{reply}");
    let worst = &reply["crossland"]["largest"];
    // A ball at constant load is worst at the edge of the contact, in the plane of the motion.
    let radius = number(&reply["contact"]["contact_radius"]);
    let place: Vec<f64> = worst["point"].as_array().unwrap().iter().map(number).collect();
    assert!((place[0].abs() / radius - 1.0).abs() < 1e-3 && place[1] == 0.0 && place[2] == 0.0, "{worst}");
    assert!((number(&reply["crossland"]["margin"]) - 3e8 / number(&worst["value"])).abs() < 1e-12);
    assert_eq!(reply["crossland"]["values"][0], worst["value"]);
    assert!(!codes(&reply).iter().any(|code| code.starts_with("grid")), "{reply}");
    // A grid finds nothing larger, and says that a larger value lies off it.
    asked["plane"] = json!({"normal": "y", "offset": 0.0, "x": [-1.2e-4, 1.3e-4, 40], "z": [2e-6, 6e-5, 7]});
    asked["criteria"].as_object_mut().unwrap().remove("friction_work");
    let grid = good(server.post("/fretting", &of(&ball(), &asked)).await).await;
    assert!(number(&grid["crossland"]["largest"]["value"]) < number(&worst["value"]));
    assert!(codes(&grid).contains(&"grid_misses_largest"), "{}", grid["warnings"]);
    // The shallowest row is the rim.
    assert!(codes(&grid).contains(&"grid_rim"), "{}", grid["warnings"]);
}

#[tokio::test]
async fn a_grid_that_says_little_says_so() {
    let server = Server::start().await;
    let path = json!({"displacement": [1e-7, -1e-7]});
    let away = json!({
        "path": path, "body": "first", "criteria": {"swt": {"limit": 1.0}},
        "surface": {"x": [-0.1, 0.1, 4], "y": [0.05, 0.1, 2]}
    });
    let reply = good(server.post("/fretting", &of(&ball(), &away)).await).await;
    assert!(codes(&reply).contains(&"grid_outside_contact"), "{}", reply["warnings"]);
    // Nothing opens deep below the middle, where all is compressed.
    let pressed = json!({
        "path": path, "body": "first", "criteria": {"swt": {"limit": 1.0}}, "points": [[0.0, 0.0, 3e-6]],
        "bulk": {"mean": -1e9}
    });
    let reply = good(server.post("/fretting", &of(&ball(), &pressed)).await).await;
    assert!(codes(&reply).contains(&"no_positive_value") && reply["swt"].get("margin").is_none(), "{reply}");
    // The tip of a cone has no largest value.
    let mut cone = ball();
    cone["profile"] = json!({"type": "cone", "slope": 0.01});
    let tip = json!({"path": path, "body": "first", "criteria": {"crossland": {"alpha": 0.3, "limit": 3e8}}});
    let reply = good(server.post("/fretting", &of(&cone, &tip)).await).await;
    assert_eq!(reply["crossland"]["values"][0], json!(null));
    assert!(reply["crossland"].get("largest").is_none() && reply["crossland"].get("margin").is_none(), "{reply}");
    assert!(codes(&reply).contains(&"unbounded_stress"), "{}", reply["warnings"]);
    let asked = json!({"path": path, "body": "first", "criteria": {"swt": {}}, "stress_paths": [0]});
    let refused = problem(server.post("/fretting", &of(&ball(), &asked)).await).await;
    assert_eq!(refused.errors[0].pointer, "/stress_paths/0");
}

#[tokio::test]
async fn a_cusp_between_equal_instants_is_not_missed() {
    let server = Server::start().await;
    let asked = json!({
        "contact": {
            "profile": {"type": "sphere", "radius": 0.01}, "friction": 0.6, "preload": {"contact_radius": 1e-4},
            "material": {"bodies": [{"youngs_modulus": 2.1e11, "poisson_ratio": 0.3}, "rigid"]}
        },
        "path": {"moves": [
            {"displacement": -9.107142857142858e-07, "indentation": 1e-6},
            {"displacement": -1.3478571428571431e-06, "indentation": 2.6e-7}
        ]},
        "body": "first", "points": [[5.69e-5, 0.0, 0.0]], "criteria": {"crossland": {"alpha": 0.3}}
    });
    let reply = good(server.post("/fretting", &asked).await).await;
    let largest = &reply["crossland"]["largest"];
    // By bisection of 26 000 instants down to chords within 100 Pa: the mechanics tests do it anew.
    assert!((number(&largest["value"]) / 3.244_852e8 - 1.0).abs() < 1e-5, "{largest}");
    assert!(number(&largest["error"]) <= 1e-4 * 3.244_852e8 && number(&reply["change"]) <= 1e-4, "{reply}");
}

#[tokio::test]
async fn all_formats_have_the_same_numbers() {
    let server = Server::start().await;
    let body = of(
        &ball(),
        &json!({
            "path": {"displacement": [1e-7, -1e-7]}, "body": "first",
            "plane": {"normal": "y", "offset": 0.0, "x": [-1e-4, 1e-4, 5], "z": [1e-6, 5e-5, 3]},
            "criteria": {"crossland": {"alpha": 0.3}}
        }),
    );
    let columns = good(server.post("/fretting", &body).await).await;
    let rows = good(server.post("/fretting?format=rows", &body).await).await;
    for (index, row) in rows.as_array().unwrap().iter().enumerate() {
        assert_eq!((&row["x"], &row["crossland"]), (&columns["x"][index], &columns["crossland"]["values"][index]));
    }
    assert_eq!(rows.as_array().unwrap().len(), 15);
    for (format, start) in [("svg", &b"<svg"[..]), ("png", &b"\x89PNG"[..]), ("csv", &b"x,y,z,crossland\n"[..])] {
        let written = server.post(&format!("/fretting?format={format}"), &body).await;
        assert!(written.bytes().await.unwrap().starts_with(start), "{format}");
    }
}

#[tokio::test]
async fn every_fault_is_named_with_its_place() {
    let server = Server::start().await;
    let cases = [
        (json!({"path": {"moves": [{"displacement": 1e-9, "relative": true}]}}), "/path", "displacement"),
        (json!({"path": {"cycles": {"displacement": 1e-8, "count": 101}}}), "/path", "at most 200"),
        (json!({"criteria": {}}), "/criteria", "crossland"),
        (json!({"criteria": {"tresca": {}}}), "/criteria/tresca", ""),
        (json!({"criteria": {"crossland": {"alpha": -1.0}}}), "/criteria/crossland/alpha", "allowed is 0"),
        (json!({"criteria": {"fatemi_socie": {"k": 1.0, "yield": 0.0}}}), "/criteria/fatemi_socie/yield", "allowed is"),
        (json!({"criteria": {"swt": {"youngs_modulus": 1e11}}}), "/criteria/swt/youngs_modulus", "contradicts"),
        (json!({"criteria": {"ruiz": {}}}), "/criteria/ruiz", "z = 0"),
        (json!({"stress_paths": [1]}), "/stress_paths/0", "the last is 0"),
        (json!({"points": [[0.0, 0.0, -1e-6]]}), "/points/0/2", "above the surface"),
        (json!({"body": "second"}), "/body", "rigid"),
        (json!({"tolerance": 1.0}), "/tolerance", "allowed is"),
    ];
    for (change, pointer, detail) in cases {
        let mut asked = json!({
            "path": {"displacement": [1e-8, -1e-8]}, "body": "first", "points": [[0.0, 0.0, 1e-5]],
            "criteria": {"crossland": {"alpha": 0.3}}
        });
        asked.as_object_mut().unwrap().extend(change.as_object().unwrap().clone());
        let refused = problem(server.post("/fretting", &of(&ball(), &asked)).await).await;
        assert_eq!(refused.errors[0].pointer, pointer, "{change}");
        assert!(refused.errors[0].detail.contains(detail), "{change}: {}", refused.errors[0].detail);
    }
    let asked = json!({
        "path": {"displacement": [0.1, -0.1]}, "body": "first", "poisson_ratio": 0.3, "points": [[0.0, 0.0, 0.1]],
        "criteria": {"swt": {}}
    });
    let refused = problem(server.post("/fretting", &of(&unit_sphere(), &asked)).await).await;
    assert_eq!(refused.errors[0].pointer, "/criteria/swt/youngs_modulus");
}
