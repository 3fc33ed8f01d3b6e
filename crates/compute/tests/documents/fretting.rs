//! Fatigue criteria: published figures, warnings, and every fault with its place. What the criteria are is tested in
//! `crates/mechanics/tests/physics/{fatigue,fretting}.rs`.

use serde_json::{Value, json};
use stickslip_compute::formats::Format;

use crate::json::{ball, changed, codes, number, of, with};
use crate::subsurface::unit_sphere;
use crate::{assert_refused, good, post, problem, written};

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

fn rated(body: &Value) -> Value {
    good(post("/fretting", body))
}

#[test]
fn a_cycle_in_partial_slip_has_its_published_values() {
    let body = json!({
        // W = 0.6 d up and down.
        "path": {"cycles": {"displacement": 0.3, "count": 2}},
        "body": "second", "poisson_ratio": 0.3, "points": [[-0.98, 0.0, 0.02], [0.0, 0.0, 0.5]],
        "criteria": {"crossland": {"alpha": 0.0, "limit": 0.6}, "dang_van": {"alpha": 0.3}}, "tolerance": 1e-8,
        "stress_paths": [0]
    });
    let reply = rated(&of(&unit_sphere(), &body));
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
    let alone = good(post("/simulate", &of(&unit_sphere(), &alone)));
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
    let reply = rated(&far);
    let crossland = 1e8 / 3.0_f64.sqrt() + 0.3 * 1.5e8 / 3.0;
    for (name, expected) in [("crossland", crossland), ("findley", 5e7), ("fatemi_socie", 5e7 * 2.6 / 2.1e11)] {
        assert!((number(&reply[name]["values"][0]) / expected - 1.0).abs() < 1e-6, "{name}: {reply}");
    }
    assert!(codes(&reply).contains(&"bulk_shift_neglected"), "{reply}");
}

#[test]
fn the_worst_places_of_a_body_are_found_without_a_grid_and_a_grid_that_says_little_says_so() {
    let criteria = json!({"crossland": {"alpha": 0.3, "limit": 3e8}, "friction_work": {}});
    let reply = rated(&asked(json!({"search": 1, "criteria": criteria})));
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
    let pages = include_str!("../../../../docs/warnings.md");
    for (body, expected) in [
        // A larger value lies off the grid, whose shallowest row is its rim.
        (asked(json!({"plane": plane})), &["grid_misses_largest", "grid_rim"][..]),
        (asked(json!({"surface": away, "criteria": swt})), &["grid_outside_contact"]),
        // Nothing opens deep below the middle, where all is compressed.
        (asked(json!({"criteria": swt, "bulk": {"mean": -1e9}})), &["no_positive_value"]),
        // The tip of a cone has no largest value.
        (cone, &["unbounded_stress"]),
    ] {
        let reply = rated(&body);
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

#[test]
fn every_fault_is_named_with_its_place() {
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
        let refused = problem(post("/fretting", &asked(changes.clone())));
        assert_eq!(refused.errors[0].pointer, pointer, "{changes}");
        assert!(refused.errors[0].detail.contains(detail), "{changes}: {}", refused.errors[0].detail);
    }
    let unknown = json!({"path": {"displacement": [0.1, -0.1]}, "body": "first", "poisson_ratio": 0.3,
        "points": [[0.0, 0.0, 0.1]], "criteria": {"swt": {}}});
    let refused = ("invalid_input", "/criteria/swt/youngs_modulus", "");
    assert_refused("/fretting", &of(&unit_sphere(), &unknown), refused);
}

#[test]
fn a_picture_shows_the_criterion_that_is_named_in_its_own_unit() {
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
        let exact = number(&rated(&body)[name]["largest"]["value"]);
        let text = written("/fretting", Format::Svg, Some(name), &body);
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
        let text = written("/fretting", Format::Svg, None, &body);
        assert!(text.contains(axis) && text.contains("Crossland, first body: largest "), "{axis}");
        assert_eq!(text.contains("on the contact at the preload"), is_on_contact, "{axis}");
    }
    // Ruiz's second parameter comes with the first. A table has all criteria, whichever is named.
    let ruiz = asked(changed(surface, &json!({"criteria": {"ruiz": {}}})));
    assert!(written("/fretting", Format::Svg, None, &ruiz).contains("Ruiz, shear stress times slip"));
    let table = written("/fretting", Format::Csv, Some("findley"), &asked(plane));
    assert!(table.starts_with("x,y,z,crossland,findley\n"));
}
