//! Moves a second by store, against a bare handler: `cargo bench --bench service`. Needs PostgreSQL, as the tests do.
//!
//! `POST /contacts/{id}/move` at 32 connections over 256 contacts, by each store, as a ratio to the baseline: an axum
//! handler in its own process that parses the same body and writes a reply of the same shape. All take turns in every
//! round, so that a busy machine slows them alike. The load comes from plain sockets, because it shares the processors
//! with the service. Another build, whose path is in `OTHER_BUILD`, takes its turns too.

#[path = "../tests/common/port.rs"]
mod port;
#[allow(dead_code, reason = "the benchmark uses a part of it")]
#[path = "../tests/common/postgres.rs"]
mod postgres;

mod load;

use std::process::Command;
use std::time::{Duration, Instant};

use axum::extract::Path;
use axum::routing::post;
use axum::{Json, Router};
use load::{CONTACT, Connection, Process, baseline, join, median, serve, serve_other};
use stickslip_wire::{MoveReply, MoveRequest};
use tokio::net::TcpListener;
use uuid::Uuid;

const CONNECTIONS: usize = 32;
const CONTACTS: usize = 256;
// Many short rounds: the median of few long ones differed by 7 % between two runs of one program.
const ROUNDS: usize = 12;
const ROUND: Duration = Duration::from_millis(1500);

/// A server of moves, and its measurements.
struct Service {
    name: &'static str,
    process: Process,
    paths: Vec<String>,
    rates: Vec<f64>,
    /// Processor time of the server a move, s, by round.
    costs: Vec<f64>,
}

impl Service {
    async fn start(name: &'static str, command: Command) -> Service {
        let process = Process::start(command);
        let mut service = Service { name, process, paths: Vec::new(), rates: Vec::new(), costs: Vec::new() };
        let mut connection = Connection::open(&service.process.address).await;
        for _ in 0..CONTACTS {
            let id = if name == "baseline" { Uuid::now_v7() } else { connection.create().await };
            service.paths.push(format!("/contacts/{id}/move"));
        }
        service
    }

    /// Makes moves over all connections for a while.
    async fn round(&mut self) {
        let (start, used) = (Instant::now(), self.process.processor_seconds());
        let workers = self.paths.chunks(CONTACTS / CONNECTIONS).map(|paths| {
            let (paths, address) = (paths.to_vec(), self.process.address.clone());
            tokio::spawn(async move {
                let mut connection = Connection::open(&address).await;
                let mut count = 0_u32;
                while start.elapsed() < ROUND {
                    for path in &paths {
                        let sign = if count.is_multiple_of(2) { 1.0 } else { -1.0 };
                        let target = sign * (1.0 + f64::from(count % 97)) * 1e-9;
                        connection.post(path, format!(r#"{{"displacement":{target:e}}}"#).as_bytes()).await;
                        count += 1;
                    }
                }
                count
            })
        });
        let count: u32 = join(workers).await.into_iter().sum();
        self.rates.push(f64::from(count) / start.elapsed().as_secs_f64());
        self.costs.push((self.process.processor_seconds() - used) / f64::from(count));
    }
}

/// Serves the baseline: parses the same body and writes a reply of the same shape.
async fn serve_baseline() {
    let reply = stickslip_compute::simulation::simulate(
        &stickslip_wire::read::<stickslip_wire::SimulateRequest>(
            format!(r#"{{"contact":{CONTACT},"path":{{"displacement":[1e-7]}}}}"#).as_bytes(),
        )
        .expect("a sound request"),
        &stickslip_compute::Flag::default(),
    )
    .expect("a reply");
    let handler = move |Path(id): Path<Uuid>, Json(request): Json<MoveRequest>| async move {
        std::hint::black_box(request);
        Json(MoveReply {
            id,
            sequence: 1,
            state: reply.steps[0],
            stress: None,
            accuracy: reply.accuracy,
            warnings: Vec::new(),
        })
    };
    let router = Router::new().route("/contacts/{id}/move", post(handler));
    let listener = TcpListener::bind("127.0.0.1:0").await.expect("a free port");
    println!("baseline on http://{}", listener.local_addr().expect("an address"));
    axum::serve(listener, router).await.expect("a server");
}

async fn compare() {
    let folder = std::env::temp_dir().join(format!("stickslip-bench-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a temporary folder");
    let file = format!("sqlite:{}", folder.join("bench.db").display());
    let cluster = postgres::Cluster::shared();
    let mut services = vec![
        Service::start("baseline", baseline()).await,
        Service::start("memory", serve("memory:")).await,
        Service::start("sqlite", serve(&file)).await,
        Service::start("postgres", serve(&cluster.database().await)).await,
    ];
    let other_file = format!("sqlite:{}", folder.join("other.db").display());
    let other_database = cluster.database().await;
    for (name, store) in [
        ("memory, other build", "memory:"),
        ("sqlite, other build", &other_file),
        ("postgres, other build", &other_database),
    ] {
        if let Some(command) = serve_other(store) {
            services.push(Service::start(name, command).await);
        }
    }
    for _ in 0..ROUNDS {
        for service in &mut services {
            service.round().await;
        }
    }
    let baseline_rates = services[0].rates.clone();
    println!("| store | moves a second | ratio to the baseline | of rounds | processor time a move |");
    println!("|---|---|---|---|---|");
    for Service { name, rates, costs, .. } in &services {
        let ratios: Vec<f64> = rates.iter().zip(&baseline_rates).map(|(rate, baseline)| rate / baseline).collect();
        let (least, most) =
            (ratios.iter().copied().fold(f64::INFINITY, f64::min), ratios.iter().copied().fold(0.0, f64::max));
        let (rate, ratio, cost) = (median(rates), median(&ratios), 1e6 * median(costs));
        println!("| {name} | {rate:.0} | {ratio:.2} | {least:.2} to {most:.2} | {cost:.1} us |");
    }
    drop(services);
    std::fs::remove_dir_all(&folder).expect("the temporary folder");
}

#[tokio::main]
async fn main() {
    if std::env::args().any(|argument| argument == "baseline") {
        serve_baseline().await;
    } else {
        compare().await;
    }
}
