//! A server that is told to stop: requests that it has begun are done, or refused with a document, and never cut off.

use std::time::Duration;

use crate::common::raw::{Service, get, post};
use crate::common::{PATIENCE, until};
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::TcpStream;
use tokio::time::{sleep, timeout};

/// A simulation, in two pieces.
fn halves() -> (String, String) {
    let contact = r#"{"profile": {"type": "sphere", "radius": 0.01}, "material": {"effective": {"e_star": 1e11,
        "g_star": 8e10}}, "friction": 0.3, "preload": {"normal_force": 10}}"#;
    let whole = post("/simulate", &format!(r#"{{"contact": {contact}, "path": {{"force": [1.0]}}}}"#));
    let (first, second) = whole.split_at(whole.len() - 10);
    (first.to_owned(), second.to_owned())
}

/// Sends half a request and has the server stop; after `pause`, if there is one, the other half. The reply.
async fn stopped_within(drain_time: &str, pause: Option<Duration>) -> String {
    let service = Service::start(&["--drain-time", drain_time]);
    let (first, second) = halves();
    let mut stream = TcpStream::connect(service.address).await.unwrap();
    stream.write_all(first.as_bytes()).await.unwrap();
    // The head has been read once the metrics count the request.
    let in_flight = "stickslip_http_requests_in_flight{method=\"POST\",route=\"/simulate\"} 1";
    let page = async || service.ask("127.0.0.1", &get("/metrics")).await.unwrap().text;
    until("it is in flight", async || page().await.contains(in_flight).then_some(())).await;
    service.signal("TERM");
    if let Some(pause) = pause {
        sleep(pause).await;
        stream.write_all(second.as_bytes()).await.unwrap();
    }
    let mut reply = Vec::new();
    timeout(PATIENCE, stream.read_to_end(&mut reply)).await.unwrap().unwrap();
    String::from_utf8(reply).unwrap()
}

#[tokio::test]
async fn what_takes_no_longer_than_the_drain_time_is_done() {
    let reply = stopped_within("1m", Some(Duration::from_secs(4))).await;
    assert!(reply.starts_with("HTTP/1.1 200 OK"), "{reply}");
}

#[tokio::test]
async fn what_takes_longer_is_refused() {
    let reply = stopped_within("100ms", None).await;
    assert!(
        reply.starts_with("HTTP/1.1 503 Service Unavailable") && reply.contains("\"code\":\"stopping\""),
        "{reply}"
    );
    assert!(reply.to_lowercase().contains("retry-after: "), "{reply}");
}

/// A connection beyond the limit is kept for a health check, and never ends its head.
#[tokio::test]
async fn a_spare_connection_does_not_hold_up_the_stop() {
    let service = Service::start(&["--max-connections", "1", "--log", "debug"]);
    let taken = TcpStream::connect(service.address).await.unwrap();
    let mut spare = TcpStream::connect(service.address).await.unwrap();
    spare.write_all(b"GET /healthz HT").await.unwrap();
    // This one came later and is served: those before it have been accepted.
    let health = service.ask("127.0.0.1", &get("/healthz")).await.unwrap();
    assert_eq!(health.statuses, [200], "{}", health.text);
    drop(taken);
    service.signal("TERM");
    let mut nothing = Vec::new();
    timeout(PATIENCE, spare.read_to_end(&mut nothing)).await.unwrap().unwrap();
    assert!(nothing.is_empty());
    until("the server stops", async || service.log().contains("stopping").then_some(())).await;
    let log = service.log();
    assert!(!log.contains("taken too long") && !log.contains("have been closed"), "{log}");
}
