//! The largest request of every endpoint with the least memory that the server can be given: each is served, alone and
//! beside another one, so that no request waits for memory that only itself or its neighbour could give back.

use crate::common::openapi::{examples, operations};
use crate::common::raw::{Service, get, post};
use crate::common::{ball, create, until};
use futures::future::join_all;
use serde_json::{Value, json};
use stickslip::admission::Capacity;
use stickslip::server::{ConnectionLimits, memory_budget};
use stickslip_wire::JobState;
use stickslip_wire::client::Options;

const MIB: usize = 1024 * 1024;
/// A body of spaces that is to become as much memory as one request may take, while it is parsed.
const PADDED: usize = 8 * MIB - 64 * 1024;
/// Moves of the contact that is read.
const MOVES: usize = 19_999;
/// What is asked for of each resource that is read, at its largest. Those without a line have no size.
const QUERIES: [(&str, &str); 8] = [
    ("/contacts", "order=newest&limit=1000"),
    ("/contacts/{id}/cycle", "displacement=1e-7&points=10000&format=columns"),
    ("/contacts/{id}/cycles", "last=1000&format=png"),
    ("/contacts/{id}/history", "after=18000&limit=1000&format=png"),
    ("/contacts/{id}/loop", "after=18900&limit=1000&points_per_move=10&format=csv"),
    ("/contacts/{id}/residual", "format=svg"),
    ("/contacts/{id}/stress", "points=10&format=png"),
    ("/jobs/{id}/result", "format=csv"),
];
/// They have no end, and take no memory.
const STREAMS: [&str; 2] = ["/contacts/{id}/events", "/jobs/{id}/events"];

fn least_memory() -> Service {
    Service::start(&["--work-bytes", "256MiB", "--cache-bytes", "16MiB", "--max-wait", "1m", "--log", "warn"])
}

/// The bound of a service with the least memory.
fn bound() -> usize {
    let capacity = Capacity { bytes: 256 * MIB, ..Capacity::default() };
    memory_budget::memory(&ConnectionLimits::default(), &capacity, 16 << 20, false) as usize
}

/// Sends a request alone and twice at once: each time it is served.
async fn alone_and_in_pairs(service: &Service, name: &str, request: &str) {
    for number in [1, 2] {
        for answer in join_all((0..number).map(|_| service.ask("127.0.0.1", request))).await {
            let answer = answer.unwrap();
            let start: String = answer.text.chars().take(2_000).collect();
            assert!(answer.statuses.iter().all(|status| (200..300).contains(status)), "{name}, {number}: {start}");
        }
    }
}

/// A document with spaces before its end.
fn padded(document: &Value) -> String {
    let mut text = document.to_string();
    let end = text.pop().unwrap();
    let spaces = " ".repeat(PADDED - text.len());
    format!("{text}{spaces}{end}")
}

#[tokio::test]
async fn largest_requests_are_served_with_the_least_memory() {
    let service = least_memory();
    let id = service.client.create(&create(), &Options::default()).await.unwrap().id.to_string();
    let path = json!({"path": {"falling_amplitude": {"reversals": MOVES}}, "steps": "last"}).to_string();
    alone_and_in_pairs(&service, "path", &post(&format!("/contacts/{id}/path"), &path)).await;
    let sweep = json!({
        "base": {"contact": ball(), "path": {"displacement": [1e-8]}},
        "axes": [{"pointer": "/contact/friction", "values": [0.1, 0.2]}],
        "outputs": ["/steps/0/force"], "job": true
    });
    let made = service.ask("127.0.0.1", &post("/sweep", &sweep.to_string())).await.unwrap();
    let job = made.text.lines().find_map(|line| line.strip_prefix("location: /jobs/")).unwrap().to_owned();
    let is_done = async || service.client.job(job.parse().unwrap()).await.unwrap().state == JobState::Done;
    until("the job is done", async || is_done().await.then_some(())).await;
    let document = service.client.openapi().await.unwrap();
    let mut count = 0;
    for (method, path, operation) in operations(&document) {
        // A deletion has no body, and cannot be repeated.
        if STREAMS.contains(&path) || method == "DELETE" {
            continue;
        }
        let named = if path.starts_with("/jobs/") { &job } else { &id };
        let place = path.replace("{id}", named).replace("{code}", "not_found");
        let query = QUERIES.iter().find(|(of, _)| *of == path).map_or("", |(_, query)| query);
        let request = |example: &Value| match example {
            // Empty lines are no data.
            Value::String(file) => post(&place, &format!("{file}{}", "\n".repeat(PADDED))).replacen(
                "application/json",
                "application/octet-stream",
                1,
            ),
            document => post(&place, &padded(document)).replacen("POST", &method, 1),
        };
        let mut requests: Vec<String> = examples(&document, operation).iter().map(request).collect();
        if requests.is_empty() {
            assert_eq!(method, "GET");
            requests.push(get(&format!("{place}?{query}")));
        }
        for request in requests {
            alone_and_in_pairs(&service, &format!("{method} {path}"), &request).await;
            count += 1;
        }
    }
    assert!(count > 35, "{count}");
    let (peak, bound) = (service.peak(), bound());
    println!("{count} largest requests: at most {} MiB of {}", peak / MIB, bound / MIB);
    assert!(peak < bound, "{peak} of {bound}");
}

/// Many stresses in depth: the places of a body of 2.8 MB.
fn depths() -> String {
    let places = vec!["[0,0,0]"; 350_000].join(",");
    format!(r#"{{"body": "first", "fields": ["von_mises"], "points": [{places}]}}"#)
}

#[tokio::test]
async fn requests_that_work_on_much_are_served_with_the_least_memory() {
    let service = least_memory();
    let id = service.client.create(&create(), &Options::default()).await.unwrap().id;
    let subsurface = post(&format!("/contacts/{id}/subsurface?format=csv"), &depths());
    alone_and_in_pairs(&service, "subsurface", &subsurface).await;
    let moves = vec!["0"; 100_000].join(",");
    let simulation = format!(r#"{{"contact": {}, "path": {{"displacement": [{moves}]}}}}"#, ball());
    alone_and_in_pairs(&service, "simulate", &post("/simulate", &simulation)).await;
    let path = json!({"path": {"falling_amplitude": {"reversals": MOVES}}, "steps": "last"}).to_string();
    let moved = service.ask("127.0.0.1", &post(&format!("/contacts/{id}/path"), &path)).await.unwrap();
    assert_eq!(moved.statuses, [200], "{}", moved.text);
    // Pages of a deep history: five of them nearly take all that there is, and more while they are traced.
    let page = get(&format!("/contacts/{id}/loop?points_per_move=100&after=18999&limit=1000"));
    for answer in join_all((0..8).map(|_| service.ask("127.0.0.1", &page))).await {
        let answer = answer.unwrap();
        assert_eq!(answer.statuses, [200], "{}", answer.text);
    }
    let (peak, bound) = (service.peak(), bound());
    println!("much work: at most {} MiB of {}", peak / MIB, bound / MIB);
    assert!(peak < bound, "{peak} of {bound}");
}
