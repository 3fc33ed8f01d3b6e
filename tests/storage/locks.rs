//! Rows that another transaction holds, in PostgreSQL: only the changes that need them wait, for a bounded time. Each
//! test says what happens while the lock is held, and none how long it takes.

use crate::common;
use crate::fixtures::{JOB_LIMITS, LEASE, job, made, receipt, record, records, session, soon};
use crate::freezing_proxy::{FreezingProxy, Silence};

use std::sync::Arc;
use std::time::{Duration, Instant};

use common::postgres::{Cluster, connected};
use common::{Server, ball, until};
use futures::future::join_all;
use reqwest::{Method, StatusCode};
use serde_json::{Value, json};
use stickslip::admission::{Capacity, Pool, QuotaLimits};
use stickslip::sessions::{CAPACITY, Sessions};
use stickslip::store::{ChunkResult, Job, JobStore as _, LabelChange, PostgresStore, Store, StoreError, Tenant};
use tokio_postgres::Client;
use uuid::Uuid;

/// How long the answer of a frozen replica is waited for: longer than a database may be silent in a short statement.
const UNANSWERED: Duration = Duration::from_secs(30);
/// Rounds of other clients' requests beside a lock.
const ROUNDS: usize = 20;

/// Whether a transaction that has changed or locked something is open.
async fn is_held(watcher: &Client) -> bool {
    let held = "SELECT 1 FROM pg_stat_activity WHERE backend_xid IS NOT NULL AND datname = current_database()";
    !watcher.query(held, &[]).await.unwrap().is_empty()
}

/// The times of calls, in words.
fn spread(mut times: Vec<Duration>) -> String {
    times.sort();
    let ms = |time: Duration| time.as_secs_f64() * 1e3;
    format!("{:.1} ms in the median, {:.1} ms at most", ms(times[times.len() / 2]), ms(times[times.len() - 1]))
}

/// Moves of contacts, and new ones, one after the other: each must be made.
async fn others_go_on(server: &Server, ids: &[String]) -> Vec<Duration> {
    let mut times = Vec::new();
    for round in 0..ROUNDS {
        let moved = format!("/contacts/{}/move", ids[round % ids.len()]);
        for (path, body) in [(moved.as_str(), json!({"displacement": 1e-8, "relative": true})), ("/contacts", ball())] {
            let begin = Instant::now();
            let reply = soon(server.post(path, &body)).await;
            assert!(reply.status().is_success(), "{path}: {}", reply.text().await.unwrap());
            times.push(begin.elapsed());
        }
        assert_eq!(server.get("/readyz").await.status(), StatusCode::OK);
    }
    times
}

/// Freezes a replica inside a request about a contact, and returns the sequence of the contact once the replica is
/// gone. Meanwhile the other replica serves all others, and refuses in time the request that needs what the first one
/// holds.
async fn frozen_inside(statement: &'static str, method: Method, of: &str, body: Value, key: Option<&str>) -> Value {
    let url = Cluster::shared().database().await;
    let proxy = FreezingProxy::start(&url).await;
    let open = async |url: &str| Server::with(Arc::new(PostgresStore::open(url).await.unwrap()), CAPACITY).await;
    let (here, there, watcher) = (open(&proxy.url).await, open(&url).await, connected(&url).await);
    let ids = join_all((0..4).map(|_| there.contact())).await;
    let held = here.contact().await;
    let usual = others_go_on(&there, &ids).await;
    proxy.arm(statement, Silence::Inside);
    let (path, text) = (format!("/contacts/{held}{of}"), body.to_string());
    let headers: Vec<_> = key.map(|key| ("idempotency-key", key)).into_iter().collect();
    let frozen = here.send(method.clone(), &path, Some(&text), &headers);
    let beside = async {
        proxy.silent().await;
        until("the statement is executed", async || is_held(&watcher).await.then_some(())).await;
        let refused = async {
            let begin = Instant::now();
            let refused = soon(there.send(method, &path, Some(&text), &headers)).await;
            assert_eq!(refused.status(), StatusCode::SERVICE_UNAVAILABLE);
            assert!(refused.headers().contains_key("retry-after"));
            begin.elapsed()
        };
        let others = async {
            let times = others_go_on(&there, &ids).await;
            assert!(is_held(&watcher).await, "the others were served when the lock was released");
            times
        };
        let (refused, others) = futures::join!(refused, others);
        assert!(is_held(&watcher).await, "the lock was released before the refusal");
        println!(
            "beside a replica frozen inside {statement:?}: others {}, usually {}; the one that is held, 503 after \
                {:.1} s",
            spread(others),
            spread(usual),
            refused.as_secs_f64()
        );
    };
    // It does not know what has become of it.
    let (unknown, ()) = futures::join!(tokio::time::timeout(UNANSWERED, frozen), beside);
    match unknown {
        Ok(unknown) => assert_eq!(unknown.status(), StatusCode::SERVICE_UNAVAILABLE),
        // It may take 90 s.
        Err(_) => assert_eq!(of, "/fork"),
    }
    drop(proxy);
    until("it is free", async || (!is_held(&watcher).await).then_some(())).await;
    let step = json!({"displacement": 1e-8, "relative": true});
    let reply: Value = there.post(&format!("/contacts/{held}/move"), &step).await.json().await.unwrap();
    reply["sequence"].clone()
}

#[tokio::test(flavor = "multi_thread")]
async fn a_replica_frozen_inside_a_change_stops_only_its_contacts() {
    let step = json!({"displacement": 1e-8, "relative": true});
    let sequences = futures::join!(
        frozen_inside("UPDATE contacts SET label", Method::PATCH, "", json!({"label": "new"}), None),
        frozen_inside("FROM moves", Method::POST, "/fork", json!({}), Some("fork")),
        frozen_inside("SET sequence", Method::POST, "/move", step, None),
    );
    assert_eq!(sequences, (json!(1), json!(1), json!(1)));
}

#[tokio::test(flavor = "multi_thread")]
async fn any_number_of_rows_held_from_outside_delays_nobody_else_and_the_order_stays() {
    let url = Cluster::shared().database().await;
    let (store, other) = (PostgresStore::open(&url).await.unwrap(), connected(&url).await);
    let ids = join_all((0..300).map(|_| made(&store, None))).await;
    let free = made(&store, None).await;
    other.batch_execute("BEGIN").await.unwrap();
    other.query("SELECT id FROM contacts WHERE id = ANY($1) FOR UPDATE", &[&ids]).await.unwrap();
    let held = join_all(ids.iter().map(|id| store.append(*id, 0, vec![record(1)], None)));
    let others = async {
        let mut times = Vec::new();
        for sequence in 0..100 {
            let begin = Instant::now();
            soon(store.append(free, sequence, vec![record(sequence + 1)], None)).await.unwrap();
            soon(store.create(session(None), Some(receipt(&format!("new {sequence}"), None, 0)))).await.unwrap();
            times.push(begin.elapsed());
        }
        store.ready().await.unwrap();
        println!("beside 300 rows that are held: a move and a creation, {}", spread(times));
    };
    let (held, ()) = futures::join!(held, others);
    assert!(held.iter().all(|refused| matches!(refused, Err(StoreError::Locked(_)))), "{held:?}");
    // The second of two changes waits behind the first one, however often that is tried.
    let two = futures::future::join(
        store.append(ids[0], 0, vec![record(1)], None),
        store.append(ids[0], 1, vec![record(2)], None),
    );
    let release = async {
        soon(store.append(free, 100, vec![record(101)], None)).await.unwrap();
        other.batch_execute("COMMIT").await.unwrap();
    };
    let ((first, second), ()) = futures::join!(two, release);
    assert!(first.is_ok() && second.is_ok(), "{first:?} {second:?}");
    assert_eq!(store.history(ids[1], 0, 10).await.unwrap().len(), 0);
}

#[tokio::test(flavor = "multi_thread")]
async fn a_key_held_from_outside_stops_only_the_request_that_has_it() {
    let url = Cluster::shared().database().await;
    let (store, other) = (PostgresStore::open(&url).await.unwrap(), connected(&url).await);
    let ids = join_all((0..20).map(|_| made(&store, None))).await;
    other.batch_execute("BEGIN").await.unwrap();
    let held = "INSERT INTO receipts (key, fingerprint, sequence, body) VALUES ('5', '', 0, '')";
    other.batch_execute(held).await.unwrap();
    let done = std::sync::atomic::AtomicUsize::new(0);
    let moves = join_all(ids.iter().zip(0..).map(|(id, number)| {
        let (store, done) = (&store, &done);
        async move {
            let moved = store.append(*id, 0, vec![record(1)], Some(receipt(&format!("{number}"), None, 1))).await;
            done.fetch_add(usize::from(moved.is_ok()), std::sync::atomic::Ordering::SeqCst);
            moved
        }
    }));
    let moved = soon(moves).await;
    assert_eq!(done.into_inner(), 19);
    assert!(matches!(moved[5], Err(StoreError::Locked(_))), "{:?}", moved[5]);
    other.batch_execute("ROLLBACK").await.unwrap();
    store.append(ids[5], 0, vec![record(1)], Some(receipt("5", None, 1))).await.unwrap();
}

#[tokio::test(flavor = "multi_thread")]
async fn changes_that_wait_for_rows_hold_no_connection() {
    let url = Cluster::shared().database().await;
    let (store, other) = (PostgresStore::open(&url).await.unwrap(), connected(&url).await);
    // More than there are connections.
    let ids = join_all((0..24).map(|_| made(&store, None))).await;
    let job = Job { points: 1, chunk: 1, ..job("lab") };
    store.create_job(job.clone(), "{}".to_owned(), JOB_LIMITS, None).await.unwrap();
    let claim = store.claim(Uuid::now_v7(), None, LEASE).await.unwrap().unwrap();
    let result = || ChunkResult { content: b"done".to_vec(), points: 1, failed: 0 };
    other.batch_execute("BEGIN").await.unwrap();
    other.query("SELECT id FROM contacts WHERE id = ANY($1) FOR UPDATE", &[&ids]).await.unwrap();
    other.query("SELECT id FROM jobs WHERE id = $1 FOR UPDATE", &[&job.id]).await.unwrap();
    let new = || LabelChange { from: None, to: Some("new".to_owned()) };
    let held = async {
        let renamed = join_all(ids.iter().map(|id| store.rename(*id, new(), 0, None)));
        let deleted = join_all(ids.iter().map(|id| store.delete(*id, 0)));
        let saved = futures::future::join3(
            store.save_chunk(claim, result()),
            store.fail_job(job.id, "why".to_owned()),
            store.delete_job(job.id),
        );
        let (mut all, deleted, saved) = futures::join!(renamed, deleted, saved);
        all.extend(deleted.into_iter().chain([saved.0, saved.1, saved.2]));
        all
    };
    let reads = async {
        for id in ids.iter().chain(&ids) {
            assert_eq!(soon(store.extent(*id)).await.unwrap().label, None);
        }
        // A copy needs no lock.
        soon(store.fork(ids[0], session(None), None)).await.unwrap();
    };
    let mut held = Box::pin(held);
    tokio::select! {
        biased;
        held = &mut held => panic!("they did not wait: {held:?}"),
        () = reads => {}
    }
    for refused in held.await {
        assert!(matches!(refused, Err(StoreError::Locked(_))), "{refused:?}");
    }
    let free = async {
        soon(store.extent(ids[0])).await.unwrap();
        other.batch_execute("COMMIT").await.unwrap();
    };
    let (renamed, deleted, saved, ()) = futures::join!(
        store.rename(ids[0], new(), 0, Some(receipt("name", None, 0))),
        store.delete(ids[1], 0),
        store.save_chunk(claim, result()),
        free
    );
    assert!(renamed.is_ok() && deleted.is_ok() && saved.is_ok(), "{renamed:?} {deleted:?} {saved:?}");
    assert_eq!(store.extent(ids[0]).await.unwrap().label.as_deref(), Some("new"));
    assert!(matches!(store.find(ids[1]).await, Err(StoreError::NotFound)));
    assert_eq!(store.job(job.id).await.unwrap().done, 1);
    assert!(store.check_integrity().await.unwrap().is_empty());
}

/// A creation that was under way when another replica made the same one, and that the quota refuses for that reason: it
/// gets the reply to the other.
#[tokio::test(flavor = "multi_thread")]
async fn a_creation_that_fills_the_quota_and_is_sent_twice_has_one_reply() {
    let url = Cluster::shared().database().await;
    let replica = async || {
        let quotas = QuotaLimits { contacts: 2, ..QuotaLimits::default() };
        let pool = Pool::new(Capacity { quotas, ..Capacity::default() });
        let store = Arc::new(PostgresStore::open(&url).await.unwrap());
        Server::over(Sessions::new(store, pool.clone(), CAPACITY), pool).await
    };
    let (here, there, other) = (replica().await, replica().await, connected(&url).await);
    let text = ball().to_string();
    let create = async |server: &Server| {
        let headers = [("idempotency-key", "once")];
        let made = server.send(Method::POST, "/contacts", Some(&text), &headers).await;
        (made.status(), made.text().await.unwrap())
    };
    // This one has counted what is stored; the other has to, which takes this table.
    here.contact().await;
    other.batch_execute("BEGIN; LOCK TABLE snapshots IN ACCESS EXCLUSIVE MODE").await.unwrap();
    let waits = "SELECT 1 FROM pg_locks JOIN pg_database ON pg_database.oid = database
        WHERE NOT granted AND datname = current_database() AND relation = 'snapshots'::regclass";
    let first = async {
        until("it counts", async || (!other.query(waits, &[]).await.unwrap().is_empty()).then_some(())).await;
        let made = create(&here).await;
        other.batch_execute("COMMIT").await.unwrap();
        made
    };
    let (second, first) = futures::join!(create(&there), first);
    assert_eq!((second.0, &second), (StatusCode::CREATED, &first));
    for server in [&here, &there] {
        assert_eq!(server.post("/contacts", &ball()).await.status(), StatusCode::TOO_MANY_REQUESTS);
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn a_transaction_of_a_replica_that_falls_silent_is_ended_by_the_server() {
    let url = Cluster::shared().database().await;
    let proxy = FreezingProxy::start(&url).await;
    let (here, there) = (PostgresStore::open(&proxy.url).await.unwrap(), PostgresStore::open(&url).await.unwrap());
    // It holds the lock of the tenant, and the server waits for what comes next.
    proxy.arm("pg_try_advisory_xact_lock", Silence::After);
    let frozen = here.create_job(job("lab"), "{}".to_owned(), JOB_LIMITS, None);
    let other = async {
        proxy.silent().await;
        until("another replica makes a job", async || {
            there.create_job(job("lab"), "{}".to_owned(), JOB_LIMITS, None).await.ok()
        })
        .await;
    };
    tokio::select! {
        done = frozen => panic!("nothing has been said: {done:?}"),
        () = other => {}
    }
    assert_eq!(there.jobs(Tenant::new("lab")).await.unwrap().len(), 1);
}

#[tokio::test(flavor = "multi_thread")]
async fn a_writer_without_a_commit_while_changes_wait_is_not_ready() {
    let url = Cluster::shared().database().await;
    let (store, other) = (PostgresStore::open(&url).await.unwrap(), connected(&url).await);
    let ids = join_all((0..4).map(|_| made(&store, None))).await;
    other.batch_execute("BEGIN; LOCK TABLE moves IN EXCLUSIVE MODE").await.unwrap();
    let ended = tokio::sync::watch::Sender::new(false);
    let moves = join_all(ids.iter().map(|id| {
        let (store, ended) = (&store, ended.subscribe());
        async move {
            let mut refused = 0;
            while !*ended.borrow() {
                match store.append(*id, 0, records(0, 1), None).await {
                    Err(StoreError::Locked(_)) => refused += 1,
                    Ok(()) => break,
                    Err(other) => panic!("{other}"),
                }
            }
            refused
        }
    }));
    let ready = async {
        until("it is not ready", async || store.ready().await.is_err().then_some(())).await;
        other.batch_execute("ROLLBACK").await.unwrap();
        until("it is ready", async || store.ready().await.is_ok().then_some(())).await;
    };
    let (refused, ()) = futures::join!(moves, ready);
    println!("refused meanwhile: {refused:?}");
    for id in ids {
        assert_eq!(store.extent(id).await.unwrap().sequence, 1);
    }
    ended.send_replace(true);
}
