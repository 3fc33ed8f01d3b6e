//! Warnings over HTTP: each code appears exactly when it should, and is in the docs.

use crate::common;

use serde_json::{Value, json};

/// A scene without warnings.
fn flawless() -> Value {
    json!({
        "contact": {
            "profile": {"type": "sphere", "radius": 0.01},
            "material": {"effective": {"e_star": 1.15e11, "g_star": 8.5e10}},
            "friction": 0.3,
            "preload": {"normal_force": 10.0}
        },
        "path": {"displacement": [1e-7]}
    })
}

/// The scene with some members of its contact, or its path, in place of others.
fn with(changes: &Value) -> Value {
    let mut scene = flawless();
    for (name, value) in changes.as_object().unwrap() {
        let place = if ["path", "tolerance"].contains(&name.as_str()) { &mut scene } else { &mut scene["contact"] };
        place[name] = value.clone();
    }
    scene
}

/// A ball of 10 mm, measured every 2 um with heights rounded to `step` (m).
fn measured(step: f64) -> Value {
    let radii: Vec<f64> = (0..=200).map(|index| 2e-6 * f64::from(index)).collect();
    let heights: Vec<f64> = radii.iter().map(|r| (r * r / 0.02 / step).round() * step).collect();
    json!({"type": "tabulated", "r": radii, "z": heights})
}

/// A ball of 10 mm as a table that reaches to nine tenths of it.
fn steep_table() -> Value {
    let radii: Vec<f64> = (0..=200).map(|index| 4.5e-5 * f64::from(index)).collect();
    let heights: Vec<f64> = radii.iter().map(|r| 0.01 - (1e-4 - r * r).sqrt()).collect();
    json!({"type": "tabulated", "r": radii, "z": heights})
}

/// A ball of this radius (m) as a power law.
fn parabola(radius: f64) -> Value {
    json!({"type": "power_law", "exponent": 2.0, "coefficient": 0.5 / radius})
}

async fn codes(server: &common::Server, scene: &Value) -> Vec<String> {
    let reply = reqwest::Client::new().post(format!("{}/simulate", server.base)).json(scene).send().await.unwrap();
    assert_eq!(reply.status(), 200, "{scene}");
    let reply: Value = reply.json().await.unwrap();
    reply["warnings"].as_array().unwrap().iter().map(|warning| warning["code"].as_str().unwrap().to_owned()).collect()
}

#[tokio::test]
async fn each_warning_has_its_cause_and_its_page() {
    let server = common::Server::start().await;
    let steel = json!({"youngs_modulus": 2.1e11, "poisson_ratio": 0.3});
    let incompressible = json!({"youngs_modulus": 2.1e11, "poisson_ratio": 0.5});
    let cases: &[(Value, &[&str])] = &[
        (json!({}), &[]),
        (json!({"profile": measured(1e-15)}), &[]),
        (json!({"material": {"bodies": [steel, steel]}}), &["slip_direction"]),
        (json!({"material": {"bodies": [steel, "rigid"]}}), &["dundurs_beta", "slip_direction"]),
        // Against a rigid body beta vanishes for an incompressible one.
        (json!({"material": {"bodies": [incompressible, "rigid"]}}), &["slip_direction"]),
        (json!({"preload": {"contact_radius": 0.0029}}), &[]),
        (json!({"preload": {"contact_radius": 0.0031}}), &["large_contact"]),
        // A slope of 0.3 is that of the sphere itself at a/R = 0.287.
        (json!({"profile": {"type": "exact_sphere", "radius": 0.01}, "preload": {"contact_radius": 0.0028}}), &[]),
        (
            json!({"profile": {"type": "exact_sphere", "radius": 0.01}, "preload": {"contact_radius": 0.003}}),
            &["large_contact"],
        ),
        (json!({"profile": steep_table(), "preload": {"contact_radius": 0.008}}), &["large_contact"]),
        (json!({"profile": parabola(0.01), "preload": {"contact_radius": 0.0029}}), &[]),
        (json!({"profile": parabola(0.01), "preload": {"contact_radius": 0.0031}}), &["large_contact"]),
        (
            json!({"profile": {"type": "rounded_cone", "slope": 0.5, "tip_radius": 0.005},
                "preload": {"contact_radius": 0.0029}}),
            &[],
        ),
        (
            json!({"profile": {"type": "rounded_cone", "slope": 0.5, "tip_radius": 0.005},
                "preload": {"contact_radius": 0.0031}}),
            &["large_contact"],
        ),
        (
            json!({"profile": {"type": "sum", "parts": [parabola(0.02), {"type": "sphere", "radius": 0.02}]},
                "preload": {"contact_radius": 0.0031}}),
            &["large_contact"],
        ),
        (json!({"profile": {"type": "cone", "slope": 0.29}}), &[]),
        (json!({"profile": {"type": "cone", "slope": 0.31}}), &["large_contact"]),
        (json!({"profile": {"type": "rounded_punch", "flat_radius": 0.01, "edge_radius": 0.001}}), &[]),
        (json!({"profile": {"type": "flat_punch", "radius": 0.01}}), &[]),
        (json!({"profile": {"type": "truncated_sphere", "radius": 0.01, "flat_radius": 0.001}}), &[]),
        // A path may lead from no load at all.
        (
            json!({"profile": measured(1e-15), "preload": {"normal_force": 0.0},
                "path": {"moves": [{"normal_force": 10.0}]}}),
            &[],
        ),
        (
            json!({"profile": measured(1e-9), "preload": {"normal_force": 0.0},
                "path": {"moves": [{"normal_force": 10.0}]}}),
            &["noisy_table"],
        ),
        // A radius of 10 and moduli of 115 GPa: millimetres and megapascals.
        (
            json!({"profile": {"type": "sphere", "radius": 10.0},
                "material": {"effective": {"e_star": 1.15e5, "g_star": 8.5e4}}}),
            &["units"],
        ),
        (json!({"profile": measured(1e-9)}), &["noisy_table"]),
        (
            json!({
                "profile": {"type": "cone", "slope": 0.01},
                "preload": {"normal_force": 0.0},
                "path": {"moves": [{"displacement": 2e-7, "normal_force": 10.0}]},
                "tolerance": 1e-14
            }),
            &["tolerance_not_met"],
        ),
        // What the last move wipes out is still in the states before it.
        (
            json!({
                "profile": {"type": "cone", "slope": 0.01},
                "preload": {"normal_force": 0.0},
                "path": {"moves": [{"displacement": 2e-7, "normal_force": 10.0}, {"displacement": 1e-5}]},
                "tolerance": 1e-14
            }),
            &["tolerance_not_met"],
        ),
    ];
    let pages = include_str!("../../docs/warnings.md");
    for (changes, expected) in cases {
        let found = codes(&server, &with(changes)).await;
        assert_eq!(&found, expected, "{changes}");
        for code in found {
            assert!(pages.contains(&format!("\n## {code}\n")), "docs/warnings.md has nothing on {code}");
        }
    }
}

/// Twenty springs have the force to a share of a per cent, and stresses only by their order.
#[tokio::test]
async fn stresses_that_are_far_off_warn_where_they_are_asked_for() {
    let server = common::Server::start().await;
    let mut scene = flawless();
    scene["solver"] = json!({"springs": {"count": 20}});
    assert_eq!(codes(&server, &scene).await, [""; 0]);
    scene["residual"] = json!(true);
    assert_eq!(codes(&server, &scene).await, ["stress_error"]);
    scene["solver"] = json!("exact");
    assert_eq!(codes(&server, &scene).await, [""; 0]);
    assert!(include_str!("../../docs/warnings.md").contains("\n## stress_error\n"));
}

/// The codes of the warnings of a reply, and whether it has the member at all.
fn codes_if_present(reply: &Value) -> Option<Vec<&str>> {
    let warnings = reply.get("warnings")?.as_array().unwrap();
    Some(warnings.iter().map(|warning| warning["code"].as_str().unwrap()).collect())
}

#[tokio::test]
async fn a_session_warns_when_a_move_gives_it_cause() {
    let server = common::Server::start().await;
    let client = reqwest::Client::new();
    let send = async |place: &str, body: Value| -> Value {
        let reply = client.post(format!("{}{place}", server.base)).json(&body).send().await.unwrap();
        assert!(reply.status().is_success(), "{body}");
        reply.json().await.unwrap()
    };
    let steel = json!({"youngs_modulus": 2.1e11, "poisson_ratio": 0.3});
    let contact = with(&json!({"material": {"bodies": [steel, steel]}}))["contact"].clone();
    let made = send("/contacts", contact).await;
    assert_eq!(codes_if_present(&made), Some(vec!["slip_direction"]));
    let place = |last: &str| format!("/contacts/{}/{last}", made["id"].as_str().unwrap());
    for (last, body, expected) in [
        ("move", json!({"displacement": 1e-7}), None),
        // a^2 = R d, and a warning of the preload is not repeated.
        ("move", json!({"indentation": 8.9e-4}), None),
        ("move", json!({"indentation": 9.1e-4}), Some(vec!["large_contact"])),
        ("move", json!({"indentation": 9.2e-4}), None),
        ("move", json!({"indentation": 1e-6}), None),
        (
            "path",
            json!({"path": {"moves": [{"indentation": 1e-3}, {"indentation": 1e-6}]}}),
            Some(vec!["large_contact"]),
        ),
        ("path", json!({"path": {"displacement": [1e-7, 0.0]}}), None),
        ("move", json!({"force": 1.0, "normal_force": 20.0, "tolerance": 1e-10}), None),
    ] {
        assert_eq!(codes_if_present(&send(&place(last), body.clone()).await), expected, "{body}");
    }
    let cone = with(&json!({"profile": {"type": "cone", "slope": 0.01}, "preload": {"normal_force": 0.0}}));
    let made = send("/contacts", cone["contact"].clone()).await;
    let place = format!("/contacts/{}/move", made["id"].as_str().unwrap());
    let hard = json!({"displacement": 2e-7, "normal_force": 10.0, "tolerance": 1e-14});
    assert_eq!(codes_if_present(&send(&place, hard).await), Some(vec!["tolerance_not_met"]));
}
