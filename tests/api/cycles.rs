//! Closed cycles of a contact: those of the library, the same wherever they are read from. What they are is tested in
//! `crates/mechanics/tests/physics/closed_cycles.rs`.

use crate::common;

use std::sync::Arc;

use common::kill::history;
use common::process::Process;
use common::{PATIENCE, Server, along, create, problem};
use futures::StreamExt as _;
use proptest::prelude::*;
use proptest::strategy::ValueTree as _;
use proptest::test_runner::TestRunner;
use serde_json::{Value, json};
use stickslip::sessions::CAPACITY;
use stickslip::store::SqliteStore;
use stickslip_mechanics::closed_cycles::{ClosedCycle, CycleLog};
use stickslip_mechanics::{Contact, DEFAULT_TOLERANCE};
use stickslip_wire::client::{Client, Event, Options};
use stickslip_wire::{Cycle, Document as _, ForkRequest, HistoryItem, Move};
use tempfile::tempdir;
use uuid::Uuid;

/// A new contact, and its displacement of gross slip.
async fn new(client: &Client) -> (Uuid, f64) {
    let made = client.create(&create(), &Options::default()).await.unwrap();
    (made.id, made.contact.gross_slip_displacement)
}

async fn follow(client: &Client, id: Uuid, moves: Vec<Move>) {
    client.path(id, &along(moves), &Options::default()).await.unwrap();
}

/// Moves through these displacements, in units of the displacement of gross slip.
fn slide(unit: f64, displacements: &[f64]) -> Vec<Move> {
    displacements.iter().map(|part| Move::displacement(part * unit)).collect()
}

async fn cycles(client: &Client, id: Uuid) -> Vec<Cycle> {
    client.cycles(id, Some(1_000)).await.unwrap().items
}

fn ends(cycles: &[Cycle]) -> Vec<(u64, u64)> {
    cycles.iter().map(|cycle| (cycle.from, cycle.to)).collect()
}

/// The cycles that the moves of a history carry are those that close last with them.
fn assert_marked(history: &[HistoryItem], cycles: &[Cycle]) {
    for item in history {
        let outermost = cycles.iter().rfind(|cycle| cycle.to == item.sequence);
        assert_eq!(item.cycle.as_ref(), outermost, "move {}", item.sequence);
    }
}

/// The newest cycles after these moves, as the mechanics finds and measures them.
fn by_the_library(history: &[HistoryItem]) -> Vec<Cycle> {
    let virgin = Contact::new(create().check().unwrap().setup).unwrap();
    let (mut contact, mut log) = (virgin.clone(), CycleLog::new(&virgin.state(), 1_000));
    for item in history {
        contact.apply_within(&item.step.step(), DEFAULT_TOLERANCE).unwrap();
        log.push(item.sequence, &contact.state());
    }
    let measured = |cycle: &ClosedCycle| {
        let found = cycle.loop_of(&virgin).unwrap();
        let stiffness = found.force_amplitude / cycle.displacement_amplitude;
        Cycle {
            from: cycle.from,
            to: cycle.to,
            displacement_amplitude: cycle.displacement_amplitude,
            force_amplitude: found.force_amplitude,
            secant_stiffness: Some(stiffness),
            dissipated_energy: found.dissipated_energy,
            sliding_ratio: found.sliding_ratio,
        }
    };
    log.newest.iter().map(measured).collect()
}

#[tokio::test]
async fn cycles_are_those_of_the_library_with_their_loops() {
    let server = Server::start().await;
    let client = &server.client;
    let (id, unit) = new(client).await;
    let mut moves = slide(unit, &[0.2, 0.4, -0.4, 0.4, -0.5, 0.5, -0.6, -0.1, -0.3, 0.6, -1.7, 1.7, -1.7]);
    let to = |part: f64, load: f64| Move { normal_force: Some(load), ..Move::displacement(part * unit) };
    moves.extend([to(0.5, 12.0), to(-0.5, 8.0)].repeat(3));
    follow(client, id, moves).await;
    let (found, history) = (cycles(client, id).await, history(client, id).await);
    assert_marked(&history, &found);
    assert_eq!(found, by_the_library(&history));
    assert!(found.len() > 6 && found.iter().any(|cycle| cycle.sliding_ratio.is_none()));
    let newest = client.cycles(id, Some(2)).await.unwrap().items;
    assert_eq!(newest, found[found.len() - 2..]);
}

#[tokio::test]
async fn cycles_are_the_same_after_a_restart_in_a_fork_and_read_piece_by_piece() {
    let folder = tempdir().unwrap();
    let store = format!("sqlite:{}", folder.path().join("contacts.db").display());
    let path = prop::collection::vec(-1.4..1.4, 90).new_tree(&mut TestRunner::deterministic()).unwrap().current();
    let memory = Arc::new(SqliteStore::in_memory().unwrap());
    let (cached, uncached) = (Server::with(memory.clone(), CAPACITY).await, Server::with(memory, 0).await);
    let (id, unit) = new(&cached.client).await;
    for moves in path.chunks(7) {
        follow(&cached.client, id, slide(unit, moves)).await;
        // The one reads on where it was, the other from the beginning.
        let found = cycles(&cached.client, id).await;
        assert_eq!(found, cycles(&uncached.client, id).await);
        for server in [&cached, &uncached] {
            assert_marked(&history(&server.client, id).await, &found);
        }
    }
    let expected = cycles(&uncached.client, id).await;
    assert!(expected.len() > 20);
    let fork = cached.client.fork(id, &ForkRequest::default(), &Options::default()).await.unwrap().id;
    for server in [&cached, &uncached] {
        assert_eq!(cycles(&server.client, fork).await, expected);
    }
    follow(&uncached.client, fork, slide(unit, &[2.0, -2.0, 2.0])).await;
    let expected_of_fork = cycles(&uncached.client, fork).await;
    assert!(expected_of_fork.len() > expected.len() && expected_of_fork.starts_with(&expected));

    let server = Process::with(&store, &[]);
    let (id, _) = new(&server.client).await;
    follow(&server.client, id, slide(unit, &path)).await;
    assert_eq!(cycles(&server.client, id).await, expected);
    let fork = server.client.fork(id, &ForkRequest::default(), &Options::default()).await.unwrap().id;
    follow(&server.client, fork, slide(unit, &[2.0, -2.0, 2.0])).await;
    drop(server);
    let server = Process::with(&store, &[]);
    assert_marked(&history(&server.client, id).await, &expected);
    assert_eq!(cycles(&server.client, id).await, expected);
    assert_eq!(cycles(&server.client, fork).await, expected_of_fork);
    assert_marked(&history(&server.client, fork).await, &expected_of_fork);
}

#[tokio::test]
async fn a_history_is_marked_the_same_in_whatever_order_it_is_read() {
    let memory = Arc::new(SqliteStore::in_memory().unwrap());
    let (cached, uncached) = (Server::with(memory.clone(), CAPACITY).await, Server::with(memory, 0).await);
    let (id, unit) = new(&cached.client).await;
    // More cycles than a list can have: each second move closes one that began two moves before.
    follow(&cached.client, id, slide(unit, &[0.5, -0.5].repeat(1_200))).await;
    for (after, limit) in [(0, 40), (40, 40), (2_300, 1_000), (80, 40), (7, 1), (2_000, 100), (120, 1_000), (1, 2)] {
        for server in [&cached, &uncached] {
            let page = server.client.history(id, Some(after), Some(limit)).await.unwrap();
            assert_eq!(page.items[0].sequence, after + 1);
            for item in page.items {
                let expected =
                    (item.sequence > 2 && item.sequence % 2 == 1).then(|| (item.sequence - 2, item.sequence));
                assert_eq!(item.cycle.map(|cycle| (cycle.from, cycle.to)), expected, "after {after}");
            }
        }
        assert_eq!(cycles(&cached.client, id).await.len(), 1_000);
    }
}

#[tokio::test]
async fn an_event_carries_the_cycle_that_its_move_closes_and_the_outermost_of_several() {
    let server = Server::start().await;
    let client = &server.client;
    let (id, unit) = new(client).await;
    let mut events = std::pin::pin!(client.events(id, Some(0)).await.unwrap());
    let path = [0.5, -0.5, 0.1, -0.2, 0.0, -0.1, 0.5, -0.5, 0.7];
    let mut closed = Vec::new();
    for step in slide(unit, &path) {
        client.apply(id, &step.into(), &Options::default()).await.unwrap();
        let event = tokio::time::timeout(PATIENCE, events.next()).await.unwrap().unwrap().unwrap();
        let Event::State(state) = event else { panic!("{event:?}") };
        let found = cycles(client, id).await;
        assert_eq!(state.cycle.as_ref(), found.iter().rfind(|cycle| cycle.to == state.sequence));
        closed.extend(state.cycle.map(|cycle| (cycle.from, cycle.to)));
    }
    // The seventh move closes those within too: 5 to 7 and 3 to 7.
    assert_eq!(closed, [(1, 7), (7, 9)]);
    assert_eq!(ends(&cycles(client, id).await), [(5, 7), (3, 7), (1, 7), (7, 9)]);
    // A listener that comes late sees the last move as the others did.
    let late = std::pin::pin!(client.events(id, None).await.unwrap()).next().await.unwrap().unwrap();
    let Event::State(state) = late else { panic!("{late:?}") };
    assert_eq!((state.sequence, state.cycle.as_ref()), (9, cycles(client, id).await.last()));
}

#[tokio::test]
async fn what_has_no_cycles_has_an_empty_list_and_what_is_wrong_is_refused_at_its_place() {
    let server = Server::start().await;
    let (id, unit) = new(&server.client).await;
    let path = format!("/contacts/{id}/cycles");
    assert_eq!(server.get(&path).await.json::<Value>().await.unwrap(), json!({"items": []}));
    assert_eq!(server.get(&format!("{path}?format=rows")).await.json::<Value>().await.unwrap(), json!([]));
    // A first loading and the way back close nothing: the force does not come back to zero.
    follow(&server.client, id, slide(unit, &[0.5, 0.0])).await;
    assert_eq!(server.get(&path).await.json::<Value>().await.unwrap(), json!({"items": []}));

    for (query, pointer) in [
        ("last=0", "/last"),
        ("last=1001", "/last"),
        ("last=-1", "/last"),
        ("last=18446744073709551616", "/last"),
        ("last=few", "/last"),
        ("limit=1", "/limit"),
        ("format=xml", "/format"),
    ] {
        let refused = problem(server.get(&format!("{path}?{query}")).await).await;
        assert_eq!((refused.status, refused.errors[0].pointer.as_str()), (422, pointer), "{query}");
    }
    let unknown = problem(server.get(&format!("/contacts/{}/cycles", Uuid::nil())).await).await;
    assert_eq!((unknown.status, unknown.code.as_str()), (404, "contact_not_found"));
}
