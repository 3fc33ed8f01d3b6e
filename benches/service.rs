//! What the service costs beside a bare handler: `cargo bench --bench service`. Needs PostgreSQL, as the tests do.
//!
//! `POST /contacts/{id}/move` at 32 connections over 256 sessions, by each store, as a ratio to an axum handler in a process of its
//! own that parses the same body and writes a reply of the same shape. All take turns in every round, so that a busy machine
//! slows them alike; the load is made by plain sockets, since it shares the processors with the service.

// Made for the tests, of which this uses a part.
#[allow(dead_code)]
#[path = "../tests/common/postgres.rs"]
mod postgres;

use std::io::{BufRead as _, BufReader};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use axum::extract::Path;
use axum::routing::post;
use axum::{Json, Router};
use stickslip::wire::{MoveReply, MoveRequest};
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::{TcpListener, TcpStream};
use uuid::Uuid;

const CONNECTIONS: usize = 32;
const SESSIONS: usize = 256;
const ROUNDS: usize = 5;
/// Parts of a second that Linux counts processor time in.
const TICKS: f64 = 100.0;
const ROUND: Duration = Duration::from_secs(3);
const CONTACT: &str = r#"{"profile":{"type":"sphere","radius":0.01},"material":{"effective":{"e_star":1.15e11,"g_star":8.5e10}},"friction":0.3,"preload":{"normal_force":10}}"#;

/// A process that serves, ended when dropped.
struct Service {
    name: &'static str,
    process: Child,
    address: String,
    paths: Vec<String>,
    rates: Vec<f64>,
    /// Seconds of processor time that a move took of the process, round by round.
    costs: Vec<f64>,
}

impl Service {
    async fn start(name: &'static str, mut command: Command) -> Service {
        let mut process =
            command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().expect("the service should start");
        let output = process.stdout.take().expect("its output is piped");
        let mut line = String::new();
        BufReader::new(output).read_line(&mut line).expect("it should say where it listens");
        let address = line.split("http://").nth(1).expect("it names an address").split([',', '\n']).next();
        let address = address.expect("an address").to_owned();
        let mut service = Service { name, process, address, paths: Vec::new(), rates: Vec::new(), costs: Vec::new() };
        for _ in 0..SESSIONS {
            let id = if name == "bare" { Uuid::now_v7() } else { service.create().await };
            service.paths.push(format!("/contacts/{id}/move"));
        }
        service
    }

    async fn create(&self) -> Uuid {
        let mut connection = Connection::open(&self.address).await;
        let reply = connection.post("/contacts", CONTACT.as_bytes()).await;
        let reply: serde_json::Value = serde_json::from_slice(reply).expect("a contact");
        serde_json::from_value(reply["id"].clone()).expect("an identifier")
    }

    /// Processor time that the process has used, in seconds.
    fn used(&self) -> f64 {
        let stat = std::fs::read_to_string(format!("/proc/{}/stat", self.process.id())).expect("a process that runs");
        // The name of the program stands in brackets, and may hold blanks.
        let fields = stat.rsplit_once(')').expect("a name in brackets").1.split_ascii_whitespace();
        let ticks: f64 = fields.skip(11).take(2).map(|ticks| ticks.parse::<f64>().expect("a number")).sum();
        ticks / TICKS
    }

    /// Makes moves over all connections for a while.
    async fn round(&mut self) {
        let (start, used) = (Instant::now(), self.used());
        let workers = self.paths.chunks(SESSIONS / CONNECTIONS).map(|paths| {
            let (paths, address) = (paths.to_vec(), self.address.clone());
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
        let counts = futures::future::join_all(workers.collect::<Vec<_>>()).await;
        let count: u32 = counts.into_iter().map(|count| count.expect("a worker that ends well")).sum();
        self.rates.push(f64::from(count) / start.elapsed().as_secs_f64());
        self.costs.push((self.used() - used) / f64::from(count));
    }
}

impl Drop for Service {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

/// As little of HTTP as a load generator needs.
struct Connection {
    stream: TcpStream,
    buffer: Vec<u8>,
}

impl Connection {
    async fn open(address: &str) -> Connection {
        let stream = TcpStream::connect(address).await.expect("the service should accept");
        stream.set_nodelay(true).expect("TCP_NODELAY");
        Connection { stream, buffer: Vec::new() }
    }

    /// The body of the reply.
    async fn post(&mut self, path: &str, body: &[u8]) -> &[u8] {
        self.buffer.clear();
        let head = format!(
            "POST {path} HTTP/1.1\r\nhost: localhost\r\ncontent-type: application/json\r\ncontent-length: {}\r\n\r\n",
            body.len()
        );
        self.buffer.extend_from_slice(head.as_bytes());
        self.buffer.extend_from_slice(body);
        self.stream.write_all(&self.buffer).await.expect("a request sent");
        self.buffer.clear();
        loop {
            assert!(self.stream.read_buf(&mut self.buffer).await.expect("a reply") > 0, "the service hung up");
            let Some(end) = self.buffer.windows(4).position(|four| four == b"\r\n\r\n") else { continue };
            let head = std::str::from_utf8(&self.buffer[..end]).expect("a head in ASCII");
            assert!(head.starts_with("HTTP/1.1 2"), "{head}");
            let length = head.lines().find_map(|line| line.strip_prefix("content-length: ")).expect("a length");
            let length: usize = length.parse().expect("a number");
            if self.buffer.len() >= end + 4 + length {
                return &self.buffer[end + 4..end + 4 + length];
            }
        }
    }
}

/// The same body in and the same shape out, with nothing between.
async fn bare() {
    let reply = stickslip::simulation::simulate(
        &stickslip::wire::read::<stickslip::wire::SimulateRequest>(
            format!(r#"{{"contact":{CONTACT},"path":{{"displacement":[1e-7]}}}}"#).as_bytes(),
        )
        .expect("a sound request"),
        &stickslip::simulation::Stop::default(),
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
    println!("bare on http://{}", listener.local_addr().expect("an address"));
    axum::serve(listener, router).await.expect("a server");
}

fn served(store: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_stickslip"));
    command.args(["serve", "--listen", "127.0.0.1:0", "--log", "warn", "--store", store]);
    command
}

async fn compare() {
    let mut itself = Command::new(std::env::current_exe().expect("the path of this program"));
    itself.arg("bare");
    let folder = std::env::temp_dir().join(format!("stickslip-bench-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a temporary folder");
    let file = format!("sqlite:{}", folder.join("bench.db").display());
    let cluster = postgres::Cluster::shared();
    let mut services = vec![
        Service::start("bare", itself).await,
        Service::start("memory", served("memory:")).await,
        Service::start("sqlite", served(&file)).await,
        Service::start("postgres", served(&cluster.database().await)).await,
    ];
    for _ in 0..ROUNDS {
        for service in &mut services {
            service.round().await;
        }
    }
    let bare = services[0].rates.clone();
    println!("| store | moves a second | ratio to bare | of rounds | processor time a move |");
    println!("|---|---|---|---|---|");
    for service in &services {
        let (mut rates, mut costs) = (service.rates.clone(), service.costs.clone());
        costs.sort_by(f64::total_cmp);
        let mut ratios: Vec<f64> = rates.iter().zip(&bare).map(|(rate, bare)| rate / bare).collect();
        rates.sort_by(f64::total_cmp);
        ratios.sort_by(f64::total_cmp);
        let (name, middle) = (service.name, ROUNDS / 2);
        println!(
            "| {name} | {:.0} | {:.2} | {:.2} to {:.2} | {:.1} us |",
            rates[middle],
            ratios[middle],
            ratios[0],
            ratios[ROUNDS - 1],
            costs[middle] * 1e6
        );
    }
    drop(services);
    std::fs::remove_dir_all(&folder).expect("the temporary folder");
}

#[tokio::main]
async fn main() {
    if std::env::args().any(|argument| argument == "bare") {
        bare().await;
    } else {
        compare().await;
    }
}
