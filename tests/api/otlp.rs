//! Traces: a real receiver of OTLP gets a span for each request, in the trace that the client names, and spans of its
//! parts.

use crate::common;

use std::future::pending;
use std::net::SocketAddr;
use std::sync::{Arc, Mutex};
use std::time::Duration;

use axum::http::{HeaderMap, HeaderValue, StatusCode};
use axum::routing::post;
use axum::serve::Listener;
use axum::{Json, Router};
use common::process::Process;
use common::{binary, create};
use opentelemetry::trace::TraceContextExt as _;
use rustls::ServerConfig;
use rustls::crypto::ring;
use rustls::pki_types::PrivateKeyDer;
use serde_json::{Value, json};
use stickslip::otlp::parent;
use stickslip_wire::Move;
use stickslip_wire::client::Options;
use tokio::net::{TcpListener, TcpStream};
use tokio_rustls::TlsAcceptor;
use tokio_rustls::server::TlsStream;

/// The bodies that a collector received.
type Posts = Arc<Mutex<Vec<Value>>>;

fn receiver() -> (Router, Posts) {
    let posts = Posts::default();
    let kept = Arc::clone(&posts);
    let receive = move |Json(body): Json<Value>| async move {
        kept.lock().unwrap().push(body);
        (StatusCode::OK, Json(json!({})))
    };
    (Router::new().route("/v1/traces", post(receive)), posts)
}

async fn collector() -> (String, Posts) {
    let (router, posts) = receiver();
    let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let base = format!("http://{}", listener.local_addr().unwrap());
    tokio::spawn(axum::serve(listener, router).into_future());
    (base, posts)
}

/// All received spans, with the resource that they belong to.
fn spans(posts: &Posts) -> Vec<Value> {
    let mut spans = Vec::new();
    for post in posts.lock().unwrap().iter() {
        let resource = &post["resourceSpans"][0];
        assert_eq!(*attribute(&resource["resource"], "service.name"), "stickslip");
        assert_eq!(*attribute(&resource["resource"], "service.version"), env!("CARGO_PKG_VERSION"));
        spans.extend(resource["scopeSpans"][0]["spans"].as_array().unwrap().iter().cloned());
    }
    spans
}

/// The names of the parts of a span, in the order of their beginning, each with its own parts behind it.
fn parts(spans: &[Value], parent: &Value) -> Vec<String> {
    let mut parts: Vec<&Value> = spans.iter().filter(|span| span["parentSpanId"] == parent["spanId"]).collect();
    parts.sort_by_key(|span| time(span, "startTimeUnixNano"));
    for part in &parts {
        assert_eq!(part["traceId"], parent["traceId"]);
        assert!(time(parent, "startTimeUnixNano") <= time(part, "startTimeUnixNano"), "{parent} {part}");
        assert!(time(part, "endTimeUnixNano") <= time(parent, "endTimeUnixNano"), "{parent} {part}");
    }
    parts.iter().map(|part| part["name"].as_str().unwrap().to_owned()).collect()
}

fn time(span: &Value, name: &str) -> u128 {
    span[name].as_str().unwrap().parse().unwrap()
}

fn attribute<'a>(span: &'a Value, key: &str) -> &'a Value {
    let all = span["attributes"].as_array().unwrap();
    let found = all.iter().find(|attribute| attribute["key"] == key);
    found.map_or(&Value::Null, |attribute| attribute["value"].as_object().unwrap().values().next().unwrap())
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn a_collector_gets_a_span_for_each_request() {
    let (base, posts) = collector().await;
    // What the log shows is another matter.
    let server = Process::with("memory:", &["--otlp-endpoint", &base, "--log", "error"]);
    let (client, options) = (server.client.clone(), Options::default());
    let id = client.create(&create(), &options).await.unwrap().id;
    for _ in 0..700 {
        client.apply(id, &Move { relative: true, ..Move::displacement(1e-10) }.into(), &options).await.unwrap();
    }
    client.apply(id, &Move::force(99.0).into(), &options).await.unwrap_err();
    let trace = "0af7651916cd43dd8448eb211c80319c";
    for (flags, request) in [("01", "mine"), ("00", "not-to-be-traced")] {
        let call = reqwest::Client::new().get(format!("{}/contacts", server.base));
        let parent = format!("00-{trace}-b7ad6b7169203331-{flags}");
        call.header("traceparent", parent).header("x-request-id", request).send().await.unwrap();
    }
    server.stop().await;

    assert!(posts.lock().unwrap().len() >= 2, "{} posts", posts.lock().unwrap().len());
    let all = spans(&posts);
    let mut ids: Vec<&str> = all.iter().map(|span| span["spanId"].as_str().unwrap()).collect();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), all.len());
    let spans: Vec<&Value> = all.iter().filter(|span| span["kind"] == 2).collect();
    assert_eq!(spans.len(), 1 + 700 + 1 + 1);
    for span in &all {
        assert!(time(span, "startTimeUnixNano") < time(span, "endTimeUnixNano"), "{span}");
        assert_eq!((span["traceId"].as_str().unwrap().len(), span["spanId"].as_str().unwrap().len()), (32, 16));
    }
    let named = |name: &'static str| spans.iter().filter(move |span| span["name"] == name);
    let created = named("POST /contacts").next().unwrap();
    assert_eq!(parts(&all, created), ["parse", "write", "store"]);
    for moved in named("POST /contacts/{id}/move").filter(|span| *attribute(span, "http.response.status_code") == "200")
    {
        assert_eq!(parts(&all, moved), ["parse", "solve", "write", "store"]);
        assert_eq!(moved["parentSpanId"].as_str().unwrap_or_default(), "");
        assert_eq!(*attribute(moved, "http.request.method"), "POST");
        assert_eq!(*attribute(moved, "http.route"), "/contacts/{id}/move");
        assert_eq!(attribute(moved, "error.type"), &Value::Null);
    }
    let refused = spans.iter().find(|span| attribute(span, "http.response.status_code") == "422").unwrap();
    assert_eq!(refused["name"], "POST /contacts/{id}/move");
    assert_eq!(*attribute(refused, "error.type"), "force_exceeds_friction");
    // A refusal is no failure of the server.
    assert_ne!(refused["status"]["code"], 2);
    let traced: Vec<&Value> = spans.iter().copied().filter(|span| span["traceId"] == trace).collect();
    assert_eq!(traced.len(), 1);
    assert_eq!(
        (&traced[0]["parentSpanId"], attribute(traced[0], "stickslip.request_id")),
        (&"b7ad6b7169203331".into(), &"mine".into())
    );
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn an_unreachable_collector_costs_only_traces() {
    let server = Process::with("memory:", &["--otlp-endpoint", "http://127.0.0.1:1"]);
    let id = server.client.create(&create(), &Options::default()).await.unwrap().id;
    server.client.apply(id, &Move::displacement(1e-9).into(), &Options::default()).await.unwrap();
    // Time for a batch to fail; the next one fails at the end.
    tokio::time::sleep(Duration::from_millis(1_500)).await;
    server.client.apply(id, &Move::displacement(2e-9).into(), &Options::default()).await.unwrap();
    let log = server.stop().await;
    let warnings: Vec<&str> = log.lines().filter(|line| line.contains("WARN") && line.contains("traces")).collect();
    assert_eq!(warnings.len(), 1, "{log}");
    assert!(warnings[0].contains("traces cannot be sent"), "{log}");
    for wrong in ["ftp://localhost:4318", "localhost:4318", "http://", "https://", "https://a b"] {
        let output = common::run(&["serve", "--otlp-endpoint", wrong]);
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(!output.status.success() && said.contains("--otlp-endpoint"), "{said}");
    }
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn a_collector_that_never_answers_holds_up_neither_requests_nor_the_end() {
    let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let base = format!("http://{}", listener.local_addr().unwrap());
    let silent = Router::new().route("/v1/traces", post(async || pending::<()>().await));
    tokio::spawn(axum::serve(listener, silent).into_future());
    let server = Process::with("memory:", &["--otlp-endpoint", &base, "--log", "warn"]);
    let id = server.client.create(&create(), &Options::default()).await.unwrap().id;
    for _ in 0..1_000 {
        let increment = Move { relative: true, ..Move::displacement(1e-10) };
        server.client.apply(id, &increment.into(), &Options::default()).await.unwrap();
    }
    server.stop().await;
}

/// A listener for TLS, for a collector.
struct Tls {
    listener: TcpListener,
    acceptor: TlsAcceptor,
}

impl Listener for Tls {
    type Io = TlsStream<TcpStream>;
    type Addr = SocketAddr;

    async fn accept(&mut self) -> (Self::Io, Self::Addr) {
        loop {
            let (stream, address) = self.listener.accept().await.unwrap();
            // A client that does not trust the certificate breaks off.
            if let Ok(stream) = self.acceptor.accept(stream).await {
                return (stream, address);
            }
        }
    }

    fn local_addr(&self) -> std::io::Result<SocketAddr> {
        self.listener.local_addr()
    }
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn spans_travel_by_https_to_a_collector_that_is_trusted_and_to_no_other() {
    let made = rcgen::generate_simple_self_signed(vec!["localhost".to_owned()]).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let trusted = folder.path().join("trusted.pem");
    std::fs::write(&trusted, made.cert.pem()).unwrap();
    let key = PrivateKeyDer::try_from(made.signing_key.serialize_der()).unwrap();
    let config = ServerConfig::builder_with_provider(Arc::new(ring::default_provider()));
    let config = config.with_safe_default_protocol_versions().unwrap().with_no_client_auth();
    let config = config.with_single_cert(vec![made.cert.der().clone()], key).unwrap();
    let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let base = format!("https://localhost:{}", listener.local_addr().unwrap().port());
    let (router, posts) = receiver();
    tokio::spawn(axum::serve(Tls { listener, acceptor: Arc::new(config).into() }, router).into_future());

    let stranger = rcgen::generate_simple_self_signed(vec!["localhost".to_owned()]).unwrap();
    let strange = folder.path().join("strange.pem");
    std::fs::write(&strange, stranger.cert.pem()).unwrap();
    for (roots, arrived) in [(strange, 0), (trusted, 1)] {
        let log = folder.path().join("log");
        let mut command = binary(&["serve", "--listen", "127.0.0.1:0", "--store", "memory:", "--otlp-endpoint", &base]);
        command.env("SSL_CERT_FILE", &roots).env_remove("SSL_CERT_DIR").stderr(std::fs::File::create(&log).unwrap());
        let server = Process::of(command).await;
        server.client.healthz().await.unwrap();
        server.stop().await;
        let found = spans(&posts).iter().filter(|span| span["name"] == "GET /healthz").count();
        assert_eq!(found, arrived, "{}", std::fs::read_to_string(log).unwrap());
    }
}

#[test]
fn a_parent_is_accepted_as_the_standard_defines_it() {
    let of = |header: &str| {
        let headers = HeaderMap::from_iter([("traceparent".parse().unwrap(), HeaderValue::from_str(header).unwrap())]);
        let context = parent(&headers)?;
        let span = context.span().span_context().clone();
        Some((span.span_id().to_string(), span.is_sampled()))
    };
    let trace = "0af7651916cd43dd8448eb211c80319c";
    assert_eq!(of(&format!("00-{trace}-b7ad6b7169203331-01")), Some(("b7ad6b7169203331".to_owned(), true)));
    assert_eq!(of(&format!("00-{trace}-b7ad6b7169203331-00")), Some(("b7ad6b7169203331".to_owned(), false)));
    assert_eq!(of(&format!("cc-{trace}-b7ad6b7169203331-01-more")), Some(("b7ad6b7169203331".to_owned(), true)));
    for wrong in [
        "",
        "00",
        &format!("00-{trace}-b7ad6b7169203331-01-more"),
        &format!("ff-{trace}-b7ad6b7169203331-01"),
        &format!("00-{trace}-0000000000000000-01"),
        &format!("00-{}-b7ad6b7169203331-01", "0".repeat(32)),
        &format!("00-{}-b7ad6b7169203331-01", trace.to_uppercase()),
        &format!("00-{trace}-b7ad6b71692033-01"),
    ] {
        assert_eq!(of(wrong), None, "{wrong}");
    }
}
