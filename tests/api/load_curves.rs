//! Contacts that are known by their load curve alone, over HTTP.

use crate::common;

use serde_json::{Value, json};

async fn post(server: &str, path: &str, body: &Value) -> (u16, Value) {
    let reply = reqwest::Client::new().post(format!("{server}{path}")).json(body).send().await.unwrap();
    (reply.status().as_u16(), reply.json().await.unwrap())
}

fn contact(profile: Value) -> Value {
    json!({
        "profile": profile,
        "material": {"bodies": [{"youngs_modulus": 2.1e11, "poisson_ratio": 0.3}, "rigid"]},
        "friction": 0.3,
        "preload": {"normal_force": 10.0}
    })
}

fn profiles() -> [Value; 3] {
    let indentation: Vec<f64> = (0..=20).map(|index| 2e-7 * f64::from(index)).collect();
    let force: Vec<f64> = indentation.iter().map(|d| 3e10 * d.powf(1.5)).collect();
    [
        json!({"type": "asperities", "radii": [1e-3, 2e-3, 3e-3], "gaps": [0.0, -1e-7, 3e-6]}),
        json!({"type": "load_curve", "indentation": indentation, "normal_force": force}),
        json!({"type": "ellipsoid", "radii": [0.01, 0.004], "direction": "y"}),
    ]
}

/// The code and the place of a refusal.
fn refusal((status, reply): (u16, Value)) -> (u16, String, String) {
    let text = |pointer: &str| reply.pointer(pointer).and_then(Value::as_str).unwrap_or_default().to_owned();
    (status, text("/code"), text("/errors/0/pointer"))
}

#[tokio::test]
async fn one_asperity_is_a_ball() {
    let server = common::Server::start().await;
    let path = json!({"moves": [{"displacement": 3e-7}, {"normal_force": 14.0}, {"force": -1.0}]});
    let [ball, one] =
        [json!({"type": "sphere", "radius": 0.01}), json!({"type": "asperities", "radius": 0.01, "gaps": [5.0]})];
    let (_, ball) = post(&server.base, "/simulate", &json!({"contact": contact(ball), "path": path})).await;
    let (status, one) = post(&server.base, "/simulate", &json!({"contact": contact(one), "path": path})).await;
    assert_eq!(status, 200, "{one}");
    for step in 0..3 {
        for name in ["force", "normal_force", "contact_radius", "dissipated_energy", "elastic_energy"] {
            let number = |reply: &Value| reply["steps"][step][name].as_f64().unwrap();
            assert!((number(&one) - number(&ball)).abs() <= 1e-13 * number(&ball).abs(), "{name} of {step}");
        }
    }
    assert_eq!(one["contact"]["max_pressure"], Value::Null);
    assert!(one["accuracy"]["reason"].as_str().unwrap().contains("not to interact"));
}

#[tokio::test]
async fn they_are_stored_moved_swept_and_cycled() {
    let server = common::Server::start().await;
    let codes = ["interaction_neglected", "load_curve_alone", "elliptic_slip"];
    for (profile, code) in profiles().into_iter().zip(codes) {
        let (status, made) = post(&server.base, "/contacts", &contact(profile.clone())).await;
        assert_eq!(status, 201, "{made}");
        let warned = made["warnings"].as_array().unwrap().iter().any(|warning| warning["code"] == json!(code));
        assert!(warned, "{made}");
        let place = format!("/contacts/{}", made["id"].as_str().unwrap());
        let (status, moved) = post(&server.base, &format!("{place}/move"), &json!({"force": 1.5})).await;
        assert!(status == 200 && (moved["state"]["force"].as_f64().unwrap() - 1.5).abs() < 1e-12, "{moved}");
        let body = json!({"contact": contact(profile.clone()), "drive": {"displacement": 1e-7}, "harmonics": 3});
        let (status, cycled) = post(&server.base, "/cycle", &body).await;
        assert_eq!(status, 200, "{cycled}");
        assert!(cycled["cycles"][0]["dissipated_energy"].as_f64().unwrap() > 0.0);
        let sweep = json!({
            "base": {"contact": contact(profile.clone()), "path": {"displacement": [1e-7]}, "steps": "last"},
            "axes": [{"pointer": "/contact/friction", "values": [0.1, 0.2]}],
            "outputs": ["/steps/0/force"]
        });
        let (status, swept) = post(&server.base, "/sweep", &sweep).await;
        assert_eq!(status, 200, "{swept}");
        let definition = reqwest::get(format!("{}{place}/definition", server.base)).await.unwrap();
        assert_eq!(definition.status(), 200);
        let stress = reqwest::get(format!("{}{place}/stress?points=3", server.base)).await.unwrap();
        assert_eq!(refusal((stress.status().as_u16(), stress.json().await.unwrap())).1, "no_stress_field");
        for (path, body) in [
            ("move", json!({"force": 1.0, "stress": {"points": 3}})),
            ("path", json!({"path": {"equal_peaks": {"reversals": 3}}})),
            ("relax", json!({"reversals": 3})),
            ("subsurface", json!({"body": "first", "points": [[0.0, 0.0, 1e-5]]})),
        ] {
            let (status, reply) = post(&server.base, &format!("{place}/{path}"), &body).await;
            let named = format!("`{}`", profile["type"].as_str().unwrap());
            assert!(reply["detail"].as_str().unwrap().contains(&named), "{reply}");
            assert_eq!((status, refusal((status, reply)).1.as_str()), (422, "no_stress_field"), "{path}");
        }
        let now: Value = reqwest::get(format!("{}{place}", server.base)).await.unwrap().json().await.unwrap();
        assert_eq!(now["sequence"], json!(1), "a refused move changes nothing");
    }
}

#[tokio::test]
async fn stresses_of_them_are_refused_at_their_place() {
    let server = common::Server::start().await;
    for profile in profiles() {
        let asked = |body: Value| {
            let mut body = body;
            body["contact"] = contact(profile.clone());
            body
        };
        let path = json!({"displacement": [1e-7]});
        for (call, body, place) in [
            ("/simulate", json!({"path": path, "stress": {"points": 3}}), "/stress"),
            ("/simulate", json!({"path": path, "residual": true}), "/residual"),
            (
                "/simulate",
                json!({"path": path, "subsurface": {"body": "first", "points": [[0.0, 0.0, 1e-5]]}}),
                "/subsurface",
            ),
            ("/simulate", json!({"path": {"equal_peaks": {"reversals": 3}}}), "/path/equal_peaks"),
            ("/accuracy", json!({"path": path}), "/contact/profile"),
            ("/protocols", json!({"reversals": 3}), "/contact/profile"),
            ("/cycle", json!({"drive": {"displacement": 1e-7}, "work_density": {"points": 3}}), "/work_density"),
            (
                "/fretting",
                json!({"path": path, "body": "first", "points": [[0.0, 0.0, 1e-5]],
                    "criteria": {"crossland": {"alpha": 0.3}}}),
                "/contact/profile",
            ),
        ] {
            let found = refusal(post(&server.base, call, &asked(body)).await);
            assert_eq!(found, (422, "no_stress_field".to_owned(), place.to_owned()), "{call}");
        }
        let springs = asked(json!({"path": path, "solver": {"springs": {"count": 100}}}));
        let found = refusal(post(&server.base, "/simulate", &springs).await);
        assert_eq!(found, (422, "invalid_input".to_owned(), "/solver".to_owned()));
        let sum = json!({"type": "sum", "parts": [{"type": "sphere", "radius": 0.01}, profile.clone()]});
        let found = refusal(post(&server.base, "/simulate", &json!({"contact": contact(sum), "path": path})).await);
        assert_eq!((found.0, found.2.as_str()), (422, "/contact/profile/parts/1"));
    }
}

#[tokio::test]
async fn what_is_no_such_profile_is_refused_at_its_place() {
    let server = common::Server::start().await;
    let curve = |d: Value, force: Value| json!({"type": "load_curve", "indentation": d, "normal_force": force});
    let ellipsoid = |radii: Value| json!({"type": "ellipsoid", "radii": radii, "direction": "x"});
    for (profile, place) in [
        (json!({"type": "asperities", "gaps": [0.0]}), ""),
        (json!({"type": "asperities", "radius": 1.0, "radii": [1.0], "gaps": [0.0]}), ""),
        (json!({"type": "asperities", "radii": [1.0, 2.0], "gaps": [0.0]}), "/gaps"),
        (json!({"type": "asperities", "radius": 1.0, "gaps": []}), "/gaps"),
        (json!({"type": "asperities", "radii": [-1.0], "gaps": [0.0]}), "/radii/0"),
        (json!({"type": "asperities", "radius": 1.0, "gaps": ["NaN"]}), "/gaps/0"),
        (json!({"type": "asperities", "radius": 1.0, "gaps": vec![0; 1_000_001]}), "/gaps"),
        (curve(json!([0.0, 1e-6]), json!([0.0, 1.0])), "/indentation"),
        (curve(json!(vec![0; 200_000]), json!([0, 1, 2])), "/indentation"),
        (curve(json!([0.0, 1e-6, 2e-6]), json!([0.0, 1.0, 2.0, 3.0])), "/normal_force"),
        (curve(json!([1e-7, 1e-6, 2e-6]), json!([0.0, 1.0, 2.0])), "/indentation/0"),
        (curve(json!([0.0, 1e-6, 2e-6]), json!([0.1, 1.0, 2.0])), "/normal_force/0"),
        (curve(json!([0.0, 2e-6, 1e-6]), json!([0.0, 1.0, 2.0])), "/indentation/2"),
        (curve(json!([0.0, 1e-6, 2e-6]), json!([0.0, 1.0, 1.9])), "/normal_force/2"),
        (curve(json!([0.0, 1e-6, 2e-6]), json!([0.0, 0.0, 1.9])), "/normal_force/1"),
        (ellipsoid(json!([1.0])), "/radii"),
        (ellipsoid(json!([1.0, 2.0, 3.0])), "/radii"),
        (ellipsoid(json!([1.0, 1e-7])), "/radii"),
        (json!({"type": "ellipsoid", "radii": [1.0, 1.0], "direction": "z"}), "/direction"),
        (json!({"type": "ellipsoid", "radii": [1.0, 1.0]}), "/direction"),
    ] {
        let body = json!({"contact": contact(profile), "path": {"displacement": [1e-7]}});
        let found = refusal(post(&server.base, "/simulate", &body).await);
        assert_eq!(
            found,
            (422, "invalid_input".to_owned(), format!("/contact/profile{place}")),
            "{:.300}",
            body.to_string()
        );
    }
    let mut unknown = contact(ellipsoid(json!([0.01, 0.02])));
    unknown["material"] = json!({"effective": {"e_star": 1e11, "g_star": 8e10}});
    let body = json!({"contact": unknown, "path": {"displacement": [1e-7]}});
    let found = refusal(post(&server.base, "/simulate", &body).await);
    assert_eq!(found.2, "/contact/material/effective");
    let beyond = contact(curve(json!([0.0, 1e-6, 2e-6]), json!([0.0, 1.0, 3.0])));
    let found =
        refusal(post(&server.base, "/simulate", &json!({"contact": beyond, "path": {"displacement": [0.0]}})).await);
    assert_eq!(found, (422, "beyond_profile".to_owned(), "/contact/preload/normal_force".to_owned()));
}

#[tokio::test]
async fn ellipses_have_their_semi_axes() {
    let server = common::Server::start().await;
    for (radii, direction) in [([0.01, 0.004], "x"), ([0.004, 0.01], "y")] {
        let ellipsoid = json!({"type": "ellipsoid", "radii": radii, "direction": direction});
        let body = json!({"contact": contact(ellipsoid), "path": {"displacement": [1e-8]}});
        let (_, reply) = post(&server.base, "/simulate", &body).await;
        let figure = |name: &str| reply["contact"][name].as_f64().unwrap();
        let axes: Vec<f64> = (0..2).map(|axis| reply["contact"]["semi_axes"][axis].as_f64().unwrap()).collect();
        assert_eq!(axes[0] > axes[1], radii[0] > radii[1]);
        // Hertz: F_N = 2/3 pi a b p0, d = p0 b K/E*; F_N' = 3 F_N/(2 d).
        let slope = 1.5 * figure("normal_force") / figure("indentation");
        assert!((figure("contact_radius") / (slope / 2.0 / figure("e_star")) - 1.0).abs() < 1e-13);
        // Along the major axis the stuck ellipse is softer than a circle.
        assert!(figure("e_star") / figure("g_star") > 1.7 / 1.4);
    }
}

#[tokio::test]
async fn a_hundred_thousand_asperities_are_taken() {
    let server = common::Server::start().await;
    let gaps: Vec<f64> = (1..=100_000).map(|index| 1e-6 * f64::from(index).ln()).collect();
    let rough = contact(json!({"type": "asperities", "radius": 1e-4, "gaps": gaps}));
    let (status, made) = post(&server.base, "/contacts", &rough).await;
    assert_eq!(status, 201);
    let place = format!("/contacts/{}/path", made["id"].as_str().unwrap());
    let path = json!({"path": {"force": [2.0, -2.0, 1.0, 2.999]}, "steps": "last"});
    let (status, moved) = post(&server.base, &place, &path).await;
    assert!(status == 200 && (moved["steps"][0]["force"].as_f64().unwrap() - 2.999).abs() < 1e-12, "{moved}");
}
