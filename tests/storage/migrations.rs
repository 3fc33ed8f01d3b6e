//! Migrations: a step is applied once and whole or not at all, what is stored survives it, and a newer schema is
//! refused.
//!
//! The next version of the tables is made up here.

use std::fs;

use stickslip::store::{self, ChunkResult, Job, Page, Record, Session, Store, Tenant, postgres, sqlite};
use uuid::Uuid;

use crate::common::kill::exact;
use crate::common::place::Place;
use crate::common::postgres::connected;
use crate::fixtures::{JOB_LIMITS, LEASE, job, receipt, record, records, session, snapshot, stored};

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

/// Brings the tables of a place up to date by migrations: what is made of those of the program.
async fn migrate_by(place: &Place, made: impl Fn(&[&'static str]) -> Vec<&'static str>) -> Result<(), String> {
    match place {
        Place::File(_) => {
            let migrated = sqlite::schema::migrate(&mut place.connection(), &made(sqlite::schema::MIGRATIONS));
            migrated.map_err(|error| error.to_string())
        }
        Place::Database(url) => {
            let migrations = made(postgres::schema::MIGRATIONS);
            let migrated = postgres::schema::migrate(&mut connected(url).await, &migrations).await;
            migrated.map_err(|error| format!("{error:?} {error}"))
        }
    }
}

/// Takes these steps behind the migrations of the program.
async fn migrate(place: &Place, steps: &[&'static str]) -> Result<(), String> {
    migrate_by(place, |own| [own, steps].concat()).await
}

/// A contact with moves (one of them to -0.0), a snapshot and a fork, a reply kept for retries, a contact that has
/// expired, and a job with a chunk.
async fn fill(store: &dyn Store) -> [Uuid; 3] {
    let (made, _) = stored(store, 3).await;
    let mut awkward = record(4);
    (awkward.step.force, awkward.state.force, awkward.state.elastic_energy) = (Some(-0.0), Some(-0.0), 5e-324);
    store.append(made.id, 3, vec![awkward], Some(receipt("kept", None, 4))).await.unwrap();
    store.save_snapshot(made.id, snapshot(4), None).await.unwrap();
    let fork = Session { sequence: 4, tenant: Tenant::new("lab"), ..session(None) };
    store.fork(made.id, fork.clone(), None).await.unwrap();
    let idle = Session { updated_at: jiff::Timestamp::UNIX_EPOCH, ..session(None) };
    store.create(idle.clone(), None).await.unwrap();
    assert_eq!(store.purge_expired(Some(made.created_at)).await.unwrap(), 1);
    let job = Job { points: 4, chunk: 2, ..job("lab") };
    store.create_job(job.clone(), "request".to_owned(), JOB_LIMITS, None).await.unwrap();
    let claim = store.claim(Uuid::now_v7(), None, LEASE).await.unwrap().unwrap();
    store.save_chunk(claim, ChunkResult { points: 2, failed: 1, content: vec![7] }).await.unwrap();
    [made.id, fork.id, job.id]
}

/// All data that a store returns of what [`fill`] has saved.
async fn content(store: &dyn Store, [made, fork, job]: [Uuid; 3]) -> String {
    let contact = async |id| {
        let (found, past) = (store.find(id).await.unwrap(), store.history(id, 0, 10).await.unwrap());
        (found, past, store.snapshot(id).await.unwrap())
    };
    exact(&(
        (contact(made).await, contact(fork).await),
        (store.list(None, None, Page::oldest(None, 10)).await.unwrap(), store.receipt("kept").await.unwrap().unwrap()),
        (store.job(job).await.unwrap(), store.job_request(job).await.unwrap(), store.chunks(job, 0, 10).await.unwrap()),
        store.check_integrity().await.unwrap(),
    ))
}

#[tokio::test]
async fn a_step_is_taken_once_and_whole_and_keeps_what_is_stored() {
    for place in Place::both().await {
        let (known, version, tables) = match place {
            Place::File(_) => (sqlite::schema::MIGRATIONS.len(), "PRAGMA user_version", "sqlite_schema WHERE name"),
            Place::Database(_) => (
                postgres::schema::MIGRATIONS.len(),
                "SELECT max(version)::bigint FROM stickslip_schema",
                "pg_tables WHERE tablename",
            ),
        };
        let known = known as i64;
        let tables = format!("SELECT count(*) FROM {tables} IN ('half', 'labels')");
        let found = async || (place.number(version).await, place.number(&tables).await);
        let store = place.open().await;
        let ids = fill(&*store).await;
        let before = content(&*store, ids).await;
        drop(store);
        assert_eq!(found().await, (known, 0));

        // Of two steps the second fails: neither has been made.
        assert!(migrate(&place, &[STEP, FAILING_STEP]).await.unwrap_err().contains("nowhere"));
        assert_eq!(found().await, (known, 0));
        assert_eq!(content(&*place.open().await, ids).await, before);

        // Of several that migrate at once, one does it.
        let migrated = futures::join!(migrate(&place, &[STEP]), migrate(&place, &[STEP]), migrate(&place, &[STEP]));
        assert_eq!(migrated, (Ok(()), Ok(()), Ok(())));
        assert_eq!(found().await, (known + 1, 1));
        assert_eq!(place.number("SELECT count(*) FROM labels").await, 2);
        assert_eq!(place.number("SELECT count(*) FROM contacts WHERE colour = 'grey'").await, 2);

        // This program does not have the step: it refuses the place, and leaves it as it is.
        let bytes = || place.path().map(|path| fs::read(path).unwrap());
        let (newer, unchanged) = (format!("it has schema version {}", known + 1), bytes());
        assert!(migrate(&place, &[]).await.unwrap_err().contains(&newer));
        for refused in [store::open(&place.url()).await, store::open_to_read(&place.url()).await] {
            let refused = refused.map(drop).unwrap_err().to_string();
            assert!(refused.contains(&newer) && !refused.contains('@'), "{refused}");
        }
        assert!(bytes() == unchanged, "a file that was refused has changed");
        assert_eq!(found().await, (known + 1, 1));

        // The step only adds: with its version put back by hand, the tables read as before, and take changes.
        match &place {
            Place::File(_) => place.connection().pragma_update(None, "user_version", known).unwrap(),
            Place::Database(_) => {
                place.change(&format!("DELETE FROM stickslip_schema WHERE version = {}", known + 1)).await
            }
        }
        let store = place.open().await;
        assert_eq!(content(&*store, ids).await, before);
        store.append(ids[0], 4, records(4, 5), None).await.unwrap();
        assert_eq!(store.find(ids[0]).await.unwrap().sequence, 5);
    }
}

/// A contact at an earlier version of the tables, with one move to a force: version 1 knew no observations, and version
/// 2 not by which key a move was made.
#[tokio::test]
async fn what_earlier_versions_have_stored_is_read() {
    for (version, observed) in [(1, ""), (2, ", 0.5, 12")] {
        for place in Place::both().await {
            let Session { id, definition, .. } = session(None);
            let definition = serde_json::to_string(&*definition).unwrap();
            migrate_by(&place, |own| own[..version].to_vec()).await.unwrap();
            let (contact, moved) = match &place {
                Place::File(_) => (
                    format!("1, '{id}', NULL, '', 5, 5, 0, '{definition}'"),
                    "1, 1, 7, NULL, 0.0, NULL, NULL, 0, 1e-10, 1, 0, 3, 4, 5, 6, 'stick', 7, 8, 9, 66".to_owned(),
                ),
                Place::Database(_) => (
                    format!("'{id}', NULL, '', '{definition}', 1, now(), 0, now(), 0"),
                    format!(
                        "'{id}', 1, NULL, '-0', NULL, NULL, false, 1e-10, 1, '-0', 3, 4, 5, 6, 'stick', 7, 8, 9, now(),
                        0, 11"
                    ),
                ),
            };
            place.change(&format!("INSERT INTO contacts VALUES ({contact})")).await;
            place.change(&format!("INSERT INTO moves VALUES ({moved}{observed})")).await;
            let store = place.open().await;
            let [read] = store.history(id, 0, 10).await.unwrap().try_into().unwrap();
            assert_eq!(
                (read.measured.map(|measured| measured.force), exact(&read.step.force), exact(&read.state.force)),
                ((version > 1).then_some(0.5), exact(&Some(-0.0)), exact(&Some(-0.0)))
            );
            assert_eq!((read.state.memory_depth, read.state.elastic_energy, read.by), (9, 8.0, None));
            let next = Record { sequence: 2, ..record(3) };
            store.append(id, 1, vec![next.clone()], None).await.unwrap();
            assert_eq!(exact(&store.history(id, 1, 10).await.unwrap()), exact(&[next]));
            let view = if place.path().is_some() { "history" } else { "moves" };
            let named = format!("SELECT count(*) FROM {view} WHERE made_by = 'key_3.a-B' AND sequence = 2");
            assert_eq!(place.number(&named).await, 1);
        }
    }
}
