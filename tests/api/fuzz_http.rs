//! Random requests over HTTP to the real binary: no 5xx but for overload, no panic, and each refusal is a problem
//! document that names the place of the fault in the body.
//!
//! Requests are the examples of the OpenAPI document, for every path and method, damaged as the bodies of the harness
//! are; Schemathesis makes others from the schemas (`tests/docs/clients.rs`). Raw sockets get requests with random
//! bytes. The number of cases is fixed, and case n is the same on every run and every machine, as is the order of cases
//! on each contact. `STICKSLIP_LONG=1` and `STICKSLIP_FUZZ_CASES` ask for other numbers of each kind,
//! `STICKSLIP_FUZZ_SEED` for other cases.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use futures::future::join_all;
use percent_encoding::{NON_ALPHANUMERIC, utf8_percent_encode};
use proptest::strategy::{Strategy as _, ValueTree as _};
use proptest::test_runner::TestRunner;
use reqwest::{Method, Response};
use serde::de::IgnoredAny;
use serde_json::{Value, json};
use stickslip_wire::ProblemDocument;
use stickslip_wire::client::Options;

use crate::cases::{case_count, runner, seed};
use crate::common::kill::Random;
use crate::common::openapi::{document, examples, operations};
use crate::common::raw::{Service, get, post};
use crate::common::{PATIENCE, ball, create};
use crate::damage::damage;

/// Tasks that send requests at the same time. Each has its own contacts.
const TASKS: u64 = 8;
const CONTACTS_PER_TASK: usize = 2;

/// Runs so many cases in several tasks; `case` gets the index of its task and the number of the case.
async fn run(numbers: [u64; 2], case: impl AsyncFn(usize, u64, &mut Random) + Clone) {
    let (cases, seed, start) = (case_count(numbers), seed(), Instant::now());
    let tasks = (0..TASKS).map(async |task| {
        // Every task has cases of its own, so that the speed of the others does not change their order.
        for number in (task..cases).step_by(TASKS as usize) {
            let mut random = Random(seed.wrapping_mul(0x9e37_79b9).wrapping_add(number << 20));
            case(task as usize, number, &mut random).await;
        }
    });
    join_all(tasks).await;
    println!("seed {seed}: {cases} cases in {:?}", start.elapsed());
}

/// A request to send.
#[derive(Debug)]
struct Request {
    method: String,
    target: String,
    headers: Vec<(&'static str, String)>,
    body: Option<String>,
    /// The media type of the body.
    kind: &'static str,
    /// Whether only the body can be at fault, and is JSON.
    body_alone: bool,
}

fn pick<'a, T>(all: &'a [T], random: &mut Random) -> &'a T {
    &all[random.below(all.len() as u64) as usize]
}

/// A value of a parameter: one of its names, or a word that may be no value of it.
fn parameter(document: &Value, schema: &Value, random: &mut Random) -> String {
    let of = |schema: &Value| schema["$ref"].as_str().and_then(|at| document.pointer(&at[1..])).cloned();
    let schema = of(schema).unwrap_or_else(|| schema.clone());
    let names = schema["enum"].as_array().or(schema["items"]["enum"].as_array());
    match names.filter(|_| random.below(4) > 0) {
        Some(names) => pick(names, random).as_str().unwrap_or("1").to_owned(),
        None => {
            const WORDS: [&str; 14] =
                ["1", "2", "7", "40", "0", "-1", "1e-8", "1e-9,2e-9", "1e999", "", "true", "x y", "\0\u{202e}", "NaN"];
            pick(&WORDS, random).to_string()
        }
    }
}

fn request(document: &Value, contacts: &[String], number: u64, random: &mut Random) -> Request {
    let operations: Vec<_> = operations(document).collect();
    let (method, path, operation) = pick(&operations, random);
    let id = match random.below(8) {
        0 => "01890a5d-ac96-774b-bcce-b302099a8057".to_owned(),
        1 => {
            utf8_percent_encode(pick::<&str>(&["", "..", "é", "\0", "a b", "7"], random), NON_ALPHANUMERIC).to_string()
        }
        _ => pick(contacts, random).clone(),
    };
    let mut target = path.replace("{id}", &id).replace("{code}", pick::<&str>(&["not_json", "none", "%ff"], random));
    let (mut query, mut headers) = (Vec::new(), Vec::new());
    for described in operation["parameters"].as_array().into_iter().flatten() {
        if random.below(2) == 0 {
            continue;
        }
        let text = parameter(document, &described["schema"], random);
        match (described["in"].as_str(), described["name"].as_str().unwrap()) {
            (Some("query"), name) => query.push(format!("{name}={}", utf8_percent_encode(&text, NON_ALPHANUMERIC))),
            (Some("header"), "If-Match") => headers.push(("if-match", format!("\"{}\"", random.below(3)))),
            (Some("header"), "Idempotency-Key") => headers.push(("idempotency-key", text)),
            (Some("header"), "Last-Event-ID") => headers.push(("last-event-id", random.below(5).to_string())),
            _ => {}
        }
    }
    headers.retain(|(_, value)| reqwest::header::HeaderValue::from_str(value).is_ok());
    if !query.is_empty() {
        target = format!("{target}?{}", query.join("&"));
    }
    let examples = examples(document, operation);
    let (mut body, mut kind, mut body_alone) = (None, "application/json", headers.is_empty());
    if !examples.is_empty() {
        let example = pick(&examples, random);
        let mut bytes = example.as_str().map_or_else(|| example.to_string(), str::to_owned).into_bytes();
        let mut runner = runner(seed(), number);
        for _ in 0..random.below(4) {
            bytes = match example {
                Value::String(_) => damaged(bytes, &mut runner, random),
                _ => damage().new_tree(&mut runner).unwrap().current().apply(bytes),
            };
        }
        let text = String::from_utf8_lossy(&bytes).into_owned();
        body_alone &= example.is_object() && serde_json::from_str::<Value>(&text).is_ok_and(|body| body.is_object());
        kind = if example.is_object() { kind } else { "text/csv" };
        body = Some(text);
    }
    let mut method = method.clone();
    if random.below(20) == 0 {
        method =
            pick(&["GET", "POST", "PUT", "DELETE", "PATCH", "HEAD", "OPTIONS", "TRACE", "FROB"], random).to_string();
        body_alone = false;
    }
    Request { method, target, headers, body, kind, body_alone }
}

/// Checks a reply; the request is for the message.
async fn examine(request: &Request, response: Response, number: u64) {
    let shown = || format!("case {number}: {request:?}").chars().take(3_000).collect::<String>();
    let status = response.status().as_u16();
    assert!(status < 500 || status == 503, "{status} for {}", shown());
    let streams = response.headers().get("content-type").is_some_and(|kind| kind == "text/event-stream");
    if streams || request.method == "HEAD" {
        return;
    }
    let again = response.headers().contains_key("retry-after");
    let kind = response.headers().get("content-type").map(|kind| kind.to_str().unwrap().to_owned());
    let body = response.bytes().await.unwrap_or_else(|error| panic!("{error} for {}", shown()));
    if status < 400 {
        if kind.as_deref() == Some("application/json") {
            serde_json::from_slice::<IgnoredAny>(&body).unwrap_or_else(|error| panic!("{error} for {}", shown()));
        }
        return;
    }
    let problem: ProblemDocument = serde_json::from_slice(&body)
        .unwrap_or_else(|error| panic!("{error}: {} for {}", String::from_utf8_lossy(&body), shown()));
    assert_eq!((kind.as_deref(), problem.status), (Some("application/problem+json"), status), "{}", shown());
    assert!(status != 503 || again, "{}", shown());
    let text = request.body.as_deref().unwrap_or_default();
    if problem.code == "not_json" {
        assert!(serde_json::from_str::<IgnoredAny>(text).is_err(), "JSON, and refused as none: {}", shown());
    }
    if request.body_alone && request.body.is_some() && status == 422 {
        assert!(!problem.errors.is_empty(), "no place in {problem:?} for {}", shown());
        let body: Value = serde_json::from_str(text).unwrap();
        for fault in &problem.errors {
            let parent = fault.pointer.rsplit_once('/').map_or("", |(parent, _)| parent);
            // A very long pointer is shortened.
            let found = body.pointer(parent).is_some() || fault.pointer.ends_with('…');
            assert!(found, "{} is no place in {}", fault.pointer, shown());
        }
    }
}

fn service() -> Arc<Service> {
    Arc::new(Service::start(&["--log", "error", "--deadline", "2s", "--cache-bytes", "32MiB", "--body-time", "2s"]))
}

/// Fails if the log has an error: it has a line for each 5xx but those of overload.
fn assert_log_is_clean(service: &Service) {
    let log = service.log();
    let errors: Vec<&str> = log.lines().filter(|line| !line.contains("overloaded")).take(5).collect();
    assert!(errors.is_empty(), "{errors:#?}");
    println!("peak memory {} MiB", service.peak() >> 20);
}

#[tokio::test]
async fn damaged_examples_of_every_operation() {
    let (service, document) = (service(), document());
    let mut contacts = Vec::new();
    for _ in 0..TASKS as usize * CONTACTS_PER_TASK {
        contacts.push(service.client.create(&create(), &Options::default()).await.unwrap().id.to_string());
    }
    let (http, answered, refused) = (reqwest::Client::new(), AtomicU64::new(0), AtomicU64::new(0));
    let base = &service.base;
    let contacts: Vec<&[String]> = contacts.chunks(CONTACTS_PER_TASK).collect();
    run([10_000, 50_000], async |task, number, random| {
        let request = request(&document, contacts[task], number, random);
        // Most cases should find their contact.
        if request.method == "DELETE" && number % 50 != 0 {
            return;
        }
        let method = Method::from_bytes(request.method.as_bytes()).unwrap();
        let mut call = http.request(method, format!("{base}{}", request.target)).timeout(PATIENCE);
        for (name, value) in &request.headers {
            call = call.header(*name, value);
        }
        if let Some(body) = &request.body {
            call = call.header("content-type", request.kind).body(body.clone());
        }
        // The server closes a connection whose request it did not read to the end, perhaps as the next one is sent on
        // it.
        let mut sent = call.try_clone().unwrap().send().await;
        for _ in 0..3 {
            if sent.is_err() {
                sent = call.try_clone().unwrap().send().await;
            }
        }
        match sent {
            Ok(response) => {
                let count = if response.status().is_success() { &answered } else { &refused };
                count.fetch_add(1, Ordering::Relaxed);
                examine(&request, response, number).await;
            }
            Err(error) => panic!("{error:?} for case {number}: {request:?}"),
        }
    })
    .await;
    let (answered, refused) = (answered.into_inner(), refused.into_inner());
    println!("{answered} answered, {refused} refused");
    assert!(answered > 0 && refused > 0);
    assert_log_is_clean(&service);
}

#[tokio::test]
async fn bytes_on_the_socket() {
    let service = service();
    let id = service.client.create(&create(), &Options::default()).await.unwrap().id;
    let sound = [
        post("/simulate", &json!({"contact": ball(), "path": {"force": [0.1]}}).to_string()),
        post(&format!("/contacts/{id}/move"), r#"{"displacement": 1e-8}"#),
        get(&format!("/contacts/{id}/stress?points=5")),
        "POST /simulate HTTP/1.1\r\nhost: localhost\r\ncontent-type: application/json\r\ntransfer-encoding: \
         chunked\r\n\r\n5\r\n{\"a\":\r\n2\r\n1}\r\n0\r\n\r\n"
            .to_owned(),
    ];
    run([15_000, 60_000], async |_, number, random| {
        let mut bytes = pick(&sound, random).clone().into_bytes();
        if random.below(6) == 0 {
            bytes = (0..random.below(3_000)).map(|_| random.next() as u8).collect();
        }
        let mut runner = runner(seed(), number);
        for _ in 0..1 + random.below(4) {
            bytes = damaged(bytes, &mut runner, random);
        }
        let answer = service.send_all(&bytes).await;
        let shown = || format!("case {number}: {}", String::from_utf8_lossy(&bytes));
        assert!(
            answer.statuses.iter().all(|status| *status < 500 || *status == 503),
            "{} for {}",
            answer.text,
            shown()
        );
    })
    .await;
    assert!(service.client.contact(id).await.is_ok());
    assert_log_is_clean(&service);
}

/// A damage of the harness, or of those that a head and the end of a message can have.
fn damaged(mut bytes: Vec<u8>, runner: &mut TestRunner, random: &mut Random) -> Vec<u8> {
    const WORDS: &str = "\r\n|\n|\0|\r\nContent-Length: 3|\r\nTransfer-Encoding: chunked|%00| |\r\n\r\n|\
        \r\nExpect: 100-continue";
    let place = random.below(bytes.len() as u64 + 1) as usize;
    match random.below(6) {
        0 => bytes.truncate(place),
        1 => drop(bytes.splice(place..place, std::iter::repeat_n(b'a', 40_000))),
        2 => drop(bytes.splice(place..place, pick(&WORDS.split('|').collect::<Vec<_>>(), random).bytes())),
        _ => return damage().new_tree(runner).unwrap().current().apply(bytes),
    }
    bytes
}
