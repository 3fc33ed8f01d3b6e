//! Fatigue criteria over HTTP: published figures, warnings, every fault with its place, and the picture. What the
//! criteria are is tested in `crates/mechanics/tests/physics/{fatigue,fretting}.rs`.

use serde_json::{Value, json};

use crate::common::{Server, assert_refused, ball, changed, codes, good, number, of, problem, run, with};
use crate::subsurface::unit_sphere;

/// A cycle in partial slip of the ball, rated by Crossland below its middle.
fn asked(changes: Value) -> Value {
    let mut body = json!({"path": {"displacement": [1e-7, -1e-7]}, "body": "first",
        "points": [[0.0, 0.0, 1e-5]], "criteria": {"crossland": {"alpha": 0.3}}});
    if ["plane", "line", "surface", "search"].iter().any(|place| changes.get(place).is_some()) {
        body.as_object_mut().unwrap().remove("points");
    }
    let mut body = changed(body, &changes);
    body.as_object_mut().unwrap().remove("search");
    of(&ball(), &body)
}

async fn rated(server: &Server, body: &Value) -> Value {
    good(server.post("/fretting", body).await).await
}

#[tokio::test]
async fn a_cycle_in_partial_slip_has_its_published_values() {
    let server = Server::start().await;
    let body = json!({
        // W = 0.6 d up and down.
        "path": {"cycles": {"displacement": 0.3, "count": 2}},
        "body": "second", "poisson_ratio": 0.3, "points": [[-0.98, 0.0, 0.02], [0.0, 0.0, 0.5]],
        "criteria": {"crossland": {"alpha": 0.0, "limit": 0.6}, "dang_van": {"alpha": 0.3}}, "tolerance": 1e-8,
        "stress_paths": [0]
    });
    let reply = rated(&server, &of(&unit_sphere(), &body)).await;
    let crossland = number(&reply["crossland"]["values"][0]);
    assert!((crossland - 0.303_364_330_750).abs() < 1e-8, "{crossland}");
    assert!((number(&reply["dang_van"]["values"][0]) - 0.313_215_178_853).abs() < 1e-8, "{reply}");
    let largest = &reply["crossland"]["largest"];
    assert_eq!((&largest["point"], number(&largest["value"])), (&json!([-0.98, 0.0, 0.02]), crossland));
    assert!((number(&reply["crossland"]["margin"]) - 0.6 / crossland).abs() < 1e-12);
    assert!(reply["dang_van"].get("margin").is_none() && reply.get("findley").is_none());
    assert!(number(&reply["change"]) <= 1e-8 && number(&largest["error"]) <= 1e-8 * crossland);
    // The stresses over the cycle are those of the same path by themselves, at the instants that the place took.
    let path = &reply["stress_paths"][0];
    let end = path["part"].as_array().unwrap().iter().rposition(|part| part == &json!(1.0)).unwrap();
    let of_move = |step: usize| path["move"].as_array().unwrap().iter().filter(|at| **at == json!(step)).count();
    assert_eq!((0..4).map(of_move).max(), Some(reply["instants"].as_u64().unwrap() as usize));
    let below = json!({"body": "second", "poisson_ratio": 0.3, "points": [[-0.98, 0.0, 0.02]]});
    let alone = json!({"path": {"displacement": [0.3, -0.3, 0.3]}, "steps": "last", "subsurface": below});
    let alone = good(server.post("/simulate", &of(&unit_sphere(), &alone)).await).await;
    for name in ["xx", "yy", "zz", "xy", "yz", "xz"] {
        let (one, other) = (number(&path[name][end]), number(&alone["subsurface"][name][0]));
        assert!((one - other).abs() < 1e-12, "{name}: {one} {other}");
    }
    // Far away tension swings by s along one axis: sqrt(J2a) = s/sqrt(3), and the shear amplitude is s/2.
    let far = asked(json!({
        "path": {"displacement": [1e-9, -1e-9]}, "points": [[0.0, 0.0, 1.0]],
        "bulk": {"mean": 5e7, "amplitude": 1e8, "phase": 0.0}, "tolerance": 1e-6,
        "criteria": {"crossland": {"alpha": 0.3}, "findley": {"k": 0.0}, "fatemi_socie": {"k": 0.0, "yield": 3e8}}
    }));
    let reply = rated(&server, &far).await;
    let crossland = 1e8 / 3.0_f64.sqrt() + 0.3 * 1.5e8 / 3.0;
    for (name, expected) in [("crossland", crossland), ("findley", 5e7), ("fatemi_socie", 5e7 * 2.6 / 2.1e11)] {
        assert!((number(&reply[name]["values"][0]) / expected - 1.0).abs() < 1e-6, "{name}: {reply}");
    }
    assert!(codes(&reply).contains(&"bulk_shift_neglected"), "{reply}");
}

#[tokio::test]
async fn the_worst_places_of_a_body_are_found_without_a_grid_and_a_grid_that_says_little_says_so() {
    let server = Server::start().await;
    let criteria = json!({"crossland": {"alpha": 0.3, "limit": 3e8}, "friction_work": {}});
    let reply = rated(&server, &asked(json!({"search": 1, "criteria": criteria}))).await;
    let worst = &reply["crossland"]["largest"];
    // A ball at constant load is worst at the edge of the contact, in the plane of the motion.
    let radius = number(&reply["contact"]["contact_radius"]);
    let place: Vec<f64> = worst["point"].as_array().unwrap().iter().map(number).collect();
    assert!((place[0].abs() / radius - 1.0).abs() < 1e-3 && place[1] == 0.0 && place[2] == 0.0, "{worst}");
    assert!((number(&reply["crossland"]["margin"]) - 3e8 / number(&worst["value"])).abs() < 1e-12);
    assert!(reply["crossland"]["values"][0] == worst["value"] && reply["x"].as_array().unwrap().len() == 2);
    assert!(!codes(&reply).iter().any(|code| code.starts_with("grid")), "{reply}");
    let plane = json!({"normal": "y", "offset": 0.0, "x": [-1.2e-4, 1.3e-4, 40], "z": [2e-6, 6e-5, 7]});
    let swt = json!({"swt": {"limit": 1.0}});
    let away = json!({"x": [-0.1, 0.1, 4], "y": [0.05, 0.1, 2]});
    let cone = with(asked(json!({"search": 1})), "/contact/profile", json!({"type": "cone", "slope": 0.01}));
    let pages = include_str!("../../docs/warnings.md");
    for (body, expected) in [
        // A larger value lies off the grid, whose shallowest row is its rim.
        (asked(json!({"plane": plane})), &["grid_misses_largest", "grid_rim"][..]),
        (asked(json!({"surface": away, "criteria": swt})), &["grid_outside_contact"]),
        // Nothing opens deep below the middle, where all is compressed.
        (asked(json!({"criteria": swt, "bulk": {"mean": -1e9}})), &["no_positive_value"]),
        // The tip of a cone has no largest value.
        (cone, &["unbounded_stress"]),
    ] {
        let reply = rated(&server, &body).await;
        for code in expected {
            assert!(codes(&reply).contains(code), "{code}: {}", reply["warnings"]);
            assert!(pages.contains(&format!("\n## {code}\n")), "docs/warnings.md has nothing on {code}");
        }
        let rating = if reply.get("swt").is_some() { &reply["swt"] } else { &reply["crossland"] };
        let has_none = ["no_positive_value", "unbounded_stress"].contains(&expected[0]);
        assert!(!has_none || rating.get("margin").is_none(), "{reply}");
        assert_eq!(rating["values"][0].is_null(), expected[0] == "unbounded_stress", "{reply}");
    }
}

#[tokio::test]
async fn every_fault_is_named_with_its_place() {
    let server = Server::start().await;
    for (changes, pointer, detail) in [
        (json!({"path": {"moves": [{"displacement": 1e-9, "relative": true}]}}), "/path", "displacement"),
        (json!({"path": {"cycles": {"displacement": 1e-8, "count": 101}}}), "/path", "at most 200"),
        (json!({"criteria": {}}), "/criteria", "crossland"),
        (json!({"criteria": {"tresca": {}}}), "/criteria/tresca", ""),
        (json!({"criteria": {"fatemi_socie": {"k": 1.0, "yield": 0.0}}}), "/criteria/fatemi_socie/yield", "allowed is"),
        (json!({"criteria": {"swt": {"youngs_modulus": 1e11}}}), "/criteria/swt/youngs_modulus", "contradicts"),
        (json!({"criteria": {"ruiz": {}}}), "/criteria/ruiz", "z = 0"),
        (json!({"stress_paths": [1]}), "/stress_paths/0", "the last is 0"),
        (json!({"search": 1, "stress_paths": [0]}), "/stress_paths/0", ""),
        (json!({"points": [[0.0, 0.0, -1e-6]]}), "/points/0/2", "above the surface"),
        (json!({"body": "second"}), "/body", "rigid"),
        (json!({"tolerance": 1.0}), "/tolerance", "allowed is"),
    ] {
        let refused = problem(server.post("/fretting", &asked(changes.clone())).await).await;
        assert_eq!(refused.errors[0].pointer, pointer, "{changes}");
        assert!(refused.errors[0].detail.contains(detail), "{changes}: {}", refused.errors[0].detail);
    }
    let unknown = json!({"path": {"displacement": [0.1, -0.1]}, "body": "first", "poisson_ratio": 0.3,
        "points": [[0.0, 0.0, 0.1]], "criteria": {"swt": {}}});
    let refused = ("invalid_input", "/criteria/swt/youngs_modulus", "");
    assert_refused(&server, "/fretting", &of(&unit_sphere(), &unknown), refused).await;
}

async fn svg(server: &Server, query: &str, body: &Value) -> String {
    let reply = server.post(&format!("/fretting?format=svg{query}"), body).await;
    assert_eq!(reply.status(), 200, "{query}");
    reply.text().await.unwrap()
}

#[tokio::test]
async fn a_picture_shows_the_criterion_that_is_named_in_its_own_unit() {
    let server = Server::start().await;
    let plane = json!({
        "plane": {"normal": "y", "offset": 0.0, "x": [-1.2e-4, 1.2e-4, 13], "z": [0.0, 6e-5, 5]},
        "criteria": {"crossland": {"alpha": 0.3}, "findley": {"k": 0.3}}
    });
    let surface = json!({
        // The middles of its sides slip, and the trailing one is under tension.
        "surface": {"x": [-6.6e-5, 6.6e-5, 5], "y": [-6.6e-5, 6.6e-5, 5]},
        "criteria": {"ruiz": {}, "friction_work": {}, "dang_van": {"alpha": 0.3}}
    });
    for (changes, name, title, unit) in [
        (&plane, "findley", "Findley", "MPa"),
        (&surface, "friction_work", "Friction work per cycle", "J/m²"),
        (&surface, "ruiz_tension", "Ruiz, with tension", "N²/m³"),
        (&surface, "ruiz", "Ruiz, shear stress times slip", "N/m"),
    ] {
        let body = asked(changes.clone());
        let exact = number(&rated(&server, &body).await[name]["largest"]["value"]);
        let text = svg(&server, &format!("&criterion={name}"), &body).await;
        // The title has the value of the reply in the unit of the scale, whatever the prefix.
        let heading = text.lines().find(|line| line.starts_with(&format!("{title}, first body: largest "))).unwrap();
        let shown = heading.split("largest ").nth(1).unwrap().split(" at ").next().unwrap();
        let (digits, shown_unit) = shown.split_once(' ').unwrap();
        let mantissa = |value: f64| value / 10f64.powf(value.log10().floor());
        assert!((mantissa(digits.parse().unwrap()) / mantissa(exact) - 1.0).abs() < 1e-3, "{heading} {exact}");
        assert!(heading.contains(unit), "{heading}");
        let scale = shown_unit.trim_start_matches("· ");
        assert!([scale.to_owned(), format!("({scale})")].iter().any(|it| text.contains(&format!("{title} / {it}"))));
        // A ring in the legend, and one with its halo at the worst place.
        assert_eq!(text.matches("<circle").count(), 3, "{name}");
        assert!(text.contains("edge of the contact at the preload"));
    }
    let line = |from: [f64; 3], to: [f64; 3]| asked(json!({"line": {"from": from, "to": to, "count": 41}}));
    for (body, axis, is_on_contact) in [
        (line([-1e-4, 0.0, 0.0], [1e-4, 0.0, 0.0]), "x, along the motion / µm", true),
        (line([-5e-5, 0.0, 0.0], [-5e-5, 0.0, 5e-5]), "z, the depth / µm", false),
        (line([0.0, 0.0, 0.0], [5e-5, 5e-5, 0.0]), "distance along the line / µm", true),
    ] {
        let text = svg(&server, "", &body).await;
        assert!(text.contains(axis) && text.contains("Crossland, first body: largest "), "{axis}");
        assert_eq!(text.contains("on the contact at the preload"), is_on_contact, "{axis}");
    }
    // Ruiz's second parameter comes with the first. A table has all criteria, whichever is named.
    let ruiz = changed(surface, &json!({"criteria": {"ruiz": {}}}));
    assert!(svg(&server, "", &asked(ruiz)).await.contains("Ruiz, shear stress times slip"));
    let body = asked(plane);
    let table = server.post("/fretting?format=csv&criterion=findley", &body).await.text().await.unwrap();
    assert!(table.starts_with("x,y,z,crossland,findley\n"));
    for (query, named) in [
        ("?format=svg", &["choose one of `crossland`, `findley`"][..]),
        ("?format=csv&criterion=ruiz", &["`ruiz` is not asked for", "`crossland`, `findley`"]),
        ("?criterion=tresca", &["`tresca` is not one of", "`dang_van`", "`ruiz_tension`"]),
        ("?criterion=findley&criterion=crossland", &["given twice"]),
    ] {
        let refused = problem(server.post(&format!("/fretting{query}"), &body).await).await;
        assert_eq!((refused.status, refused.errors[0].pointer.as_str()), (422, "/criterion"), "{query}");
        assert!(named.iter().all(|named| refused.errors[0].detail.contains(named)), "{query}: {refused:?}");
    }
    assert_refused(&server, "/fretting?format=svg", &asked(json!({})), ("invalid_input", "/points", "`plane`")).await;
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("body.json");
    std::fs::write(&file, body.to_string()).unwrap();
    for (arguments, said) in [
        (&["--format", "svg"][..], "choose one of `crossland`, `findley`"),
        (&["--format", "svg", "--criterion", "swt"], "`swt` is not asked for"),
        (&["--criterion", "tresca"], "expected: crossland or dang_van"),
    ] {
        let refused = run(&[&["fretting", file.to_str().unwrap()], arguments].concat());
        let error = String::from_utf8_lossy(&refused.stderr);
        assert!(!refused.status.success() && error.contains(said), "{error}");
    }
}
