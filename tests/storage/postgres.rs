//! Guarantees of the PostgreSQL store beyond those of every store.

use crate::common;
use crate::fixtures::{self, made, record, soon};

use std::sync::Arc;
use std::time::{Duration, Instant};

use common::postgres::{Cluster, connected};
use common::until;
use futures::future::join_all;
use jiff::Timestamp;
use stickslip::store::{Page, PostgresStore, Receipt, Record, Session, Store, StoreError};

fn session() -> Session {
    fixtures::session(Some("Kugel auf Ebene: μ'\\"))
}

fn receipt(key: &str) -> Option<Receipt> {
    Some(fixtures::receipt(key, None, 1))
}

#[tokio::test]
async fn of_many_who_move_one_session_at_once_one_wins_in_every_process() {
    let url = Cluster::shared().database().await;
    let stores = [PostgresStore::open(&url).await.unwrap(), PostgresStore::open(&url).await.unwrap()];
    let ids = join_all((0..8).map(|_| made(&stores[0], None))).await;
    for round in 0..20 {
        // Opposite orders, which would deadlock if batches locked in the order of arrival.
        let forward = ids.iter().map(|id| (&stores[0], *id));
        let backward = ids.iter().rev().map(|id| (&stores[1], *id));
        let attempts = forward.chain(backward).map(|(store, id)| async move {
            let step = record(round + 1);
            (id, store.append(id, round, vec![step], None).await)
        });
        let results = join_all(attempts).await;
        for id in &ids {
            let of_this = results.iter().filter(|(of, _)| of == id);
            let won = of_this.clone().filter(|(_, result)| result.is_ok()).count();
            let lost =
                of_this.filter(|(_, result)| matches!(result, Err(StoreError::Stale { found }) if *found == round + 1));
            assert_eq!((won, lost.count()), (1, 1), "round {round}");
        }
    }
    for id in ids {
        assert_eq!(stores[0].history(id, 0, 100).await.unwrap().len(), 20);
    }
}

#[tokio::test]
async fn a_batch_that_waits_for_a_row_sees_what_was_committed_meanwhile() {
    let url = Cluster::shared().database().await;
    let store = PostgresStore::open(&url).await.unwrap();
    let (raced, free) = (session(), session());
    for new in [&raced, &free] {
        store.create(new.clone(), None).await.unwrap();
    }
    let other = connected(&url).await;
    other.batch_execute("BEGIN").await.unwrap();
    // Another process moves one of the two, and has not committed when the batch begins; nor when the other one is
    // stored.
    let taken = other.execute("UPDATE contacts SET sequence = 1 WHERE id = $1", &[&raced.id]).await.unwrap();
    assert_eq!(taken, 1);
    let won = async {
        let won = soon(store.append(free.id, 0, vec![record(1)], receipt("won"))).await;
        other.batch_execute("COMMIT").await.unwrap();
        won
    };
    let (lost, won) = futures::join!(store.append(raced.id, 0, vec![record(1)], receipt("lost")), won);
    assert!(matches!(lost, Err(StoreError::Stale { found: 1 })), "{lost:?}");
    assert!(won.is_ok(), "{won:?}");
    assert_eq!(store.find(raced.id).await.unwrap().sequence, 1);
    let written =
        "SELECT (SELECT count(*) FROM moves WHERE contact = $1), (SELECT count(*) FROM moves WHERE contact = $2)";
    let written = other.query_one(written, &[&raced.id, &free.id]).await.unwrap();
    assert_eq!((written.get::<_, i64>(0), written.get::<_, i64>(1)), (0, 1));
    assert_eq!(store.receipt("lost").await.unwrap(), None);
    assert_eq!(store.receipt("won").await.unwrap(), receipt("won"));
}

#[tokio::test]
async fn replicas_that_start_together_make_the_tables_once() {
    let url = Cluster::shared().database().await;
    let opened = join_all((0..6).map(|_| PostgresStore::open(&url))).await;
    assert!(opened.iter().all(Result::is_ok), "{:?}", opened.iter().filter_map(|one| one.as_ref().err()).next());
}

/// The database counts how often it uses an index, and how many updates change no column of an index.
#[tokio::test]
async fn idle_contacts_are_found_by_an_index_that_moves_leave_alone() {
    const MOVES: u64 = 200;
    let cluster = Cluster::shared();
    let url = cluster.database().await;
    let store = PostgresStore::open(&url).await.unwrap();
    let client = connected(&url).await;
    let counted = async |sql: &str| client.query_one(sql, &[]).await.unwrap().get::<_, i64>(0);
    let fresh = Session { updated_at: Timestamp::now(), ..session() };
    store.create(fresh.clone(), None).await.unwrap();
    for sequence in 0..MOVES {
        let step = Record { at: Timestamp::now(), ..record(sequence + 1) };
        store.append(fresh.id, sequence, vec![step], None).await.unwrap();
    }
    let kept = "SELECT n_tup_hot_upd FROM pg_stat_user_tables WHERE relname = 'contacts'";
    // Most of them: some find no room in their page.
    until("the moves are counted", async || (counted(kept).await > MOVES as i64 / 2).then_some(())).await;

    let copies =
        "INSERT INTO contacts (id, label, definition, sequence, created_at, created_ns, updated_at, updated_ns, tenant)
        SELECT gen_random_uuid(), label, definition, sequence, created_at, created_ns, now(), updated_ns, tenant
        FROM contacts, generate_series(1, 5000)";
    client.batch_execute(copies).await.unwrap();
    client.batch_execute("ANALYZE contacts").await.unwrap();
    let used = "SELECT idx_scan FROM pg_stat_user_indexes WHERE indexrelname = 'contacts_by_activity'";
    let read = async || {
        let limit = Timestamp::now() - jiff::SignedDuration::from_hours(24);
        assert_eq!(store.purge_expired(Some(limit)).await.unwrap(), 0);
        (counted(used).await > 0).then_some(())
    };
    until("the index is used", read).await;
}

#[tokio::test]
async fn several_sweep_at_once_and_each_idle_session_goes_once() {
    let cluster = Cluster::shared();
    let url = cluster.database().await;
    let stores = join_all((0..3).map(|_| PostgresStore::open(&url))).await;
    let stores: Vec<PostgresStore> = stores.into_iter().map(Result::unwrap).collect();
    let idle: Vec<Session> = (0..230).map(|_| session()).collect();
    join_all(idle.iter().map(|one| stores[0].create(one.clone(), None))).await;
    let fresh = Session { updated_at: Timestamp::now(), ..session() };
    stores[0].create(fresh.clone(), None).await.unwrap();
    // The session was last moved at this very nanosecond, and so not before it.
    let not_yet = join_all(stores.iter().map(|store| store.purge_expired(Some(idle[0].updated_at)))).await;
    assert!(not_yet.into_iter().all(|count| count.unwrap() == 0));
    let swept = join_all(stores.iter().map(|store| store.purge_expired(Some(fresh.updated_at)))).await;
    assert_eq!(swept.into_iter().map(Result::unwrap).sum::<u64>(), 230);
    assert!(matches!(stores[1].find(idle[7].id).await, Err(StoreError::Expired(_))));
    assert!(matches!(stores[2].append(idle[7].id, 0, vec![record(1)], None).await, Err(StoreError::Expired(_))));
    let left = stores[1].list(None, None, Page::oldest(None, 1000)).await.unwrap();
    assert_eq!(left.into_iter().map(|one| one.id).collect::<Vec<_>>(), [fresh.id]);
}

#[tokio::test]
async fn a_search_that_nobody_waits_for_any_more_is_ended_by_the_database() {
    let url = Cluster::shared().database().await;
    let store = Arc::new(PostgresStore::open(&url).await.unwrap());
    let made = session();
    for other in [made.clone(), session(), session()] {
        store.create(other, None).await.unwrap();
    }
    let client = connected(&url).await;
    // From now on a contact takes three seconds to read.
    let slow = "ALTER TABLE contacts RENAME TO quick;
        CREATE VIEW contacts AS SELECT quick.* FROM quick, LATERAL (SELECT pg_sleep(3), quick.id) AS pause";
    client.batch_execute(slow).await.unwrap();
    let running = "SELECT count(*) FROM pg_stat_activity
        WHERE datname = current_database() AND state = 'active' AND query LIKE '%strpos%' AND pid <> pg_backend_pid()";
    let running = async || client.query_one(running, &[]).await.unwrap().get::<_, i64>(0);
    let search = || {
        let store = Arc::clone(&store);
        tokio::spawn(async move { store.list(None, Some("kugel".to_owned()), Page::oldest(None, 10)).await })
    };
    let searches = [search(), search(), search()];
    until("two of them run", async || (running().await == 2).then_some(())).await;
    searches.iter().for_each(|search| search.abort());
    let given_up = Instant::now();
    until("none runs", async || (running().await == 0).then_some(())).await;
    // By themselves they would end after nine seconds.
    assert!(given_up.elapsed() < Duration::from_secs(6), "{:?}", given_up.elapsed());
    client.batch_execute("DROP VIEW contacts; ALTER TABLE quick RENAME TO contacts").await.unwrap();
    let found = soon(store.list(None, Some("KUGEL".to_owned()), Page::oldest(None, 10))).await.unwrap();
    assert!(found.len() == 3 && found[0].id == made.id);
}

#[tokio::test]
async fn changes_by_another_process_wake_waiting_listeners() {
    let cluster = Cluster::shared();
    let url = cluster.database().await;
    let (here, there) = (PostgresStore::open(&url).await.unwrap(), PostgresStore::open(&url).await.unwrap());
    let new = session();
    here.create(new.clone(), None).await.unwrap();
    // The listener's start wakes all listeners too: it must be over before a wake-up proves anything.
    let mut waits = there.changes().subscribe(new.id);
    for round in 0..3 {
        here.append(new.id, round, vec![record(round + 1)], None).await.unwrap();
        soon(waits.changed()).await.unwrap();
        waits.mark_unchanged();
    }
    here.delete(new.id, 3).await.unwrap();
    soon(waits.changed()).await.unwrap();
}

#[tokio::test]
async fn a_role_that_may_not_announce_changes_is_refused_at_the_start() {
    let cluster = Cluster::shared();
    let url = cluster.database().await;
    let name = url.rsplit('/').next().unwrap();
    let grants = "CREATE ROLE plain LOGIN; GRANT ALL ON SCHEMA public TO plain; \
        REVOKE EXECUTE ON FUNCTION pg_notify FROM PUBLIC";
    cluster.execute(name, grants).await;
    let refused = PostgresStore::open(&url.replace("stickslip@", "plain@")).await.map(drop).unwrap_err().to_string();
    assert!(refused.contains("pg_notify"), "{refused}");
}

#[tokio::test]
async fn tls_is_used_and_verified_as_the_url_says() {
    let cluster = Cluster::start();
    let url = cluster.database().await.replace("127.0.0.1", "localhost");
    let certificate = cluster.encrypt();
    let open = async |options: &str| PostgresStore::open(&format!("{url}?{options}")).await.map(drop);
    let other = tempfile::NamedTempFile::new().unwrap();
    let full = format!("sslmode=verify-full&sslrootcert={}", certificate.display());
    // The server accepts no connection without TLS.
    for valid in ["sslmode=require", "sslmode=prefer", "", &full] {
        open(valid).await.unwrap_or_else(|error| panic!("{valid}: {error}"));
    }
    assert!(open("sslmode=disable").await.unwrap_err().to_string().contains("no encryption"));
    // No authority has signed this certificate, and it is not for this host.
    let by_the_system = open("sslmode=verify-full").await.unwrap_err().to_string();
    assert!(by_the_system.contains("certificate"), "{by_the_system}");
    let elsewhere = format!("{}?{full}", url.replace("localhost", "127.0.0.1"));
    let elsewhere = PostgresStore::open(&elsewhere).await.err().unwrap().to_string();
    assert!(elsewhere.contains("certificate"), "{elsewhere}");
    let nothing = open(&format!("sslmode=verify-full&sslrootcert={}", other.path().display())).await;
    assert!(nothing.unwrap_err().to_string().contains("no certificate authority"));
}

#[tokio::test]
async fn a_password_is_never_shown() {
    for url in [
        "postgres://me:secret@127.0.0.1:port/db",
        "postgres://me:secret@host/db?sslmode=verify-ca",
        "postgres://me:secret@host/db?unheard=of",
        "postgre://me:secret@host/db",
        "postgres:me:secret@host",
    ] {
        let refused = stickslip::store::open(url).await.map(drop).unwrap_err().to_string();
        assert!(!refused.contains("secret"), "{refused}");
    }
}
