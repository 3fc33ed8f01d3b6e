//! Moves that wait for one contact together are made together, and each has a reply of its own.

use crate::common;

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use common::create;
use common::kill::{PATIENCE, Random, exact, history, replays_to_the_last_bit};
use common::process::Process;
use futures::future::join_all;
use stickslip::admission::Pool;
use stickslip::sessions::{CAPACITY, SessionError, Sessions};
use stickslip::store::{Record, Reply, SqliteStore, Store};
use stickslip_wire::client::{Client, Options};
use stickslip_wire::{Document as _, Move, MoveReply, MoveRequest, State};
use tempfile::tempdir;
use uuid::Uuid;

/// The sessions over a new file, and its store.
fn sessions(file: &std::path::Path) -> (Sessions, Arc<SqliteStore>) {
    let store = Arc::new(SqliteStore::open(file).unwrap());
    (Sessions::new(store.clone(), Pool::with_defaults(), CAPACITY), store)
}

async fn made(sessions: &Sessions) -> Uuid {
    sessions.changes().create(create().check().unwrap(), None).await.unwrap().created.unwrap()
}

async fn moved(sessions: &Sessions, id: Uuid, step: Move, expected: Option<u64>) -> Result<Reply, SessionError> {
    sessions.moves().apply(id, MoveRequest::from(step).check().unwrap(), expected.map(Into::into), None).await
}

fn commits(store: &SqliteStore) -> u64 {
    store.commits().unwrap().size.get_sample_count()
}

fn state(reply: &Reply) -> State {
    serde_json::from_slice::<MoveReply>(&reply.body).unwrap().state
}

fn steps(records: &[Record]) -> Vec<(u64, Move, String)> {
    records.iter().map(|record| (record.sequence, record.step, exact(&record.state))).collect()
}

// On one thread the first of them has the contact when the others come, each in its turn: what waits is the same in
// every run.
#[tokio::test]
async fn moves_that_wait_together_share_a_commit_in_the_order_of_their_arrival() {
    let folder = tempdir().unwrap();
    let (sessions, store) = sessions(&folder.path().join("groups.db"));
    let (together, alone) = (made(&sessions).await, made(&sessions).await);
    let mut random = Random(7);
    // Of five one expects another sequence, and of seven one has a force that friction does not bear: these two are
    // refused.
    let wanted: Vec<(Move, Option<u64>)> = (0..40)
        .map(|index| match index {
            _ if index % 5 == 4 => (Move::displacement(1e-8), Some(10_000)),
            _ if index % 7 == 6 => (Move::force(1e6), None),
            _ => (Move::displacement(2e-7 * random.number()), None),
        })
        .collect();
    let before = commits(&store);
    let replies = join_all(wanted.iter().map(|(step, expected)| moved(&sessions, together, *step, *expected))).await;
    // One for the first move, one for all that waited for it, and on a machine that stalls a snapshot after each.
    assert!((2..=4).contains(&(commits(&store) - before)), "{} commits", commits(&store) - before);

    let mut sequence = 0;
    for ((step, expected), reply) in wanted.iter().zip(replies) {
        match reply {
            Ok(reply) => {
                sequence += 1;
                let expected = moved(&sessions, alone, *step, None).await.unwrap();
                assert_eq!((reply.sequence, exact(&state(&reply))), (sequence, exact(&state(&expected))));
            }
            Err(SessionError::Stale { expected: 10_000, .. }) => assert_eq!(*expected, Some(10_000)),
            Err(SessionError::Failure(_)) => assert_eq!(step.force, Some(1e6)),
            Err(error) => panic!("{step:?}: {error}"),
        }
    }
    assert_eq!(sequence, 28);
    let [here, there] = [together, alone].map(|id| store.history(id, 0, 100));
    assert_eq!(steps(&here.await.unwrap()), steps(&there.await.unwrap()));
}

/// One move more than fits in a group, with a path and a read between them, which wait in the same line.
#[tokio::test]
async fn a_path_that_waits_between_moves_keeps_its_place() {
    let folder = tempdir().unwrap();
    let (sessions, store) = sessions(&folder.path().join("groups.db"));
    let id = made(&sessions).await;
    let step = |number: usize| Move::displacement(1e-9 * number as f64);
    let path = serde_json::json!({"path": {"displacement": [5e-8, -5e-8]}});
    let path = serde_json::from_value::<stickslip_wire::PathRequest>(path).unwrap().check().unwrap();
    let moves =
        |numbers: std::ops::Range<usize>| join_all(numbers.map(|number| moved(&sessions, id, step(number), None)));
    let before = commits(&store);
    let mover = sessions.moves();
    let (first, between, last, read) =
        futures::join!(moves(0..4), mover.apply(id, path, None, None), moves(4..80), sessions.get(id));
    let sequences = |replies: Vec<Result<Reply, SessionError>>| -> Vec<u64> {
        replies.into_iter().map(|reply| reply.unwrap().sequence).collect()
    };
    assert_eq!(sequences(first), [1, 2, 3, 4]);
    assert_eq!(between.unwrap().sequence, 6);
    assert_eq!(sequences(last), (7..=82).collect::<Vec<_>>());
    assert_eq!(read.unwrap().sequence, 82);
    // The first move, three, the path, sixty-four and twelve, and on a machine that stalls a snapshot after each.
    assert!((5..=10).contains(&(commits(&store) - before)), "{} commits", commits(&store) - before);
}

#[tokio::test]
async fn a_client_that_leaves_takes_no_other_move_with_it() {
    let folder = tempdir().unwrap();
    let (sessions, store) = sessions(&folder.path().join("groups.db"));
    let id = made(&sessions).await;
    let step = |number: u32| Move::displacement(1e-9 * f64::from(number));
    let mut kept = Vec::new();
    let (first, mut leads) = (moved(&sessions, id, step(0), None), Box::pin(moved(&sessions, id, step(1), None)));
    let mut first = Box::pin(first);
    assert!(futures::poll!(first.as_mut()).is_pending() && futures::poll!(leads.as_mut()).is_pending());
    for number in 2..8 {
        let mut waiting = Box::pin(moved(&sessions, id, step(number), None));
        assert!(futures::poll!(waiting.as_mut()).is_pending());
        kept.push(waiting);
    }
    let left = kept.remove(0);
    drop(left);
    first.await.unwrap();
    // It has the contact now, and has begun to make the moves of the others.
    assert!(futures::poll!(leads.as_mut()).is_pending());
    drop(leads);
    let sequences: Vec<u64> = join_all(kept).await.into_iter().map(|reply| reply.unwrap().sequence).collect();
    assert_eq!(sequences, [3, 4, 5, 6, 7]);
    assert_eq!(store.history(id, 0, 100).await.unwrap().len(), 7);
}

/// Moves one contact until the server is gone; returns what it has acknowledged.
async fn acknowledged(client: Client, id: Uuid, seed: u64, count: Arc<AtomicUsize>) -> Vec<(u64, Move, State)> {
    let (mut random, mut replies) = (Random(seed), Vec::new());
    loop {
        let step = Move::displacement(2e-7 * random.number());
        let Ok(reply) = client.apply(id, &step.into(), &Options::default()).await else { return replies };
        count.fetch_add(1, Ordering::SeqCst);
        replies.push((reply.sequence, step, reply.state));
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn kills_lose_no_move_that_was_made_with_others() {
    let folder = tempdir().unwrap();
    let store = format!("sqlite:{}", folder.path().join("killed.db").display());
    let mut process = Process::start(&store).await;
    let id = process.client.create(&create(), &Options::default()).await.unwrap().id;
    for round in 0..8 {
        let count = Arc::new(AtomicUsize::new(0));
        let clients: Vec<_> = (0..24)
            .map(|client| tokio::spawn(acknowledged(process.client.clone(), id, 100 * round + client, count.clone())))
            .collect();
        let busy = async {
            while count.load(Ordering::SeqCst) < 200 {
                tokio::time::sleep(Duration::from_millis(2)).await;
            }
        };
        tokio::time::timeout(PATIENCE, busy).await.expect("nothing moves");
        process.kill().await;
        process = Process::start(&store).await;
        let stored = history(&process.client, id).await;
        let mut seen = vec![false; stored.len()];
        for client in clients {
            for (sequence, step, state) in client.await.unwrap() {
                let place = sequence as usize - 1;
                assert!(!std::mem::replace(&mut seen[place], true), "two moves were acknowledged as number {sequence}");
                assert_eq!((exact(&step), exact(&state)), (exact(&stored[place].step), exact(&stored[place].state)));
            }
        }
        replays_to_the_last_bit(&stored);
    }
    process.stop().await;
}
