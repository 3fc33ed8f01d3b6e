//! Several servers on one PostgreSQL: they serve as one, and go on when a part of them fails.

use crate::common;
use crate::fixtures::{keyed, soon};
use crate::freezing_proxy::{FreezingProxy, Silence};

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use common::kill::history;
use common::postgres::{Cluster, connected};
use common::process::Process;
use common::{Server, ball, create, until, varied_moves};
use futures::StreamExt as _;
use reqwest::StatusCode;
use serde_json::{Value, json};
use stickslip::sessions::CAPACITY;
use stickslip::store::PostgresStore;
use stickslip_wire::Move;
use stickslip_wire::client::{Event, Options};

#[tokio::test]
async fn a_retry_gets_its_reply_after_a_restart_and_from_the_other_replica() {
    let url = Cluster::shared().database().await;
    let (here, there) = (Process::start(&url).await, Process::start(&url).await);
    let http = reqwest::Client::new();
    let post = async |base: &str, path: &str, key: &str, body: Value| {
        let call = http.post(format!("{base}{path}")).header("idempotency-key", key).json(&body);
        let response = soon(call.send()).await.unwrap();
        (response.status(), response.headers().get("etag").cloned(), response.text().await.unwrap())
    };
    let made = post(&here.base, "/contacts", "make", ball()).await;
    let id = serde_json::from_str::<Value>(&made.2).unwrap()["id"].as_str().unwrap().to_owned();
    let (moved, forked) = (format!("/contacts/{id}/move"), format!("/contacts/{id}/fork"));
    let step = || json!({"displacement": 1e-8, "relative": true});
    let first = post(&here.base, &moved, "move", step()).await;
    let fork = post(&there.base, &forked, "fork", json!({})).await;
    post(&there.base, &moved, "on", step()).await;
    here.kill().await;
    let again = Process::start(&url).await;
    for base in [&again.base, &there.base] {
        assert_eq!(post(base, "/contacts", "make", ball()).await, made);
        assert_eq!(post(base, &moved, "move", step()).await, first);
        assert_eq!(post(base, &forked, "fork", json!({})).await, fork);
        assert_eq!(post(base, &moved, "move", json!({"displacement": 0.0})).await.0, StatusCode::UNPROCESSABLE_ENTITY);
    }
    assert_eq!(again.client.contact(id.parse().unwrap()).await.unwrap().sequence, 2);
    assert_eq!(again.client.contacts(None, None).await.unwrap().items.len(), 2);
}

/// The connection of a replica is lost after its move was executed, before or after the commit, and the other replica
/// moves the contact before the first one has asked what has become of its own.
#[tokio::test(flavor = "multi_thread")]
async fn a_move_in_doubt_is_made_once_and_a_rival_in_between_keeps_its_place() {
    for (silence, places) in [(Silence::Inside, [2, 1]), (Silence::After, [1, 2])] {
        let url = Cluster::shared().database().await;
        let proxy = FreezingProxy::start(&url).await;
        let open = async |url: &str| Server::with(Arc::new(PostgresStore::open(url).await.unwrap()), CAPACITY).await;
        let (here, there, watcher) = (open(&proxy.url).await, open(&url).await, connected(&url).await);
        let id = here.contact().await;
        let path = format!("/contacts/{id}/move");
        let (own, rival) = (json!({"displacement": 1e-8}), json!({"displacement": 2e-8}));
        proxy.arm("SET sequence", silence);
        let lost = here.post(&path, &own);
        let between = async {
            proxy.silent().await;
            // Executed; its transaction is open, or the move is stored.
            until("the move is executed", async || {
                let done = match silence {
                    Silence::Inside => "SELECT 1 FROM pg_stat_activity WHERE backend_xid IS NOT NULL",
                    Silence::After => "SELECT 1 FROM moves",
                };
                (!watcher.query(done, &[]).await.unwrap().is_empty()).then_some(())
            })
            .await;
            proxy.cut();
            let made = until("the other replica moves it", async || {
                let reply = there.post(&path, &rival).await;
                if reply.status().is_success() { Some(reply.json::<Value>().await.unwrap()) } else { None }
            });
            let made = made.await;
            proxy.restore();
            made
        };
        let (lost, made) = futures::join!(lost, between);
        let lost: Value = lost.json().await.unwrap();
        assert_eq!(
            [&lost["sequence"], &made["sequence"]],
            places.map(|place| json!(place)).each_ref(),
            "{lost} {made}"
        );
        let moves = history(&there.client, id.parse().unwrap()).await;
        let ends: Vec<Value> = moves.iter().map(|item| json!(item.state.displacement)).collect();
        let expected = if places[0] == 1 { json!([1e-8, 2e-8]) } else { json!([2e-8, 1e-8]) };
        assert_eq!(Value::from(ends), expected);
    }
}

/// That they show what the other has acknowledged is tested by their recorded histories (`order`), whose moves are
/// never refused by the mechanics.
#[tokio::test]
async fn what_the_cached_state_of_a_replica_would_refuse_is_made_in_the_stored_one() {
    let url = Cluster::shared().database().await;
    let (here, there) = (Process::start(&url).await, Process::start(&url).await);
    let plain = Options::default();
    let id = here.client.create(&create(), &plain).await.unwrap().id;
    let pressed = |indentation| Move { indentation: Some(indentation), ..Move::default() };
    there.client.apply(id, &pressed(-1e-7).into(), &plain).await.unwrap();
    here.client.apply(id, &pressed(4.7e-7).into(), &plain).await.unwrap();
    there.client.apply(id, &Move::force(0.1).into(), &plain).await.unwrap();
    // What is computed of a state is of the stored one too.
    let stress = Server::at(&here.base).get(&format!("/contacts/{id}/stress?points=2")).await;
    assert_eq!(stress.headers()["etag"], "\"3\"");
}

#[tokio::test]
async fn a_lost_database_is_admitted_and_found_again() {
    let cluster = Cluster::start();
    let store = PostgresStore::open(&cluster.database().await).await.unwrap();
    let server = Server::with(Arc::new(store), CAPACITY).await;
    let id = server.contact().await;
    let moved = format!("/contacts/{id}/move");
    let step = json!({"displacement": 1e-8, "relative": true});
    assert_eq!(server.get("/readyz").await.status(), StatusCode::OK);
    cluster.crash();
    for _ in 0..2 {
        for refused in [
            server.get("/readyz").await,
            server.post(&moved, &step).await,
            server.post("/contacts", &ball()).await,
            server.get(&format!("/contacts/{id}")).await,
        ] {
            assert_eq!(refused.status(), StatusCode::SERVICE_UNAVAILABLE);
            assert!(refused.headers().contains_key("retry-after"));
        }
    }
    assert_eq!(server.get("/healthz").await.status(), StatusCode::OK);
    cluster.resume();
    until("it is ready", async || (server.get("/readyz").await.status() == StatusCode::OK).then_some(())).await;
    let reply: Value = server.post(&moved, &step).await.json().await.unwrap();
    assert_eq!(reply["sequence"], 1);
    // Clients do not notice a short interruption: what is safe to repeat is repeated.
    let stop = AtomicBool::new(false);
    let (count, ()) = futures::join!(
        async {
            let mut count = 1;
            while !stop.load(Ordering::Relaxed) {
                assert_eq!(server.post(&moved, &step).await.status(), StatusCode::OK);
                assert_eq!(server.get(&format!("/contacts/{id}")).await.status(), StatusCode::OK);
                count += 1;
            }
            count
        },
        async {
            for _ in 0..5 {
                let end = "SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE application_name = 'stickslip'";
                cluster.execute("postgres", end).await;
                tokio::time::sleep(Duration::from_millis(50)).await;
            }
            stop.store(true, Ordering::Relaxed);
        }
    );
    assert_eq!(history(&server.client, id.parse().unwrap()).await.len(), count);
}

#[tokio::test]
async fn moves_made_at_one_replica_are_sent_by_the_other_also_after_the_database_was_away() {
    let cluster = Cluster::start();
    let url = cluster.database().await;
    let (here, there) = (Process::start(&url).await, Process::start(&url).await);
    let id = here.client.create(&create(), &Options::default()).await.unwrap().id;
    let mut events = Box::pin(there.client.events(id, Some(0)).await.unwrap());
    let mut seen_events = Vec::new();
    for (index, step) in varied_moves(40, 0.0).into_iter().enumerate() {
        if index == 20 {
            cluster.crash();
            cluster.resume();
        }
        until("it is made", async || here.client.apply(id, &step.into(), &keyed(index)).await.ok()).await;
        match soon(events.next()).await.expect("the events ended").unwrap() {
            Event::State(state) => seen_events.push((state.sequence, state.step, state.state)),
            Event::End(reason) => panic!("the events ended: {reason:?}"),
        }
    }
    let past = history(&there.client, id).await;
    let past: Vec<_> = past.into_iter().map(|item| (item.sequence, Some(item.step), item.state)).collect();
    assert_eq!(seen_events, past);
}

/// A dump is put back under a replica that runs, which has a later state; another one moves the contact on from there.
#[tokio::test]
async fn a_past_that_was_put_back_is_not_gone_on_with_by_the_sequence_alone() {
    let url = Cluster::shared().database().await;
    let open = async || {
        let store = Arc::new(PostgresStore::open(&url).await.unwrap());
        (store.clone(), Server::with(store, CAPACITY).await.client.clone())
    };
    let ((_, here), (store, there), options) = (open().await, open().await, Options::default());
    let id = here.create(&create(), &options).await.unwrap().id;
    let to = async |client: &stickslip_wire::client::Client, displacement: f64| {
        client.apply(id, &Move::displacement(displacement).into(), &options).await.unwrap()
    };
    let dumped = to(&here, 1e-8).await;
    for displacement in [5e-7, -5e-7] {
        to(&here, displacement).await;
    }
    let database = connected(&url).await;
    let restore = "DELETE FROM moves WHERE sequence > 1;
        UPDATE contacts SET sequence = 1, updated_at = m.at, updated_ns = m.at_ns FROM moves AS m";
    database.batch_execute(restore).await.unwrap();
    assert_eq!(there.contact(id).await.unwrap().state, dumped.state);
    for displacement in [2e-8, 3e-8] {
        to(&there, displacement).await;
    }
    assert_eq!(here.contact(id).await.unwrap().state, there.contact(id).await.unwrap().state);
    // The first one has what was before the dump, and the sequence after it.
    database.batch_execute(restore).await.unwrap();
    for displacement in [4e-7, 6e-8] {
        to(&there, displacement).await;
    }
    let last = to(&here, 7e-8).await;
    assert_eq!((last.sequence, there.contact(id).await.unwrap().state), (4, last.state));
    let checked = stickslip::sessions::check(&*store, 0.0, &mut |_| ()).await.unwrap();
    assert_eq!((checked.findings, checked.moves), (0, 4));
}

/// What the operator of the database has to mend is no fault of the server, and it is not ready meanwhile.
#[tokio::test]
async fn a_lost_table_or_right_is_an_outage_of_the_storage() {
    let url = Cluster::shared().database().await;
    let server = Server::with(Arc::new(PostgresStore::open(&url).await.unwrap()), CAPACITY).await;
    let (id, database) = (server.contact().await, connected(&url).await);
    for (lost, back) in [
        ("ALTER TABLE moves RENAME TO gone", "ALTER TABLE gone RENAME TO moves"),
        ("ALTER TABLE receipts RENAME TO gone", "ALTER TABLE gone RENAME TO receipts"),
    ] {
        database.batch_execute(lost).await.unwrap();
        let refused = server.post(&format!("/contacts/{id}/move"), &json!({"force": 0.1})).await;
        assert!(refused.headers().contains_key("retry-after"));
        assert_eq!(common::problem(refused).await.code, "storage_unavailable");
        until("it is not ready", async || (server.get("/readyz").await.status() == 503).then_some(())).await;
        database.batch_execute(back).await.unwrap();
        until("it is ready", async || (server.get("/readyz").await.status() == 200).then_some(())).await;
        assert_eq!(server.post(&format!("/contacts/{id}/move"), &json!({"force": 0.1})).await.status(), 200);
    }
}

#[tokio::test]
async fn a_database_without_all_letters_is_refused_at_the_start() {
    let url = Cluster::shared().database().await;
    let (server, name) = url.rsplit_once('/').unwrap();
    let latin = format!("{}_latin", name.split('?').next().unwrap());
    let make = format!("CREATE DATABASE {latin} ENCODING 'LATIN1' LC_COLLATE 'C' LC_CTYPE 'C' TEMPLATE template0");
    connected(&url).await.batch_execute(&make).await.unwrap();
    let refused = PostgresStore::open(&format!("{server}/{latin}")).await.err().unwrap().to_string();
    assert!(refused.contains("LATIN1"), "{refused}");
}
