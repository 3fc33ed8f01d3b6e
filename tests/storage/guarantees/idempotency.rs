//! Idempotency keys: taken together with the change that they name, once.

use std::sync::Arc;

use futures::future::join_all;
use stickslip::store::{Receipt, RequestKey, Session, Store, StoreError};
use uuid::Uuid;

use crate::common::kill::exact;
use crate::fixtures::{receipt, record, records, session, stored};

pub async fn a_receipt_is_returned_as_it_was_stored(store: &dyn Store) {
    let made = session(None);
    let long = "k".repeat(255);
    let born = Receipt {
        request: RequestKey { key: long.clone(), fingerprint: std::array::from_fn(|index| index as u8 * 8) },
        ..receipt("", Some(made.id), 0)
    };
    store.create(made.clone(), Some(born.clone())).await.unwrap();
    assert_eq!(store.receipt(&long).await.unwrap(), Some(born));
    let mut moved = receipt("moved", None, 1);
    moved.reply.body = (0..=u8::MAX).cycle().take(100_000).collect();
    store.append(made.id, 0, records(0, 1), Some(moved.clone())).await.unwrap();
    assert_eq!(store.receipt("moved").await.unwrap(), Some(moved.clone()));
    let copy = Session { sequence: 1, ..session(None) };
    let forked = receipt("forked", Some(copy.id), 1);
    store.fork(made.id, copy, Some(forked.clone())).await.unwrap();
    assert_eq!(store.receipt("forked").await.unwrap(), Some(forked));
    let alone = receipt("alone", None, 0);
    store.keep(alone.clone()).await.unwrap();
    assert_eq!(store.receipt("alone").await.unwrap(), Some(alone.clone()));
    assert!(matches!(store.keep(alone).await, Err(StoreError::KeyTaken)));
    // A retry gets its reply even when the session is deleted.
    store.delete(made.id, 1).await.unwrap();
    assert_eq!(store.receipt("moved").await.unwrap(), Some(moved));
    assert_eq!(store.receipt("Moved").await.unwrap(), None);
}

pub async fn a_taken_key_refuses_every_change_and_changes_nothing(store: &dyn Store) {
    let (session_before, _) = stored(store, 1).await;
    let id = session_before.id;
    let first = receipt("taken", None, 2);
    store.append(id, 1, vec![record(2)], Some(first.clone())).await.unwrap();
    let (fresh, copy) = (session(None), Session { sequence: 2, ..session(None) });
    let again = || Some(receipt("taken", None, 3));
    for refused in [
        store.append(id, 2, vec![record(3)], again()).await,
        store.create(fresh.clone(), again()).await,
        store.fork(id, copy.clone(), again()).await,
        store.keep(receipt("taken", None, 3)).await,
    ] {
        assert!(matches!(refused, Err(StoreError::KeyTaken)), "{refused:?}");
    }
    assert_eq!(store.find(id).await.unwrap().sequence, 2);
    for unborn in [fresh.id, copy.id] {
        assert!(matches!(store.find(unborn).await, Err(StoreError::NotFound)));
    }
    assert_eq!(exact(&store.receipt("taken").await.unwrap()), exact(&Some(first)));
}

pub async fn a_refused_change_takes_no_key(store: &dyn Store) {
    let (session, _) = stored(store, 1).await;
    let refused = store.append(session.id, 0, records(0, 1), Some(receipt("free", None, 1))).await;
    assert!(matches!(refused, Err(StoreError::Stale { found: 1 })), "{refused:?}");
    let refused = store.append(Uuid::now_v7(), 0, records(0, 1), Some(receipt("free", None, 1))).await;
    assert!(matches!(refused, Err(StoreError::NotFound)), "{refused:?}");
    assert_eq!(store.receipt("free").await.unwrap(), None);
    store.append(session.id, 1, records(1, 2), Some(receipt("free", None, 2))).await.unwrap();
}

pub async fn one_of_many_with_the_same_key_or_sequence_wins(store: Arc<dyn Store>) {
    let mut sessions = Vec::new();
    for _ in 0..8 {
        sessions.push(stored(&*store, 0).await.0.id);
    }
    // Mixed, so that requests that fail share transactions with those that succeed: with a key of another contact, at
    // another sequence, or of no contact.
    let nobody = Uuid::now_v7();
    let tasks = (0..160_u64).map(|index| {
        let id = if index % 11 == 10 { nobody } else { sessions[index as usize % 8] };
        let (store, expected) = (Arc::clone(&store), if index % 13 == 12 { 7 } else { 0 });
        let key = (index % 3 == 0).then(|| receipt(&format!("key {}", index % 21), None, 1));
        tokio::spawn(async move { (id, store.append(id, expected, vec![record(expected + 1)], key).await) })
    });
    let made = join_all((0..8).map(|_| store.create(session(None), None)));
    let (tasks, made) = futures::join!(join_all(tasks), made);
    assert!(made.iter().all(Result::is_ok), "{made:?}");
    let mut won = Vec::new();
    for task in tasks {
        match task.unwrap() {
            (id, Ok(())) => won.push(id),
            (id, Err(StoreError::NotFound)) => assert_eq!(id, nobody),
            (_, Err(StoreError::Stale { found: 0 | 1 } | StoreError::KeyTaken)) => {}
            (_, Err(error)) => panic!("{error}"),
        }
    }
    won.sort_unstable();
    sessions.sort_unstable();
    assert_eq!(won, sessions);
    for id in sessions {
        assert_eq!(store.history(id, 0, 10).await.unwrap().len(), 1);
    }
}
