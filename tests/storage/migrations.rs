//! Migrations: a step is applied once and whole or not at all, what is stored survives it, and a newer schema is
//! refused.
//!
//! The next version of the tables is made up here.

use std::fs;

use rusqlite::Connection;
use stickslip::store::{
    ChunkResult, Job, JobLimits, Page, PostgresStore, SqliteStore, Store, Tenant, postgres, sqlite,
};
use tempfile::tempdir;
use uuid::Uuid;

use crate::common::kill::exact;
use crate::common::postgres::{Cluster, connected};
use crate::fixtures::{receipt, record, records, session, snapshot, stored, url};

/// A next version: a column with a value for what is there, and a table filled from another. A second time it would
/// fail.
const STEP: &str = "
ALTER TABLE contacts ADD COLUMN colour text NOT NULL DEFAULT 'grey';
CREATE TABLE labels (label text);
INSERT INTO labels SELECT label FROM contacts;
";
/// A step that fails after it has changed something.
const FAILING_STEP: &str = "
CREATE TABLE half (made text);
DELETE FROM receipts;
INSERT INTO nowhere SELECT label FROM contacts;
";

fn with<'a>(migrations: &[&'a str], steps: &[&'a str]) -> Vec<&'a str> {
    [migrations, steps].concat()
}

/// A contact with moves (one of them to -0.0), a snapshot and a fork, a reply kept for retries, a contact that has
/// expired, and a job with a chunk.
async fn fill(store: &dyn Store) -> [Uuid; 3] {
    let (made, _) = stored(store, 3).await;
    let mut awkward = record(4);
    (awkward.step.force, awkward.state.force, awkward.state.elastic_energy) = (Some(-0.0), -0.0, 5e-324);
    store.append(made.id, 3, vec![awkward], Some(receipt("kept", None, 4))).await.unwrap();
    store.save_snapshot(made.id, snapshot(4), None).await.unwrap();
    let fork = stickslip::store::Session { sequence: 4, tenant: Tenant::new("lab"), ..session(None) };
    store.fork(made.id, fork.clone(), None).await.unwrap();
    let idle = stickslip::store::Session { updated_at: jiff::Timestamp::UNIX_EPOCH, ..session(None) };
    store.create(idle.clone(), None).await.unwrap();
    assert_eq!(store.purge_expired(Some(made.created_at)).await.unwrap(), 1);
    let job = Job {
        id: Uuid::now_v7(),
        tenant: Tenant::new("lab"),
        created_at: made.created_at,
        finished_at: None,
        error: None,
        points: 4,
        chunk: 2,
        done: 0,
        failed: 0,
        bytes: 10,
        cost: 10,
    };
    let limits = JobLimits { jobs: 1, bytes: 10, cost: 10 };
    store.create_job(job.clone(), "request".to_owned(), limits, None).await.unwrap();
    let claim = store.claim(Uuid::now_v7(), None, std::time::Duration::from_secs(600)).await.unwrap().unwrap();
    store.save_chunk(claim, ChunkResult { points: 2, failed: 1, content: vec![7] }).await.unwrap();
    [made.id, fork.id, job.id]
}

/// All data that a store returns of what [`fill`] has saved.
async fn content(store: &dyn Store, [made, fork, job]: [Uuid; 3]) -> String {
    exact(&(
        (
            store.find(made).await.unwrap(),
            store.history(made, 0, 10).await.unwrap(),
            store.snapshot(made).await.unwrap(),
        ),
        (
            store.find(fork).await.unwrap(),
            store.history(fork, 0, 10).await.unwrap(),
            store.snapshot(fork).await.unwrap(),
        ),
        (store.list(None, None, Page::oldest(None, 10)).await.unwrap(), store.receipt("kept").await.unwrap().unwrap()),
        (store.job(job).await.unwrap(), store.job_request(job).await.unwrap(), store.chunks(job, 0, 10).await.unwrap()),
        store.check_integrity().await.unwrap(),
    ))
}

#[tokio::test]
async fn a_file_takes_a_step_once_and_whole_and_keeps_what_is_in_it() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("contacts.db");
    let store = SqliteStore::open(&path).unwrap();
    let ids = fill(&store).await;
    let before = content(&store, ids).await;
    drop(store);
    let migrations = sqlite::schema::MIGRATIONS;
    let known = migrations.len() as i32;
    let migrate = |steps: &[&str]| {
        let mut database = Connection::open(&path).unwrap();
        sqlite::schema::migrate(&mut database, &with(migrations, steps)).map_err(|error| error.to_string())
    };
    let ask = |sql: &str| -> i32 { Connection::open(&path).unwrap().query_row(sql, [], |row| row.get(0)).unwrap() };
    let version = || ask("PRAGMA user_version");
    let tables = || ask("SELECT count(*) FROM sqlite_schema WHERE name IN ('half', 'labels')");
    assert_eq!(version(), known);

    // Of two steps the second fails: neither has been made.
    assert!(migrate(&[STEP, FAILING_STEP]).unwrap_err().contains("nowhere"));
    assert_eq!((version(), tables()), (known, 0));
    let store = SqliteStore::open(&path).unwrap();
    assert_eq!(content(&store, ids).await, before);
    drop(store);

    migrate(&[STEP]).unwrap();
    migrate(&[STEP]).unwrap();
    assert_eq!((version(), tables()), (known + 1, 1));
    assert_eq!(ask("SELECT count(*) FROM labels"), 2);
    assert_eq!(ask("SELECT count(*) FROM contacts WHERE colour = 'grey'"), 2);

    // This program does not have the step: it refuses the file, and leaves it as it is.
    let file = fs::read(&path).unwrap();
    let newer = format!("it has schema version {}", known + 1);
    assert!(migrate(&[]).unwrap_err().starts_with(&newer));
    for refused in [SqliteStore::open(&path), SqliteStore::open_to_read(&path)] {
        let refused = refused.map(drop).unwrap_err().to_string();
        assert!(refused.starts_with(&newer), "{refused}");
    }
    assert!(fs::read(&path).unwrap() == file, "a file that was refused has changed");
    assert!(stickslip::store::open(&url(&path)).await.is_err());

    // The step only adds: with its version put back by hand, the tables read as before, and take changes.
    Connection::open(&path).unwrap().pragma_update(None, "user_version", known).unwrap();
    let store = SqliteStore::open(&path).unwrap();
    assert_eq!(content(&store, ids).await, before);
    store.append(ids[0], 4, records(4, 5), None).await.unwrap();
    assert_eq!(store.find(ids[0]).await.unwrap().sequence, 5);
}

/// A contact at an earlier version of the tables, with one move to a force: version 1 knew no observations, and version
/// 2 not by which key a move was made.
#[tokio::test]
async fn what_earlier_versions_have_stored_is_read() {
    let folder = tempdir().unwrap();
    for (version, observed) in [(1, ""), (2, ", 0.5, 12")] {
        let path = folder.path().join(format!("{version}.db"));
        let made = session(None);
        let definition = serde_json::to_string(&*made.definition).unwrap();
        let mut database = Connection::open(&path).unwrap();
        sqlite::schema::migrate(&mut database, &sqlite::schema::MIGRATIONS[..version]).unwrap();
        let contact = "INSERT INTO contacts VALUES (1, ?1, NULL, '', 5, 5, 0, ?2)";
        database.execute(contact, [made.id.to_string(), definition.clone()]).unwrap();
        let moved = format!(
            "INSERT INTO moves VALUES
            (1, 1, 7, NULL, 0.0, NULL, NULL, 0, 1e-10, 1, 0, 3, 4, 5, 6, 'stick', 7, 8, 9, 66{observed})"
        );
        database.execute(&moved, []).unwrap();
        drop(database);
        let store = SqliteStore::open(&path).unwrap();
        reads_earlier_version(&store, made.id, version).await;
        let named = |sql: &str| -> Vec<Option<String>> {
            let database = Connection::open(&path).unwrap();
            let mut query = database.prepare(sql).unwrap();
            query.query_map([], |row| row.get(0)).unwrap().map(Result::unwrap).collect()
        };
        assert_eq!(named("SELECT made_by FROM history ORDER BY sequence"), [None, Some("key_3.a-B".to_owned())]);

        let url = Cluster::shared().database().await;
        let mut client = connected(&url).await;
        postgres::schema::migrate(&mut client, &postgres::schema::MIGRATIONS[..version]).await.unwrap();
        let contact = "INSERT INTO contacts VALUES ($1, NULL, '', $2, 1, now(), 0, now(), 0)";
        client.execute(contact, &[&made.id, &definition]).await.unwrap();
        let moved = format!(
            "INSERT INTO moves VALUES
            ($1, 1, NULL, '-0', NULL, NULL, false, 1e-10, 1, '-0', 3, 4, 5, 6, 'stick', 7, 8, 9, now(), 0,
                11{observed})"
        );
        client.execute(&moved, &[&made.id]).await.unwrap();
        reads_earlier_version(&PostgresStore::open(&url).await.unwrap(), made.id, version).await;
    }
}

async fn reads_earlier_version(store: &dyn Store, id: Uuid, version: usize) {
    let [read] = store.history(id, 0, 10).await.unwrap().try_into().unwrap();
    assert_eq!(
        (read.measured.map(|measured| measured.force), exact(&read.step.force), exact(&read.state.force)),
        ((version > 1).then_some(0.5), exact(&Some(-0.0)), exact(&-0.0))
    );
    assert_eq!((read.state.memory_depth, read.state.elastic_energy, read.by), (9, 8.0, None));
    let next = record(3);
    let next = stickslip::store::Record { sequence: 2, ..next };
    store.append(id, 1, vec![next.clone()], None).await.unwrap();
    assert_eq!(exact(&store.history(id, 1, 10).await.unwrap()), exact(&[next]));
}

#[tokio::test]
async fn a_database_takes_a_step_once_and_whole_and_keeps_what_is_in_it() {
    let url = Cluster::shared().database().await;
    let store = PostgresStore::open(&url).await.unwrap();
    let ids = fill(&store).await;
    let before = content(&store, ids).await;
    drop(store);
    let migrations = postgres::schema::MIGRATIONS;
    let known = migrations.len() as i32;
    let migrate = async |steps: &[&str]| {
        let migrated = postgres::schema::migrate(&mut connected(&url).await, &with(migrations, steps)).await;
        migrated.map_err(|error| format!("{error:?} {error}"))
    };
    let ask = async |sql: &str| connected(&url).await.query_one(sql, &[]).await.unwrap().get::<_, i64>(0);
    let version = async || ask("SELECT max(version)::bigint FROM stickslip_schema").await;
    let tables = async || ask("SELECT count(*) FROM pg_tables WHERE tablename IN ('half', 'labels')").await;
    assert_eq!(version().await, i64::from(known));

    // Of two steps the second fails: neither has been made.
    assert!(migrate(&[STEP, FAILING_STEP]).await.unwrap_err().contains("nowhere"));
    assert_eq!((version().await, tables().await), (i64::from(known), 0));
    let store = PostgresStore::open(&url).await.unwrap();
    assert_eq!(content(&store, ids).await, before);
    drop(store);

    // Of several that migrate at once, one does it.
    let migrated = futures::join!(migrate(&[STEP]), migrate(&[STEP]), migrate(&[STEP]));
    assert_eq!(migrated, (Ok(()), Ok(()), Ok(())));
    assert_eq!((version().await, tables().await), (i64::from(known) + 1, 1));
    assert_eq!(ask("SELECT count(*) FROM labels").await, 2);
    assert_eq!(ask("SELECT count(*) FROM contacts WHERE colour = 'grey'").await, 2);

    // This program does not have the step: it refuses the database, and leaves it as it is.
    let newer = format!("it has schema version {}", known + 1);
    assert!(migrate(&[]).await.unwrap_err().contains(&newer));
    for refused in [PostgresStore::open(&url).await, PostgresStore::open_to_read(&url).await] {
        let refused = refused.map(drop).unwrap_err().to_string();
        assert!(refused.contains(&newer), "{refused}");
    }
    assert_eq!((version().await, tables().await), (i64::from(known) + 1, 1));

    // The step only adds: with its version put back by hand, the tables read as before, and take changes.
    connected(&url).await.execute("DELETE FROM stickslip_schema WHERE version = $1", &[&(known + 1)]).await.unwrap();
    let store = PostgresStore::open(&url).await.unwrap();
    assert_eq!(content(&store, ids).await, before);
    store.append(ids[0], 4, records(4, 5), None).await.unwrap();
    assert_eq!(store.find(ids[0]).await.unwrap().sequence, 5);
}
