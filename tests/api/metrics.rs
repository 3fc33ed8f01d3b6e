//! `/metrics`: what a real Prometheus reads there is what a client counted.

use crate::common;

use std::collections::BTreeMap;
use std::io::Write as _;
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::time::Duration;

use common::prometheus::{MISSING, Prometheus};
use common::{Server, ball, metric, until};
use prometheus::core::Collector as _;
use prometheus::{Opts, TextEncoder};
use reqwest::{Method, StatusCode};
use serde_json::{Value, json};
use stickslip::metrics::{Counted, gauge, histogram};
use stickslip::sessions::CAPACITY;
use stickslip::store::SqliteStore;

/// How long a test waits for what should take a second.
const PATIENCE: Duration = Duration::from_secs(60);

/// The samples that Prometheus has read from one server.
struct Readings {
    prometheus: Prometheus,
    /// The moment that queries are about: that of a reading that succeeded.
    at: String,
}

impl Readings {
    fn start(target: &str) -> Readings {
        Readings { prometheus: Prometheus::start(target), at: String::new() }
    }

    async fn query(&self, query: &str) -> Vec<(Value, f64)> {
        self.prometheus.query(&[("query", query), ("time", &self.at)]).await
    }

    /// The value of the one sample that a query finds.
    async fn value(&self, query: &str) -> f64 {
        let found = self.query(query).await;
        assert_eq!(found.len(), 1, "{query}: {found:?}");
        found[0].1
    }

    /// The same where it counts something.
    async fn count(&self, query: &str) -> u64 {
        whole(self.value(query).await)
    }

    /// The samples of a query by some of their labels, without zeros.
    async fn table<const N: usize>(&self, query: &str, labels: [&str; N]) -> BTreeMap<[String; N], u64> {
        let key = |labels_of: &Value| labels.map(|label| labels_of[label].as_str().unwrap().to_owned());
        let found = self.query(query).await;
        found.iter().filter(|(_, value)| *value > 0.0).map(|(of, value)| (key(of), whole(*value))).collect()
    }

    /// Waits until it has read the server after this moment. Queries are about that reading from then on.
    async fn catch_up(&mut self) {
        let now = jiff::Timestamp::now().as_millisecond() as f64 / 1e3;
        let read = async {
            let at = self.reading_after(&now.to_string()).await;
            // The next reading begins when all of the first is stored.
            self.reading_after(&at).await;
            at
        };
        self.at = tokio::time::timeout(PATIENCE, read).await.expect("Prometheus cannot read the server");
    }

    /// The time of a reading after another time, in seconds.
    async fn reading_after(&self, time: &str) -> String {
        let newer = format!("timestamp(up == 1) > {time}");
        loop {
            if let Some((_, at)) = self.prometheus.query(&[("query", &newer)]).await.first() {
                return at.to_string();
            }
            tokio::time::sleep(Duration::from_millis(50)).await;
        }
    }
}

/// A number that counts something.
fn whole(value: f64) -> u64 {
    assert!(value >= 0.0 && value.fract().to_bits() == 0, "{value}");
    value as u64
}

/// Sends requests and counts them as it goes.
struct Counting<'a> {
    server: &'a Server,
    sent: BTreeMap<[String; 3], u64>,
}

impl Counting<'_> {
    async fn send(&mut self, times: u64, method: &str, route: &str, path: &str, body: Option<Value>, expected: u16) {
        let body = body.map(|body| body.to_string());
        for _ in 0..times {
            let method = Method::from_bytes(method.as_bytes()).unwrap();
            let response = self.server.send(method, path, body.as_deref(), &[]).await;
            assert_eq!(response.status().as_u16(), expected, "{path}");
            response.bytes().await.unwrap();
        }
        // All methods outside HTTP share one label, so that clients cannot make up labels.
        let method = if method == "BREW" { "other" } else { method };
        *self.sent.entry([route, method, &expected.to_string()].map(str::to_owned)).or_default() += times;
    }
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn prometheus_reads_what_a_client_counted() {
    let folder = tempfile::tempdir().unwrap();
    let store = SqliteStore::open(&folder.path().join("contacts.db")).unwrap();
    let server = Server::with(Arc::new(store), CAPACITY).await;
    let mut prometheus = Readings::start(server.base.trim_start_matches("http://"));
    let mut client = Counting { server: &server, sent: BTreeMap::new() };

    client.send(7, "GET", "/healthz", "/healthz", None, 200).await;
    client.send(2, "POST", "/contacts", "/contacts", Some(ball()), 201).await;
    client.send(3, "POST", "/contacts", "/contacts", Some(json!({"friction": 0})), 422).await;
    let id = server.contact().await;
    *client.sent.get_mut(&["/contacts", "POST", "201"].map(str::to_owned)).unwrap() += 1;
    let (contact, moved) = (format!("/contacts/{id}"), format!("/contacts/{id}/move"));
    let increment = json!({"displacement": 1e-9, "relative": true});
    client.send(11, "POST", "/contacts/{id}/move", &moved, Some(increment), 200).await;
    client.send(2, "POST", "/contacts/{id}/move", &moved, Some(json!({"force": 99})), 422).await;
    let path = json!({"path": {"displacement": [1e-9, 2e-9, 3e-9, 4e-9, 5e-9]}});
    client.send(4, "POST", "/contacts/{id}/path", &format!("{contact}/path"), Some(path), 200).await;
    client.send(3, "GET", "/contacts/{id}", &contact, None, 200).await;
    client.send(5, "GET", "/contacts/{id}", "/contacts/nowhere", None, 404).await;
    client.send(1, "GET", "none", "/nowhere/at/all", None, 404).await;
    client.send(6, "GET", "none", "/made/up?by=me", None, 404).await;
    client.send(2, "PATCH", "/healthz", "/healthz", None, 405).await;
    client.send(3, "BREW", "/healthz", "/healthz", None, 405).await;
    client.send(1, "BREW", "none", "/nowhere", None, 404).await;
    client.send(1, "DELETE", "/contacts/{id}", &contact, None, 204).await;
    prometheus.catch_up().await;

    let requests = "stickslip_http_requests_total{route!=\"/metrics\"}";
    assert_eq!(prometheus.table(requests, ["route", "method", "status"]).await, client.sent);
    let mut by_endpoint = BTreeMap::new();
    for ([route, method, _], count) in &client.sent {
        *by_endpoint.entry([route.clone(), method.clone()]).or_default() += count;
    }
    for part in ["count{", "bucket{le=\"+Inf\","] {
        let query = format!("stickslip_http_request_duration_seconds_{part}route!=\"/metrics\"}}");
        assert_eq!(prometheus.table(&query, ["route", "method"]).await, by_endpoint);
    }
    let metadata = prometheus
        .prometheus
        .ask("metadata", &[("metric", "stickslip_http_request_duration_seconds")])
        .await
        .unwrap_or_default();
    assert_eq!(metadata["stickslip_http_request_duration_seconds"][0]["type"], "histogram");

    for (query, expected) in [
        ("stickslip_moves_total", 11 + 4 * 5),
        // Moves, refused ones too, paths, reads, and the deletion.
        ("stickslip_cache_hits_total", 11 + 2 + 4 + 3 + 1),
        ("stickslip_cache_misses_total", 0),
        ("stickslip_cache_contacts", 2),
        ("stickslip_commit_failures_total{store=\"sqlite\"}", 0),
        ("stickslip_store_pending_changes{store=\"sqlite\"}", 0),
        ("sum(stickslip_http_requests_in_flight{route!=\"/metrics\"})", 0),
        ("stickslip_http_requests_in_flight{route=\"/metrics\"}", 1),
        ("stickslip_solver_waiting + stickslip_solver_running", 0),
        ("stickslip_solver_seconds_count", 11 + 2 + 4),
        ("stickslip_build_info", 1),
    ] {
        assert_eq!(prometheus.count(query).await, expected, "{query}");
    }
    // A client that waits for each answer has each change in a transaction of its own. On a machine so slow that a
    // replay of the moves would take long, there are snapshots besides.
    let (made, committed) = ("stickslip_commit_changes_sum{store=\"sqlite\"}", "stickslip_commit_seconds_count");
    let (made, committed) = (prometheus.count(made).await, prometheus.count(committed).await);
    let changes = 3 + 11 + 4 + 1;
    assert!(changes <= committed && committed <= made && made <= changes + 3, "{committed} {made}");
    assert!(prometheus.value("stickslip_commit_seconds_sum").await > 0.0);
}

#[tokio::test]
async fn promtool_has_nothing_against_the_page() {
    let folder = tempfile::tempdir().unwrap();
    let store = SqliteStore::open(&folder.path().join("contacts.db")).unwrap();
    let server = Server::with(Arc::new(store), CAPACITY).await;
    let id = server.contact().await;
    server.post(&format!("/contacts/{id}/move"), &json!({"displacement": 1e-9})).await;
    let response = server.get("/metrics").await;
    assert_eq!(response.status(), StatusCode::OK);
    assert_eq!(response.headers()["content-type"], "text/plain; version=0.0.4; charset=utf-8");
    let page = response.text().await.unwrap();
    // What the document describes is there before it comes: a rate needs a zero to rise from.
    let of = |status: u16| format!("{{method=\"POST\",route=\"/contacts/{{id}}/move\",status=\"{status}\"}}");
    let shown = |status, count| page.contains(&format!("stickslip_http_requests_total{} {count}\n", of(status)));
    assert!(shown(200, 1) && shown(503, 0) && !shown(499, 0), "{page}");

    let promtool =
        Command::new("promtool").args(["check", "metrics"]).stdin(Stdio::piped()).stderr(Stdio::piped()).spawn();
    let mut promtool = promtool.expect(MISSING);
    promtool.stdin.take().unwrap().write_all(page.as_bytes()).unwrap();
    let verdict = promtool.wait_with_output().unwrap();
    assert!(verdict.status.success(), "{}\n{page}", String::from_utf8_lossy(&verdict.stderr));
}

#[tokio::test]
async fn an_uncached_contact_counts_as_a_miss() {
    let server = Server::with(Arc::new(SqliteStore::in_memory().unwrap()), 1).await;
    let id = server.contact().await;
    for _ in 0..3 {
        server.get(&format!("/contacts/{id}")).await;
    }
    server.get("/contacts/00000000-0000-7000-8000-000000000000").await;
    let names = ["hits_total", "misses_total", "contacts", "bytes", "capacity_bytes"];
    for (name, expected) in names.into_iter().zip([0, 3, 0, 0, 1]) {
        assert_eq!(metric(&server.base, &format!("stickslip_cache_{name}")).await, expected, "{name}");
    }
}

#[tokio::test]
async fn clients_that_listen_are_counted() {
    let server = Server::start().await;
    let id = server.contact().await;
    let path = format!("/contacts/{id}/events");
    let (first, second) = (server.get(&path).await, server.get(&path).await);
    assert_eq!(metric(&server.base, "stickslip_event_streams").await, 2);
    drop((first, second));
    let none_is_left = async || (metric(&server.base, "stickslip_event_streams").await == 0).then_some(());
    until("they have left", none_is_left).await;
}

#[tokio::test]
async fn sweeps_are_counted_at_once_and_as_jobs() {
    let server = Server::start().await;
    let sweep = |count: u64, job: bool| {
        json!({"base": {"contact": ball(), "path": {"displacement": [1e-8]}}, "job": job, "outputs": ["/steps/0/force"],
            "axes": [{"pointer": "/contact/friction", "linear": {"from": 0.1, "to": 0.5, "count": count}}]})
    };
    assert_eq!(server.post("/sweep", &sweep(30, false)).await.status(), 200);
    assert_eq!(metric(&server.base, "stickslip_sweep_points_total").await, 30);
    assert_eq!(server.post("/sweep", &sweep(20, true)).await.status(), 202);
    let chunks = async || metric(&server.base, "stickslip_job_chunks_total").await;
    until("its one chunk is stored", async || (chunks().await > 0).then_some(())).await;
    let names = ["sweep_points_total", "job_chunks_total", "job_chunks_returned_total", "jobs_failed_total"];
    for (name, expected) in names.into_iter().zip([50, 1, 0, 0]) {
        assert_eq!(metric(&server.base, &format!("stickslip_{name}")).await, expected, "{name}");
    }
}

#[test]
fn an_observation_on_a_bound_counts_as_below_it() {
    let histogram = histogram(Opts::new("wait_seconds", "Waits.").const_label("by", "\"me\""), &[1.0, 2.5]);
    [0.5, 1.0, 1.5, 2.5, 3.0].into_iter().for_each(|value| histogram.observe(value));
    let expected = "# HELP wait_seconds Waits.\n# TYPE wait_seconds histogram\n\
        wait_seconds_bucket{by=\"\\\"me\\\"\",le=\"1\"} 2\nwait_seconds_bucket{by=\"\\\"me\\\"\",le=\"2.5\"} 4\n\
        wait_seconds_bucket{by=\"\\\"me\\\"\",le=\"+Inf\"} 5\nwait_seconds_sum{by=\"\\\"me\\\"\"} 8.5\n\
        wait_seconds_count{by=\"\\\"me\\\"\"} 5\n";
    assert_eq!(TextEncoder::new().encode_to_string(&histogram.collect()).unwrap(), expected);
}

#[test]
fn a_gauge_falls_even_after_a_panic() {
    let gauge = gauge(Opts::new("connections", "Connections."));
    let caught = std::panic::catch_unwind(|| {
        let _counted = Counted::by(&gauge);
        assert_eq!(gauge.get(), 2, "not yet");
    });
    assert!(caught.is_err());
    assert_eq!(gauge.get(), 0);
}
