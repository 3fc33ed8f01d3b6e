//! What can hardly be meant: moves far beyond slip, and cycles beyond the model of fretting fatigue, each with its
//! warning.

use crate::common;

use common::{Server, ball, good, of};
use serde_json::{Value, json};

fn codes(reply: &Value) -> Vec<&str> {
    let warnings = reply.get("warnings").and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
    warnings.iter().map(|warning| warning["code"].as_str().unwrap()).collect()
}

/// The ball slips at 172 nm, and a tenth of its radius is 1 mm.
#[tokio::test]
async fn a_move_far_beyond_slip_says_so_and_is_made() {
    let server = Server::start().await;
    let made = good(server.post("/contacts", &ball()).await).await;
    let place = |last: &str| format!("/contacts/{}/{last}", made["id"].as_str().unwrap());
    for (last, body, is_far) in [
        ("move", json!({"displacement": 0.999e-3}), false),
        ("move", json!({"displacement": -1.001e-3}), true),
        // It stays there, and the load alone changes.
        ("move", json!({"normal_force": 12.0}), false),
        ("move", json!({"displacement": 1e3}), true),
        ("move", json!({"displacement": -1e3, "relative": true}), false),
        ("move", json!({"displacement": 1.0, "indentation": 1e-6}), true),
        ("path", json!({"path": {"displacement": [1e-7, 2e-3, 0.0]}, "steps": "last"}), true),
        ("path", json!({"path": {"displacement": [1e-7, -1e-7, 0.0]}}), false),
    ] {
        let reply = good(server.post(&place(last), &body).await).await;
        assert_eq!(codes(&reply).contains(&"far_beyond_slip"), is_far, "{body}: {reply}");
        assert!(is_far || reply.get("warnings").is_none(), "{body}: {reply}");
    }
    // A simulation warns of the farthest move, with either solver.
    for (path, solver, is_far) in [
        (json!([1e-7, 1.1e-3, 0.0]), json!("exact"), true),
        (json!([1e-7, 0.9e-3, 0.0]), json!("exact"), false),
        (json!([1e-7, 1.1e-3, 0.0]), json!({"springs": {"count": 100}}), true),
        (json!([1e-7, 0.9e-3, 0.0]), json!({"springs": {"count": 100}}), false),
    ] {
        let body = json!({"contact": ball(), "path": {"displacement": path}, "solver": solver, "steps": "last"});
        let reply = good(server.post("/simulate", &body).await).await;
        assert_eq!(codes(&reply).contains(&"far_beyond_slip"), is_far, "{body}");
    }
    let body = json!({"contact": ball(), "path": {"displacement": [-1234.5]}});
    let reply = good(server.post("/simulate", &body).await).await;
    let message = reply["warnings"].as_array().unwrap().last().unwrap()["message"].as_str().unwrap();
    assert!(message.contains("-1.2345 km") && message.contains("nm"), "{message}");
}

/// Where a hundred times the displacement of gross slip is more than a tenth of the length, it counts.
#[tokio::test]
async fn a_soft_contact_slips_later_than_a_tenth_of_its_length() {
    let server = Server::start().await;
    // d = 1 mm on a ball of 1 m: slip from 0.9 E*/G* mm on, and a tenth of the radius is 0.1 m.
    let contact = |profile: Value| {
        json!({"profile": profile, "material": {"effective": {"e_star": 1e9, "g_star": 5e8}}, "friction": 0.9,
            "preload": {"indentation": 1e-3}})
    };
    let cone = json!({"type": "cone", "slope": 0.1});
    for (profile, displacement, is_far) in [
        (json!({"type": "sphere", "radius": 1.0}), 0.179, false),
        (json!({"type": "sphere", "radius": 1.0}), 0.181, true),
        // Of a cone the contact radius is the only length: 6.4 mm.
        (cone.clone(), 0.179, false),
        (cone, 0.181, true),
    ] {
        let body = json!({"contact": contact(profile), "path": {"displacement": [displacement]}});
        let reply = good(server.post("/simulate", &body).await).await;
        assert_eq!(codes(&reply).contains(&"far_beyond_slip"), is_far, "{body}");
    }
    // Apart from each other the bodies do not slip at all.
    let body = json!({"contact": ball(), "path": {"moves": [{"indentation": -1e-6}, {"displacement": 1.0}]}});
    let reply = good(server.post("/simulate", &body).await).await;
    let message = reply["warnings"].as_array().unwrap().last().unwrap()["message"].as_str().unwrap();
    assert!(message.contains("1 m,") && message.contains("hardly touch"), "{message}");
}

#[tokio::test]
async fn a_cycle_beyond_the_model_of_fretting_says_which_part_of_it() {
    let server = Server::start().await;
    let wide = |radius: f64| {
        let mut contact = ball();
        contact["preload"] = json!({"contact_radius": radius});
        contact
    };
    let limit = |limit: f64| json!({"criteria": {"crossland": {"alpha": 0.3, "limit": limit}}});
    let moves = |moves: Value| json!({"path": {"moves": moves}});
    for (contact, changes, said) in [
        (ball(), json!({}), None),
        (wide(0.0029), json!({}), None),
        (wide(0.0031), json!({}), Some("slope of 0.31")),
        // Larger on the way than at the preload.
        (ball(), moves(json!([{"indentation": 9.7e-4}, {"indentation": 1e-6}])), Some("slope of 0.31")),
        // From end to end 20 contact radii of 100 um.
        (wide(1e-4), json!({"path": {"displacement": [0.9e-3, -0.9e-3]}}), None),
        (wide(1e-4), json!({"path": {"displacement": [1.1e-3, -1.1e-3]}}), Some("2.2 mm long")),
        (
            wide(1e-4),
            json!({"path": {"displacement": [2.0, -2.0]}}),
            Some(
                "4 m long, over 20 contact radii of 100 \
            µm",
            ),
        ),
        (ball(), json!({"bulk": {"mean": 2e10, "amplitude": 4e9}}), Some("the bulk stress reaches 24 GPa")),
        (ball(), json!({"bulk": {"mean": 2e8, "amplitude": 4e8}}), None),
        (ball(), json!({"bulk": {"amplitude": 120.0}}), Some("120 Pa alone")),
        (ball(), limit(300.0), Some("the limit of crossland is 300 Pa")),
        (ball(), limit(3e8), None),
        (ball(), limit(3e14), Some("the limit of crossland is 300 TPa")),
    ] {
        let mut asked = json!({
            "path": {"displacement": [1e-8, -1e-8]}, "body": "first", "points": [[0.0, 0.0, 1e-5]],
            "criteria": {"crossland": {"alpha": 0.3}}
        });
        asked.as_object_mut().unwrap().extend(changes.as_object().unwrap().clone());
        let reply = good(server.post("/fretting", &of(&contact, &asked)).await).await;
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
    let pages = include_str!("../../docs/warnings.md");
    for code in ["beyond_model", "far_beyond_slip"] {
        assert!(pages.contains(&format!("\n## {code}\n")), "docs/warnings.md has nothing on {code}");
    }
}
