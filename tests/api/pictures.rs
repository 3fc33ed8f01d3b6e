//! Every picture as SVG beside one that a person has looked at: those of the service in `pictures/`, which `UPDATE=1`
//! writes anew, to be looked at again.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use serde_json::{Value, json};

use crate::common::Server;
use crate::common::pictures::other_lines;

const FOLDER: &str = "tests/api/pictures";
/// How far a line of a vector plot may be from its reference, pixels: coordinates are rounded to whole ones.
const SHIFT: f64 = 1.0;
/// Examples of the document: the name of the file, the path, the example and the query.
const EXAMPLES: [(&str, &str, &str, &str); 14] = [
    ("simulate-steps", "/simulate", "back and forth", "show=steps"),
    ("simulate-stress", "/simulate", "back and forth", "show=stress"),
    ("simulate-residual", "/simulate", "back and forth", "show=residual"),
    ("cycle-amplitudes", "/cycle", "amplitudes", ""),
    ("cycle-machine", "/cycle", "machine", ""),
    ("cycle-map", "/cycle", "map", ""),
    ("fretting-section", "/fretting", "section", ""),
    ("fretting-surface", "/fretting", "surface", "criterion=findley"),
    ("wear", "/wear", "ball", ""),
    ("sliders", "/sliders", "by error", ""),
    ("rolling", "/rolling", "cylinders", ""),
    ("fretting-work", "/fretting", "surface", "criterion=friction_work"),
    ("fit", "/fit", "steady", ""),
    ("profile", "/profiles/fit", "line", ""),
];

/// What is shown of a contact after some moves: the name of the file, the path, and the query or the example.
const OF_CONTACT: [(&str, &str, &str); 8] = [
    ("contact-stress", "/stress", ""),
    ("contact-loop", "/loop", "points_per_move=20"),
    ("contact-history", "/history", ""),
    ("contact-cycles", "/cycles", ""),
    ("contact-residual", "/residual", ""),
    ("contact-cycle", "/cycle", "displacement=1e-7"),
    ("contact-dissipation", "/cycle", "displacement=1e-8,3e-8,1e-7,3e-7"),
    ("contact-section", "/subsurface", "section"),
];

/// Compares the picture of a scene with its reference, or writes that.
async fn hold(server: &Server, name: &str, path: &str, query: &str, body: Option<&Value>) {
    let path = format!("{path}?format=svg&{query}").trim_end_matches('&').to_owned();
    let response = match body {
        Some(body) => server.post(&path, body).await,
        None => server.get(&path).await,
    };
    assert!(response.status().is_success(), "{path}");
    let found = response.text().await.unwrap();
    let file = Path::new(FOLDER).join(format!("{name}.svg"));
    if std::env::var_os("UPDATE").is_some() {
        fs::create_dir_all(FOLDER).unwrap();
        fs::write(&file, &found).unwrap();
    }
    let other = other_lines(&found, &fs::read_to_string(&file).unwrap(), SHIFT);
    assert!(other.is_none(), "{} is another picture: {}", file.display(), other.unwrap_or_default());
}

#[tokio::test]
async fn each_picture_is_the_one_that_was_looked_at() {
    let server = Server::start().await;
    let document: Value = server.get("/openapi.json").await.json().await.unwrap();
    let example = |path: &str, name: &str| {
        let operation = &document["paths"][path]["post"];
        operation["requestBody"]["content"]["application/json"]["examples"][name]["value"].clone()
    };
    let id = server.contact().await;
    for (name, path, scene, query) in EXAMPLES {
        hold(&server, name, path, query, Some(&example(path, scene))).await;
    }
    let moves =
        json!({"path": {"displacement": [1.5e-7, -1.4e-7, 1.4e-7, -1.4e-7, 1.2e-7, -1.2e-7, 1e-7, -5e-8, 2e-8]}});
    assert!(server.post(&format!("/contacts/{id}/path"), &moves).await.status().is_success());
    for (name, path, query) in OF_CONTACT {
        let of = format!("/contacts/{id}{path}");
        let body = (path == "/subsurface").then(|| example("/contacts/{id}/subsurface", query));
        let query = if body.is_some() { "" } else { query };
        hold(&server, name, &of, query, body.as_ref()).await;
    }
    // Whatever the service draws is among them.
    let drawn = document["paths"].as_object().unwrap().iter().filter(|(_, operations)| {
        let mut replies = operations.as_object().unwrap().values().map(|operation| &operation["responses"]["200"]);
        replies.any(|reply| reply["content"]["image/svg+xml"].is_object())
    });
    let drawn: BTreeSet<String> = drawn.map(|(path, _)| path.clone()).collect();
    let held = EXAMPLES.iter().map(|(_, path, ..)| (*path).to_owned());
    let held = held.chain(OF_CONTACT.iter().map(|(_, path, _)| format!("/contacts/{{id}}{path}")));
    assert_eq!(drawn, held.collect::<BTreeSet<_>>());
}
