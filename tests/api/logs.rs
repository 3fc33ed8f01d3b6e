//! The log: one JSON object a line, with what an operator needs to find the cause of a failed request.

use crate::common;

use std::io::Read as _;
use std::process::Command;

use common::{Binary, create};
use reqwest::Client;
use serde_json::Value;
use stickslip_wire::Move;
use stickslip_wire::client::Options;

/// Ends the server as an operator would, and returns its log.
fn end(mut server: Binary) -> Vec<Value> {
    let sent = Command::new("kill").args(["-TERM", &server.child.id().to_string()]).status().unwrap();
    assert!(sent.success() && server.child.wait().unwrap().success());
    let mut log = String::new();
    server.child.stderr.take().unwrap().read_to_string(&mut log).unwrap();
    log.lines().map(|line| serde_json::from_str(line).unwrap_or_else(|_| panic!("not JSON: {line}"))).collect()
}

#[tokio::test]
async fn a_request_is_one_line_and_the_life_of_the_server_a_few() {
    let server = Binary::start(&["--log-format", "json"]);
    let client = server.client.clone();
    let id = client.create(&create(), &Options::default()).await.unwrap().id;
    client.apply(id, &Move::displacement(1e-9).into(), &Options::default()).await.unwrap();
    let refused = client.apply(id, &Move::force(99.0).into(), &Options::default()).await.unwrap_err();
    let request_id = refused.problem().unwrap().request_id.clone();

    let mut log = end(server);
    for line in &log {
        assert!(line["timestamp"].is_string() && line["level"].is_string(), "{line}");
        assert!(!line.to_string().contains(&id.to_string()), "a route, and not a path: {line}");
    }
    let requests: Vec<Value> = log.extract_if(.., |line| line["message"] == "request").collect();
    let lives: Vec<&str> = log.iter().map(|line| line["message"].as_str().unwrap()).collect();
    let about_memory = "contacts are kept in memory: they are lost when this process ends";
    assert_eq!(lives, [about_memory, "starting", "listening", "stopping", "stopped"]);
    let said: Vec<_> =
        requests.iter().map(|line| (line["route"].as_str().unwrap(), line["status"].as_u64().unwrap())).collect();
    assert_eq!(said, [("/contacts", 201), ("/contacts/{id}/move", 200), ("/contacts/{id}/move", 422)]);
    let refusal = &requests[2];
    assert_eq!((&refusal["request_id"], &refusal["code"]), (&request_id.into(), &"force_exceeds_friction".into()));
    assert!(requests.iter().all(|line| line["duration_ms"].as_f64().is_some_and(|time| time > 0.0)));
}

#[tokio::test]
async fn a_client_that_leaves_has_its_line_too() {
    let server = Binary::start(&["--log-format", "json"]);
    let long = serde_json::json!({"contact": common::ball(), "path": {"falling_amplitude": {"reversals": 1900}},
        "steps": "last", "solver": {"springs": {"count": 1_000_000}}});
    let address = server.address.clone();
    let call = Client::new().post(format!("{address}/simulate")).json(&long).header("x-request-id", "mine").send();
    let left = tokio::time::timeout(std::time::Duration::from_millis(300), call).await;
    assert!(left.is_err(), "too quick to leave");
    server.client.healthz().await.unwrap();
    let log = end(server);
    let line = log.iter().find(|line| line["message"] == "the client left").unwrap_or_else(|| panic!("{log:?}"));
    assert_eq!(
        (&line["request_id"], &line["status"], &line["route"]),
        (&"mine".into(), &499.into(), &"/simulate".into())
    );
}
