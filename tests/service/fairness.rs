//! Fairness, on the real binary: heavy requests and jobs of some clients do not keep the threads from others.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use crate::common::raw::{Service, get, post};
use crate::common::{PATIENCE, ball, long_simulation, metric};
use futures::future::join_all;
use serde_json::{Value, json};
use tokio::io::AsyncWriteExt as _;
use tokio::net::TcpStream;
use tokio::time::{sleep, timeout};

/// The address of the client that is to be served all the same.
const HONEST: &str = "127.0.0.2";

/// A body of revolution whose search for extrema is long: its kernel does not fall everywhere.
fn power_law() -> Value {
    json!({"profile": {"type": "power_law", "exponent": 2.37, "coefficient": 50.0},
        "material": {"effective": {"e_star": 1.2e11, "g_star": 9.6e10}},
        "friction": 0.3, "preload": {"indentation": 1e-6}})
}

fn search(reversals: usize) -> Value {
    json!({"contact": power_law(), "path": {"falling_amplitude": {"reversals": reversals}}, "steps": "last",
        "residual": true})
}

fn heavy_job() -> String {
    json!({"base": search(4_000), "axes": [{"pointer": "/contact/friction",
        "linear": {"from": 0.1, "to": 0.6, "count": 200}}],
        "outputs": ["/residual/max"], "job": true})
    .to_string()
}

/// Sends heavy requests of two kinds, each from an address of its own, and does not wait for the replies.
async fn send_heavy(service: &Service, number: usize) -> Vec<TcpStream> {
    let requests = [search(9_000), long_simulation()].map(|body| post("/simulate", &body.to_string()));
    let sent = (0..number).map(|index| {
        let request = &requests[index % 2];
        async move {
            let mut stream = service.connect_from(&format!("127.0.0.{}", 10 + index)).await.unwrap();
            stream.write_all(request.as_bytes()).await.unwrap();
            stream
        }
    });
    join_all(sent).await
}

/// A call that needs a thread, short enough to be interactive, and one that needs none.
fn ordinary() -> [(&'static str, String); 3] {
    let short = json!({"contact": ball(), "path": {"falling_amplitude": {"reversals": 20}}, "stress": {"points": 200},
        "residual": true});
    [
        ("simulate, ball", post("/simulate", &short.to_string())),
        ("simulate, power law", post("/simulate", &search(60).to_string())),
        ("protocols, 5 reversals", post("/protocols", &json!({"contact": ball(), "reversals": 5}).to_string())),
    ]
}

async fn time_of(service: &Service, request: &str) -> Duration {
    let begin = Instant::now();
    let answer = service.ask(HONEST, request).await.expect("an answer");
    assert_eq!(answer.statuses, [200], "{}", answer.text);
    begin.elapsed()
}

#[tokio::test]
async fn heavy_requests_and_a_job_leave_threads_to_others() {
    let service = Arc::new(Service::start(&["--log", "warn", "--max-wait", "5s"]));
    assert_eq!(service.ask("127.0.0.9", &post("/sweep", &heavy_job())).await.unwrap().statuses, [202]);
    let heavy = send_heavy(&service, 8).await;
    sleep(Duration::from_millis(200)).await;
    // Each of these was refused after `--max-wait` while heavy work held all threads, however long that took.
    for _ in 0..3 {
        for (name, request) in ordinary() {
            let served = timeout(PATIENCE, time_of(&service, &request)).await;
            println!("{name}: {:?}", served.expect("an answer in time"));
        }
    }
    let running = metric(&service.base, "stickslip_solver_running").await;
    assert!(running >= 2, "the heavy work has not ended: {running}");
    drop(heavy);
}

/// `cargo test --test service fairness -- --ignored --nocapture` prints the figures of docs/overload.md.
#[tokio::test]
#[ignore = "takes minutes, and measures times"]
async fn an_ordinary_call_takes_at_most_twice_its_time_and_a_tenth_of_a_second() {
    const CALLS: usize = 100;
    let service = Arc::new(Service::start(&["--log", "warn"]));
    let mut alone = Vec::new();
    for (_, request) in &ordinary() {
        let mut times = Vec::new();
        for _ in 0..20 {
            times.push(time_of(&service, request).await);
        }
        times.sort();
        alone.push(times[times.len() / 2]);
    }
    assert_eq!(service.ask("127.0.0.9", &post("/sweep", &heavy_job())).await.unwrap().statuses, [202]);
    let heavy = send_heavy(&service, 8).await;
    sleep(Duration::from_secs(1)).await;
    for ((name, request), own) in ordinary().iter().zip(alone) {
        let mut times = Vec::new();
        for _ in 0..CALLS {
            times.push(time_of(&service, request).await);
        }
        times.sort();
        let (median, most) = (times[CALLS / 2], times[CALLS - 2]);
        println!("{name}: alone {own:?}; beside 8 heavy requests and a job {median:?}, 99 of 100 within {most:?}");
        assert!(most <= 2 * own + Duration::from_millis(100), "{name}: {most:?}, alone {own:?}");
    }
    drop(heavy);
}

/// A simulation whose table of 10 000 points is not that of any other.
fn tabulated(number: usize) -> String {
    let radius = 0.01 * (1.0 + 1e-6 * number as f64);
    let radii: Vec<_> = (0..10_000).map(|index| 1e-7 * f64::from(index)).collect();
    let heights: Vec<_> = radii.iter().map(|r| r * r / (2.0 * radius)).collect();
    let mut contact = ball();
    contact["profile"] = json!({"type": "tabulated", "r": radii, "z": heights});
    post("/simulate", &json!({"contact": contact, "path": {"displacement": [1e-8]}}).to_string())
}

/// `cargo test --test service beside_clients_that_send_tables -- --ignored --nocapture` prints the figures of
/// docs/overload.md.
#[tokio::test]
#[ignore = "measures times"]
async fn a_short_call_beside_clients_that_send_tables() {
    const SENDERS: usize = 8;
    let (name, short) = &ordinary()[1];
    for (kind, different) in [("ever new", 1_000), ("the same", 0)] {
        let service = Arc::new(Service::start(&["--log", "warn"]));
        let mut times = Vec::new();
        for _ in 0..50 {
            times.push(time_of(&service, short).await);
        }
        times.sort();
        let alone = times[25];
        let (bodies, sent) = (Arc::new(AtomicUsize::new(0)), Arc::new(AtomicUsize::new(0)));
        let senders: Vec<_> = (0..SENDERS)
            .map(|sender| {
                let (service, bodies, sent) = (Arc::clone(&service), Arc::clone(&bodies), Arc::clone(&sent));
                tokio::spawn(async move {
                    let address = format!("127.0.0.{}", 10 + sender);
                    loop {
                        let number = bodies.fetch_add(1, Ordering::Relaxed) * different / 1_000;
                        let answer = service.ask(&address, &tabulated(number)).await.expect("an answer");
                        assert_eq!(answer.statuses, [200], "{}", answer.text);
                        sent.fetch_add(1, Ordering::Relaxed);
                    }
                })
            })
            .collect();
        while sent.load(Ordering::Relaxed) < SENDERS {
            sleep(Duration::from_millis(50)).await;
        }
        let mut times = Vec::new();
        for _ in 0..100 {
            times.push(time_of(&service, short).await);
        }
        times.sort();
        let served = sent.load(Ordering::Relaxed);
        println!(
            "{name}: alone {alone:?}; beside {SENDERS} clients that send {kind} tables of 10 000 points (of which \
             {served} were answered) {:?}, 99 of 100 within {:?}",
            times[50], times[98]
        );
        senders.iter().for_each(tokio::task::JoinHandle::abort);
    }
}

#[tokio::test]
async fn contacts_beyond_the_quota_are_refused_by_its_name_until_some_are_deleted() {
    let service = Service::start(&["--max-contacts-per-tenant", "2", "--log", "warn"]);
    let create = post("/contacts", &ball().to_string());
    let mut made = Vec::new();
    for _ in 0..2 {
        let answer = service.ask(HONEST, &create).await.unwrap();
        assert_eq!(answer.statuses, [201], "{}", answer.text);
        made.push(answer.text.split("\"id\":\"").nth(1).unwrap()[..36].to_owned());
    }
    for request in [create.clone(), post(&format!("/contacts/{}/fork", made[0]), "{}")] {
        let refused = service.ask(HONEST, &request).await.unwrap();
        assert_eq!(refused.statuses, [429], "{}", refused.text);
        for part in ["quota_exceeded", "max-contacts-per-tenant", "retry-after: "] {
            assert!(refused.text.contains(part), "{}", refused.text);
        }
    }
    let delete = get(&format!("/contacts/{}", made[0])).replacen("GET", "DELETE", 1);
    assert_eq!(service.ask(HONEST, &delete).await.unwrap().statuses, [204]);
    // At once.
    assert_eq!(service.ask(HONEST, &create).await.unwrap().statuses, [201]);
}

#[tokio::test]
async fn a_search_that_cannot_end_in_time_is_refused_at_once_with_what_would_fit() {
    let service = Service::start(&["--deadline", "1s", "--log", "warn"]);
    let refused = service.ask(HONEST, &post("/simulate", &search(99_999).to_string())).await.unwrap();
    assert_eq!(refused.statuses, [422], "{}", refused.text);
    for part in ["too_much_work", "\"pointer\":\"/residual\"", "is estimated at", "pieces are possible"] {
        assert!(refused.text.contains(part), "{part}: {}", refused.text);
    }
    let axes = json!([{"pointer": "/contact/friction", "values": [0.1, 0.2]}]);
    let job = json!({"base": search(99_999), "axes": axes, "outputs": ["/residual/max"], "job": true});
    let refused = service.ask(HONEST, &post("/sweep", &job.to_string())).await.unwrap();
    assert_eq!(refused.statuses, [422], "{}", refused.text);
    assert!(refused.text.contains("a point is estimated at"), "{}", refused.text);
}
