//! A contact of which a move is missing in the store: nothing is answered for it, and the contacts beside it are
//! served.

use crate::common;
use crate::fixtures::{along, soon};

use common::kill::Random;
use common::place::Place;
use common::process::Process;
use common::{Server, create, problem, run};
use futures::StreamExt as _;
use reqwest::Method;
use stickslip_wire::client::{Client, Event, Options};
use stickslip_wire::{EndReason, ForkRequest};
use uuid::Uuid;

const MOVES: usize = 12;

/// A contact with moves.
async fn moved(client: &Client) -> Uuid {
    let (options, mut random) = (Options::default(), Random(3));
    let id = client.create(&create(), &options).await.unwrap().id;
    client.path(id, &along((0..MOVES).map(|_| random.step()).collect()), &options).await.unwrap();
    id
}

/// Every question about a contact and every change of it is refused, named in the log, and found by `check`.
async fn is_damaged(process: &Process, store: &str, (damaged, whole): (Uuid, Uuid), missing: &str) {
    let server = Server::at(&process.base);
    let past = format!("/contacts/{damaged}");
    for question in [
        "",
        "/history",
        "/history?format=csv&limit=20",
        "/history?format=csv",
        "/history?format=csv&cycles=false",
        "/history?format=ndjson",
        "/history?format=arrow",
        "/cycles",
        "/loop",
        "/loop?format=csv",
        "/loop?format=csv&points_per_move=3",
        "/stress?points=2",
        "/events",
    ] {
        let refusal = problem(server.get(&format!("{past}{question}")).await).await;
        assert_eq!((refusal.status, &*refusal.code), (500, "damaged_contact"), "{question}: {refusal:?}");
        assert!(refusal.detail.contains(&damaged.to_string()), "{refusal:?}");
    }
    for (change, body) in
        [("move", r#"{"force": 0.1}"#), ("path", r#"{"path": {"displacement": [1e-9]}}"#), ("fork", "{}")]
    {
        let refusal = server.send(Method::POST, &format!("{past}/{change}"), Some(body), &[]).await;
        assert_eq!(problem(refusal).await.code, "damaged_contact", "{change}");
    }
    // What was made before the gap is rescued.
    let before = ForkRequest { sequence: Some(6), label: None };
    assert_eq!(server.client.fork(damaged, &before, &Options::default()).await.unwrap().sequence, 6);
    assert_eq!(server.client.contact(whole).await.unwrap().sequence, MOVES as u64);
    let lines = process.log();
    let named = lines.lines().filter(|line| line.contains("ERROR") && line.contains(&damaged.to_string()));
    assert!(named.filter(|line| line.contains(missing)).count() >= 10, "{lines}");
    let checked = run(&["check", "--store", store]);
    let said = String::from_utf8(checked.stdout).unwrap();
    assert!(said.starts_with(&format!("contact {damaged}: {missing}\n")) && said.contains(": 1 finding\n"), "{said}");
}

#[tokio::test]
async fn a_gap_in_the_moves_is_answered_by_an_error_of_its_own() {
    for (missing, which) in [("move 7 is missing", "= 7"), ("move 11 is missing", "> 10")] {
        // In a file the last move itself says how many there are.
        for place in Place::both().await.into_iter().skip(usize::from(which == "> 10")) {
            let start = || Process::with(&place.url(), &["--log", "warn"]);
            let process = start();
            let (damaged, whole) = (moved(&process.client).await, moved(&process.client).await);
            process.stop().await;
            let contact = place.key("contacts", damaged);
            place.change(&format!("DELETE FROM moves WHERE contact = {contact} AND sequence {which}")).await;
            let process = start();
            is_damaged(&process, &place.url(), (damaged, whole), missing).await;
            process.stop().await;
        }
    }
}

#[tokio::test]
async fn a_gap_that_comes_while_a_contact_is_cached_ends_its_events_and_refuses_its_forks() {
    let place = Place::file();
    let process = Process::start(&place.url()).await;
    let id = moved(&process.client).await;
    place.change("DELETE FROM moves WHERE sequence = 7").await;
    let mut events = Box::pin(process.client.events(id, Some(0)).await.unwrap());
    assert_eq!(events.next().await.unwrap().unwrap(), Event::End(EndReason::Damaged));
    let server = Server::at(&process.base);
    let fork = server.send(Method::POST, &format!("/contacts/{id}/fork"), Some("{}"), &[]).await;
    assert_eq!(problem(fork).await.code, "damaged_contact");
    assert_eq!(process.client.contacts(None, None).await.unwrap().items.len(), 1);
    // The refused fork has left nothing behind.
    process.stop().await;
    let unowned = "SELECT count(*) FROM moves WHERE contact NOT IN (SELECT number FROM contacts)";
    assert_eq!(place.number(unowned).await, 0);
}

#[tokio::test]
async fn a_snapshot_of_moves_that_are_not_stored_is_not_believed() {
    let place = Place::file();
    let process = Process::start(&place.url()).await;
    let (options, mut random) = (Options::default(), Random(5));
    let id = process.client.create(&create(), &options).await.unwrap().id;
    for _ in 0..6 {
        process.client.path(id, &along((0..2_000).map(|_| random.step()).collect()), &options).await.unwrap();
    }
    place.has_snapshot().await;
    process.stop().await;
    place.change("DELETE FROM moves WHERE sequence > (SELECT sequence - 1 FROM snapshots)").await;
    let process = Process::start(&place.url()).await;
    let server = Server::at(&process.base);
    assert_eq!(problem(server.get(&format!("/contacts/{id}")).await).await.code, "damaged_contact");
}

#[tokio::test]
async fn events_that_can_never_be_read_end_by_a_reason_and_a_line_of_the_log() {
    let place = Place::file();
    let process = Process::with(&place.url(), &["--log", "warn"]);
    let id = moved(&process.client).await;
    place.change("UPDATE moves SET regime = 'unknown' WHERE sequence = 7").await;
    let mut events = Box::pin(process.client.events(id, Some(0)).await.unwrap());
    assert_eq!(soon(events.next()).await.unwrap().unwrap(), Event::End(EndReason::Failed));
    assert!(events.next().await.is_none());
    let lines = process.stop().await;
    let named = |line: &&str| line.contains("events end") && line.contains("ERROR") && line.contains(&id.to_string());
    assert_eq!(lines.lines().filter(named).count(), 1, "{lines}");
}
