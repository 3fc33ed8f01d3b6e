//! `stickslip backup`: a copy taken while the service writes holds every move that was acknowledged before, bit for
//! bit.

use crate::common;
use crate::fixtures::url;

use std::collections::HashMap;
use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};

use common::kill::{Random, exact, history, replays_to_the_last_bit};
use common::process::Process;
use common::{create, run, until};
use rusqlite::Connection;
use stickslip_wire::client::Options;
use tempfile::tempdir;
use uuid::Uuid;

const SESSIONS: usize = 6;
const COPIES: usize = 4;
/// Acknowledged moves of each session between two copies.
const MOVES: u64 = 25;

/// Makes a copy by the command line; what it says on standard error if it refuses.
fn backup(store: &str, copy: &Path) -> Result<(), String> {
    let output = run(&["backup", copy.to_str().unwrap(), "--store", store]);
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.success(), said.is_empty(), "{said}");
    if said.is_empty() { Ok(()) } else { Err(said) }
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn a_copy_taken_under_load_holds_every_acknowledged_move() {
    let folder = tempdir().unwrap();
    let store = folder.path().join("contacts.db");
    let server = Process::start(&url(&store)).await;
    let acknowledged: Arc<Mutex<HashMap<Uuid, u64>>> = Arc::default();
    let over = Arc::new(AtomicBool::new(false));
    let mut movers = Vec::new();
    for seed in 0..SESSIONS as u64 {
        let (client, options) = (server.client.clone(), Options::default());
        let id = client.create(&create(), &options).await.unwrap().id;
        acknowledged.lock().unwrap().insert(id, 0);
        let (acknowledged, over, mut random) = (Arc::clone(&acknowledged), Arc::clone(&over), Random(seed));
        movers.push(tokio::spawn(async move {
            while !over.load(Ordering::SeqCst) {
                let sequence = client.apply(id, &random.step().into(), &options).await.unwrap().sequence;
                acknowledged.lock().unwrap().insert(id, sequence);
            }
        }));
    }
    let mut copies = Vec::new();
    for number in 1..=COPIES as u64 {
        let all = || acknowledged.lock().unwrap().values().all(|sequence| *sequence >= number * MOVES);
        until("all have moved", async || all().then_some(())).await;
        let before = acknowledged.lock().unwrap().clone();
        let (store, copy) = (url(&store), folder.path().join(format!("copy {number}.db")));
        let path = copy.clone();
        tokio::task::spawn_blocking(move || backup(&store, &path)).await.unwrap().unwrap();
        copies.push((copy, before));
    }
    over.store(true, Ordering::SeqCst);
    for mover in movers {
        mover.await.unwrap();
    }
    let mut originals = HashMap::new();
    let moved: Vec<Uuid> = acknowledged.lock().unwrap().keys().copied().collect();
    for id in moved {
        originals.insert(id, history(&server.client, id).await);
    }
    server.stop().await;

    for (copy, before) in copies {
        let checked = run(&["check", "--store", &url(&copy)]);
        assert!(checked.status.success(), "{checked:?}");
        let restored = Process::start(&url(&copy)).await;
        for (id, original) in &originals {
            let copied = history(&restored.client, *id).await;
            assert!(copied.len() as u64 >= before[id], "{} of {} acknowledged moves", copied.len(), before[id]);
            assert_eq!(exact(&copied), exact(&original[..copied.len()].to_vec()));
            replays_to_the_last_bit(&copied);
            // It is a store like any other: it goes on from there.
            let moved = restored.client.apply(*id, &Random(9).step().into(), &Options::default()).await.unwrap();
            assert_eq!(moved.sequence, copied.len() as u64 + 1);
        }
        restored.stop().await;
    }
    let left: Vec<String> =
        fs::read_dir(folder.path()).unwrap().map(|file| file.unwrap().file_name().into_string().unwrap()).collect();
    assert!(left.iter().all(|name| !name.contains("new")), "{left:?}");
}

#[tokio::test]
async fn what_cannot_be_copied_is_refused_in_one_line_and_nothing_is_touched() {
    let folder = tempdir().unwrap();
    let (store, copy) = (folder.path().join("contacts.db"), folder.path().join("copy.db"));
    Process::start(&url(&store)).await.stop().await;
    let refused = |store: &str, copy: &Path, why: &str| {
        let said = backup(store, copy).unwrap_err();
        assert!(said.lines().count() == 1 && said.contains(why), "{said}");
        assert!(!said.contains("secret"), "{said}");
    };
    fs::write(&copy, "precious").unwrap();
    refused(&url(&store), &copy, "already exists");
    assert_eq!(fs::read_to_string(&copy).unwrap(), "precious");

    let other = folder.path().join("other.db");
    Connection::open(&other).unwrap().execute_batch("CREATE TABLE a (b)").unwrap();
    let fresh = folder.path().join("fresh.db");
    refused(&url(&other), &fresh, "of another application");
    refused(&url(&folder.path().join("missing.db")), &fresh, "No such file");
    refused(&url(&store), &folder.path().join("no such folder/copy.db"), "No such file");
    refused("memory:", &fresh, "only in the process");
    refused("postgres://me:secret@localhost/contacts", &fresh, "pg_dump");
    refused("mysql://me:secret@localhost/contacts", &fresh, "unknown kind of store");
    let mut left: Vec<String> =
        fs::read_dir(folder.path()).unwrap().map(|file| file.unwrap().file_name().into_string().unwrap()).collect();
    // Reading a store that no process serves leaves an empty log beside it.
    left.retain(|name| !matches!(name.as_str(), "contacts.db-shm" | "contacts.db-wal"));
    left.sort();
    assert_eq!(left, ["contacts.db", "copy.db", "other.db"]);

    // What an interrupted copy has left does not prevent another.
    fs::write(folder.path().join("fresh.db.new"), "half of a copy").unwrap();
    backup(&url(&store), &fresh).unwrap();
    assert!(!folder.path().join("fresh.db.new").exists());
}
