//! The contract: every endpoint through the typed client, and what the replies promise.

use crate::common;

use std::io::{BufRead as _, BufReader};
use std::process::{Command, Stdio};

use common::{PATIENCE, Server, ball, create, until};
use serde_json::{Value, json};
use stickslip_wire::client::{Client, Options, Swept};
use stickslip_wire::files::{LoopFileHints, ScanFileHints};
use stickslip_wire::fit::ForceUnit;
use stickslip_wire::profile_fit::{LengthUnit, ScanData, ScanUnits};
use stickslip_wire::{
    FallingAmplitude, Field, ForkRequest, JobState, Move, Path, PathRequest, Regime, SimulateRequest, SolverKind,
    Steps, StressRequest, SweepRequest,
};
use tokio::io::AsyncReadExt as _;

fn simulation(more: Value) -> SimulateRequest {
    let mut body = json!({"contact": ball(), "path": {"falling_amplitude": {"reversals": 20}}});
    body.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
    serde_json::from_value(body).unwrap()
}

#[tokio::test]
async fn loops_and_sweeps_answer_the_client() {
    let server = Server::start().await;
    let (client, plain) = (&server.client, Options::default());
    let contact = client.create(&create(), &plain).await.unwrap();
    for displacement in [1e-7, -1e-7] {
        client.apply(contact.id, &Move::displacement(displacement).into(), &plain).await.unwrap();
    }
    let page = client.hysteresis_loop(contact.id, Some(1), Some(1), Some(4)).await.unwrap();
    assert_eq!((page.sequence, page.part), (vec![2; 4], vec![0.25, 0.5, 0.75, 1.0]));
    assert_eq!((page.displacement[3], page.next), (-1e-7, None));
    client.apply(contact.id, &Move::displacement(1e-7).into(), &plain).await.unwrap();
    let cycles = client.cycles(contact.id, Some(1)).await.unwrap().items;
    assert_eq!((cycles.len(), cycles[0].from, cycles[0].to, cycles[0].displacement_amplitude), (1, 1, 3, 1e-7));

    let mut request: SweepRequest = serde_json::from_value(json!({
        "base": {"contact": ball(), "path": {"displacement": [1e-8]}},
        "axes": [{"pointer": "/contact/friction", "values": [0.1, 0.2, 0.3]}], "outputs": ["/steps/0/force"]
    }))
    .unwrap();
    let Swept::Table(table) = client.sweep(&request, &plain).await.unwrap() else { panic!("three points are no job") };
    assert_eq!((table.points, table.columns["/steps/0/force"].len()), (3, 3));
    request.job = true;
    let keyed = Options { idempotency_key: Some("a-sweep".to_owned()), ..Options::default() };
    let Swept::Job(job) = client.sweep(&request, &keyed).await.unwrap() else { panic!("a job was asked for") };
    assert_eq!(
        client.sweep(&request, &keyed).await.unwrap(),
        Swept::Job(job.clone()),
        "once, however often it is sent"
    );
    until("the job ends", async || (client.job(job.id).await.unwrap().state != JobState::Running).then_some(())).await;
    assert_eq!(client.job_result(job.id).await.unwrap(), table);
    client.delete_job(job.id).await.unwrap();
    assert_eq!(client.job(job.id).await.unwrap_err().problem().unwrap().code, "job_not_found");
}

#[tokio::test]
async fn every_endpoint_answers_the_client() {
    let server = Server::start().await;
    let client = &server.client;
    let plain = Options::default();
    client.healthz().await.unwrap();
    client.readyz().await.unwrap();
    assert_eq!(client.openapi().await.unwrap()["info"]["title"], "stickslip");

    let contact = client.create(&create(), &plain).await.unwrap();
    assert_eq!((contact.sequence, contact.state.regime), (0, Regime::Stick));
    assert_eq!(contact.warnings[0].code, "dundurs_beta");

    let moved = client.apply(contact.id, &Move::displacement(1e-7).into(), &plain).await.unwrap();
    assert_eq!(moved.sequence, 1);
    assert!(moved.state.force > 0.0 && moved.state.regime == Regime::PartialSlip && moved.stress.is_none());

    let path = PathRequest {
        path: Path::FallingAmplitude(FallingAmplitude { reversals: 3, amplitude: None }),
        stress: Some(StressRequest { points: Some(5), ..StressRequest::default() }),
        steps: Steps::All,
        tolerance: None,
    };
    let followed = client.path(contact.id, &path, &plain).await.unwrap();
    assert_eq!((followed.sequence, followed.steps.len()), (5, 4));
    assert_eq!(followed.stress.unwrap().radius.len(), 5);

    let wanted = StressRequest { radii: Some(vec![0.0, 1e-5]), fields: Some(vec![Field::Shear]), points: None };
    let stress = client.stress(contact.id, &wanted, true).await.unwrap();
    assert_eq!(stress.radius, [0.0, 1e-5]);
    assert!(stress.pressure.is_none() && stress.shear.unwrap().len() == 2);

    assert_eq!(client.residual(contact.id).await.unwrap(), stress.residual.unwrap());

    let matrix = b"1 2 3 4\n5 6 7 8\n2 4 6 8\n1 3 5 7\n".to_vec();
    let [lateral, height] = [LengthUnit::Millimetre, LengthUnit::Micrometre].map(Some);
    let [wide, high] = ["mm", "micrometres"].map(|unit| Some(unit.to_owned()));
    let hints = ScanFileHints { lateral: wide, height: high, spacing: Some(0.5), ..Default::default() };
    let read = client.read_scan(matrix, &hints).await.unwrap();
    assert_eq!((read.units, read.preview.rows), (ScanUnits { lateral, height }, 4));
    assert!(matches!(read.scan, ScanData::Map(map) if (map.dx, map.dy) == (0.5, 0.5)));
    let text = "Force (N);Displacement (um);Other\n0;0;3\n1;2;5\n".to_owned().into_bytes();
    let read = client.read_loop(text.clone(), &LoopFileHints::default()).await.unwrap();
    assert_eq!((read.measured.displacement, read.measured.force), (vec![0.0, 2.0], vec![0.0, 1.0]));
    let other = LoopFileHints { force: Some("3".into()), force_unit: Some("kN".into()), ..Default::default() };
    let read = client.read_loop(text, &other).await.unwrap();
    assert_eq!((read.measured.force, read.units.force), (vec![3.0, 5.0], Some(ForceUnit::Kilonewton)));
    let refused = client.read_loop(b"a;b".to_vec(), &LoopFileHints::default()).await.unwrap_err();
    assert_eq!(refused.problem().unwrap().code, "invalid_input");

    let history = client.history(contact.id, Some(1), Some(2)).await.unwrap();
    assert_eq!(history.items.iter().map(|item| item.sequence).collect::<Vec<_>>(), [2, 3]);
    assert_eq!(history.next, Some(3));

    let fork = client
        .fork(contact.id, &ForkRequest { label: Some("what if".to_owned()), sequence: None }, &plain)
        .await
        .unwrap();
    assert_eq!((fork.sequence, fork.state), (5, followed.steps[3]));

    let shown = client.contact(contact.id).await.unwrap();
    assert_eq!((shown.sequence, shown.state), (5, followed.steps[3]));
    let page = client.contacts(None, Some(1)).await.unwrap();
    assert_eq!((page.items[0].id, page.next), (contact.id, Some(contact.id)));
    let page = client.contacts(page.next, None).await.unwrap();
    assert_eq!((page.items[0].label.as_deref(), page.next), (Some("what if"), None));

    client.delete(contact.id, &plain).await.unwrap();
    let gone = client.contact(contact.id).await.unwrap_err();
    assert_eq!(gone.problem().unwrap().code, "contact_not_found");
}

#[tokio::test]
async fn a_simulation_computes_what_is_asked_for_and_nothing_else() {
    let server = Server::start().await;
    let reply = server.client.simulate(&simulation(json!({}))).await.unwrap();
    assert_eq!(reply.steps.len(), 21);
    assert!(reply.stress.is_none() && reply.residual.is_none());
    assert_eq!(reply.accuracy.solver, SolverKind::Exact);
    let last = reply.steps[20];
    assert!((last.force / reply.contact.gross_slip_force + 0.002_045).abs() < 1e-6, "{last:?}");

    let asked = json!({"stress": {"points": 3, "fields": ["pressure"]}, "residual": true, "steps": "last"});
    let reply = server.client.simulate(&simulation(asked)).await.unwrap();
    assert_eq!(reply.steps, [last]);
    let stress = reply.stress.unwrap();
    assert!(stress.shear.is_none());
    assert_eq!(stress.radius, [0.0, 0.5 * last.contact_radius, last.contact_radius]);
    assert_eq!(stress.pressure.unwrap()[2], Some(0.0));
    assert_eq!(reply.residual.unwrap().peaks.len(), 20);
}

#[tokio::test]
async fn springs_answer_when_asked_for() {
    let server = Server::start().await;
    let exact = server.client.simulate(&simulation(json!({"solver": "exact"}))).await.unwrap();
    let springs = server.client.simulate(&simulation(json!({"solver": {"springs": {"count": 4000}}}))).await.unwrap();
    assert_eq!(springs.accuracy.solver, SolverKind::Springs);
    let limit = exact.contact.gross_slip_force;
    for (one, other) in exact.steps.iter().zip(&springs.steps) {
        assert!(((one.force - other.force) / limit).abs() < 1e-5);
    }
}

#[tokio::test]
async fn headers_say_where_and_which() {
    let server = Server::start().await;
    let created = server.post("/contacts", &ball()).await;
    assert_eq!(created.status(), 201);
    let place = created.headers()["location"].to_str().unwrap().to_owned();
    assert_eq!(created.headers()["etag"], "\"0\"");
    assert_eq!(created.json::<Value>().await.unwrap()["id"], place.trim_start_matches("/contacts/"));

    let moved = server.post(&format!("{place}/move"), &json!({"force": 1.0})).await;
    assert_eq!((moved.status().as_u16(), &moved.headers()["etag"]), (200, &"\"1\"".parse().unwrap()));
    let shown = server.send(reqwest::Method::GET, &place, None, &[("x-request-id", "mine-7")]).await;
    assert_eq!(
        (&shown.headers()["etag"], &shown.headers()["x-request-id"]),
        (&"\"1\"".parse().unwrap(), &"mine-7".parse().unwrap())
    );
    let forked = server.send(reqwest::Method::POST, &format!("{place}/fork"), None, &[]).await;
    assert_eq!((forked.status().as_u16(), &forked.headers()["etag"]), (201, &"\"1\"".parse().unwrap()));
    let deleted = server.send(reqwest::Method::DELETE, &place, None, &[]).await;
    assert_eq!((deleted.status().as_u16(), deleted.bytes().await.unwrap().len()), (204, 0));
    let docs = server.get("/docs/").await;
    assert!(docs.status().is_success() && docs.text().await.unwrap().contains("swagger"));
}

/// The real binary: it starts, prints its address, and stops at a signal, although a connection is open.
#[tokio::test]
async fn the_binary_starts_and_stops_gracefully() {
    let mut child = Command::new(env!("CARGO_BIN_EXE_stickslip"))
        .args(["--listen", "127.0.0.1:0", "--store", "memory:"])
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut line = String::new();
    BufReader::new(child.stdout.take().unwrap()).read_line(&mut line).unwrap();
    let base = line.split_whitespace().find(|word| word.starts_with("http://")).unwrap().trim_end_matches(',');
    let client = Client::new(base);
    client.healthz().await.unwrap();
    let healthcheck = |address: &str| {
        let check = Command::new(env!("CARGO_BIN_EXE_stickslip")).args(["healthcheck", "--listen", address]).output();
        check.unwrap().status.success()
    };
    let address = base.trim_start_matches("http://");
    assert!(healthcheck(address) && !healthcheck("127.0.0.1:1"));
    let mut idle = tokio::net::TcpStream::connect(address).await.unwrap();

    let sent = Command::new("kill").args(["-TERM", &child.id().to_string()]).status().unwrap();
    assert!(sent.success());
    let ended = tokio::task::spawn_blocking(move || child.wait().unwrap());
    let status = tokio::time::timeout(PATIENCE, ended).await.expect("it waits for the connection").unwrap();
    assert!(status.success(), "{status}");
    // It was the server that closed the connection.
    assert_eq!(idle.read(&mut [0]).await.unwrap_or(0), 0);
}

#[test]
fn the_command_line_simulates_as_the_service_does() {
    let run = |body: &str| {
        use std::io::Write as _;
        let mut child = Command::new(env!("CARGO_BIN_EXE_stickslip"))
            .args(["simulate", "-"])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        child.stdin.take().unwrap().write_all(body.as_bytes()).unwrap();
        child.wait_with_output().unwrap()
    };
    let good = run(&json!({"contact": ball(), "path": {"force": [1.0]}}).to_string());
    assert!(good.status.success());
    let reply: Value = serde_json::from_slice(&good.stdout).unwrap();
    assert!((reply["steps"][0]["force"].as_f64().unwrap() - 1.0).abs() < 1e-12);

    let bad = run(&json!({"contact": ball(), "path": {"force": [3.0]}}).to_string());
    assert_eq!(bad.status.code(), Some(1));
    let problem: Value = serde_json::from_slice(&bad.stderr).unwrap();
    assert_eq!(
        (&problem["code"], &problem["errors"][0]["pointer"]),
        (&json!("force_exceeds_friction"), &json!("/path/force/0"))
    );
}
