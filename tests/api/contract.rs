//! The contract: every endpoint of contacts, files and sweeps through the typed client, and what the replies promise.

use serde_json::{Value, json};
use stickslip_wire::client::{Options, Swept};
use stickslip_wire::files::{LoopFileHints, ScanFileHints};
use stickslip_wire::fit::ForceUnit;
use stickslip_wire::profile_fit::{LengthUnit, ScanData, ScanUnits};
use stickslip_wire::{
    FallingAmplitude, Field, ForkRequest, JobState, Move, Path, PathRequest, Regime, SolverKind, Steps, StressReply,
    StressRequest, SweepRequest,
};
use tokio::io::AsyncReadExt as _;

use crate::common::process::Process;
use crate::common::{Server, ball, create, of, run, until, with};

#[tokio::test]
async fn every_endpoint_answers_the_client() {
    let server = Server::start().await;
    let (client, plain) = (&server.client, Options::default());
    client.healthz().await.unwrap();
    client.readyz().await.unwrap();
    assert_eq!(client.openapi().await.unwrap()["info"]["title"], "stickslip");

    let contact = client.create(&create(), &plain).await.unwrap();
    assert_eq!((contact.sequence, contact.state.regime), (0, Regime::Stick));
    assert_eq!(contact.warnings[0].code, "dundurs_beta");
    let moved = client.apply(contact.id, &Move::displacement(1e-7).into(), &plain).await.unwrap();
    assert_eq!(moved.sequence, 1);
    assert!(
        moved.state.force.is_some_and(|force| force > 0.0)
            && moved.state.regime == Regime::PartialSlip
            && moved.stress.is_none()
    );
    let path = PathRequest {
        path: Path::FallingAmplitude(FallingAmplitude { reversals: 3, amplitude: None }).into(),
        stress: Some(StressRequest { points: Some(5), ..StressRequest::default() }),
        steps: Steps::All,
        tolerance: None,
    };
    let followed = client.path(contact.id, &path, &plain).await.unwrap();
    assert_eq!((followed.sequence, followed.steps.len()), (5, 4));
    assert_eq!(followed.stress.unwrap().places().len(), 5);
    let radii = Some(vec![0.0, 1e-5]);
    let wanted = StressRequest { radii, fields: Some(vec![Field::Shear]), ..StressRequest::default() };
    let StressReply { stress, residual } = client.stress(contact.id, &wanted, true).await.unwrap();
    assert_eq!(stress.places(), [0.0, 1e-5]);
    assert!(stress.pressure.is_none() && stress.shear.unwrap().len() == 2);
    assert_eq!(client.residual(contact.id).await.unwrap(), residual.unwrap());

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
    let page = client.hysteresis_loop(contact.id, Some(1), Some(1), Some(4)).await.unwrap();
    assert_eq!((page.sequence, page.part, page.next), (vec![2; 4], vec![0.25, 0.5, 0.75, 1.0], Some(2)));
    let request = ForkRequest { label: Some("what if".to_owned()), sequence: None };
    let fork = client.fork(contact.id, &request, &plain).await.unwrap();
    assert_eq!((fork.sequence, fork.state), (5, followed.steps[3]));
    let shown = client.contact(contact.id).await.unwrap();
    assert_eq!((shown.sequence, shown.state), (5, followed.steps[3]));
    let page = client.contacts(None, Some(1)).await.unwrap();
    assert_eq!((page.items[0].id, page.next), (contact.id, Some(contact.id)));
    let page = client.contacts(page.next, None).await.unwrap();
    assert_eq!((page.items[0].label.as_deref(), page.next), (Some("what if"), None));
    client.delete(contact.id, &plain).await.unwrap();
    assert_eq!(client.contact(contact.id).await.unwrap_err().problem().unwrap().code, "contact_not_found");

    let mut request: SweepRequest = serde_json::from_value(json!({
        "base": of(&ball(), &json!({"path": {"displacement": [1e-8]}})),
        "axes": [{"pointer": "/contact/friction", "values": [0.1, 0.2, 0.3]}], "outputs": ["/steps/0/force"]
    }))
    .unwrap();
    let Swept::Table(table) = client.sweep(&request, &plain).await.unwrap() else { panic!("three points are no job") };
    assert_eq!((table.points, table.columns["/steps/0/force"].len()), (3, 3));
    request.job = true;
    let Swept::Job(job) = client.sweep(&request, &plain).await.unwrap() else { panic!("a job was asked for") };
    until("the job ends", async || (client.job(job.id).await.unwrap().state != JobState::Running).then_some(())).await;
    assert_eq!(client.job_result(job.id).await.unwrap(), table);
    client.delete_job(job.id).await.unwrap();
    assert_eq!(client.job(job.id).await.unwrap_err().problem().unwrap().code, "job_not_found");
}

#[tokio::test]
async fn a_simulation_computes_what_is_asked_for_and_nothing_else_with_either_solver() {
    let server = Server::start().await;
    let ask = async |more: Value| {
        let body = of(&ball(), &json!({"path": {"falling_amplitude": {"reversals": 20}}}));
        let body = crate::common::changed(body, &more);
        server.client.simulate(&serde_json::from_value(body).unwrap()).await.unwrap()
    };
    let exact = ask(json!({})).await;
    assert!(exact.steps.len() == 21 && exact.stress.is_none() && exact.residual.is_none());
    assert_eq!(exact.accuracy.solver, SolverKind::Exact);
    let last = exact.steps[20];
    let stress = json!({"stress": {"points": 3, "fields": ["pressure"]}, "residual": true, "steps": "last"});
    let reply = ask(stress).await;
    assert_eq!(reply.steps, [last]);
    let stress = reply.stress.unwrap();
    assert!(stress.shear.is_none());
    assert_eq!(stress.places(), [0.0, 0.5 * last.contact_radius, last.contact_radius]);
    assert_eq!((stress.pressure.unwrap()[2], reply.residual.unwrap().peaks.len()), (Some(0.0), 20));
    let springs = ask(json!({"solver": {"springs": {"count": 4000}}})).await;
    assert_eq!(springs.accuracy.solver, SolverKind::Springs);
}

#[tokio::test]
async fn a_zero_of_a_new_contact_has_no_sign() {
    let server = Server::start().await;
    for friction in [0.0, 0.3] {
        let text = server.post("/contacts", &with(ball(), "/friction", json!(friction))).await.text().await.unwrap();
        assert!(text.contains("\"id\"") && !text.contains("-0.0"), "{text}");
    }
}

#[tokio::test]
async fn headers_say_where_and_which() {
    let server = Server::start().await;
    let created = server.post("/contacts", &ball()).await;
    let place = created.headers()["location"].to_str().unwrap().to_owned();
    assert_eq!((created.status().as_u16(), &created.headers()["etag"]), (201, &"\"0\"".parse().unwrap()));
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
    let server = Process::with("memory:", &[]);
    server.client.healthz().await.unwrap();
    let address = server.base.trim_start_matches("http://").to_owned();
    let healthcheck = |address: &str| run(&["healthcheck", "--listen", address]).status.success();
    assert!(healthcheck(&address) && !healthcheck("127.0.0.1:1"));
    let mut idle = tokio::net::TcpStream::connect(address).await.unwrap();
    server.stop().await;
    // It was the server that closed the connection.
    assert_eq!(idle.read(&mut [0]).await.unwrap_or(0), 0);
}
