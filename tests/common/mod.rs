//! A real server on a free port, and requests to send to it.

#![allow(dead_code, reason = "each test binary uses a part of it")]

#[path = "../../crates/compute/tests/documents/json.rs"]
pub mod json;
pub mod kill;
pub mod openapi;
pub mod pictures;
pub mod place;
pub mod port;
pub mod postgres;
pub mod process;
pub mod prometheus;
pub mod raw;
pub mod small_disk;
pub mod tables;

#[allow(unused_imports, reason = "each test binary uses a part of it")]
pub use json::{ball, changed, codes, number, of, timeless, with};

use std::process::{Command, Output};
use std::sync::Arc;
use std::time::Duration;

use jiff::Timestamp;
use reqwest::{Method, Response};
use serde_json::{Value, json};
use stickslip::admission::Pool;
use stickslip::api::{self, Access, App};
use stickslip::jobs::Jobs;
use stickslip::sessions::{CAPACITY, Sessions};
use stickslip::store::{Session, SqliteStore, Store, Tenant};
use stickslip_wire::client::Client;
use stickslip_wire::{CreateRequest, Document as _, Move, Path, PathRequest, ProblemDocument, Steps};
use tokio::net::TcpListener;
use uuid::Uuid;

/// How long a test waits before it gives up. It guards against hanging; nothing is measured by it.
pub const PATIENCE: Duration = Duration::from_secs(120);

/// Waits until `look` finds something.
pub async fn until<T>(what: &str, mut look: impl AsyncFnMut() -> Option<T>) -> T {
    let found = async {
        loop {
            match look().await {
                Some(found) => break found,
                None => tokio::time::sleep(Duration::from_millis(20)).await,
            }
        }
    };
    tokio::time::timeout(PATIENCE, found).await.unwrap_or_else(|_| panic!("timed out waiting until {what}"))
}

/// A server. If this process runs it, it ends with the runtime of its test.
pub struct Server {
    pub client: Client,
    pub base: String,
    pub http: reqwest::Client,
}

impl Server {
    pub async fn start() -> Server {
        Server::with(Arc::new(SqliteStore::in_memory().unwrap()), CAPACITY).await
    }

    /// A server over a store, with at most `bytes` bytes of cached states.
    pub async fn with(store: Arc<dyn Store>, capacity: usize) -> Server {
        let pool = Pool::with_defaults();
        let jobs = Jobs::new(Arc::clone(&store), pool.clone());
        let sessions = Sessions::new(store, pool.clone(), capacity);
        Server::of(sessions, jobs, pool).await
    }

    /// A server over sessions that the test uses directly too; its jobs have a store of their own.
    pub async fn over(sessions: Sessions, pool: Pool) -> Server {
        let jobs = Jobs::new(Arc::new(SqliteStore::in_memory().unwrap()), pool.clone());
        Server::of(sessions, jobs, pool).await
    }

    /// A server that keeps contacts in memory and works in a pool.
    pub async fn in_pool(pool: Pool) -> Server {
        let sessions = Sessions::new(Arc::new(SqliteStore::in_memory().unwrap()), pool.clone(), CAPACITY);
        Server::over(sessions, pool).await
    }

    /// A server that another process runs.
    pub fn at(base: &str) -> Server {
        Server { client: Client::new(base), base: base.to_owned(), http: reqwest::Client::new() }
    }

    async fn of(sessions: Sessions, jobs: Jobs, pool: Pool) -> Server {
        let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
        let base = format!("http://{}", listener.local_addr().unwrap());
        tokio::spawn(jobs.clone().work(stickslip::jobs::LEASE));
        let app = App { sessions, jobs, pool, access: Access::default() };
        tokio::spawn(api::serve(listener, app, std::future::pending()));
        Server::at(&base)
    }

    /// Any request; a body goes as JSON.
    pub async fn send(&self, method: Method, path: &str, body: Option<&str>, headers: &[(&str, &str)]) -> Response {
        let mut call = self.http.request(method, format!("{}{path}", self.base));
        if let Some(body) = body {
            call = call.header("content-type", "application/json").body(body.to_owned());
        }
        for (name, value) in headers {
            call = call.header(*name, *value);
        }
        call.send().await.unwrap()
    }

    pub async fn post(&self, path: &str, body: &Value) -> Response {
        self.send(Method::POST, path, Some(&body.to_string()), &[]).await
    }

    pub async fn get(&self, path: &str) -> Response {
        self.send(Method::GET, path, None, &[]).await
    }

    /// A new contact's identifier.
    pub async fn contact(&self) -> String {
        let reply: Value = self.post("/contacts", &ball()).await.json().await.unwrap();
        reply["id"].as_str().unwrap().to_owned()
    }
}

/// A path through moves, of whose states only the last is requested.
pub fn along(moves: Vec<Move>) -> PathRequest {
    PathRequest { path: Path::Moves(moves).into(), stress: None, steps: Steps::Last, tolerance: None }
}

/// A contact that is not stored yet.
pub fn session(contact: Value) -> Session {
    let definition = serde_json::from_value::<CreateRequest>(contact).unwrap().check().unwrap().definition;
    let now = Timestamp::now();
    Session {
        id: Uuid::now_v7(),
        tenant: Tenant::default(),
        label: None,
        definition: Arc::new(definition),
        sequence: 0,
        created_at: now,
        updated_at: now,
    }
}

/// The binary with these arguments, and without the settings of the environment.
pub fn binary(arguments: &[&str]) -> Command {
    let mut command = clean(Command::new(env!("CARGO_BIN_EXE_stickslip")));
    command.args(arguments);
    command
}

/// Its output, after it has exited by itself.
pub fn run(arguments: &[&str]) -> Output {
    binary(arguments).output().unwrap()
}

/// Without the settings that the environment of the tests may hold.
pub fn clean(mut command: Command) -> Command {
    for (name, _) in std::env::vars_os().filter(|(name, _)| name.to_string_lossy().starts_with("STICKSLIP_")) {
        command.env_remove(name);
    }
    command
}

/// A contact whose curved moves take long.
pub fn slow_contact() -> Value {
    with(ball(), "/profile", json!({"type": "power_law", "exponent": 2.7, "coefficient": 1e3}))
}

/// One of many curved moves.
pub fn curved_move(index: u64) -> Value {
    json!({"force": 0.2 * (index % 7) as f64, "normal_force": 5.0 + (index % 9) as f64})
}

/// Moves of all kinds, some of them curved, many small ones among them that leave a deep slip history.
pub fn varied_moves(count: usize, seed: f64) -> Vec<Move> {
    let turn = |index: usize| (seed + index as f64 * 2.399).sin();
    let step = |index: usize| match index % 97 {
        0 => Move { indentation: Some(4.7e-7 * (1.0 + 0.3 * turn(index))), ..Move::displacement(5e-8 * turn(index)) },
        31 => Move { normal_force: Some(10.0 + 2.0 * turn(index)), ..Move::default() },
        62 => Move { normal_force: Some(10.0 + 2.0 * turn(index)), ..Move::force(0.5 * turn(index)) },
        _ => Move::displacement(2e-7 * turn(index) * (1.0 - (index % 97) as f64 / 100.0)),
    };
    (0..count).map(step).collect()
}

/// A path that takes the slow contact most of an hour: each move is followed in thousands of small steps.
pub fn long_path() -> Value {
    json!({"path": {"moves": (0..80_000).map(curved_move).collect::<Vec<_>>()}, "steps": "last", "tolerance": 1e-14})
}

/// A simulation that ends when its client leaves, or at its time limit.
pub fn long_simulation() -> Value {
    of(&slow_contact(), &long_path())
}

/// The whole number that a sample of the metrics of a server has.
pub async fn metric(base: &str, sample: &str) -> u64 {
    let page = reqwest::get(format!("{base}/metrics")).await.unwrap().text().await.unwrap();
    let value = page.lines().find_map(|line| line.strip_prefix(sample)?.strip_prefix(' '));
    value.unwrap_or_else(|| panic!("{sample}: {page}")).parse::<f64>().unwrap() as u64
}

/// The document of a reply that is no refusal.
pub async fn good(response: Response) -> Value {
    let status = response.status();
    let text = response.text().await.unwrap();
    assert!(status.is_success(), "{status} {text}");
    serde_json::from_str(&text).unwrap()
}

/// Asserts that a body is refused with a code, at a place, by a text with these words.
pub async fn assert_refused(server: &Server, path: &str, body: &Value, (code, pointer, words): (&str, &str, &str)) {
    let text = body.to_string();
    let refused = problem(server.send(Method::POST, path, Some(&text), &[]).await).await;
    let shown = format!("{path} {:.300}..{}: {refused:?}", text, &text[text.len().saturating_sub(200)..]);
    assert_eq!((refused.status, refused.code.as_str()), (422, code), "{shown}");
    assert_eq!(refused.errors[0].pointer, pointer, "{shown}");
    assert!(refused.errors[0].detail.contains(words), "{shown}");
}

/// The same as a typed request.
pub fn create() -> CreateRequest {
    serde_json::from_value(ball()).unwrap()
}

/// The problem document of a refusal; checks what holds for all of them.
pub async fn problem(response: Response) -> ProblemDocument {
    let status = response.status().as_u16();
    assert_eq!(response.headers()["content-type"], "application/problem+json", "status {status}");
    let id = response.headers()["x-request-id"].to_str().unwrap().to_owned();
    let problem: ProblemDocument = response.json().await.unwrap();
    assert_eq!((problem.status, &problem.request_id), (status, &id));
    assert_eq!(problem.kind, format!("/problems/{}", problem.code));
    problem
}
