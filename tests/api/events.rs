//! Live events: each new state once, in order, without a gap, to every listener, until there are no more.

use crate::common;

use std::pin::pin;
use std::sync::Arc;

use common::process::Process;
use common::{PATIENCE, Server, create, problem};
use futures::future::join_all;
use futures::{Stream, StreamExt as _};
use reqwest::Method;
use serde_json::{Value, json};
use stickslip::admission::{Pool, STREAMS};
use stickslip::sessions::{CAPACITY, Sessions, events};
use stickslip::store::{SqliteStore, StreamEvent};
use stickslip_wire::client::{Client, Error, Event, Options};
use stickslip_wire::{EndReason, Move, Path, PathRequest, StateEvent, Steps};
use uuid::Uuid;

type Events<'a> = std::pin::Pin<Box<dyn Stream<Item = Result<Event, Error>> + Send + 'a>>;

async fn listen(client: &Client, id: Uuid, after: Option<u64>) -> Events<'static> {
    Box::pin(client.events(id, after).await.unwrap())
}

async fn next(events: &mut Events<'_>) -> Event {
    let event = tokio::time::timeout(PATIENCE, events.next()).await.expect("no event came");
    event.expect("the events ended").unwrap()
}

async fn next_state(events: &mut Events<'_>) -> StateEvent {
    match next(events).await {
        Event::State(state) => *state,
        Event::End(reason) => panic!("the events ended: {reason:?}"),
    }
}

fn path(moves: usize) -> PathRequest {
    let displacement = (0..moves).map(|index| 2e-7 * (index as f64 * 2.399).sin()).collect();
    PathRequest { path: Path::Displacement(displacement).into(), stress: None, steps: Steps::Last, tolerance: None }
}

/// The moves beyond `after` by the history.
async fn past(client: &Client, id: Uuid, after: u64) -> Vec<StateEvent> {
    let (mut all, mut after) = (Vec::new(), Some(after));
    while after.is_some() {
        let page = client.history(id, after, Some(1_000)).await.unwrap();
        let event = |item: stickslip_wire::HistoryItem| StateEvent {
            id,
            sequence: item.sequence,
            step: Some(item.step),
            state: item.state,
            cycle: item.cycle,
            observation: item.observation,
            at: item.at,
        };
        all.extend(page.items.into_iter().map(event));
        after = page.next;
    }
    all
}

#[tokio::test]
async fn everybody_sees_the_same_moves_in_order_after_the_present_state() {
    let server = Server::start().await;
    let (client, options) = (&server.client, Options::default());
    let new = client.create(&create(), &options).await.unwrap();
    let id = new.id;
    let (mut early, mut other) = (listen(client, id, None).await, listen(client, id, None).await);
    for events in [&mut early, &mut other] {
        let first = next_state(events).await;
        assert_eq!((first.id, first.sequence, first.step, first.state), (id, 0, None, new.state));
    }
    let writes = (0..40).map(|index| {
        let step = Move { relative: true, ..Move::displacement(1e-9 * f64::from(index)) };
        let options = options.clone();
        async move { client.apply(id, &step.into(), &options).await.unwrap() }
    });
    join_all(writes).await;
    let expected = past(client, id, 0).await;
    assert!(expected.iter().map(|state| state.sequence).eq(1..=40), "{expected:?}");
    assert!((expected[39].state.displacement.unwrap() - 7.8e-7).abs() < 1e-18, "{:?}", expected[39]);
    for events in [&mut early, &mut other] {
        for state in &expected {
            assert_eq!(&next_state(events).await, state);
        }
    }
    // A new listener gets the last state first.
    let mut late = listen(client, id, None).await;
    assert_eq!(&next_state(&mut late).await, &expected[39]);
    client.apply(id, &Move::displacement(0.0).into(), &options).await.unwrap();
    for events in [&mut early, &mut other, &mut late] {
        assert_eq!(next_state(events).await.sequence, 41);
    }
}

#[tokio::test]
async fn a_move_is_read_and_written_once_however_many_follow() {
    let pool = Pool::with_defaults();
    let sessions = Sessions::new(Arc::new(SqliteStore::in_memory().unwrap()), pool.clone(), CAPACITY);
    let client = Server::over(sessions.clone(), pool).await.client.clone();
    let id = client.create(&create(), &Options::default()).await.unwrap().id;
    let mut followers = Vec::new();
    for _ in 0..100 {
        let mut follower = Box::pin(events(&sessions, id, None).await.unwrap());
        follower.next().await.unwrap();
        followers.push(follower);
    }
    let mut asked = 0;
    for sequence in 1..=6 {
        client.apply(id, &Move::displacement(1e-9 * sequence as f64).into(), &Options::default()).await.unwrap();
        let events = join_all(followers.iter_mut().map(|follower| follower.next())).await;
        let events: Vec<_> = events
            .into_iter()
            .map(|event| match event.unwrap() {
                StreamEvent::State(event) => event,
                StreamEvent::End(reason) => panic!("{reason:?}"),
            })
            .collect();
        assert!(events.iter().all(|event| event.sequence == sequence && Arc::ptr_eq(event, &events[0])));
        asked = if sequence == 1 { sessions.metrics.hits.get() } else { asked };
    }
    // The first event has looked at the contact for all that follow.
    assert_eq!(sessions.metrics.hits.get() - asked, 5);
}

#[tokio::test]
async fn a_path_of_a_thousand_moves_is_a_thousand_events() {
    let server = Server::start().await;
    let id = server.client.create(&create(), &Options::default()).await.unwrap().id;
    let mut events = listen(&server.client, id, Some(0)).await;
    server.client.path(id, &path(1_000), &Options::default()).await.unwrap();
    for expected in past(&server.client, id, 0).await {
        assert_eq!(next_state(&mut events).await, expected);
    }
    server.client.delete(id, &Options::default()).await.unwrap();
    assert_eq!(next(&mut events).await, Event::End(EndReason::Deleted));
    assert!(events.next().await.is_none());
}

#[tokio::test]
async fn a_listener_that_is_cut_off_at_random_misses_nothing_and_sees_nothing_twice() {
    let server = Server::start().await;
    let (client, options) = (server.client.clone(), Options::default());
    let id = client.create(&create(), &options).await.unwrap().id;
    let writer = {
        let client = client.clone();
        tokio::spawn(async move {
            for index in 0..60 {
                client.path(id, &path(1 + index % 12), &Options::default()).await.unwrap();
            }
        })
    };
    let (mut seen, mut seed, mut cuts) = (Vec::<StateEvent>::new(), 12_345_u64, 0);
    let total = (0..60).map(|index| 1 + index % 12).sum::<usize>();
    while seen.len() < total {
        let mut events = listen(&client, id, Some(seen.last().map_or(0, |state| state.sequence))).await;
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        for _ in 0..1 + (seed >> 33) % 30 {
            if seen.len() < total {
                seen.push(next_state(&mut events).await);
            }
        }
        cuts += 1;
    }
    writer.await.unwrap();
    assert_eq!(seen, past(&client, id, 0).await);
    assert!(cuts > 10, "{cuts}");
}

#[tokio::test]
async fn the_stream_is_what_event_sources_read() {
    let server = Server::start().await;
    let id = server.contact().await;
    server.post(&format!("/contacts/{id}/move"), &json!({"displacement": 1e-7})).await;
    let response = server.get(&format!("/contacts/{id}/events")).await;
    assert_eq!(response.headers()["content-type"], "text/event-stream");
    let mut chunks = pin!(response.bytes_stream());
    let mut text = String::new();
    while !text.contains("\n\n") {
        text.push_str(std::str::from_utf8(&chunks.next().await.unwrap().unwrap()).unwrap());
    }
    let mut lines: Vec<&str> = text.trim_end().lines().collect();
    lines.sort_unstable();
    let data: Value = serde_json::from_str(lines[0].strip_prefix("data: ").unwrap()).unwrap();
    assert_eq!(lines[1..], ["event: state", "id: 1"]);
    assert_eq!(
        (&data["id"], &data["sequence"], &data["move"]),
        (&json!(id), &json!(1), &json!({"displacement": 1e-7}))
    );
    assert!(data["state"]["force"].as_f64().unwrap() > 0.0 && data["at"].is_string());
}

#[tokio::test]
async fn a_fault_in_last_event_id_is_named() {
    let server = Server::start().await;
    let path = format!("/contacts/{}/events", server.contact().await);
    for value in ["-1", "x", "1.5", "", "18446744073709551616"] {
        let refused = server.send(Method::GET, &path, None, &[("last-event-id", value)]).await;
        let refused = problem(refused).await;
        assert_eq!((refused.status, refused.code.as_str()), (422, "invalid_input"), "{value}");
        assert_eq!(refused.errors[0].pointer, "/Last-Event-ID");
    }
    // One that this contact has not reached means from now; that of a query is for a client that cannot send the
    // header.
    for (query, header) in [("limit=1", Some("7")), ("limit=1&last_event_id=7", None), ("limit=1", None)] {
        let header = header.map(|value| ("last-event-id", value));
        let reply = server.send(Method::GET, &format!("{path}?{query}"), None, header.as_slice()).await;
        let text = reply.text().await.unwrap();
        assert!(text.contains("id: 0\n"), "{query}: {text}");
    }
    let unknown = problem(server.get(&format!("/contacts/{}/events", Uuid::now_v7())).await).await;
    assert_eq!(unknown.code, "contact_not_found");
    let parameter = problem(server.get(&format!("{path}?after=0")).await).await;
    assert_eq!(parameter.errors[0].pointer, "/after");
}

#[tokio::test]
async fn the_number_of_listeners_is_limited() {
    let pool = Pool::with_defaults();
    let sessions = Sessions::new(Arc::new(SqliteStore::in_memory().unwrap()), pool.clone(), CAPACITY);
    let server = Server::over(sessions.clone(), pool).await;
    let id = server.client.create(&create(), &Options::default()).await.unwrap().id;
    let mut listeners = Vec::new();
    for _ in 0..STREAMS {
        listeners.push(events(&sessions, id, None).await.unwrap());
    }
    let refused = server.get(&format!("/contacts/{id}/events")).await;
    assert_eq!(refused.headers()["retry-after"], "1");
    assert_eq!(problem(refused).await.status, 503);
    listeners.pop();
    assert_eq!(next_state(&mut listen(&server.client, id, None).await).await.sequence, 0);
}

#[tokio::test]
async fn a_graceful_stop_ends_the_events_and_is_not_held_up_by_them() {
    let server = Process::with("memory:", &[]);
    let client = server.client.clone();
    let id = client.create(&create(), &Options::default()).await.unwrap().id;
    let mut listeners = Vec::new();
    for _ in 0..5 {
        let mut events = listen(&client, id, None).await;
        assert_eq!(next_state(&mut events).await.sequence, 0);
        listeners.push(events);
    }
    server.signal("TERM");
    for events in &mut listeners {
        assert_eq!(next(events).await, Event::End(EndReason::Stopping));
        assert!(events.next().await.is_none());
    }
    let log = server.ended().await;
    // Otherwise the streams would have been closed by force when the grace was over.
    assert!(log.contains("stopping") && !log.contains("still open"), "{log}");
}
