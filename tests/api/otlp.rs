//! Traces: a real receiver of OTLP gets a span for each request, in the trace that the client names.

use crate::common;

use std::process::Command;
use std::sync::{Arc, Mutex};

use axum::http::StatusCode;
use axum::routing::post;
use axum::{Json, Router};
use common::{Binary, create};
use serde_json::{Value, json};
use stickslip_wire::Move;
use stickslip_wire::client::Options;
use tokio::net::TcpListener;

/// What posts to a collector brought.
type Posts = Arc<Mutex<Vec<Value>>>;

async fn collector() -> (String, Posts) {
    let posts = Posts::default();
    let kept = Arc::clone(&posts);
    let receive = move |Json(body): Json<Value>| async move {
        kept.lock().unwrap().push(body);
        (StatusCode::OK, Json(json!({})))
    };
    let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let base = format!("http://{}", listener.local_addr().unwrap());
    tokio::spawn(axum::serve(listener, Router::new().route("/v1/traces", post(receive))).into_future());
    (base, posts)
}

fn attribute<'a>(span: &'a Value, key: &str) -> &'a Value {
    let all = span["attributes"].as_array().unwrap();
    let found = all.iter().find(|attribute| attribute["key"] == key);
    found.map_or(&Value::Null, |attribute| attribute["value"].as_object().unwrap().values().next().unwrap())
}

async fn end(mut server: Binary) {
    let told = Command::new("kill").args(["-TERM", &server.child.id().to_string()]).status().unwrap();
    assert!(told.success());
    let status = tokio::task::spawn_blocking(move || server.child.wait().unwrap()).await.unwrap();
    assert!(status.success());
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn a_collector_gets_a_span_for_each_request() {
    let (base, posts) = collector().await;
    // What the log shows is another matter.
    let server = Binary::start(&["--otlp-endpoint", &base, "--log", "error"]);
    let (client, options) = (server.client.clone(), Options::default());
    let id = client.create(&create(), &options).await.unwrap().id;
    for _ in 0..700 {
        client.apply(id, &Move { relative: true, ..Move::displacement(1e-10) }.into(), &options).await.unwrap();
    }
    client.apply(id, &Move::force(99.0).into(), &options).await.unwrap_err();
    let trace = "0af7651916cd43dd8448eb211c80319c";
    for (flags, request) in [("01", "mine"), ("00", "not-to-be-traced")] {
        let call = reqwest::Client::new().get(format!("{}/contacts", server.address));
        let parent = format!("00-{trace}-b7ad6b7169203331-{flags}");
        call.header("traceparent", parent).header("x-request-id", request).send().await.unwrap();
    }
    end(server).await;

    let posts = posts.lock().unwrap();
    assert!(posts.len() >= 2, "{} posts", posts.len());
    let mut spans = Vec::new();
    for post in posts.iter() {
        let resource = &post["resourceSpans"][0];
        assert_eq!(*attribute(&resource["resource"], "service.name"), "stickslip");
        spans.extend(resource["scopeSpans"][0]["spans"].as_array().unwrap().iter().cloned());
    }
    assert_eq!(spans.len(), 1 + 700 + 1 + 1);
    let mut ids: Vec<&str> = spans.iter().map(|span| span["spanId"].as_str().unwrap()).collect();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), spans.len());
    for span in &spans {
        let time = |name: &str| span[name].as_str().unwrap().parse::<u128>().unwrap();
        assert!(time("startTimeUnixNano") < time("endTimeUnixNano"), "{span}");
        assert_eq!((span["traceId"].as_str().unwrap().len(), span["spanId"].as_str().unwrap().len()), (32, 16));
    }
    let refused = spans.iter().find(|span| attribute(span, "http.response.status_code") == "422").unwrap();
    assert_eq!(refused["name"], "POST /contacts/{id}/move");
    assert_eq!(*attribute(refused, "error.type"), "force_exceeds_friction");
    let traced: Vec<&Value> = spans.iter().filter(|span| span["traceId"] == trace).collect();
    assert_eq!(traced.len(), 1);
    assert_eq!(
        (&traced[0]["parentSpanId"], attribute(traced[0], "stickslip.request_id")),
        (&"b7ad6b7169203331".into(), &"mine".into())
    );
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn a_collector_that_is_away_costs_nothing_but_traces() {
    let server = Binary::start(&["--otlp-endpoint", "http://127.0.0.1:1"]);
    let id = server.client.create(&create(), &Options::default()).await.unwrap().id;
    server.client.apply(id, &Move::displacement(1e-9).into(), &Options::default()).await.unwrap();
    end(server).await;
    for wrong in ["https://localhost:4318", "localhost:4318", "http://"] {
        let output = common::run(&["serve", "--otlp-endpoint", wrong]);
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(!output.status.success() && said.contains("--otlp-endpoint"), "{said}");
    }
}
