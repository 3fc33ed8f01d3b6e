//! The file of the SQLite store: what is refused at start and left unchanged, what is recovered, and what people can
//! read.

use crate::common;
use crate::fixtures::{along, url};

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use common::kill::{exact, history};
use common::process::{Process, refused};
use common::{create, until};
use rusqlite::Connection;
use stickslip::store::{SqliteStore, Store as _, StoreError};
use stickslip_wire::Move;
use stickslip_wire::client::Options;
use tempfile::tempdir;
use uuid::Uuid;

/// All files of a folder. Of shared memory only that it is there: readers leave marks in it, and it holds no data.
fn content(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let files = fs::read_dir(folder).unwrap().map(|file| file.unwrap().path()).filter(|file| file.is_file());
    let read =
        |path: &Path| if path.to_str().unwrap().ends_with("-shm") { Vec::new() } else { fs::read(path).unwrap() };
    files.map(|path| (path.file_name().unwrap().to_str().unwrap().to_owned(), read(&path))).collect()
}

/// The server does not start on the file, says why in one line, and leaves everything as it was.
fn is_refused(path: &Path, why: &str) {
    let folder = path.parent().unwrap();
    let before = content(folder);
    let output = refused(&url(path));
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!((output.status.code(), said.lines().count(), output.stdout.len()), (Some(1), 1, 0), "{said}");
    assert!(said.starts_with(&format!("cannot open the store {}: ", url(path))) && said.contains(why), "{said}");
    let after = content(folder);
    assert_eq!(before.keys().collect::<Vec<_>>(), after.keys().collect::<Vec<_>>(), "{why}");
    let changed = before.keys().filter(|name| before[*name] != after[*name]).collect::<Vec<_>>();
    assert!(changed.is_empty(), "{why}: {changed:?}");
}

/// A file with a session that has moved on, closed gracefully or not.
async fn used(path: &Path, gracefully: bool) -> Uuid {
    let process = Process::start(&url(path)).await;
    let (client, options) = (&process.client, Options::default());
    let id = client.create(&create(), &options).await.unwrap().id;
    let moves = (0..300).map(|index| Move::displacement(f64::from(index % 7) * 1e-8)).collect();
    client.path(id, &along(moves), &options).await.unwrap();
    client.apply(id, &Move::force(0.25).into(), &options).await.unwrap();
    if gracefully {
        drop(process.stop().await)
    } else {
        process.kill().await
    }
    id
}

fn cut(path: &Path, length: u64) {
    fs::OpenOptions::new().write(true).open(path).unwrap().set_len(length).unwrap();
}

#[test]
fn a_file_that_is_no_store_is_refused_and_left_unchanged() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("file.db");
    for text in ["x", "not a database\n", "SQLite format 3\0", &"a letter to a friend\n".repeat(1_000)] {
        fs::write(&path, text).unwrap();
        is_refused(&path, "not an SQLite database");
    }
    fs::remove_file(&path).unwrap();
    let foreign = Connection::open(&path).unwrap();
    foreign.execute_batch("CREATE TABLE accounts (name TEXT); INSERT INTO accounts VALUES ('savings')").unwrap();
    is_refused(&path, "another application");
    // With changes of its own that are not in the file yet.
    foreign.execute_batch("PRAGMA journal_mode = WAL; INSERT INTO accounts VALUES ('current')").unwrap();
    is_refused(&path, "another application");
    drop(foreign);
    for (nothing, why) in [
        (url(folder.path()), "folder"),
        (url(&folder.path().join("nowhere/file.db")), "cannot be created"),
        ("sqlite:".to_owned(), "path"),
        ("sqlite::memory:".to_owned(), "path"),
        ("mysql://here".to_owned(), "unknown kind"),
        (String::new(), "unknown kind"),
    ] {
        let output = refused(&nothing);
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!((output.status.code(), said.lines().count(), said.contains(why)), (Some(1), 1, true), "{said}");
    }
}

#[tokio::test]
async fn a_truncated_file_is_refused_and_left_unchanged() {
    for gracefully in [true, false] {
        let folder = tempdir().unwrap();
        let path = folder.path().join("torn.db");
        let id = used(&path, gracefully).await;
        let whole = content(folder.path());
        assert_eq!(whole.len(), if gracefully { 1 } else { 3 }, "{:?}", whole.keys());
        let length = whole["torn.db"].len() as u64;
        // Not the last page alone: that of a new file is in the log.
        for cut_to in [length / 2, length / 2 + 100, length - 2 * 4096] {
            cut(&path, cut_to);
            // Pages that are also in the log are not lost with the file.
            is_refused(&path, "cut off");
            fs::write(&path, &whole["torn.db"]).unwrap();
        }
        cut(&path, 50);
        is_refused(&path, "cut off");
        fs::write(&path, &whole["torn.db"]).unwrap();
        let mut scratched = whole["torn.db"].clone();
        // The leaves of the newest pages: everything between the first page and the end.
        scratched[4096..].iter_mut().for_each(|byte| *byte ^= 0x5a);
        fs::write(&path, &scratched).unwrap();
        is_refused(&path, "damaged");
        fs::write(&path, &whole["torn.db"]).unwrap();

        let process = Process::start(&url(&path)).await;
        assert_eq!(history(&process.client, id).await.len(), 301);
        process.kill().await;
        fs::remove_file(&path).unwrap();
        if path.with_extension("db-wal").metadata().is_ok_and(|log| log.len() > 0) {
            is_refused(&path, "missing");
        }
    }
}

#[tokio::test]
async fn a_newer_file_is_refused_and_left_alone() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("newer.db");
    used(&path, true).await;
    let newer = Connection::open(&path).unwrap();
    let version: i32 = newer.pragma_query_value(None, "user_version", |row| row.get(0)).unwrap();
    newer.pragma_update(None, "user_version", version + 1).unwrap();
    // The newer program was killed: what it wrote last is in the log alone.
    is_refused(&path, &format!("version {}", version + 1));
    drop(newer);
    is_refused(&path, &format!("version {}", version + 1));
}

#[tokio::test]
async fn a_file_in_use_is_refused_and_serves_on() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("shared.db");
    let process = Process::start(&url(&path)).await;
    let id = process.client.create(&create(), &Options::default()).await.unwrap().id;
    is_refused(&path, "another process");
    assert_eq!(process.client.apply(id, &Move::force(0.5).into(), &Options::default()).await.unwrap().sequence, 1);
    process.stop().await;
    Process::start(&url(&path)).await.stop().await;
}

#[tokio::test]
async fn remains_of_a_crash_are_removed() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("half.db");
    let id = used(&path, true).await;
    let database = Connection::open(&path).unwrap();
    let columns = "sequence, at, relative, tolerance, displacement, force, indentation, normal_force, contact_radius,
        stick_radius, regime, dissipated_energy, elastic_energy, memory_depth, negative_zeros";
    database
        .execute_batch(&format!(
            "INSERT INTO moves (contact, {columns}) SELECT 7, {columns} FROM moves WHERE contact = 1;
             INSERT INTO unowned VALUES (7, 1)"
        ))
        .unwrap();
    let store = SqliteStore::open(&path).unwrap();
    let left =
        || -> i64 { database.query_row("SELECT count(*) FROM moves WHERE contact = 7", [], |row| row.get(0)).unwrap() };
    until("moves without a contact are removed", async || (left() == 0).then_some(())).await;
    assert_eq!(store.history(id, 0, 1_000).await.unwrap().len(), 301);
    assert!(matches!(store.find(Uuid::now_v7()).await, Err(StoreError::NotFound)));
}

#[tokio::test]
async fn people_can_read_along() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("read.db");
    let process = Process::start(&url(&path)).await;
    let (client, options) = (&process.client, Options::default());
    let id = client.create(&create(), &options).await.unwrap().id;
    let reply = client.apply(id, &Move::force(0.5).into(), &options).await.unwrap();
    let reader = Connection::open_with_flags(&path, rusqlite::OpenFlags::SQLITE_OPEN_READ_ONLY).unwrap();
    let columns = "contact, sequence, to_force, force, dissipated_energy, regime, datetime(at) IS NOT NULL";
    let row = reader.query_row(&format!("SELECT {columns} FROM history"), [], |row| {
        let (contact, sequence, target): (String, i64, f64) = (row.get(0)?, row.get(1)?, row.get(2)?);
        let (force, energy, regime): (f64, f64, String) = (row.get(3)?, row.get(4)?, row.get(5)?);
        Ok((contact, sequence, exact(&[target, force, energy]), regime, row.get::<_, bool>(6)?))
    });
    let numbers = exact(&[0.5, reply.state.force.unwrap(), reply.state.dissipated_energy]);
    assert_eq!(row.unwrap(), (id.to_string(), 1, numbers, "partial_slip".to_owned(), true));
    let seen: (String, i64) =
        reader.query_row("SELECT id, sequence FROM sessions", [], |row| Ok((row.get(0)?, row.get(1)?))).unwrap();
    assert_eq!(seen, (id.to_string(), 1));
}
