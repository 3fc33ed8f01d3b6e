//! The cost of a whole request and of its parts: `cargo bench --bench request`.
//!
//! `POST /simulate` of 20 reversals with the stress at 200 radii, at 8 connections, against two baseline handlers in
//! another process: one parses the same body and writes the same reply, computed once; one returns finished bytes. All
//! take turns in every round, and so does the build whose path is in `OTHER_BUILD`. Then, without HTTP, the cost of
//! parsing, solving and writing, and of writing a number.

mod load;

use std::hint::black_box;
use std::sync::Arc;
use std::time::{Duration, Instant};

use axum::Router;
use axum::body::Bytes;
use axum::routing::post;
use load::{Connection, Process, baseline, join, median, serve, serve_other};
use stickslip_compute::Flag;
use stickslip_compute::simulation::simulate;
use stickslip_wire::{SimulateReply, SimulateRequest, read};
use tokio::net::TcpListener;
use tokio::runtime::Handle;
use tokio::task::spawn_blocking;

const BODY: &str = concat!(
    r#"{"contact":{"profile":{"type":"sphere","radius":0.01},"friction":0.3,"preload":{"normal_force":10},"#,
    r#""material":{"effective":{"e_star":1.15e11,"g_star":8.5e10}}},"#,
    r#""path":{"falling_amplitude":{"reversals":20}},"stress":{"points":200}}"#,
);
const CONNECTIONS: usize = 8;
const ROUNDS: usize = 7;
const ROUND: Duration = Duration::from_secs(2);
/// Calls in one measurement of a part, and number of measurements.
const CALLS: usize = 200;
const MEASUREMENTS: usize = 31;

fn reply() -> SimulateReply {
    let request = read::<SimulateRequest>(BODY.as_bytes()).expect("a sound request");
    simulate(&request, &Flag::default()).expect("a reply")
}

/// Serves the two baseline handlers.
async fn serve_baseline() {
    let reply = Arc::new(reply());
    let finished = Bytes::from(serde_json::to_vec(&*reply).expect("a reply as JSON"));
    let json = [("content-type", "application/json")];
    let both = move |body: Bytes| async move {
        black_box(serde_json::from_slice::<SimulateRequest>(&body).expect("a sound request"));
        (json, serde_json::to_vec(&*reply).expect("a reply as JSON"))
    };
    let finished = move |_: Bytes| async move { (json, finished) };
    let router = Router::new().route("/both", post(both)).route("/finished", post(finished));
    let listener = TcpListener::bind("127.0.0.1:0").await.expect("a free port");
    println!("baseline on http://{}", listener.local_addr().expect("an address"));
    axum::serve(listener, router).await.expect("a server");
}

/// Requests a second, and the processor time of the server a request, s.
async fn round(process: &Process, path: &'static str) -> (f64, f64) {
    let (start, used, address) = (Instant::now(), process.processor_seconds(), &process.address);
    let workers = (0..CONNECTIONS).map(|_| {
        let address = address.to_owned();
        tokio::spawn(async move {
            let mut connection = Connection::open(&address).await;
            let mut count = 0_u32;
            while start.elapsed() < ROUND {
                connection.post(path, BODY.as_bytes()).await;
                count += 1;
            }
            count
        })
    });
    let count: u32 = join(workers).await.into_iter().sum();
    (f64::from(count) / start.elapsed().as_secs_f64(), (process.processor_seconds() - used) / f64::from(count))
}

async fn whole_requests() {
    let (baselines, service) = (Process::start(baseline()), Process::start(serve("memory:")));
    let other_build = serve_other("memory:").map(Process::start);
    let mut targets = vec![
        ("parses and writes", &baselines, "/both"),
        ("finished bytes", &baselines, "/finished"),
        ("stickslip", &service, "/simulate"),
    ];
    targets.extend(other_build.as_ref().map(|process| ("stickslip, other build", process, "/simulate")));
    let (mut rates, mut costs) = (vec![Vec::new(); targets.len()], vec![Vec::new(); targets.len()]);
    for _ in 0..ROUNDS {
        for (place, (_, process, path)) in targets.iter().enumerate() {
            let (rate, cost) = round(process, path).await;
            rates[place].push(rate);
            costs[place].push(cost);
        }
    }
    println!("| handler | requests a second | ratio to parsing and writing | processor time a request |");
    println!("|---|---|---|---|");
    for (place, (name, ..)) in targets.iter().enumerate() {
        let ratios: Vec<f64> = rates[place].iter().zip(&rates[0]).map(|(own, both)| own / both).collect();
        let (rate, ratio, cost) = (median(&rates[place]), median(&ratios), 1e6 * median(&costs[place]));
        println!("| {name} | {rate:.0} | {ratio:.2} | {cost:.0} us |");
    }
}

/// Median time of a call, us.
fn time<T>(mut work: impl FnMut() -> T) -> f64 {
    let times: Vec<f64> = (0..MEASUREMENTS)
        .map(|_| {
            let start = Instant::now();
            for _ in 0..CALLS {
                black_box(work());
            }
            start.elapsed().as_secs_f64() * 1e6 / CALLS as f64
        })
        .collect();
    median(&times)
}

fn parts() {
    let request = read::<SimulateRequest>(BODY.as_bytes()).expect("a sound request");
    let reply = reply();
    let bytes = serde_json::to_vec(&reply).expect("a reply as JSON").len();
    println!("\n| part | time |\n|---|---|");
    println!("| parsing {} bytes | {:.1} us |", BODY.len(), time(|| read::<SimulateRequest>(BODY.as_bytes())));
    println!("| solving | {:.1} us |", time(|| simulate(&request, &Flag::default())));
    println!("| writing {bytes} bytes | {:.1} us |", time(|| serde_json::to_vec(&reply)));
    let hand_over = || tokio::task::block_in_place(|| Handle::current().block_on(spawn_blocking(|| black_box(1))));
    println!("| a thread of the blocking pool and back | {:.1} us |", time(hand_over));
    let numbers: Vec<f64> = (1..=1_000).map(|number| 1.0 / f64::from(number)).collect();
    println!("\n| writing a number that reads back the same | time |\n|---|---|");
    let count = numbers.len() as f64;
    println!("| serde_json | {:.0} ns |", 1e3 / count * time(|| serde_json::to_vec(&numbers)));
    let display = || numbers.iter().map(f64::to_string).collect::<Vec<_>>().join(",");
    println!("| the standard library | {:.0} ns |", 1e3 / count * time(display));
}

#[tokio::main]
async fn main() {
    if std::env::args().any(|argument| argument == "baseline") {
        serve_baseline().await;
    } else {
        whole_requests().await;
        parts();
    }
}
