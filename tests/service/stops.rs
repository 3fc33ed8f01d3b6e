//! Work of every kind ends with its client, and at the deadline: processor time says so, on the real binary. What is
//! lost by that is no more than the request, and of a contact that is being loaded not even that.

use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use crate::common::raw::{Service, get, post};
use crate::common::{ball, create, long_moves, long_simulation, of, until, with};
use jiff::Timestamp;
use serde_json::{Value, json};
use stickslip::store::{Record, Session, Snapshot, SqliteStore, Store as _, Tenant};
use stickslip_wire::client::Options;
use stickslip_wire::{CreateRequest, Document as _, Move, State};
use tempfile::TempDir;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::TcpStream;
use tokio::time::timeout;
use uuid::Uuid;

/// Processor time, in ticks of a hundredth of a second, within which work ends. It takes less than a tenth of that, and
/// each kind would go on for longer.
const WITHIN: u64 = 60;

/// The moves of a contact that takes minutes to load, each followed in many small steps.
const LONG: u64 = 50_000;

/// The tolerance to which they are followed.
const TOLERANCE: f64 = 1e-13;

fn curved(index: u64) -> Move {
    Move {
        force: Some(0.1 * (index % 7) as f64),
        normal_force: Some(9.0 + 0.1 * (index % 9) as f64),
        ..Move::default()
    }
}

/// A contact with so many curved moves in a new file, written as if they had been made: a replay reads no states.
async fn stored(path: &Path, moves: u64) -> Uuid {
    let store = SqliteStore::open(path).unwrap();
    let definition = serde_json::from_value::<CreateRequest>(ball()).unwrap().check().unwrap().definition;
    let (id, now) = (Uuid::now_v7(), Timestamp::now());
    let session = Session {
        id,
        tenant: Tenant::default(),
        label: None,
        definition: Arc::new(definition),
        sequence: 0,
        created_at: now,
        updated_at: now,
    };
    store.create(session, None).await.unwrap();
    let record = |sequence: u64| Record {
        sequence,
        step: curved(sequence),
        tolerance: TOLERANCE,
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

/// A convex table, which is prepared as far as contacts reach, whatever its number.
fn table(number: usize) -> Value {
    let radii: Vec<_> = (0..10_000).map(|index| 1e-7 * f64::from(index)).collect();
    let heights: Vec<_> = radii.iter().map(|r| r * r / (0.02 + 1e-3 * number as f64)).collect();
    json!({"type": "tabulated", "r": radii, "z": heights})
}

/// Requests that take a second at least, by the kind of their work.
fn kinds(contact: Uuid, fresh: Uuid) -> Vec<(&'static str, String)> {
    let falling = |reversals: usize| json!({"falling_amplitude": {"reversals": reversals}});
    // Where g'/x bends upward, every interval between two kinks is searched.
    let power = json!({"type": "power_law", "exponent": 5.37, "coefficient": 1e9});
    let law = with(with(ball(), "/profile", power), "/preload", json!({"indentation": 1e-6}));
    let sum = |parts: Vec<Value>| with(ball(), "/profile", json!({"type": "sum", "parts": parts}));
    let (one, tables) = (with(ball(), "/profile", table(0)), sum((0..4).map(table).collect()));
    let springs = json!({"springs": {"count": 900_000}});
    let drive = |unit: f64| -> Vec<f64> { (1..=100).map(|index| unit * f64::from(index)).collect() };
    let errors = json!({"amplitude_error": 0.01, "friction_error": 0.05, "samples": 1_000, "seed": 1});
    let grid = json!({"normal": "y", "offset": 0.0, "x": [-2e-4, 2e-4, 200], "z": [0.0, 2e-4, 200]});
    let criteria = json!({"crossland": {"alpha": 0.3, "limit": 3e8}, "findley": {"k": 0.3}});
    let swing = json!({"normal_force": 1.0, "phase": 1.0});
    let last = |contact: &Value, rest: Value| with(of(contact, &rest), "/steps", json!("last"));
    let simulations = [
        ("curved moves", long_simulation()),
        ("a search", last(&law, json!({"path": falling(30_000), "residual": true}))),
        ("stresses", last(&one, json!({"path": falling(99_999), "stress": {"points": 10_000}}))),
        ("springs", last(&ball(), json!({"path": falling(1_900), "solver": springs}))),
        ("a force on springs", last(&ball(), json!({"path": {"force": vec![0.1; 100]}, "solver": springs}))),
        ("a search on springs", last(&ball(), json!({"path": falling(1), "solver": springs, "residual": true}))),
        ("placing springs", last(&tables, json!({"path": falling(1), "solver": springs}))),
        (
            "stresses in depth",
            last(&ball(), json!({"path": falling(5_000), "subsurface": {"body": "first", "plane": grid}})),
        ),
        ("preparing", last(&sum((0..16).map(table).collect()), json!({"path": falling(1)}))),
    ];
    let others = [
        ("a picture", "/simulate?format=png", of(&ball(), &json!({"path": falling(99_999)}))),
        (
            "a comparison",
            "/accuracy",
            of(&ball(), &json!({"path": long_moves(), "solvers": [{"springs": {"count": 9_000}}]})),
        ),
        ("a protocol", "/protocols", of(&tables, &json!({"reversals": 60, "robustness": errors}))),
        (
            "an oscillating load",
            "/cycle",
            of(&tables, &json!({"drive": {"force": drive(0.02)}, "normal": swing, "harmonics": 31})),
        ),
        (
            "best loads",
            "/cycle",
            of(&tables, &json!({"drive": {"displacement": drive(1e-9)}, "best_load": {"points": 1_000}})),
        ),
        (
            "a mass",
            "/cycle",
            of(
                &sum((0..8).map(table).collect()),
                &json!({"drive": {"displacement": 1e-8}, "frequency_response": {"mass": 0.1, "drive_force": 1.0}}),
            ),
        ),
        (
            "fretting",
            "/fretting",
            of(
                &ball(),
                &json!({"body": "first", "path": {"displacement": [1e-7, -1e-7]}, "criteria": criteria, "plane": grid}),
            ),
        ),
    ];
    let mut kinds: Vec<_> = simulations.map(|(name, body)| (name, post("/simulate", &body.to_string()))).into();
    kinds.extend(others.map(|(name, place, body)| (name, post(place, &body.to_string()))));
    let path = json!({"path": long_moves(), "steps": "last"}).to_string();
    kinds.push(("a path", post(&format!("/contacts/{fresh}/path"), &path)));
    kinds.push(("loading", get(&format!("/contacts/{contact}"))));
    kinds.push(("tracing", get(&format!("/contacts/{contact}/loop?points_per_move=100"))));
    // Bytes behind a body, which belong to another request, and hide from the HTTP library that its client has left.
    let whole = kinds[0].1.clone();
    let (head, body) = whole.split_once("\r\n\r\n").unwrap();
    let head = head.replace(&format!("content-length: {}", body.len()), "transfer-encoding: chunked");
    let chunks = format!("{head}\r\n\r\n{:x}\r\n{body}\r\n0\r\n\r\nG", body.len());
    kinds.extend([("a byte behind the body", whole + "G"), ("a byte behind chunks", chunks)]);
    kinds
}

/// Waits until no thread of the solver is at work.
async fn idle(service: &Service) {
    until("the work has ended", async || {
        let page = service.ask("127.0.0.2", &get("/metrics")).await?.text;
        let running = page.lines().find_map(|line| line.strip_prefix("stickslip_solver_running "))?;
        (running.parse::<f64>().unwrap() <= 0.0).then_some(())
    })
    .await;
}

/// Sends a request, and leaves once it has taken so many ticks.
async fn leave(service: &Service, name: &str, request: &str, ticks: u64) {
    let before = service.processor_ticks();
    let mut stream = TcpStream::connect(service.address).await.unwrap();
    stream.write_all(request.as_bytes()).await.unwrap();
    until("it is at work", async || {
        let mut reply = [0; 512];
        if let Ok(Ok(length)) = timeout(Duration::from_millis(10), stream.read(&mut reply)).await {
            panic!("{name} is too short: {}", String::from_utf8_lossy(&reply[..length]));
        }
        (service.processor_ticks() - before >= ticks).then_some(())
    })
    .await;
}

#[tokio::test]
async fn work_of_every_kind_ends_with_its_client() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("contacts.db");
    let contact = stored(&file, LONG).await;
    let service = on(&file, &[]);
    let fresh = service.client.create(&create(), &Options::default()).await.unwrap().id;
    for (name, request) in kinds(contact, fresh) {
        idle(&service).await;
        leave(&service, name, &request, 30).await;
        let left = service.processor_ticks();
        idle(&service).await;
        let used = service.processor_ticks() - left;
        println!("{name}: {used} ticks after its client has left");
        assert!(used < WITHIN, "{name}: {used} ticks");
    }
    assert_eq!(service.client.contact(fresh).await.unwrap().sequence, 0);
}

#[tokio::test]
async fn work_of_every_kind_ends_at_the_deadline() {
    const DEADLINE: u64 = 50;
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("contacts.db");
    let contact = stored(&file, LONG).await;
    let service = on(&file, &["--deadline", "500ms"]);
    let fresh = service.client.create(&create(), &Options::default()).await.unwrap().id;
    for (name, request) in kinds(contact, fresh) {
        let before = service.processor_ticks();
        let answer = service.ask("127.0.0.2", &request).await.unwrap();
        assert_eq!(answer.statuses, [422], "{name}: {}", answer.text);
        let said = match name {
            "curved moves" | "a path" => &["too_much_work", "0.5 s", "/path/moves/"][..],
            "stresses" | "a comparison" => &["too_much_work", "0.5 s"],
            _ => &["too_much_work"],
        };
        assert!(said.iter().all(|words| answer.text.contains(words)), "{name}: {}", answer.text);
        idle(&service).await;
        let used = service.processor_ticks() - before;
        println!("{name}: {used} ticks");
        assert!(used < DEADLINE + WITHIN, "{name}: {used} ticks");
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
    const MOVES: u64 = 400;
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("contacts.db");
    let id = stored(&file, MOVES).await;
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
                let now = replayed(&answer.text);
                assert!(now > before && answer.text.contains("too_much_work"), "{}, {before} before", answer.text);
                before = now;
            }
        }
    };
    // To the last bit as without a stop.
    let mut moves: Vec<Move> = (1..=MOVES).map(curved).collect();
    moves.push(Move { force: Some(0.2), ..Move::default() });
    let body = of(&ball(), &json!({"path": {"moves": moves}, "steps": "last", "tolerance": TOLERANCE}));
    let service = Service::start(&["--log", "warn"]);
    let simulated = service.ask("127.0.0.2", &post("/simulate", &body.to_string())).await.unwrap();
    let simulated = document(&simulated.text);
    assert_eq!((&moved["sequence"], &moved["state"]), (&json!(MOVES + 1), &simulated["steps"][0]));
}

#[tokio::test]
async fn what_has_been_replayed_for_a_client_that_leaves_is_kept() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("contacts.db");
    let id = stored(&file, LONG).await;
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
