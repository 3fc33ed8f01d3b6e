//! Contacts along a line over HTTP: stored ones, and that every computation serves one or refuses it by name. What they
//! reply is tested in `crates/compute/tests/documents/line_contacts.rs`.

use serde_json::{Value, json};
use stickslip_compute::computations::entries;

use crate::common::json::{cylinder, cylinder_with_bulk, pad};
use crate::common::openapi::{document, examples};
use crate::common::{Server, good, number, of, problem, with};

#[tokio::test]
async fn a_stored_line_contact_has_its_stresses_over_x() {
    let server = Server::start().await;
    let (limit, a) = (0.6 * 968.466409034, 3.853_405_405_41e-4);
    let forces = [0.5, -0.5, 0.5, -0.2, 0.1].map(|share| share * limit);
    let path = json!({"force": forces});
    let x = [-0.97, -0.5, 0.1, 0.7, 0.99].map(|part| part * a);
    let asked = json!({"path": path, "stress": {"x": x}, "residual": true});
    let reply = good(server.post("/simulate", &of(&cylinder_with_bulk(), &asked)).await).await;
    let made = good(server.post("/contacts", &cylinder_with_bulk()).await).await;
    let place = format!("/contacts/{}", made["id"].as_str().unwrap());
    let moved = good(server.post(&format!("{place}/path"), &json!({"path": path})).await).await;
    assert_eq!(moved["steps"][4], reply["steps"][4]);
    // States are read as they were, with the middle of the stick zone.
    for cycles in [true, false] {
        let page = good(server.get(&format!("{place}/history?cycles={cycles}")).await).await;
        let states = page["items"].as_array().unwrap().iter().map(|item| &item["state"]);
        assert!(states.eq(moved["steps"].as_array().unwrap()), "{page}");
    }
    let read = good(server.get(&format!("{place}/stress?points=5&residual=true")).await).await;
    assert_eq!(
        read["x"],
        json!([-1.0, -0.5, 0.0, 0.5, 1.0].map(|part| part * number(&moved["steps"][4]["contact_radius"])))
    );
    assert_eq!(read["residual"], reply["residual"]);
    let listed = x.map(|x| x.to_string()).join(",");
    let read = good(server.get(&format!("{place}/stress?x={listed}")).await).await;
    assert_eq!(read["shear"], reply["stress"]["shear"]);
    for format in ["csv", "svg"] {
        for part in ["stress?points=9", "residual?"] {
            let shown = server.get(&format!("{place}/{part}&format={format}")).await.text().await.unwrap();
            assert!(shown.contains(if format == "csv" { "x," } else { "<svg" }), "{shown}");
        }
    }
}

#[tokio::test]
async fn every_computation_serves_a_line_contact_or_refuses_it_by_name() {
    let (server, document) = (Server::start().await, document());
    let mut refused = Vec::new();
    for about in entries().into_iter().map(|entry| entry.about) {
        let Some(route) = about.route else { continue };
        for example in examples(&document, &document["paths"][route.path]["post"]) {
            if example.get("contact").is_none_or(Value::is_string) {
                continue;
            }
            for contact in [cylinder(), pad(), cylinder_with_bulk()] {
                let mut body = with(example.clone(), "/contact", contact);
                if body.pointer("/stress/radii").is_some() {
                    body = with(body, "/stress", json!({"points": 7}));
                }
                let response = server.post(route.path, &body).await;
                if response.status() != 200 {
                    let problem = problem(response).await;
                    assert_eq!(problem.status, 422, "{} {problem:?}", about.name);
                    refused.push(format!("{}: {}", about.name, problem.detail));
                }
            }
        }
    }
    let named = [
        "line contact",
        "bulk stress",
        "friction holds",
        "cannot be fitted on this profile",
        "no stress field",
        "depend on no frequency",
    ];
    for text in &refused {
        assert!(named.iter().any(|name| text.contains(name)), "{text}");
    }
    let of_name = |name: &str| refused.iter().filter(|text| text.starts_with(name)).count();
    assert!(of_name("accuracy:") > 0, "{refused:?}");
}
