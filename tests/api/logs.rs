//! The log: one JSON object a line, with what an operator needs to find the cause of a failed request.

use crate::common;

use common::process::Process;
use common::{create, metric, until};
use reqwest::Client;
use serde_json::Value;
use stickslip::access::{Role, new_key};
use stickslip_wire::Move;
use stickslip_wire::client::Options;

/// Ends the server as an operator would, and returns its log.
async fn end(server: Process) -> Vec<Value> {
    let log = server.stop().await;
    log.lines().map(|line| serde_json::from_str(line).unwrap_or_else(|_| panic!("not JSON: {line}"))).collect()
}

#[tokio::test]
async fn a_request_is_one_line_and_the_life_of_the_server_a_few() {
    let server = Process::with("memory:", &["--log-format", "json"]);
    let client = server.client.clone();
    let id = client.create(&create(), &Options::default()).await.unwrap().id;
    client.apply(id, &Move::displacement(1e-9).into(), &Options::default()).await.unwrap();
    let refused = client.apply(id, &Move::force(99.0).into(), &Options::default()).await.unwrap_err();
    let request_id = refused.problem().unwrap().request_id.clone();

    let mut log = end(server).await;
    for line in &log {
        assert!(line["timestamp"].is_string() && line["level"].is_string(), "{line}");
        // A route, and not a path; a change names its contact.
        let contact = line["contact"].as_str();
        assert_eq!(contact.is_some(), line["method"] == "POST", "{line}");
        assert_eq!(line.to_string().contains(&id.to_string()), contact == Some(&id.to_string()), "{line}");
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
async fn the_line_of_a_change_says_who_made_it() {
    let new = new_key("bench", &[Role::Write], "lab", None).unwrap();
    let server =
        Process::with("memory:", &["--log-format", "json", "--keys", &new.entry, "--trusted-proxies", "127.0.0.1"]);
    let client = server.client.clone().with_key(&new.key);
    let id = client.create(&create(), &Options::default()).await.unwrap().id;
    let url = |path: &str| format!("{}/contacts/{id}{path}", server.base);
    let send = async |call: reqwest::RequestBuilder, request_id: &str| {
        let call = call.bearer_auth(&new.key).header("x-request-id", request_id);
        call.header("x-forwarded-for", "10.0.0.1, 192.0.2.7").send().await.unwrap()
    };
    let http = Client::new();
    let moved = serde_json::json!({"displacement": 1e-9});
    assert_eq!(send(http.post(url("/move")).json(&moved), "moved").await.status(), 200);
    let fork = common::good(send(http.post(url("/fork")), "forked").await).await;
    assert_eq!(send(http.get(url("")), "read").await.status(), 200);
    assert_eq!(send(http.delete(url("")), "deleted").await.status(), 204);
    assert_eq!(http.delete(url("")).header("x-request-id", "keyless").send().await.unwrap().status(), 401);

    let log = end(server).await;
    let who = |request_id: &str| {
        let line = log.iter().find(|line| line["request_id"] == request_id).unwrap();
        ["client", "key", "tenant", "contact"].map(|name| line[name].as_str().map(str::to_owned))
    };
    let id = id.to_string();
    let by = |contact: Option<&str>| {
        [Some("192.0.2.7"), Some("bench"), Some("lab"), contact].map(|it| it.map(str::to_owned))
    };
    assert_eq!(who("moved"), by(Some(&id)));
    assert_eq!(who("forked"), by(fork["id"].as_str()));
    assert_eq!(who("deleted"), by(Some(&id)));
    assert_eq!(who("read"), by(None));
    assert_eq!(who("keyless"), [Some("127.0.0.1"), None, None, Some(&*id)].map(|it| it.map(str::to_owned)));
    assert!(!log.iter().any(|line| line.to_string().contains(&new.key["stickslip_".len()..])));
}

#[tokio::test]
async fn a_client_that_leaves_is_counted_and_has_its_line_too() {
    let server = Process::with("memory:", &["--log-format", "json"]);
    let long = common::long_simulation();
    let address = server.base.clone();
    let call = Client::new().post(format!("{address}/simulate")).json(&long).header("x-request-id", "mine").send();
    let call = tokio::spawn(call);
    // It leaves once its work has begun, however long that takes.
    let running = async || (metric(&address, "stickslip_solver_running").await == 1).then_some(());
    until("the work has begun", running).await;
    call.abort();
    assert!(call.await.unwrap_err().is_cancelled(), "too quick to leave");
    let left = "stickslip_http_requests_total{method=\"POST\",route=\"/simulate\",status=\"499\"} 1\n";
    let page = async || reqwest::get(format!("{address}/metrics")).await.unwrap().text().await.unwrap();
    until("it is counted", async || page().await.contains(left).then_some(())).await;
    let log = end(server).await;
    let line =
        log.iter().find(|line| line["message"] == "the client disconnected").unwrap_or_else(|| panic!("{log:?}"));
    assert_eq!(
        (&line["request_id"], &line["status"], &line["route"]),
        (&"mine".into(), &499.into(), &"/simulate".into())
    );
}
