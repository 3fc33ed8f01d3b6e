//! Contacts that are known by their load curve alone, over HTTP: what they answer, and what they have no stresses for.
//! Their loads and radii are tested in `crates/mechanics/tests/physics/load_curves.rs`.

use serde_json::{Value, json};

use crate::common::{Server, assert_refused, ball, changed, codes, good, number, of, with};

fn contact(profile: Value) -> Value {
    with(ball(), "/profile", profile)
}

fn ellipsoid(radii: Value) -> Value {
    json!({"type": "ellipsoid", "radii": radii, "direction": "x"})
}

fn curve(indentation: Value, force: Value) -> Value {
    json!({"type": "load_curve", "indentation": indentation, "normal_force": force})
}

fn profiles() -> [(Value, &'static str); 3] {
    let indentation: Vec<f64> = (0..=20).map(|index| 2e-7 * f64::from(index)).collect();
    let force: Vec<f64> = indentation.iter().map(|d| 3e10 * d.powf(1.5)).collect();
    [
        (
            json!({"type": "asperities", "radii": [1e-3, 2e-3, 3e-3], "gaps": [0.0, -1e-7, 3e-6]}),
            "interaction_neglected",
        ),
        (curve(json!(indentation), json!(force)), "load_curve_alone"),
        (json!({"type": "ellipsoid", "radii": [0.01, 0.004], "direction": "y"}), "elliptic_slip"),
    ]
}

#[tokio::test]
async fn they_are_stored_moved_swept_and_cycled_and_have_no_stresses() {
    let server = Server::start().await;
    let path = json!({"displacement": [1e-7]});
    let point = json!({"body": "first", "points": [[0.0, 0.0, 1e-5]]});
    for (profile, code) in profiles() {
        let made = good(server.post("/contacts", &contact(profile.clone())).await).await;
        assert!(codes(&made).contains(&code), "{made}");
        let place = format!("/contacts/{}", made["id"].as_str().unwrap());
        let moved = good(server.post(&format!("{place}/move"), &json!({"force": 1.5})).await).await;
        assert!((number(&moved["state"]["force"]) - 1.5).abs() < 1e-12, "{moved}");
        let body = of(&contact(profile.clone()), &json!({"drive": {"displacement": 1e-7}, "harmonics": 3}));
        let cycled = good(server.post("/cycle", &body).await).await;
        assert!(number(&cycled["cycles"][0]["dissipated_energy"]) > 0.0);
        let base = of(&contact(profile.clone()), &json!({"path": path, "steps": "last"}));
        let axes = json!([{"pointer": "/contact/friction", "values": [0.1, 0.2]}]);
        let sweep = json!({"base": base, "axes": axes, "outputs": ["/steps/0/force"]});
        good(server.post("/sweep", &sweep).await).await;
        good(server.get(&format!("{place}/definition")).await).await;
        assert_eq!(server.get(&format!("{place}/stress?points=3")).await.status(), 422);
        let named = format!("`{}`", profile["type"].as_str().unwrap());
        for (call, body, at) in [
            (format!("{place}/move"), json!({"force": 1.0, "stress": {"points": 3}}), "/stress"),
            (format!("{place}/path"), json!({"path": {"equal_peaks": {"reversals": 3}}}), "/path/equal_peaks"),
            (format!("{place}/relax"), json!({"reversals": 3}), ""),
            (format!("{place}/subsurface"), point.clone(), ""),
            ("/simulate".to_owned(), json!({"path": path, "stress": {"points": 3}}), "/stress"),
            ("/simulate".to_owned(), json!({"path": path, "residual": true}), "/residual"),
            ("/simulate".to_owned(), json!({"path": path, "subsurface": point}), "/subsurface"),
            ("/simulate".to_owned(), json!({"path": {"equal_peaks": {"reversals": 3}}}), "/path/equal_peaks"),
            ("/accuracy".to_owned(), json!({"path": path}), "/contact/profile"),
            ("/protocols".to_owned(), json!({"reversals": 3}), "/contact/profile"),
            (
                "/cycle".to_owned(),
                json!({"drive": {"displacement": 1e-7}, "work_density": {"points": 3}}),
                "/work_density",
            ),
            (
                "/fretting".to_owned(),
                changed(point.clone(), &json!({"path": path, "criteria": {"crossland": {"alpha": 0.3}}})),
                "/contact/profile",
            ),
            ("/wear".to_owned(), json!({"drive": {"displacement": 1e-8}, "hold": "indentation"}), "/contact/profile"),
        ] {
            let body = if call.starts_with("/contacts") { body } else { of(&contact(profile.clone()), &body) };
            let refused = crate::common::problem(server.post(&call, &body).await).await;
            assert_eq!((refused.status, refused.code.as_str()), (422, "no_stress_field"), "{call}");
            assert!(refused.detail.contains(&named), "{refused:?}");
            assert!(call.starts_with("/contacts") || refused.errors[0].pointer == at, "{call} {refused:?}");
        }
        assert_eq!(good(server.get(&place).await).await["sequence"], json!(1), "a refused move changes nothing");
        let springs = json!({"path": path, "solver": {"springs": {"count": 100}}});
        let springs = of(&contact(profile.clone()), &springs);
        assert_refused(&server, "/simulate", &springs, ("invalid_input", "/solver", "")).await;
        let sum = contact(json!({"type": "sum", "parts": [{"type": "sphere", "radius": 0.01}, profile]}));
        let place = "/contact/profile/parts/1";
        let refused = crate::common::problem(server.post("/simulate", &of(&sum, &json!({"path": path}))).await).await;
        assert_eq!(refused.errors[0].pointer, place, "{refused:?}");
    }
    // Semi-axes are along x and along y.
    for (radii, is_longer) in [([0.01, 0.004], true), ([0.004, 0.01], false)] {
        let body = of(&contact(ellipsoid(json!(radii))), &json!({"path": path}));
        let axes = &good(server.post("/simulate", &body).await).await["contact"]["semi_axes"];
        assert_eq!(number(&axes[0]) > number(&axes[1]), is_longer, "{axes}");
    }
}

#[tokio::test]
async fn a_hundred_thousand_asperities_are_taken() {
    let server = Server::start().await;
    let gaps: Vec<f64> = (1..=100_000).map(|index| 1e-6 * f64::from(index).ln()).collect();
    let rough = contact(json!({"type": "asperities", "radius": 1e-4, "gaps": gaps}));
    let made = good(server.post("/contacts", &rough).await).await;
    let place = format!("/contacts/{}/path", made["id"].as_str().unwrap());
    let path = json!({"path": {"force": [2.0, -2.0, 1.0, 2.999]}, "steps": "last"});
    let moved = good(server.post(&place, &path).await).await;
    assert!((number(&moved["steps"][0]["force"]) - 2.999).abs() < 1e-12, "{moved}");
}
