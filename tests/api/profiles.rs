//! Every profile over HTTP: the promises of the API that depend on the shape.

use crate::common;

use serde_json::{Value, json};
use stickslip_mechanics::profile::{self, Family};

async fn post(server: &str, body: &Value) -> (u16, Value) {
    let reply = reqwest::Client::new().post(format!("{server}/simulate")).json(body).send().await.unwrap();
    (reply.status().as_u16(), reply.json().await.unwrap())
}

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

fn families() -> Vec<Value> {
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

#[tokio::test]
async fn every_profile_carries_its_normal_force_and_gives_every_field() {
    let server = common::Server::start().await;
    for profile in families() {
        let mut body = request(&profile, &json!({"normal_force": 10.0}));
        body["stress"] = json!({"points": 9, "fields": ["pressure", "shear", "slip", "displacement"]});
        body["residual"] = json!(true);
        let (status, reply) = post(&server.base, &body).await;
        assert_eq!(status, 200, "{profile}: {reply}");
        assert_eq!(reply["contact"]["normal_force"], json!(10.0));
        for field in ["radius", "pressure", "shear", "slip", "displacement"] {
            assert_eq!(reply["stress"][field].as_array().unwrap().len(), 9, "{profile} {field}");
        }
    }
}

#[tokio::test]
async fn curvatures_add_up() {
    // z = r^2/(2 R) twice is the parabola of half the radius.
    let server = common::Server::start().await;
    let half = json!({"type": "sphere", "radius": 0.02});
    let twice = json!({"type": "sum", "parts": [half, half]});
    for preload in [json!({"normal_force": 10.0}), json!({"indentation": 1e-6}), json!({"contact_radius": 1e-4})] {
        let (_, one) = post(&server.base, &request(&families()[0], &preload)).await;
        let (_, sum) = post(&server.base, &request(&twice, &preload)).await;
        for pointer in [
            "/contact/indentation",
            "/contact/contact_radius",
            "/contact/normal_force",
            "/contact/max_pressure",
            "/steps/0/force",
            "/steps/0/dissipated_energy",
        ] {
            let of = |reply: &Value| reply.pointer(pointer).and_then(Value::as_f64).unwrap();
            assert!((of(&sum) / of(&one) - 1.0).abs() < 1e-11, "{pointer}: {} {}", of(&sum), of(&one));
        }
    }
}

#[tokio::test]
async fn a_domed_punch_carries_what_lies_within_its_rim() {
    // F_N = 2 E* int_0^b (d - x^2/R) dx, R from two spheres of 0.02 m.
    let server = common::Server::start().await;
    let (dome, b) = (json!({"type": "sphere", "radius": 0.02}), 5e-5_f64);
    let profile = json!({"type": "sum", "parts": [dome, dome, {"type": "flat_punch", "radius": b}]});
    let (_, reply) = post(&server.base, &request(&profile, &json!({"normal_force": 10.0}))).await;
    let expected = 10.0 / (2.0 * 1.15e11 * b) + b * b / (3.0 * 0.01);
    let found = reply["contact"]["indentation"].as_f64().unwrap();
    assert!((found / expected - 1.0).abs() < 1e-13, "{found:e} {expected:e}");
    assert_eq!(reply["contact"]["contact_radius"], json!(b));
}

#[tokio::test]
async fn only_what_is_asked_for_is_in_the_reply() {
    let server = common::Server::start().await;
    let body = request(&families()[0], &json!({"normal_force": 10.0}));
    let (_, reply) = post(&server.base, &body).await;
    for absent in ["stress", "residual", "protocol"] {
        assert!(reply.get(absent).is_none(), "{absent} was not asked for");
    }
    let mut body = body;
    body["stress"] = json!({"points": 3, "fields": ["slip"]});
    let (_, reply) = post(&server.base, &body).await;
    assert!(reply["stress"].get("pressure").is_none() && reply["stress"]["slip"].is_array());
}

#[tokio::test]
async fn infinite_stresses_are_null_and_change_nothing_else() {
    let server = common::Server::start().await;
    let mut body = request(&json!({"type": "flat_punch", "radius": 1e-3}), &json!({"normal_force": 10.0}));
    body["path"] = json!({"displacement": [1e-9]});
    body["stress"] = json!({"points": 3});
    body["residual"] = json!(true);
    let (_, reply) = post(&server.base, &body).await;
    for field in ["pressure", "shear"] {
        let values = reply["stress"][field].as_array().unwrap();
        assert!(values[0].is_number() && values[1].is_number() && values[2].is_null(), "{field}: {values:?}");
    }
    assert!(reply["contact"]["max_pressure"].is_null() && reply["residual"]["max"].is_null());
    assert_eq!(reply["steps"][0]["regime"], "stick", "a punch sticks as a whole");
    body["path"] = json!({"displacement": [1e-3]});
    let (_, reply) = post(&server.base, &body).await;
    assert_eq!(reply["steps"][0]["regime"], "gross_slip", "and slides as a whole");
}

#[tokio::test]
async fn what_a_shape_cannot_do_is_refused_by_name() {
    let server = common::Server::start().await;
    let sphere = json!({"type": "exact_sphere", "radius": 0.01});
    let punch = json!({"type": "flat_punch", "radius": 1e-3});
    let table = json!({"type": "tabulated", "r": [0.0, 1e-5, 2e-5], "z": [0.0, 1e-9, 4e-9]});
    let falling = json!({"type": "tabulated", "r": [0.0, 2e-6, 4e-6, 7e-6, 1e-5], "z": [0.0, 1e-9, 2e-9, 1e-9, 0.0]});
    for (profile, preload, code, pointer) in [
        (&sphere, json!({"contact_radius": 0.02}), "beyond_profile", "/contact/preload/contact_radius"),
        (&table, json!({"normal_force": 1e6}), "beyond_profile", "/contact/preload/normal_force"),
        (&falling, json!({"contact_radius": 9e-6}), "profile_not_convex_enough", "/contact/profile"),
        (
            &json!({"type": "sum", "parts": [{"type": "sphere", "radius": 1e9}, &falling]}),
            json!({"contact_radius": 9e-6}),
            "profile_not_convex_enough",
            "/contact/profile",
        ),
        (&punch, json!({"contact_radius": 1e-3}), "invalid_input", "/contact/preload/contact_radius"),
        (
            &json!({"type": "cone", "radius": 1.0}),
            json!({"normal_force": 1}),
            "invalid_input",
            "/contact/profile/radius",
        ),
        (&json!({"type": "cone"}), json!({"normal_force": 1}), "invalid_input", "/contact/profile/slope"),
        (
            &json!({"type": "tabulated", "r": [0, 1], "z": [0, 1]}),
            json!({"normal_force": 1}),
            "invalid_input",
            "/contact/profile/r",
        ),
        (
            &json!({"type": "power_law", "exponent": 0, "coefficient": 1}),
            json!({"normal_force": 1}),
            "invalid_input",
            "/contact/profile/exponent",
        ),
        (
            &json!({"type": "sphere", "radius": 1}),
            json!({"normal_force": 1e-300}),
            "invalid_input",
            "/contact/preload/normal_force",
        ),
        (
            // So blunt that the contact radius exceeds its limit.
            &json!({"type": "power_law", "exponent": 0.1, "coefficient": 1e-200}),
            json!({"normal_force": 1}),
            "invalid_input",
            "/contact/preload/normal_force",
        ),
    ] {
        let (status, reply) = post(&server.base, &request(profile, &preload)).await;
        assert_eq!((status, reply["code"].as_str()), (422, Some(code)), "{profile}: {reply}");
        assert_eq!(reply["errors"][0]["pointer"], pointer, "{reply}");
    }
}

#[tokio::test]
async fn a_table_that_is_none_is_refused_at_the_number_that_is_wrong() {
    let server = common::Server::start().await;
    let rising = json!([0.0, 1e-9, 4e-9, 9e-9]);
    for (r, z, code, pointer, word) in [
        (json!([0, 2e-5, 1e-5, 3e-5]), rising.clone(), "invalid_input", "/contact/profile/r/2", "rise"),
        (json!([0, 1e-5, 2e-5, 2e-5]), rising.clone(), "invalid_input", "/contact/profile/r/3", "rise"),
        (json!([1e-6, 1e-5, 2e-5, 3e-5]), rising.clone(), "invalid_input", "/contact/profile/r/0", "begin at 0"),
        (json!([0, 1e-5, 2e-5, 1e10]), rising.clone(), "invalid_input", "/contact/profile/r/3", "1e9 m"),
        (json!([0, 1e-5, 2e-5]), rising, "invalid_input", "/contact/profile/z", "length"),
        (json!([0, 1e-5, 2e-5]), json!([0, 1e-9, -1e10]), "invalid_input", "/contact/profile/z/2", "1e9 m"),
        (json!([0, 1e-5, 2e-5]), json!([1e-9, 1e-9, 1e-9]), "invalid_input", "/contact/profile/z", "rise"),
        (
            json!([0, 1e-5, 2e-5]),
            json!([0, -1e-9, -4e-9]),
            "profile_not_convex_enough",
            "/contact/profile",
            "at the radius 0 m",
        ),
    ] {
        let profile = json!({"type": "tabulated", "r": r, "z": z});
        let (status, reply) = post(&server.base, &request(&profile, &json!({"normal_force": 1e-6}))).await;
        assert_eq!((status, reply["code"].as_str()), (422, Some(code)), "{profile}: {reply}");
        assert_eq!(reply["errors"][0]["pointer"], pointer, "{reply}");
        assert!(reply["errors"][0]["detail"].as_str().unwrap().contains(word), "{reply}");
    }
}

#[tokio::test]
async fn a_profile_without_an_answer_beside_another_fault_is_one_of_two_faults() {
    let server = common::Server::start().await;
    let hollow = json!({"type": "tabulated", "r": [0, 1e-5, 2e-5], "z": [0, -1e-9, -4e-9]});
    let mut body = request(&hollow, &json!({"normal_force": 1.0}));
    body["tolerance"] = json!(1.0);
    let (status, reply) = post(&server.base, &body).await;
    assert_eq!((status, reply["code"].as_str()), (422, Some("invalid_input")), "{reply}");
    assert_eq!(reply["errors"].as_array().unwrap().len(), 2, "{reply}");
}

#[tokio::test]
async fn a_cutoff_outside_the_contact_is_refused_with_what_is_allowed() {
    let server = common::Server::start().await;
    let worn = json!({"type": "truncated_sphere", "radius": 0.01, "flat_radius": 5e-5});
    for solver in [json!("exact"), json!({"springs": {"count": 100}})] {
        for (cutoff, status) in [(6e-5, 200), (0.1, 422), (4e-5, 422)] {
            let mut body = request(&worn, &json!({"contact_radius": 1e-4}));
            body["path"] = json!({"equal_peaks": {"reversals": 3, "cutoff_radius": cutoff}});
            body["solver"] = solver.clone();
            let (found, reply) = post(&server.base, &body).await;
            assert_eq!(found, status, "{cutoff} {solver}: {reply}");
            if status == 422 {
                assert_eq!(reply["code"], "invalid_input");
                assert_eq!(reply["errors"][0]["pointer"], "/path/equal_peaks/cutoff_radius");
                assert!(reply["errors"][0]["detail"].as_str().unwrap().contains("5e-5 to 1e-4 m"), "{reply}");
            }
        }
    }
}

#[tokio::test]
async fn equal_peaks_say_which_path_they_are() {
    let server = common::Server::start().await;
    let mut body = request(&json!({"type": "cone", "slope": 0.05}), &json!({"normal_force": 10.0}));
    body["path"] = json!({"equal_peaks": {"reversals": 5}});
    let (status, reply) = post(&server.base, &body).await;
    assert_eq!(status, 200, "{reply}");
    let (radius, cutoff) = (&reply["contact"]["contact_radius"], &reply["protocol"]["cutoff_radius"]);
    assert!((cutoff.as_f64().unwrap() / radius.as_f64().unwrap() - 0.1).abs() < 1e-12);
    let path = reply["protocol"]["displacement"].clone();
    body["path"] = json!({ "displacement": path });
    let (_, again) = post(&server.base, &body).await;
    assert_eq!(again["steps"], reply["steps"], "the path is usable as it is");
}
