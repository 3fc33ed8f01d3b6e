//! Warnings over HTTP: each code appears exactly when it should, and is in the docs.

use serde_json::{Value, json};

use crate::common::{Server, changed, codes, good, with};

/// A contact without warnings.
fn flawless() -> Value {
    json!({
        "profile": {"type": "sphere", "radius": 0.01},
        "material": {"effective": {"e_star": 1.15e11, "g_star": 8.5e10}},
        "friction": 0.3,
        "preload": {"normal_force": 10.0}
    })
}

/// Asserts that the docs have a section on each code.
fn are_described(codes: &[&str]) {
    let pages = include_str!("../../docs/warnings.md");
    for code in codes {
        assert!(pages.contains(&format!("\n## {code}\n")), "docs/warnings.md has nothing on {code}");
    }
}

#[tokio::test]
async fn a_contact_warns_when_a_move_gives_it_cause() {
    let server = Server::start().await;
    let steel = json!({"youngs_modulus": 2.1e11, "poisson_ratio": 0.3});
    let made =
        good(server.post("/contacts", &with(flawless(), "/material", json!({"bodies": [steel, steel]}))).await).await;
    assert_eq!(codes(&made), ["slip_direction"]);
    let loose = json!({"profile": {"type": "cone", "slope": 0.01}, "preload": {"normal_force": 0.0}});
    let cone = good(server.post("/contacts", &changed(flawless(), &loose)).await).await;
    let [large, far, hard] = ["large_contact", "far_beyond_slip", "tolerance_not_met"].map(|code| vec![code]);
    // Gross slip begins below a micrometre, and a tenth of the radius of the ball is 1 mm.
    for (contact, last, body, expected) in [
        (&made, "move", json!({"displacement": 1e-7}), vec![]),
        // a^2 = R d, and a warning of the preload is not repeated.
        (&made, "move", json!({"indentation": 8.9e-4}), vec![]),
        (&made, "move", json!({"indentation": 9.1e-4}), large.clone()),
        (&made, "move", json!({"indentation": 9.2e-4}), vec![]),
        (&made, "move", json!({"indentation": 1e-6}), vec![]),
        (&made, "path", json!({"path": {"moves": [{"indentation": 1e-3}, {"indentation": 1e-6}]}}), large),
        (&made, "path", json!({"path": {"displacement": [1e-7, 0.0]}}), vec![]),
        (&made, "move", json!({"force": 1.0, "normal_force": 20.0, "tolerance": 1e-10}), vec![]),
        (&cone, "move", json!({"displacement": 2e-7, "normal_force": 10.0, "tolerance": 1e-14}), hard),
        (&made, "move", json!({"displacement": 0.999e-3}), vec![]),
        (&made, "move", json!({"displacement": -1.001e-3}), far.clone()),
        // It stays there, and the load alone changes.
        (&made, "move", json!({"normal_force": 12.0}), vec![]),
        (&made, "move", json!({"displacement": 1e3}), far.clone()),
        (&made, "move", json!({"displacement": -1e3, "relative": true}), vec![]),
        (&made, "path", json!({"path": {"displacement": [1e-7, 2e-3, 0.0]}, "steps": "last"}), far.clone()),
        (&made, "path", json!({"path": {"displacement": [1e-7, -1e-7, 0.0]}}), vec![]),
    ] {
        let path = format!("/contacts/{}/{last}", contact["id"].as_str().unwrap());
        let reply = good(server.post(&path, &body).await).await;
        assert_eq!(codes(&reply), expected, "{body}");
        assert_eq!(reply.get("warnings").is_some(), !expected.is_empty(), "{body}: {reply}");
        are_described(&expected);
    }
}
