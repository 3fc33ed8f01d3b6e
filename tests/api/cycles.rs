//! Closed cycles of a contact: found as by their definition, measured as by the mechanics, the same wherever they are
//! read from.

use crate::common;

use std::sync::Arc;

use common::{Binary, PATIENCE, Server, create, problem};
use futures::StreamExt as _;
use proptest::prelude::*;
use proptest::strategy::ValueTree as _;
use proptest::test_runner::TestRunner;
use serde_json::{Value, json};
use stickslip::sessions::CAPACITY;
use stickslip::store::MemoryStore;
use stickslip_mechanics::{Contact, DEFAULT_TOLERANCE, Tangential};
use stickslip_wire::client::{Client, Event, Options};
use stickslip_wire::{Cycle, Document as _, ForkRequest, HistoryItem, Move, Path, PathRequest, Regime, Steps};
use tempfile::tempdir;
use uuid::Uuid;

/// The force of gross slip of the contact of the examples, N.
const LIMIT: f64 = 3.0;

fn same(one: f64, other: f64) -> bool {
    (one - other).abs() <= 0.0
}

fn along(moves: Vec<Move>) -> PathRequest {
    PathRequest { path: Path::Moves(moves), stress: None, steps: Steps::Last, tolerance: None }
}

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

async fn history(client: &Client, id: Uuid) -> Vec<HistoryItem> {
    client.history(id, None, Some(1_000)).await.unwrap().items
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

/// A value of a strategy, the next one of a fixed sequence.
fn draw<T>(runner: &mut TestRunner, strategy: &impl Strategy<Value = T>) -> T {
    strategy.new_tree(runner).unwrap().current()
}

/// Force amplitude and friction work of a steady cycle of a ball, over those of gross slip: mu F_N, and that times the
/// displacement (Mindlin & Deresiewicz 1953).
fn mindlin(amplitude: f64) -> (f64, f64) {
    let part = amplitude.min(1.0);
    let left = 1.0 - part;
    let force = 1.0 - left.powf(1.5);
    // Eight times the area between F = 1 - (1 - U)^1.5 and its chord, and the way that the contact slides.
    let area = part - 0.4 * (1.0 - left.powf(2.5));
    (force, 8.0 * (area - 0.5 * force * part) + 4.0 * (amplitude - part))
}

#[tokio::test]
async fn a_bench_run_has_its_cycles_with_their_work() {
    let server = Server::start().await;
    let client = &server.client;
    let (id, unit) = new(client).await;
    // A ramp, five equal cycles, growing ones with an inner one, and one beyond gross slip.
    let mut path = vec![0.2, 0.4];
    path.extend([-0.4, 0.4].repeat(5));
    path.extend([-0.5, 0.5, -0.6, -0.1, -0.3, 0.6, -1.7, 1.7, -1.7]);
    follow(client, id, slide(unit, &path)).await;
    let expected = [
        (2, 4, 0.4),
        (4, 6, 0.4),
        (6, 8, 0.4),
        (8, 10, 0.4),
        (10, 12, 0.4),
        // Down to -0.5 the path is that of a first loading, which nothing comes back to: the cycle begins there.
        (13, 15, 0.5),
        (16, 18, 0.1),
        (15, 19, 0.6),
        (19, 21, 1.7),
    ];
    let found = cycles(client, id).await;
    assert_eq!(ends(&found), expected.map(|(from, to, _)| (from, to)));
    for (cycle, (.., amplitude)) in found.iter().zip(expected) {
        let (force, work) = mindlin(amplitude);
        assert!((cycle.displacement_amplitude / unit - amplitude).abs() < 1e-12, "{cycle:?}");
        assert!((cycle.force_amplitude / LIMIT - force).abs() < 1e-12, "{cycle:?}");
        assert!((cycle.dissipated_energy / (LIMIT * unit) - work).abs() < 1e-12, "{cycle:?}");
        let stiffness = cycle.force_amplitude / cycle.displacement_amplitude;
        assert!((cycle.secant_stiffness.unwrap() / stiffness - 1.0).abs() < 1e-15);
        // The branch from the upper end falls by twice the first loading.
        let zero = amplitude - 2.0 * (1.0 - (1.0 - 0.5 * force).powf(2.0 / 3.0));
        assert!((cycle.sliding_ratio.unwrap() * amplitude - zero).abs() < 1e-12, "{cycle:?}");
    }
    let history = history(client, id).await;
    let work = |sequence: u64| history[sequence as usize - 1].state.dissipated_energy;
    for cycle in &found[..5] {
        let recorded = work(cycle.to) - work(cycle.from);
        assert!((cycle.dissipated_energy / recorded - 1.0).abs() < 1e-12, "{cycle:?} {recorded}");
    }
    let newest = client.cycles(id, Some(2)).await.unwrap().items;
    assert_eq!(newest, found[7..]);
}

/// The cycles at constant load, each by its definition: the first return to a turning point after an excursion that was
/// no larger than a way by which the displacement had come to it. The first loading counts as one from its mirror
/// image, gross slip as one from infinity. Where several turning points are equal, each begins or turns one cycle at
/// most.
fn by_definition(history: &[HistoryItem]) -> Vec<(u64, u64, f64)> {
    let states: Vec<_> = history.iter().map(|item| item.state).collect();
    let at = |index: usize| if index == 0 { 0.0 } else { states[index - 1].displacement };
    let count = states.len() + 1;
    let turns = |index: usize| {
        let before = (0..index).rev().map(at).find(|other| !same(*other, at(index)));
        let after = (index + 1 < count).then(|| at(index + 1)).filter(|next| !same(*next, at(index)));
        before.zip(after).is_some_and(|(before, after)| (at(index) - before) * (after - at(index)) < 0.0)
    };
    let (mut used, mut found) = (vec![false; count], Vec::new());
    for end in 2..count {
        for begin in (1..end).rev().filter(|begin| turns(*begin)) {
            let sign = if at(begin + 1) < at(begin) { 1.0 } else { -1.0 };
            let height = |index: usize| sign * at(index);
            let returns = (begin + 1..end).all(|index| height(index) < height(begin)) && height(end) >= height(begin);
            if used[begin] || !returns {
                continue;
            }
            let depth = (begin + 1..end).map(height).fold(f64::INFINITY, f64::min);
            let way: Vec<usize> = (0..=begin).rev().take_while(|index| height(*index) <= height(begin)).collect();
            let mut room = way.iter().map(|index| height(*index)).fold(height(begin), f64::min);
            if way.last() == Some(&0) {
                room = room.min(-height(begin));
            }
            let slides =
                |index: usize| states[index - 1].regime == Regime::GrossSlip && sign * states[index - 1].force > 0.0;
            if way.iter().any(|index| *index > 0 && same(height(*index), height(begin)) && slides(*index)) {
                room = f64::NEG_INFINITY;
            }
            if depth >= room {
                let turn =
                    (begin + 1..end).rev().find(|index| same(height(*index), depth) && turns(*index) && !used[*index]);
                let Some(turn) = turn else { continue };
                (used[begin], used[turn]) = (true, true);
                found.push((begin as u64, end as u64, 0.5 * (height(begin) - depth)));
            }
        }
    }
    found
}

#[tokio::test]
async fn random_paths_have_the_cycles_of_the_definition() {
    let server = Server::start().await;
    let client = &server.client;
    let mut runner = TestRunner::deterministic();
    let mut count = 0;
    for case in 0..60 {
        // On a grid there are ties, rests and half-way stops; farther out, gross slip.
        let reach = [7, 12, 20][case % 3];
        let on_grid = prop::collection::vec((-reach..=reach).prop_map(|step| f64::from(step) / 8.0), 60);
        let free = prop::collection::vec(-1.4..1.4, 60);
        let path: Vec<f64> = if case < 45 { draw(&mut runner, &on_grid) } else { draw(&mut runner, &free) };
        let (id, unit) = new(client).await;
        follow(client, id, slide(unit, &path)).await;
        let history = history(client, id).await;
        let expected = by_definition(&history);
        let found = cycles(client, id).await;
        assert_marked(&history, &found);
        let found: Vec<_> = found.iter().map(|cycle| (cycle.from, cycle.to, cycle.displacement_amplitude)).collect();
        assert_eq!(found, expected, "{path:?}");
        count += found.len();
    }
    assert!(count > 500, "{count}");
}

/// A contact of the mechanics after these moves.
fn replayed(history: &[HistoryItem]) -> Contact {
    let mut contact = Contact::new(create().check().unwrap().setup).unwrap();
    for item in history {
        contact.apply_within(&item.step.step(), DEFAULT_TOLERANCE).unwrap();
    }
    contact
}

#[tokio::test]
async fn steady_cycles_are_closed_whatever_the_load_did_before() {
    let server = Server::start().await;
    let client = &server.client;
    let mut runner = TestRunner::deterministic();
    let (mut steady, mut other) = (0, 0);
    for _ in 0..30 {
        let one = (0..14, -1.2..1.2, 0.5..1.5);
        let (id, unit) = new(client).await;
        let state = client.contact(id).await.unwrap().state;
        let moves = draw(&mut runner, &prop::collection::vec(one, 80)).into_iter().map(|(kind, along, load)| {
            let indentation = Some(load * state.indentation);
            match kind {
                0 => Move { indentation, ..Move::default() },
                1 => Move { indentation, ..Move::displacement(along * unit) },
                2 => Move { normal_force: Some(load * state.normal_force), ..Move::default() },
                3 if load < 0.55 => Move { indentation: Some(-1e-9), ..Move::default() },
                _ => Move::displacement(along * unit),
            }
        });
        let moves: Vec<Move> = moves.collect();
        // A move to the load from above the surface comes back at once.
        let lifted = |index: usize| index > 0 && moves[index - 1].indentation.is_some_and(|depth| depth < 0.0);
        let load = Move { indentation: Some(state.indentation), ..Move::default() };
        let moves = moves.iter().enumerate().map(|(index, step)| if lifted(index) { load } else { *step });
        follow(client, id, moves.collect()).await;
        let history = history(client, id).await;
        let found = cycles(client, id).await;
        for (index, cycle) in found.iter().enumerate() {
            let inner = |inner: &&Cycle| inner.from >= cycle.from;
            let inner: f64 = found[..index].iter().filter(inner).map(|cycle| cycle.dissipated_energy).sum();
            let begin = history[cycle.from as usize - 1].state;
            // The last move only as far as the cycle goes.
            let mut contact = replayed(&history[..cycle.to as usize - 1]);
            let limit = contact.summary().gross_slip_force;
            let tangential = Some(Tangential::Displacement(begin.displacement));
            contact.apply(&stickslip_mechanics::Move { tangential, ..Default::default() }).unwrap();
            let work = contact.state().dissipated_energy - begin.dissipated_energy - inner;
            if cycle.sliding_ratio.is_some() {
                assert!((contact.force() - begin.force).abs() < 1e-11 * limit, "{cycle:?}");
                assert!((work - cycle.dissipated_energy).abs() < 1e-11 * limit * unit, "{cycle:?} {work}");
                steady += 1;
            } else {
                other += 1;
            }
        }
    }
    assert!(steady > 50 && other > 50, "{steady} {other}");
}

#[tokio::test]
async fn a_cycle_under_a_changing_load_is_what_was_recorded() {
    let server = Server::start().await;
    let client = &server.client;
    let (id, unit) = new(client).await;
    let oblique = |part: f64, load: f64| Move { normal_force: Some(load), ..Move::displacement(part * unit) };
    let lap = [oblique(0.5, 12.0), oblique(-0.5, 8.0)];
    // The last cycle has a smaller one at constant load within it.
    let mut moves = lap.repeat(3);
    moves.extend(slide(unit, &[0.1, -0.2]));
    moves.push(lap[0]);
    follow(client, id, moves).await;
    let (found, history) = (cycles(client, id).await, history(client, id).await);
    assert_eq!(ends(&found), [(1, 3), (3, 5), (7, 9), (5, 9)]);
    let state = |sequence: u64| history[sequence as usize - 1].state;
    for cycle in [&found[0], &found[1], &found[3]] {
        let forces = || (cycle.from..=cycle.to).map(|sequence| state(sequence).force);
        let range = forces().fold(f64::MIN, f64::max) - forces().fold(f64::MAX, f64::min);
        assert_eq!((cycle.force_amplitude, cycle.sliding_ratio), (0.5 * range, None));
        assert!((cycle.displacement_amplitude / unit - 0.5).abs() < 1e-15);
        let stiffness = cycle.force_amplitude / cycle.displacement_amplitude;
        assert!((cycle.secant_stiffness.unwrap() / stiffness - 1.0).abs() < 1e-15);
    }
    let work = |cycle: &Cycle| state(cycle.to).dissipated_energy - state(cycle.from).dissipated_energy;
    assert!((found[0].dissipated_energy / work(&found[0]) - 1.0).abs() < 1e-12);
    assert!(((found[2].dissipated_energy + found[3].dissipated_energy) / work(&found[3]) - 1.0).abs() < 1e-12);
}

#[tokio::test]
async fn a_change_of_the_load_before_a_cycle_leaves_it_open_until_it_has_been_gone_through() {
    let server = Server::start().await;
    let client = &server.client;
    let (id, unit) = new(client).await;
    let mut moves = slide(unit, &[0.5]);
    // The ring that this adds carries nothing yet, so that the force does not come back with the displacement.
    moves.push(Move { normal_force: Some(14.0), ..Move::default() });
    moves.extend(slide(unit, &[0.1, 0.5, 0.1, 0.5]));
    follow(client, id, moves).await;
    let (found, history) = (cycles(client, id).await, history(client, id).await);
    assert_eq!(ends(&found), [(2, 4), (4, 6)]);
    let (before, after) = (history[1].state, history[3].state);
    assert!((before.force - after.force).abs() > 1e-3 * LIMIT && found[0].sliding_ratio.is_none());
    let work = after.dissipated_energy - before.dissipated_energy;
    assert!((found[0].dissipated_energy / work - 1.0).abs() < 1e-12);
    let work = history[5].state.dissipated_energy - after.dissipated_energy;
    assert!((found[1].dissipated_energy / work - 1.0).abs() < 1e-12 && found[1].sliding_ratio.is_some());
}

#[tokio::test]
async fn a_lift_off_is_the_end_of_all_cycles() {
    let server = Server::start().await;
    let client = &server.client;
    let (id, unit) = new(client).await;
    let load = |indentation| Move { indentation: Some(indentation), ..Move::default() };
    let deep = client.contact(id).await.unwrap().state.indentation;
    let mut moves = slide(unit, &[0.5, -0.5]);
    moves.extend([load(-1e-9), load(deep)]);
    // Where it lands a new path begins: the way from -0.5 is a first loading.
    moves.extend(slide(unit, &[0.2, -0.9, 0.5, -1.2, 0.2]));
    follow(client, id, moves).await;
    assert_eq!(ends(&cycles(client, id).await), [(5, 7)]);
}

#[tokio::test]
async fn forces_that_come_back_close_cycles_though_displacements_are_rounded() {
    let server = Server::start().await;
    let client = &server.client;
    let (id, _) = new(client).await;
    follow(client, id, [1.3, -1.3].repeat(20).into_iter().map(Move::force).collect()).await;
    let found = cycles(client, id).await;
    assert_eq!(ends(&found), (0..19).map(|cycle| (2 * cycle + 1, 2 * cycle + 3)).collect::<Vec<_>>());
    for cycle in &found {
        assert!((cycle.force_amplitude / 1.3 - 1.0).abs() < 1e-12, "{cycle:?}");
    }
}

#[tokio::test]
async fn cycles_are_the_same_after_a_restart_in_a_fork_and_read_piece_by_piece() {
    let folder = tempdir().unwrap();
    let store = format!("sqlite:{}", folder.path().join("contacts.db").display());
    let mut runner = TestRunner::deterministic();
    let path = draw(&mut runner, &prop::collection::vec(-1.4..1.4, 90));
    let memory = Arc::new(MemoryStore::new());
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

    let server = Binary::over(&store, &[]);
    let (id, _) = new(&server.client).await;
    follow(&server.client, id, slide(unit, &path)).await;
    assert_eq!(cycles(&server.client, id).await, expected);
    let fork = server.client.fork(id, &ForkRequest::default(), &Options::default()).await.unwrap().id;
    follow(&server.client, fork, slide(unit, &[2.0, -2.0, 2.0])).await;
    drop(server);
    let server = Binary::over(&store, &[]);
    assert_marked(&history(&server.client, id).await, &expected);
    assert_eq!(cycles(&server.client, id).await, expected);
    assert_eq!(cycles(&server.client, fork).await, expected_of_fork);
    assert_marked(&history(&server.client, fork).await, &expected_of_fork);
}

#[tokio::test]
async fn a_history_is_marked_the_same_in_whatever_order_it_is_read() {
    let memory = Arc::new(MemoryStore::new());
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
