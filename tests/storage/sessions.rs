//! The session layer over a store: snapshots that change nothing but time, a cache of bounded bytes, expiry.

use crate::common;
use crate::fixtures::{self, soon};

use std::sync::Arc;

use common::kill::exact;
use common::{Server, ball, create, problem, until, varied_moves};
use futures::StreamExt as _;
use futures::future::join_all;
use jiff::{SignedDuration, Timestamp};
use reqwest::Method;
use serde_json::json;
use stickslip::admission::Pool;
use stickslip::sessions::{Expected, SessionError, Sessions, label_checksum};
use stickslip::store::{Snapshot, SqliteStore, Store};
use stickslip_mechanics::Contact;
use stickslip_wire::client::{Client, Event, Options};
use stickslip_wire::{
    CreateRequest, Document as _, EndReason, Faults, ForkRequest, JsonPath, Move, PathRequest, PrepareAnew, State,
    StressRequest,
};
use uuid::Uuid;

/// No state is cached.
const NO_CACHE: usize = 0;

/// A path to a tolerance at which curved moves are quick.
fn along(moves: Vec<Move>) -> PathRequest {
    PathRequest { tolerance: Some(1e-6), ..fixtures::along(moves) }
}

/// Every move of a session made again from its definition, with nothing of the session layer.
async fn replayed(store: &dyn Store, id: Uuid) -> Contact {
    let session = store.find(id).await.unwrap();
    let setup = session.definition.check(JsonPath::Root, &PrepareAnew, &mut Faults::default()).unwrap();
    let mut contact = Contact::new(setup).unwrap();
    for record in store.history(id, 0, 1_000_000).await.unwrap() {
        contact.apply_within(&record.step.step(), record.tolerance).unwrap();
        assert_eq!(exact(&State::from(contact.state())), exact(&record.state));
    }
    contact
}

async fn shear(client: &Client, id: Uuid, contact: &Contact) {
    let asked = StressRequest { points: Some(50), ..StressRequest::default() };
    let stress = client.stress(id, &asked, false).await.unwrap().stress;
    for (shear, expected) in stress.shear.clone().unwrap().into_iter().zip(contact.shears(stress.places())) {
        assert_eq!(shear.unwrap().to_bits(), expected.to_bits());
    }
}

/// Waits for the snapshot after the move `sequence`, which is kept in the background.
async fn snapshot(store: &dyn Store, id: Uuid, sequence: u64) -> Snapshot {
    let kept = async || store.snapshot(id).await.unwrap().filter(|snapshot| snapshot.sequence >= sequence);
    until("a snapshot is kept", kept).await
}

#[tokio::test]
async fn a_session_opened_from_a_snapshot_is_the_same_to_the_last_bit() {
    let store = Arc::new(SqliteStore::in_memory().unwrap());
    let server = Server::with(store.clone(), NO_CACHE).await;
    let (client, options) = (&server.client, Options::default());
    let id = client.create(&create(), &options).await.unwrap().id;
    client.path(id, &along(varied_moves(11_000, 0.0)), &options).await.unwrap();
    snapshot(&*store, id, 11_000).await;
    // Beyond the snapshot, straight and curved, each call from the store.
    let fork = client.fork(id, &ForkRequest::default(), &options).await.unwrap().id;
    for id in [id, fork] {
        client.path(id, &along(varied_moves(200, 1.0)), &options).await.unwrap();
        let contact = replayed(&*store, id).await;
        let shown = client.contact(id).await.unwrap();
        assert_eq!((shown.sequence, exact(&shown.state)), (11_200, exact(&State::from(contact.state()))));
        shear(client, id, &contact).await;
    }
    assert_eq!(store.snapshot(fork).await.unwrap().unwrap().sequence, 11_000);
}

#[tokio::test]
async fn a_snapshot_is_read_where_it_is_sound_and_ignored_where_it_is_not() {
    let store = Arc::new(SqliteStore::in_memory().unwrap());
    let server = Server::with(store.clone(), NO_CACHE).await;
    let (client, options) = (&server.client, Options::default());
    let (one, other) =
        (client.create(&create(), &options).await.unwrap().id, client.create(&create(), &options).await.unwrap().id);
    client.path(one, &along(varied_moves(10_000, 0.0)), &options).await.unwrap();
    // Too few moves for a snapshot of its own.
    let few = (0..500).map(|index| Move::displacement(2e-7 * f64::from(index).sin())).collect();
    client.path(other, &along(few), &options).await.unwrap();
    let taken = snapshot(&*store, one, 10_000).await;
    let truth = client.contact(other).await.unwrap();

    // Damaged, truncated or empty: the session is replayed.
    let mut damaged = taken.state.clone();
    damaged[taken.state.len() / 2] ^= 0x10;
    let cut = taken.state[..taken.state.len() - 8].to_vec();
    for (sequence, state) in [(401, damaged), (402, cut), (403, Vec::new())] {
        store.save_snapshot(other, Snapshot { sequence, state }, None).await.unwrap();
        assert_eq!(store.snapshot(other).await.unwrap().unwrap().sequence, sequence);
        assert_eq!(client.contact(other).await.unwrap(), truth);
    }
    // A sound one is not compared with the moves: that would be the replay that it spares.
    let third = client.create(&create(), &options).await.unwrap().id;
    client.apply(third, &Move::displacement(1e-9).into(), &options).await.unwrap();
    store.save_snapshot(third, Snapshot { sequence: 1, state: taken.state }, None).await.unwrap();
    let (found, expected) = (client.contact(third).await.unwrap(), client.contact(one).await.unwrap());
    assert_eq!((found.sequence, exact(&found.state)), (1, exact(&expected.state)));
}

/// Small contacts are read from a file in one step, and larger ones in several.
#[tokio::test]
async fn contacts_of_any_number_of_moves_are_opened_from_a_file_as_they_were() {
    let folder = tempfile::tempdir().unwrap();
    let store = Arc::new(SqliteStore::open(&folder.path().join("opened.db")).unwrap());
    let server = Server::with(store.clone(), NO_CACHE).await;
    let (client, options) = (&server.client, Options::default());
    for count in [0, 1, 2, 63, 64, 65, 200] {
        let id = client.create(&create(), &options).await.unwrap().id;
        if count > 0 {
            client.path(id, &along(varied_moves(count, count as f64)), &options).await.unwrap();
        }
        let (shown, contact) = (client.contact(id).await.unwrap(), replayed(&*store, id).await);
        assert_eq!((shown.sequence, exact(&shown.state)), (count as u64, exact(&State::from(contact.state()))));
        let stored = store.find(id).await.unwrap();
        assert_eq!((shown.created_at, shown.updated_at), (stored.created_at, stored.updated_at));
    }
    assert_eq!(client.contact(Uuid::now_v7()).await.unwrap_err().problem().unwrap().code, "contact_not_found");
}

fn table(points: usize) -> CreateRequest {
    let r: Vec<f64> = (0..points).map(|index| 1e-3 * index as f64 / points as f64).collect();
    let z: Vec<f64> = r.iter().map(|r| r * r / 0.02).collect();
    let mut definition = ball();
    definition["profile"] = json!({"type": "tabulated", "r": r, "z": z});
    definition["label"] = json!("a table");
    serde_json::from_value(definition).unwrap()
}

#[tokio::test]
async fn a_tiny_cache_under_load_stays_within_its_bytes_and_changes_no_result() {
    let budget = 150_000;
    let store = Arc::new(SqliteStore::in_memory().unwrap());
    let pool = Pool::with_defaults();
    let sessions = Sessions::new(store.clone(), pool.clone(), budget);
    let server = Server::over(sessions.clone(), pool).await;
    let (client, options) = (&server.client, Options::default());
    let mut ids = Vec::new();
    for index in 0..60 {
        let definition = if index % 20 == 0 { table(5 + index) } else { create() };
        ids.push(client.create(&definition, &options).await.unwrap().id);
    }
    let walks = ids.iter().enumerate().map(|(index, &id)| {
        let (options, sessions) = (options.clone(), sessions.clone());
        async move {
            for round in 0..6 {
                let seed = (index * 7 + round) as f64;
                for step in varied_moves(4, seed) {
                    client.apply(id, &step.into(), &options).await.unwrap();
                }
                client.path(id, &along(varied_moves(30, seed)), &options).await.unwrap();
                client.contact(id).await.unwrap();
                assert!(client.contact(Uuid::now_v7()).await.is_err());
                assert!(sessions.held().0 <= budget);
            }
        }
    });
    join_all(walks).await;
    let (bytes, held) = sessions.held();
    assert!(bytes <= budget && (1..40).contains(&held), "{held} sessions in {bytes} bytes");
    for &id in &ids {
        let (shown, contact) = (client.contact(id).await.unwrap(), replayed(&*store, id).await);
        assert_eq!((shown.sequence, exact(&shown.state)), (6 * 34, exact(&State::from(contact.state()))));
    }
}

#[tokio::test]
async fn what_is_not_touched_and_what_does_not_exist_takes_no_room() {
    let store = Arc::new(SqliteStore::in_memory().unwrap());
    let pool = Pool::with_defaults();
    let (client, options) = {
        let server = Server::with(store.clone(), NO_CACHE).await;
        (server.client, Options::default())
    };
    let mut ids = Vec::new();
    for _ in 0..200 {
        ids.push(client.create(&create(), &options).await.unwrap().id);
    }
    // The same store, as after a restart.
    let sessions = Sessions::new(store, pool.clone(), 1 << 20);
    let server = Server::over(sessions.clone(), pool).await;
    let listed = server.client.contacts(None, Some(1_000)).await.unwrap();
    assert_eq!((listed.items.len(), sessions.held()), (200, (0, 0)));
    for _ in 0..200 {
        assert!(server.client.contact(Uuid::now_v7()).await.is_err());
    }
    assert_eq!(sessions.held(), (0, 0));
    server.client.contact(ids[0]).await.unwrap();
    let (small, held) = sessions.held();
    assert_eq!(held, 1);
    // Grown by its moves, it takes more room; deleted, none.
    let peak = PathRequest {
        path: serde_json::from_value(json!({"falling_amplitude": {"reversals": 2000}})).unwrap(),
        ..along(Vec::new())
    };
    let depth = server.client.path(ids[0], &peak, &options).await.unwrap().steps[0].memory_depth;
    let (large, held) = sessions.held();
    assert!(held == 1 && large >= small + 100 * depth, "{small} {large} {depth}");
    server.client.delete(ids[0], &options).await.unwrap();
    assert_eq!(sessions.held(), (0, 0));
}

#[tokio::test]
async fn an_expired_session_is_gone_for_reads_moves_and_events_though_it_was_cached() {
    let store = Arc::new(SqliteStore::in_memory().unwrap());
    let pool = Pool::with_defaults();
    let sessions = Sessions::new(store.clone(), pool.clone(), 1 << 20);
    let server = Server::over(sessions.clone(), pool).await;
    let (client, options) = (&server.client, Options::default());
    let idle = client.create(&create(), &options).await.unwrap().id;
    let mut events = Box::pin(client.events(idle, Some(0)).await.unwrap());
    let between = Timestamp::now();
    let busy = client.create(&create(), &options).await.unwrap().id;
    assert_eq!(store.purge_expired(None).await.unwrap(), 0);
    client.contact(idle).await.unwrap();
    assert_eq!(store.purge_expired(Some(between - SignedDuration::from_hours(1))).await.unwrap(), 0);
    assert_eq!(store.purge_expired(Some(between)).await.unwrap(), 1);

    assert_eq!(soon(events.next()).await.unwrap().unwrap(), Event::End(EndReason::Expired));
    let place = format!("/contacts/{idle}");
    let (step, path) = (json!({"force": 1.0}), json!({"path": {"force": [1.0]}}));
    for refused in [
        server.post(&format!("{place}/move"), &step).await,
        server.get(&place).await,
        server.post(&format!("{place}/move"), &step).await,
        server.post(&format!("{place}/path"), &path).await,
        server.post(&format!("{place}/fork"), &json!({})).await,
        server.get(&format!("{place}/stress?points=5")).await,
        server.get(&format!("{place}/history")).await,
        server.get(&format!("{place}/events")).await,
        server.send(Method::DELETE, &place, None, &[]).await,
    ] {
        let refused = problem(refused).await;
        assert_eq!((refused.status, refused.code.as_str()), (410, "contact_expired"));
    }
    client.contact(busy).await.unwrap();
    assert_eq!(client.contacts(None, None).await.unwrap().items.len(), 1);
    assert_eq!(store.purge_expired(Some(Timestamp::now())).await.unwrap(), 1);
}

/// Two processes on one store know nothing of each other: the store decides.
#[tokio::test]
async fn of_two_that_rename_by_one_tag_one_wins() {
    let folder = tempfile::tempdir().unwrap();
    let store = Arc::new(SqliteStore::open(&folder.path().join("labels.db")).unwrap());
    let [here, there] = [(); 2].map(|()| Sessions::new(store.clone(), Pool::with_defaults(), 1 << 20));
    let id = here.create(create().check().unwrap(), None).await.unwrap().created.unwrap();
    let mut label: Option<String> = None;
    for round in 0..30 {
        let expected = Some(Expected { sequence: 0, label: Some(label_checksum(label.as_deref())) });
        let [one, other] = ["here", "there"].map(|name| Some(format!("{name} {round}")));
        let (first, second) = futures::join!(
            here.rename(id, one.clone(), expected, None),
            there.rename(id, other.clone(), expected, None)
        );
        let (won, lost) = if first.is_ok() { (one, second) } else { (other, first) };
        assert!(matches!(lost, Err(SessionError::Relabelled { found: 0 })), "{lost:?}");
        label = won;
        assert_eq!(here.get(id).await.unwrap().label, label);
    }
}
