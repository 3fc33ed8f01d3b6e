//! Every profile: the promises of replies that depend on the shape.

use serde_json::{Value, json};
use stickslip_mechanics::profile::{self, Family};

use crate::json::{changed, number, with};
use crate::{assert_refused, good, post, problem};

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

/// A profile of each family with its examples, a table and a sum.
pub fn families() -> Vec<Value> {
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

#[test]
fn every_profile_carries_its_normal_force_and_gives_every_field() {
    for profile in families() {
        let fields = json!({"points": 9, "fields": ["pressure", "shear", "slip", "displacement"]});
        let body = with(request(&profile, &json!({"normal_force": 10.0})), "/stress", fields);
        let reply = good(post("/simulate", &body));
        assert_eq!(reply["contact"]["normal_force"], json!(10.0));
        for field in ["radius", "pressure", "shear", "slip", "displacement"] {
            assert_eq!(reply["stress"][field].as_array().unwrap().len(), 9, "{profile} {field}");
        }
        assert!(reply.get("residual").is_none() && reply.get("protocol").is_none(), "not asked for");
    }
}

#[test]
fn infinite_stresses_are_null_and_change_nothing_else() {
    let body = request(&json!({"type": "flat_punch", "radius": 1e-3}), &json!({"normal_force": 10.0}));
    let asked = json!({"path": {"displacement": [1e-9]}, "stress": {"points": 3}, "residual": true});
    let reply = good(post("/simulate", &changed(body, &asked)));
    for field in ["pressure", "shear"] {
        let values = reply["stress"][field].as_array().unwrap();
        assert!(values[0].is_number() && values[1].is_number() && values[2].is_null(), "{field}: {values:?}");
    }
    assert!(reply["contact"]["max_pressure"].is_null() && reply["residual"]["max"].is_null());
    assert_eq!(reply["steps"][0]["regime"], "stick", "a punch sticks as a whole");
}

#[test]
fn what_a_shape_cannot_do_is_refused_by_name() {
    let table = |r: Value, z: Value| json!({"type": "tabulated", "r": r, "z": z});
    let sphere = json!({"type": "exact_sphere", "radius": 0.01});
    let punch = json!({"type": "flat_punch", "radius": 1e-3});
    let short = table(json!([0.0, 1e-5, 2e-5]), json!([0.0, 1e-9, 4e-9]));
    let falling = table(json!([0.0, 2e-6, 4e-6, 7e-6, 1e-5]), json!([0.0, 1e-9, 2e-9, 1e-9, 0.0]));
    let sum = json!({"type": "sum", "parts": [{"type": "sphere", "radius": 1e9}, &falling]});
    let law = |power: f64, scale: f64| json!({"type": "power_law", "exponent": power, "coefficient": scale});
    let (rising, one) = (json!([0.0, 1e-9, 4e-9, 9e-9]), json!({"normal_force": 1}));
    let [concave, beyond, invalid] = ["profile_not_convex_enough", "beyond_profile", "invalid_input"];
    for (profile, preload, refused) in [
        (&sphere, json!({"contact_radius": 0.02}), (beyond, "preload/contact_radius", "")),
        (&short, json!({"normal_force": 1e6}), (beyond, "preload/normal_force", "")),
        (&falling, json!({"contact_radius": 9e-6}), (concave, "profile", "")),
        (&sum, json!({"contact_radius": 9e-6}), (concave, "profile", "")),
        (&table(json!([0, 1e-5, 2e-5]), json!([0, -1e-9, -4e-9])), one.clone(), (concave, "profile", "the radius 0 m")),
        (&punch, json!({"contact_radius": 1e-3}), (invalid, "preload/contact_radius", "")),
        (&json!({"type": "cone", "radius": 1.0}), one.clone(), (invalid, "profile/radius", "unknown field")),
        (&json!({"type": "cone"}), one.clone(), (invalid, "profile/slope", "missing")),
        (&table(json!([0, 1]), json!([0, 1])), one.clone(), (invalid, "profile/r", "")),
        (&law(0.0, 1.0), one.clone(), (invalid, "profile/exponent", "")),
        (
            &json!({"type": "sphere", "radius": 1}),
            json!({"normal_force": 1e-300}),
            (invalid, "preload/normal_force", ""),
        ),
        // So blunt that the contact radius exceeds its limit.
        (&law(0.1, 1e-200), one.clone(), (invalid, "preload/normal_force", "")),
        (&table(json!([0, 2e-5, 1e-5, 3e-5]), rising.clone()), one.clone(), (invalid, "profile/r/2", "rise")),
        (&table(json!([0, 1e-5, 2e-5, 2e-5]), rising.clone()), one.clone(), (invalid, "profile/r/3", "rise")),
        (&table(json!([1e-6, 1e-5, 2e-5, 3e-5]), rising.clone()), one.clone(), (invalid, "profile/r/0", "begin at 0")),
        (&table(json!([0, 1e-5, 2e-5, 1e10]), rising.clone()), one.clone(), (invalid, "profile/r/3", "1e9 m")),
        (&table(json!([0, 1e-5, 2e-5]), rising), one.clone(), (invalid, "profile/z", "length")),
        (&table(json!([0, 1e-5, 2e-5]), json!([1e-9, 1e-9, 1e-9])), one, (invalid, "profile/z", "rise")),
    ] {
        let refused = (refused.0, &*format!("/contact/{}", refused.1), refused.2);
        assert_refused("/simulate", &request(profile, &preload), refused);
    }
    // A profile without an answer beside another fault is one of two faults.
    let hollow = table(json!([0, 1e-5, 2e-5]), json!([0, -1e-9, -4e-9]));
    let both = with(request(&hollow, &json!({"normal_force": 1.0})), "/tolerance", json!(1.0));
    let refused = problem(post("/simulate", &both));
    assert_eq!((refused.code.as_str(), refused.errors.len()), (invalid, 2), "{refused:?}");
}

#[test]
fn equal_peaks_say_which_path_they_are_and_refuse_a_cutoff_outside_the_contact() {
    let peaks = |peaks: Value| json!({"path": {"equal_peaks": peaks}});
    let cone = request(&json!({"type": "cone", "slope": 0.05}), &json!({"normal_force": 10.0}));
    let reply = good(post("/simulate", &changed(cone.clone(), &peaks(json!({"reversals": 5})))));
    let cutoff = number(&reply["protocol"]["cutoff_radius"]) / number(&reply["contact"]["contact_radius"]);
    assert!((cutoff - 0.1).abs() < 1e-12);
    let path = json!({"path": {"displacement": reply["protocol"]["displacement"]}});
    let again = good(post("/simulate", &changed(cone, &path)));
    assert_eq!(again["steps"], reply["steps"], "the path is usable as it is");
    let worn = json!({"type": "truncated_sphere", "radius": 0.01, "flat_radius": 5e-5});
    let worn = request(&worn, &json!({"contact_radius": 1e-4}));
    for solver in [json!("exact"), json!({"springs": {"count": 100}})] {
        for (cutoff, is_good) in [(6e-5, true), (0.1, false), (4e-5, false)] {
            let body = changed(worn.clone(), &peaks(json!({"reversals": 3, "cutoff_radius": cutoff})));
            let body = with(body, "/solver", solver.clone());
            if is_good {
                good(post("/simulate", &body));
                continue;
            }
            let refused = ("invalid_input", "/path/equal_peaks/cutoff_radius", "5e-5 to 1e-4 m");
            assert_refused("/simulate", &body, refused);
        }
    }
}

#[test]
fn limiting_cases_are_the_same_for_both_solvers() {
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
            let refused = problem(post("/simulate", &body));
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
            let reply = good(post("/simulate", &changed(smooth.clone(), &asked)));
            let stays = reply["stress"]["slip"] == json!([-0.25, -0.25, -0.25])
                && reply["stress"]["displacement"] == json!([0.0, 0.0, 0.0]);
            assert_eq!(stays, friction == 0.0, "{solver}: {reply}");
        }
        let still = changed(smooth.clone(), &json!({"path": {"displacement": [0.0, -0.0]}, "steps": "all"}));
        let text = good(post("/simulate", &still)).to_string();
        assert!(!text.contains("\"force\":-0.0"), "{text}");
    }
}
