//! The store in memory: those who read much and those who write have their turns, and nothing reaches a disk.

use std::collections::BTreeSet;
use std::fs::read_link;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use futures::future::join_all;
use jiff::Timestamp;
use stickslip::store::{Page, Record, Session, SqliteStore, Store, Tenant};
use stickslip_wire::client::Options;
use stickslip_wire::{ForkRequest, Move};
use uuid::Uuid;

use crate::common::process::Process;
use crate::common::{create, until};
use crate::fixtures::{keyed, made, records, session};

const WRITERS: usize = 8;
const READERS: usize = 8;
/// Moves of each writer, one at a time.
const MOVES: u64 = 100;
/// Moves of the contact that is read, forked and deleted meanwhile, and of a page of them.
const LONG: u64 = 9_000;
const PAGE: u64 = 3_000;

/// Reads as much as there is, again and again until all others are done.
async fn read_on(store: Arc<SqliteStore>, id: Uuid, done: Arc<AtomicBool>, rounds: Arc<AtomicUsize>) {
    while !done.load(Ordering::SeqCst) {
        for after in (0..LONG).step_by(PAGE as usize) {
            let page = store.history(id, after, PAGE as usize).await.unwrap();
            assert_eq!((page.len() as u64, page[0].sequence), (PAGE, after + 1));
        }
        let found = store.list(None, Some("lab".to_owned()), Page::oldest(None, 100)).await.unwrap();
        assert!(found.len() > WRITERS);
        assert!(store.usage(&Tenant::default()).await.unwrap().contacts > WRITERS as u64);
        rounds.fetch_add(1, Ordering::SeqCst);
    }
}

#[tokio::test(flavor = "multi_thread", worker_threads = 4)]
async fn writers_and_readers_of_long_histories_have_their_turns() {
    let store = Arc::new(SqliteStore::in_memory().unwrap());
    let long = made(&*store, Some("label")).await;
    for after in (0..LONG).step_by(PAGE as usize) {
        store.append(long, after, records(after, after + PAGE), None).await.unwrap();
    }
    let ids = join_all((0..WRITERS).map(|_| made(&*store, Some("label")))).await;
    let (done, rounds) = (Arc::new(AtomicBool::new(false)), Arc::new(AtomicUsize::new(0)));
    let readers = (0..READERS).map(|_| tokio::spawn(read_on(store.clone(), long, done.clone(), rounds.clone())));
    let readers: Vec<_> = readers.collect();
    // None of them would be done if it waited for readers that never pause.
    let writers = ids.iter().map(|&id| {
        let store = store.clone();
        tokio::spawn(async move {
            for after in 0..MOVES {
                store.append(id, after, records(after, after + 1), None).await.unwrap();
                assert_eq!(store.extent(id).await.unwrap().sequence, after + 1);
            }
        })
    });
    let writers: Vec<_> = writers.collect();
    for _ in 0..3 {
        let copy = Session { id: Uuid::now_v7(), sequence: LONG, ..session(None) };
        store.fork(long, copy.clone(), None).await.unwrap();
        assert_eq!(store.count_moves(copy.id, LONG).await.unwrap(), LONG);
        store.delete(copy.id, LONG).await.unwrap();
    }
    join_all(writers).await.into_iter().for_each(|writer| writer.unwrap());
    until("each reader has had its turn", async || (rounds.load(Ordering::SeqCst) >= READERS).then_some(())).await;
    done.store(true, Ordering::SeqCst);
    join_all(readers).await.into_iter().for_each(|reader| reader.unwrap());
    for id in ids {
        let written = store.history(id, 0, MOVES as usize + 1).await.unwrap();
        assert!(written.iter().map(|record| record.sequence).eq(1..=MOVES));
    }
    assert!(store.check_integrity().await.unwrap().is_empty());
}

#[tokio::test]
async fn nothing_reaches_a_disk_and_the_process_ends_at_once() {
    let process = Process::with("memory:", &["--expire-after", "1h"]);
    // Besides sockets and the like, its log, and what it inherits from the test.
    let files = |process: &str| -> BTreeSet<PathBuf> {
        let open = std::fs::read_dir(format!("/proc/{process}/fd")).unwrap();
        let open = open.filter_map(|file| read_link(file.unwrap().path()).ok());
        open.filter(|file| file.is_absolute() && !file.starts_with("/dev") && !file.ends_with("log")).collect()
    };
    let client = &process.client;
    let id = client.create(&create(), &keyed("new")).await.unwrap().id;
    for number in 0..20 {
        let step = Move::displacement(f64::from(number) * 1e-9);
        client.apply(id, &step.into(), &Options::default()).await.unwrap();
    }
    client.fork(id, &ForkRequest::default(), &Options::default()).await.unwrap();
    let (open, inherited) = (files(&process.id().to_string()), files("self"));
    assert!(open.is_subset(&inherited), "{open:?}");
    process.stop().await;
}

/// Moves share transactions, of which one that fails takes none along.
#[tokio::test]
async fn a_move_that_cannot_be_stored_takes_none_of_those_before_it_along() {
    let store = SqliteStore::in_memory().unwrap();
    let (id, moves) = (made(&store, None).await, records(0, 200));
    for (after, step) in (0..).zip(&moves) {
        // Beyond the times that a column has.
        let unstorable = |sequence| Record { sequence, at: Timestamp::MAX, ..step.clone() };
        if after % 7 == 0 {
            assert!(store.append(id, after, vec![unstorable(after + 1)], None).await.is_err());
        }
        if after % 50 == 0 {
            assert!(store.append(id, after, vec![step.clone(), unstorable(after + 2)], None).await.is_err());
        }
        store.append(id, after, vec![step.clone()], None).await.unwrap();
    }
    assert_eq!(store.history(id, 0, 1_000).await.unwrap(), moves);
    assert_eq!(store.extent(id).await.unwrap().sequence, 200);
}
