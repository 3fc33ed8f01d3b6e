//! Work ends with its client, and at the deadline, on the real binary: requests that would go on for most of an hour
//! leave no thread of the solver at work. What is lost by that is no more than the request, and of a contact that is
//! being loaded not even that.

use std::path::Path;
use std::time::Duration;

use crate::common::raw::{Service, get, post};
use crate::common::{ball, curved_move, long_path, long_simulation, metric, of, session, slow_contact, until, with};
use serde_json::{Value, json};
use stickslip::store::{Record, Snapshot, SqliteStore, Store as _};
use stickslip_wire::client::Options;
use stickslip_wire::{Move, State};
use tempfile::TempDir;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::TcpStream;
use tokio::time::timeout;
use uuid::Uuid;

/// Moves of a contact that takes minutes to load.
const LONG: u64 = 50_000;

/// Threads of the solver at work.
const RUNNING: &str = "stickslip_solver_running";

/// A tolerance to which a move of the ball takes less than a thousandth of a second.
const COARSE: f64 = 1e-12;

fn curved(index: u64) -> Move {
    serde_json::from_value(curved_move(index)).unwrap()
}

/// A contact with so many curved moves in a new file, written as if they had been made: a replay reads no states.
async fn stored(path: &Path, contact: Value, moves: u64, tolerance: f64) -> Uuid {
    let store = SqliteStore::open(path).unwrap();
    let session = session(contact);
    let (id, now) = (session.id, session.created_at);
    store.create(session, None).await.unwrap();
    let record = |sequence: u64| Record {
        sequence,
        step: curved(sequence),
        tolerance,
        state: State::default(),
        measured: None,
        by: None,
        at: now,
    };
    store.append(id, 0, (1..=moves).map(record).collect(), None).await.unwrap();
    id
}

fn on(file: &Path, options: &[&str]) -> Service {
    Service::start_on(&format!("sqlite:{}", file.display()), &[&["--log", "warn"], options].concat())
}

/// Requests that go on for most of an hour (a file, for seconds) unless they are stopped, by the kind of their work:
/// each way on which a request reaches a solver. `crates/compute/tests/stops.rs` has the kinds of work that ask whether
/// to go on.
fn kinds(contact: Uuid, fresh: Uuid) -> Vec<(&'static str, String)> {
    vec![
        ("a simulation", post("/simulate", &long_simulation().to_string())),
        ("a path", post(&format!("/contacts/{fresh}/path"), &long_path().to_string())),
        ("loading", get(&format!("/contacts/{contact}"))),
        ("tracing", get(&format!("/contacts/{contact}/loop?points_per_move=100"))),
        ("a file", post("/files/scan", &long_file()).replacen("application/json", "text/csv", 1)),
    ]
}

/// A file of an instrument that takes a good part of a second to read.
fn long_file() -> String {
    let row = |index: u32| format!("{};{}.25;{}\n", index % 4096, index, index * 7 % 1000);
    std::iter::once("X [um];Y [um];Z [nm]\n".to_owned()).chain((0..600_000).map(row)).collect()
}

/// Waits until no thread of the solver is at work.
async fn idle(service: &Service) {
    until("the work has ended", async || (metric(&service.base, RUNNING).await == 0).then_some(())).await;
}

/// Sends a request, and leaves once a thread of the solver is at work and has had so many ticks of processor time.
async fn leave(service: &Service, name: &str, request: &str, ticks: u64) {
    let mut stream = TcpStream::connect(service.address).await.unwrap();
    stream.write_all(request.as_bytes()).await.unwrap();
    until("it is at work", async || (metric(&service.base, RUNNING).await == 1).then_some(())).await;
    let begun = service.processor_ticks();
    until("it has worked", async || (service.processor_ticks() - begun >= ticks).then_some(())).await;
    let mut reply = [0; 512];
    if let Ok(Ok(length)) = timeout(Duration::from_millis(10), stream.read(&mut reply)).await {
        panic!("{name} is too short: {}", String::from_utf8_lossy(&reply[..length]));
    }
}

/// A service with a contact that takes long to load and one without moves, in a file.
async fn scene(folder: &TempDir, options: &[&str]) -> (Service, Uuid, Uuid) {
    let file = folder.path().join("contacts.db");
    let contact = stored(&file, slow_contact(), LONG, 1e-14).await;
    let service = on(&file, options);
    let fresh = serde_json::from_value(slow_contact()).unwrap();
    let fresh = service.client.create(&fresh, &Options::default()).await.unwrap().id;
    (service, contact, fresh)
}

#[tokio::test]
async fn work_of_every_kind_ends_with_its_client() {
    let folder = TempDir::new().unwrap();
    let (service, contact, fresh) = scene(&folder, &[]).await;
    for (name, request) in kinds(contact, fresh) {
        leave(&service, name, &request, 1).await;
        idle(&service).await;
    }
    assert_eq!(service.client.contact(fresh).await.unwrap().sequence, 0);
}

#[tokio::test]
async fn work_of_every_kind_ends_at_the_deadline() {
    let folder = TempDir::new().unwrap();
    let (service, contact, fresh) = scene(&folder, &["--deadline", "10ms"]).await;
    let table = |number: usize| {
        let radii: Vec<_> = (0..10_000).map(|index| 1e-7 * f64::from(index)).collect();
        let heights: Vec<_> = radii.iter().map(|r| r * r / (0.02 + 1e-3 * number as f64)).collect();
        json!({"type": "tabulated", "r": radii, "z": heights})
    };
    let tables = json!({"type": "sum", "parts": (0..16).map(table).collect::<Vec<_>>()});
    let prepared = of(&with(ball(), "/profile", tables), &json!({"path": {"displacement": [1e-8]}}));
    let preparing = ("preparing", post("/simulate", &prepared.to_string()));
    for (name, request) in kinds(contact, fresh).into_iter().chain([preparing]) {
        let answer = service.ask("127.0.0.2", &request).await.unwrap();
        assert_eq!(answer.statuses[0], 422, "{name}: {}", answer.text);
        let expected = match name {
            "loading" | "tracing" => &["too_much_work"][..],
            "preparing" => &["too_much_work", "0.01 s", "/contact/profile"],
            "a file" => &["too_much_work", "0.01 s"],
            _ => &["too_much_work", "0.01 s", "/path/moves/"],
        };
        assert!(expected.iter().all(|words| answer.text.contains(words)), "{name}: {}", answer.text);
        idle(&service).await;
    }
    assert_eq!(service.client.contact(fresh).await.unwrap().sequence, 0);
}

/// The document of an answer.
fn document(answer: &str) -> Value {
    let body = answer.split_once("\r\n\r\n").unwrap().1;
    serde_json::from_str(body).unwrap_or_else(|error| panic!("{error}: {answer}"))
}

/// How many moves the refusal of a contact that is being loaded says have been replayed.
fn replayed(answer: &str) -> u64 {
    let (before, _) = answer.split_once(" of its moves have been replayed").unwrap_or_else(|| panic!("{answer}"));
    before.rsplit_once(' ').unwrap().1.parse().unwrap()
}

#[tokio::test]
async fn a_contact_that_no_request_has_the_time_to_load_is_loaded_by_several() {
    const MOVES: u64 = 4_000;
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("contacts.db");
    let id = stored(&file, ball(), MOVES, COARSE).await;
    let service = on(&file, &["--deadline", "50ms"]);
    let mut before = 0;
    // Any request brings it on. A move is made once it is loaded.
    let requests =
        [get(&format!("/contacts/{id}/friction")), post(&format!("/contacts/{id}/move"), r#"{"force": 0.2}"#)];
    let moved = 'loaded: loop {
        for (request, moves) in requests.iter().zip([false, true]) {
            let answer = service.ask("127.0.0.2", request).await.unwrap();
            if answer.statuses == [200] && moves {
                break 'loaded document(&answer.text);
            }
            if answer.statuses != [200] {
                assert_eq!(answer.statuses, [422], "{}", answer.text);
                // On a busy machine a request may have no time for a single move.
                let now = replayed(&answer.text);
                assert!(now >= before && answer.text.contains("too_much_work"), "{}, {before} before", answer.text);
                before = now;
            }
        }
    };
    // To the last bit as without a stop.
    let mut moves: Vec<Move> = (1..=MOVES).map(curved).collect();
    moves.push(Move { force: Some(0.2), ..Move::default() });
    let body = of(&ball(), &json!({"path": {"moves": moves}, "steps": "last", "tolerance": COARSE}));
    let service = Service::start(&["--log", "warn"]);
    let simulated = service.ask("127.0.0.2", &post("/simulate", &body.to_string())).await.unwrap();
    let simulated = document(&simulated.text);
    assert_eq!((&moved["sequence"], &moved["state"]), (&json!(MOVES + 1), &simulated["steps"][0]));
}

#[tokio::test]
async fn what_has_been_replayed_for_a_client_that_leaves_is_kept() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("contacts.db");
    let id = stored(&file, ball(), LONG, COARSE).await;
    // Another engine has left a snapshot of its last move, which is of no use to this one.
    let foreign = Snapshot { sequence: LONG, state: b"another engine".to_vec() };
    SqliteStore::open(&file).unwrap().save_snapshot(id, foreign, None).await.unwrap();
    let kept = async || {
        let snapshot = SqliteStore::open_to_read(&file).unwrap().snapshot(id).await.unwrap();
        snapshot.map(|snapshot| snapshot.sequence).filter(|sequence| *sequence < LONG)
    };
    let service = on(&file, &[]);
    leave(&service, "loading", &get(&format!("/contacts/{id}")), 50).await;
    let first = until("a snapshot is kept", &kept).await;
    drop(service);
    // Another process goes on there.
    let service = on(&file, &["--deadline", "200ms"]);
    let refused = service.ask("127.0.0.2", &get(&format!("/contacts/{id}"))).await.unwrap();
    assert_eq!(refused.statuses, [422], "{}", refused.text);
    assert!(replayed(&refused.text) > first, "{first}: {}", refused.text);
}
