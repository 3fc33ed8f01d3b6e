//! Warnings: each code appears exactly when it should, and is in the docs.

use serde_json::{Value, json};

use crate::json::{ball, changed, codes, of, with};
use crate::{good, post};

/// A contact without warnings.
fn flawless() -> Value {
    json!({
        "profile": {"type": "sphere", "radius": 0.01},
        "material": {"effective": {"e_star": 1.15e11, "g_star": 8.5e10}},
        "friction": 0.3,
        "preload": {"normal_force": 10.0}
    })
}

/// A ball of 10 mm, measured every `spacing` with heights rounded to `step` (m).
fn table(spacing: f64, height: impl Fn(f64) -> f64, step: f64) -> Value {
    let radii: Vec<f64> = (0..=200).map(|index| spacing * f64::from(index)).collect();
    let heights: Vec<f64> = radii.iter().map(|r| (height(*r) / step).round() * step).collect();
    json!({"type": "tabulated", "r": radii, "z": heights})
}

fn measured(step: f64) -> Value {
    table(2e-6, |r| r * r / 0.02, step)
}

/// Of these members of a contact, or of a simulation beside it, the body of a simulation.
fn scene(changes: &Value) -> Value {
    let (mut contact, mut body) = (flawless(), json!({"path": {"displacement": [1e-7]}}));
    for (name, value) in changes.as_object().unwrap() {
        let of_contact = ["profile", "material", "friction", "preload"].contains(&name.as_str());
        (if of_contact { &mut contact } else { &mut body })[name] = value.clone();
    }
    of(&contact, &body)
}

/// Asserts that the docs have a section on each code.
fn are_described(codes: &[&str]) {
    let pages = include_str!("../../../../docs/warnings.md");
    for code in codes {
        assert!(pages.contains(&format!("\n## {code}\n")), "docs/warnings.md has nothing on {code}");
    }
}

#[test]
fn each_warning_has_its_cause_and_its_page() {
    let [steel, incompressible] = [0.3, 0.5].map(|nu| json!({"youngs_modulus": 2.1e11, "poisson_ratio": nu}));
    let sphere = |kind: &str| json!({"type": kind, "radius": 0.01});
    let law = |radius: f64| json!({"type": "power_law", "exponent": 2.0, "coefficient": 0.5 / radius});
    let blunt = json!({"type": "rounded_cone", "slope": 0.5, "tip_radius": 0.005});
    let sum = json!({"type": "sum", "parts": [law(0.02), {"type": "sphere", "radius": 0.02}]});
    let steep = table(4.5e-5, |r| 0.01 - (1e-4 - r * r).sqrt(), 1e-18);
    let wide = |profile: &Value, radius: f64| json!({"profile": profile, "preload": {"contact_radius": radius}});
    let from_nothing = |profile: Value, more: Value| {
        let path = json!({"moves": [{"displacement": 2e-7, "normal_force": 10.0}, {"displacement": 1e-5}]});
        changed(json!({"profile": profile, "preload": {"normal_force": 0.0}, "path": path}), &more)
    };
    let cone = |slope: f64| json!({"type": "cone", "slope": slope});
    let springs = json!({"springs": {"count": 20}});
    let cases: &[(Value, &[&str])] = &[
        (json!({}), &[]),
        (json!({"profile": measured(1e-15)}), &[]),
        (json!({"profile": measured(1e-9)}), &["noisy_table"]),
        (json!({"material": {"bodies": [steel, steel]}}), &["slip_direction"]),
        (json!({"material": {"bodies": [steel, "rigid"]}}), &["dundurs_beta", "slip_direction"]),
        // Against a rigid body beta vanishes for an incompressible one.
        (json!({"material": {"bodies": [incompressible, "rigid"]}}), &["slip_direction"]),
        (wide(&sphere("sphere"), 0.0029), &[]),
        (wide(&sphere("sphere"), 0.0031), &["large_contact"]),
        // A slope of 0.3 is that of the sphere itself at a/R = 0.287.
        (wide(&sphere("exact_sphere"), 0.0028), &[]),
        (wide(&sphere("exact_sphere"), 0.003), &["large_contact"]),
        (wide(&steep, 0.008), &["large_contact"]),
        (wide(&law(0.01), 0.0029), &[]),
        (wide(&law(0.01), 0.0031), &["large_contact"]),
        (wide(&blunt, 0.0029), &[]),
        (wide(&blunt, 0.0031), &["large_contact"]),
        (wide(&sum, 0.0031), &["large_contact"]),
        (json!({"profile": cone(0.29)}), &[]),
        (json!({"profile": cone(0.31)}), &["large_contact"]),
        (json!({"profile": {"type": "rounded_punch", "flat_radius": 0.01, "edge_radius": 0.001}}), &[]),
        (json!({"profile": {"type": "flat_punch", "radius": 0.01}}), &[]),
        (json!({"profile": {"type": "truncated_sphere", "radius": 0.01, "flat_radius": 0.001}}), &[]),
        // A path may lead from no load at all. What its last move wipes out is still in the states before it.
        (from_nothing(measured(1e-15), json!({"tolerance": 1e-6})), &[]),
        (from_nothing(measured(1e-9), json!({"tolerance": 1e-6})), &["noisy_table"]),
        (from_nothing(cone(0.01), json!({"tolerance": 1e-14})), &["tolerance_not_met"]),
        // A radius of 10 and moduli of 115 GPa: millimetres and megapascals.
        (
            json!({"profile": {"type": "sphere", "radius": 10.0},
                "material": {"effective": {"e_star": 1.15e5, "g_star": 8.5e4}}}),
            &["units"],
        ),
        // Twenty springs have the force to a share of a per cent, and stresses only by their order.
        (json!({"solver": springs}), &[]),
        (json!({"solver": springs, "residual": true}), &["stress_error"]),
        (json!({"residual": true}), &[]),
    ];
    for (changes, expected) in cases {
        let reply = good(post("/simulate", &scene(changes)));
        assert_eq!(codes(&reply), *expected, "{changes}");
        are_described(expected);
    }
}

#[test]
fn a_cycle_beyond_the_model_of_fretting_says_which_part_of_it() {
    let wide = |radius: f64| with(ball(), "/preload", json!({"contact_radius": radius}));
    let limit = |limit: f64| json!({"criteria": {"crossland": {"alpha": 0.3, "limit": limit}}});
    let between = |reach: f64| json!({"path": {"displacement": [reach, -reach]}});
    let deep = json!({"path": {"moves": [{"indentation": 9.7e-4}, {"indentation": 1e-6}]}});
    for (contact, changes, said) in [
        (ball(), json!({}), None),
        (wide(0.0029), json!({}), None),
        (wide(0.0031), json!({}), Some("slope of 0.31")),
        // Larger on the way than at the preload.
        (ball(), deep, Some("slope of 0.31")),
        // From end to end 20 contact radii of 100 um.
        (wide(1e-4), between(0.9e-3), None),
        (wide(1e-4), between(1.1e-3), Some("2.2 mm long")),
        (wide(1e-4), between(2.0), Some("4 m long, over 20 contact radii of 100 µm")),
        (ball(), json!({"bulk": {"mean": 2e10, "amplitude": 4e9}}), Some("the bulk stress reaches 24 GPa")),
        (ball(), json!({"bulk": {"mean": 2e8, "amplitude": 4e8}}), None),
        (ball(), json!({"bulk": {"amplitude": 120.0}}), Some("120 Pa alone")),
        (ball(), limit(300.0), Some("the limit of crossland is 300 Pa")),
        (ball(), limit(3e8), None),
        (ball(), limit(3e14), Some("the limit of crossland is 300 TPa")),
    ] {
        let asked = changed(
            between(1e-8),
            &json!({"body": "first", "points": [[0.0, 0.0, 1e-5]],
            "criteria": {"crossland": {"alpha": 0.3}}}),
        );
        let reply = good(post("/fretting", &of(&contact, &changed(asked, &changes))));
        let warnings = reply["warnings"].as_array().unwrap().iter();
        let found: Vec<&str> = warnings
            .filter(|warning| warning["code"] == "beyond_model")
            .map(|warning| warning["message"].as_str().unwrap())
            .collect();
        match said {
            None => assert!(found.is_empty(), "{changes}: {found:?}"),
            Some(said) => assert!(found.iter().any(|message| message.contains(said)), "{changes}: {found:?}"),
        }
    }
    are_described(&["beyond_model"]);
}

#[test]
fn a_simulation_warns_of_its_farthest_move() {
    // Where a hundred times the displacement of gross slip is more than a
    // tenth of the length, it counts: d = 1 mm on a ball of 1 m slips from 1.8 mm on; of a cone the contact radius is
    // the only length, 6.4 mm.
    let soft = json!({"material": {"effective": {"e_star": 1e9, "g_star": 5e8}}, "friction": 0.9,
        "preload": {"indentation": 1e-3}});
    let blunt = changed(soft.clone(), &json!({"profile": {"type": "sphere", "radius": 1.0}}));
    let pointed = changed(soft, &json!({"profile": {"type": "cone", "slope": 0.1}}));
    for (contact, path, said) in [
        (&ball(), json!({"displacement": [1e-7, 0.9e-3, 0.0]}), None),
        (&ball(), json!({"displacement": [-1234.5]}), Some("-1.2345 km")),
        (&blunt, json!({"displacement": [0.179]}), None),
        (&blunt, json!({"displacement": [0.181]}), Some("mm")),
        (&pointed, json!({"displacement": [0.179]}), None),
        (&pointed, json!({"displacement": [0.181]}), Some("mm")),
        // Apart from each other the bodies do not slip at all.
        (&ball(), json!({"moves": [{"indentation": -1e-6}, {"displacement": 1.0}]}), Some("hardly touch")),
    ] {
        for solver in [json!("exact"), json!({"springs": {"count": 100}})] {
            let body = of(contact, &json!({"path": path, "solver": solver, "steps": "last"}));
            let reply = good(post("/simulate", &body));
            let far = reply["warnings"].as_array().unwrap().iter().find(|one| one["code"] == "far_beyond_slip");
            assert_eq!(far.is_some(), said.is_some(), "{body}");
            assert!(far.is_none_or(|far| far["message"].as_str().unwrap().contains(said.unwrap())), "{far:?}");
        }
    }
}
