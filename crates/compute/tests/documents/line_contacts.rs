//! Contacts along a line: stresses over x, the bulk stress that moves the stick zone, and what every
//! computation does with them. Their values are tested in `crates/mechanics/tests/physics/line_contacts.rs`.

use serde_json::{Value, json};

use crate::json::{changed, codes, cylinder, cylinder_with_bulk, number, of, pad, with};
use crate::{assert_refused, good, post, problem};

#[test]
fn stresses_are_over_x_and_the_stuck_zone_is_off_the_middle() {
    let limit = 0.6 * 968.466409034;
    let (a, p0) = (3.853_405_405_41e-4, 1.6e8);
    let forces = [0.5, -0.5, 0.5, -0.2, 0.1].map(|share| share * limit);
    let path = json!({"force": forces});
    let x = [-0.97, -0.5, 0.1, 0.7, 0.99].map(|part| part * a);
    let point = json!({"body": "second", "points": [[0.95 * a, 1.0, 0.02 * a]]});
    let asked = json!({"path": path, "stress": {"x": x}, "residual": true, "subsurface": point});
    let reply = good(post("/simulate", &of(&cylinder_with_bulk(), &asked)));
    for (index, expected) in
        [0.243104915623, 0.166177503909, 0.061446284913, 0.060153085570, 0.141067359797].into_iter().enumerate()
    {
        let found = number(&reply["stress"]["shear"][index]) / (0.6 * p0);
        assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    }
    assert!((number(&reply["subsurface"]["xx"][0]) / p0 + 0.267916190567).abs() < 1e-9);
    assert!(reply["stress"].get("radius").is_none() && reply["residual"]["peaks"][0].get("radius").is_none());
    assert!(number(&reply["residual"]["peaks"][0]["x"]) < 0.0 && number(&reply["steps"][4]["stick_centre"]) > 0.0);
    assert_eq!(reply["contact"]["g_star"], reply["contact"]["e_star"]);
    assert!(codes(&reply).contains(&"bulk_work_neglected"), "{reply}");

    let worst = json!({"path": {"force": [0.5 * limit, -0.5 * limit]}, "body": "second", "criteria": {"swt": {}}});
    let found = good(post("/fretting", &of(&cylinder_with_bulk(), &worst)));
    // Forces to the right pull the specimen to the right as it is pulled: the trailing edge cracks.
    assert!((number(&found["swt"]["largest"]["point"][0]) / a + 1.0).abs() < 1e-3, "{found}");
    assert!(!codes(&found).contains(&"bulk_shift_neglected"));
    let cycle = json!({"drive": {"force": 0.5 * limit}, "work_density": {"x": [-0.95 * a, 0.95 * a]}});
    let [plain, shifted] = [cylinder(), cylinder_with_bulk()].map(|contact| of(&contact, &cycle));
    let [plain, shifted] = [plain, shifted].map(|body| good(post("/cycle", &body)));
    assert_eq!(plain["cycles"][0]["dissipated_energy"], shifted["cycles"][0]["dissipated_energy"]);
    let density = |reply: &Value, index: usize| number(&reply["cycles"][0]["friction_work"]["density"][index]);
    assert_eq!(density(&plain, 0).to_bits(), density(&plain, 1).to_bits());
    assert!(density(&shifted, 0) > 2.0 * density(&shifted, 1));
    let more = number(&shifted["cycles"][0]["friction_energy"]);
    assert!(
        more > number(&shifted["cycles"][0]["dissipated_energy"])
            && plain["cycles"][0].get("friction_energy").is_none()
    );
}

#[test]
fn what_is_no_line_contact_is_refused_at_its_place() {
    let path = json!({"path": {"force": [100.0]}});
    let line = |members: Value| with(cylinder(), "/profile", changed(cylinder()["profile"].clone(), &members));
    let rest = |members: Value| changed(path.clone(), &members);
    let bulk = |stress: f64| json!({"bulk": {"body": "second", "stress_per_force": stress}});
    let sphere = with(cylinder(), "/profile", json!({"type": "sphere", "radius": 0.01}));
    let effective = json!({"effective": {"e_star": 4e10, "g_star": 4e10}});
    let moves = json!({"path": {"moves": [{"force": 10.0, "normal_force": 500.0}]}});
    for (contact, rest, code, place, words) in [
        (line(json!({"radius": -1.0})), path.clone(), "invalid_input", "/contact/profile/radius", "1e-15 to 1e9 m"),
        (line(json!({"length": 0.0})), path.clone(), "invalid_input", "/contact/profile/length", "1e-15 to 1e9 m"),
        (
            line(json!({"reference_length": 1e-4})),
            path.clone(),
            "beyond_profile",
            "/contact/profile/reference_length",
            "90 µm",
        ),
        (
            line(json!({"reference_length": 1e10})),
            path.clone(),
            "invalid_input",
            "/contact/profile/reference_length",
            "1e9",
        ),
        (line(json!({"y": 1.0})), path.clone(), "invalid_input", "/contact/profile/y", "unknown"),
        (cylinder(), rest(json!({"stress": {"radii": [1e-4]}})), "invalid_input", "/stress/radii", "line contact"),
        (sphere.clone(), rest(json!({"stress": {"x": [1e-4]}})), "invalid_input", "/stress/x", "line contacts only"),
        (cylinder(), rest(json!({"solver": {"springs": {"count": 10}}})), "invalid_input", "/solver", "line contact"),
        (
            changed(cylinder(), &bulk(4e5)),
            path.clone(),
            "bulk_too_large",
            "/contact/bulk/stress_per_force",
            "up to 330.4",
        ),
        (changed(sphere, &bulk(1e5)), path.clone(), "bulk_too_large", "/contact/bulk", "cylinder only"),
        (changed(pad(), &bulk(1e5)), path.clone(), "bulk_too_large", "/contact/bulk", "cylinder only"),
        (changed(cylinder(), &bulk(1e40)), path.clone(), "invalid_input", "/contact/bulk/stress_per_force", "1e30"),
        (
            with(cylinder_with_bulk(), "/material", effective),
            path.clone(),
            "invalid_input",
            "/contact/bulk",
            "two bodies",
        ),
        (cylinder_with_bulk(), moves, "invalid_input", "/path/moves/0", "constant normal force"),
    ] {
        assert_refused("/simulate", &of(&contact, &rest), (code, place, words));
    }
    // The range is there for programs too.
    let body = of(&line(json!({"radius": -1.0})), &path);
    let fault = problem(post("/simulate", &body)).errors.remove(0);
    assert_eq!([fault.minimum, fault.maximum], [Some(1e-15), Some(1e9)]);
    let body = of(&cylinder(), &json!({"path": {"force": [600.0]}}));
    let fault = problem(post("/simulate", &body)).errors.remove(0);
    assert!((fault.exclusive_maximum.unwrap() - 0.6 * 968.466409034).abs() < 1e-9);
    let pad = with(pad(), "/profile/reference_length", json!(4e-4));
    let place = ("invalid_input", "/contact/profile/reference_length", "above 555");
    assert_refused("/simulate", &of(&pad, &path), place);
}
