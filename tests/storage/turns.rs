//! One contact is one loading history: moves of several clients on it have their turn in the order of their arrival.

use std::sync::Arc;

use crate::common;
use crate::fixtures::soon;

use common::create;
use common::kill::exact;
use futures::future::join_all;
use stickslip::admission::Pool;
use stickslip::sessions::{CAPACITY, SessionError, Sessions};
use stickslip::store::{Reply, SqliteStore, Store};
use stickslip_wire::{Document as _, Move, MoveReply, MoveRequest, PathRequest, State};
use tempfile::tempdir;
use uuid::Uuid;

async fn made(sessions: &Sessions) -> Uuid {
    sessions.create(create().check().unwrap(), None).await.unwrap().created.unwrap()
}

async fn moved(sessions: &Sessions, id: Uuid, step: Move, expected: Option<u64>) -> Result<Reply, SessionError> {
    sessions.apply(id, MoveRequest::from(step).check().unwrap(), expected.map(Into::into), None).await
}

fn state(reply: &Reply) -> State {
    serde_json::from_slice::<MoveReply>(&reply.body).unwrap().state
}

// On one thread the first of them has the contact when the others come, each in its turn: who waits is the same in
// every run.
#[tokio::test]
async fn requests_on_one_contact_have_their_turn_in_the_order_of_their_arrival() {
    let folder = tempdir().unwrap();
    let store = Arc::new(SqliteStore::open(&folder.path().join("turns.db")).unwrap());
    let sessions = Sessions::new(store.clone(), Pool::with_defaults(), CAPACITY);
    let (shared, alone) = (made(&sessions).await, made(&sessions).await);
    // Of five one expects another sequence, and of seven one has a force that friction does not bear.
    let wanted: Vec<(Move, Option<u64>)> = (0..40)
        .map(|index| match index {
            _ if index % 5 == 4 => (Move::displacement(1e-8), Some(10_000)),
            _ if index % 7 == 6 => (Move::force(1e6), None),
            _ => (Move::displacement(if index % 2 == 0 { 1e-9 } else { -1e-9 } * f64::from(index)), None),
        })
        .collect();
    let path = serde_json::json!({"path": {"displacement": [5e-8, -5e-8]}});
    let path = serde_json::from_value::<PathRequest>(path).unwrap();
    let moves = join_all(wanted.iter().map(|(step, expected)| moved(&sessions, shared, *step, *expected)));
    // The client of a move that waits among the others hangs up before its turn.
    let mut leaves = Box::pin(moved(&sessions, shared, Move::displacement(1e-7), None));
    let (mut moves, path_after) = (Box::pin(moves), sessions.apply(shared, path.check().unwrap(), None, None));
    let mut path_after = Box::pin(path_after);
    assert!(futures::poll!(moves.as_mut()).is_pending() && futures::poll!(leaves.as_mut()).is_pending());
    assert!(futures::poll!(path_after.as_mut()).is_pending());
    // Reads have no turn: the first move has it, and does not go on meanwhile.
    let read = soon(sessions.get(shared)).await.unwrap();
    assert!(read.sequence <= 1 && soon(sessions.sequence(shared)).await.unwrap() <= 1);
    soon(sessions.definition(shared)).await.unwrap();
    drop(leaves);
    let (replies, path_after) = futures::join!(moves, path_after);

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
    assert_eq!((path_after.unwrap().sequence, sessions.get(shared).await.unwrap().sequence), (30, 30));
    assert_eq!(store.history(shared, 0, 100).await.unwrap().len(), 30);
}
