//! Sessions are made, moved, forked and deleted.

use std::sync::Arc;

use futures::future::join_all;
use stickslip::store::{LabelChange, Page, Session, Store, StoreError};
use stickslip_wire::{ContactOrder, SessionSummary};
use uuid::Uuid;

use crate::common::kill::exact;
use crate::fixtures::{receipt, record, records, session, snapshot, stored};

pub async fn what_is_stored_is_found(store: &dyn Store) {
    store.ready().await.unwrap();
    for label in [None, Some(""), Some("Ärger 'with' \"quotes\" \u{1f980}")] {
        let mut made = session(label);
        made.updated_at = made.created_at + jiff::SignedDuration::from_nanos(1);
        store.create(made.clone(), None).await.unwrap();
        assert_eq!(exact(&store.find(made.id).await.unwrap()), exact(&made));
        assert!(store.history(made.id, 0, 10).await.unwrap().is_empty());
        assert_eq!(store.snapshot(made.id).await.unwrap(), None);
    }
    let nobody = Uuid::now_v7();
    assert!(matches!(store.find(nobody).await, Err(StoreError::NotFound)));
    assert!(matches!(store.history(nobody, 0, 1).await, Err(StoreError::NotFound)));
    assert!(matches!(store.snapshot(nobody).await, Err(StoreError::NotFound)));
    assert!(matches!(store.append(nobody, 0, records(0, 1), None).await, Err(StoreError::NotFound)));
    assert!(matches!(store.append(nobody, 0, Vec::new(), None).await, Err(StoreError::NotFound)));
    assert!(matches!(store.fork(nobody, session(None), None).await, Err(StoreError::NotFound)));
    assert!(matches!(store.delete(nobody, 0).await, Err(StoreError::NotFound)));
    assert!(matches!(store.receipt("nobody's").await, Ok(None)));
}

pub async fn sessions_are_listed_in_order_and_by_pages(store: &dyn Store) {
    let before = session(None).id;
    let mut made = Vec::new();
    for moves in [0, 3, 0, 1, 2] {
        let Session { id, label, sequence, created_at, updated_at, .. } = stored(store, moves).await.0;
        made.push(SessionSummary { id, label, sequence, created_at, updated_at });
    }
    for order in ContactOrder::ALL {
        // By the labels that they have, or by all.
        for label in [None, Some(String::new())] {
            let mut after = if order == ContactOrder::Oldest { Some(before) } else { None };
            let mut seen: Vec<SessionSummary> = Vec::new();
            loop {
                let page = store.list(None, label.clone(), Page { order, after, limit: 2 }).await.unwrap();
                assert!(page.len() <= 2);
                // Older ones are of other tests.
                after = page.last().map(|last| last.id).filter(|last| *last > before);
                seen.extend(page.into_iter().filter(|item| item.id > before));
                if after.is_none() {
                    break;
                }
            }
            let mut wanted = made.clone();
            wanted.retain(|item| label.is_none() || item.label.is_some());
            if order == ContactOrder::Newest {
                wanted.reverse();
            }
            assert_eq!(exact(&seen), exact(&wanted), "{order:?} {label:?}");
        }
    }
    assert!(store.list(None, None, Page::oldest(None, 1)).await.unwrap()[0].id <= made[0].id);
}

pub async fn a_label_changes_alone_and_finds_its_session(store: &dyn Store) {
    let (made, past) = stored(store, 2).await;
    let tenant = Some(made.tenant.clone());
    let found = async |label: &str| {
        let listed = store.list(None, Some(label.to_owned()), Page::oldest(None, 1_000)).await.unwrap();
        assert_eq!(listed.iter().any(|item| item.id == made.id), {
            let own = store.list(tenant.clone(), Some(label.to_owned()), Page::oldest(None, 1_000)).await.unwrap();
            own.iter().any(|item| item.id == made.id)
        });
        listed.iter().any(|item| item.id == made.id)
    };
    let mut before = made.label.clone();
    for label in [Some("50 %_ Ärger of A.B\\C"), None, Some("")] {
        let label = label.map(str::to_owned);
        store.rename(made.id, LabelChange { from: before, to: label.clone() }, 2, None).await.unwrap();
        before = label.clone();
        let renamed = Session { label: label.clone(), ..made.clone() };
        assert_eq!(exact(&store.find(made.id).await.unwrap()), exact(&renamed));
        let extent = store.extent(made.id).await.unwrap();
        assert_eq!((extent.sequence, extent.label), (2, label.clone()));
        assert_eq!(exact(&store.history(made.id, 0, 10).await.unwrap()), exact(&past));
        for (text, is_part) in [
            ("a.b\\c", true),
            ("A_B", false),
            ("50 %_ Ä", true),
            ("ä", false),
            ("\\\\", false),
            ("%", true),
            ("50%", false),
        ] {
            let wanted = is_part && label.as_ref().is_some_and(|label| !label.is_empty());
            assert_eq!(found(text).await, wanted, "{text} in {label:?}");
        }
        assert_eq!(found("").await, label.is_some());
    }
    let named = |from: &Option<String>, to: &Option<String>| LabelChange { from: from.clone(), to: to.clone() };
    let nobody = store.rename(Uuid::now_v7(), named(&None, &Some("nobody".to_owned())), 0, None).await;
    assert!(matches!(nobody, Err(StoreError::NotFound)));
    // A key that is taken refuses it, and it takes its key.
    let [first, second, late] = ["first", "second", "late"].map(|label| Some(label.to_owned()));
    store.rename(made.id, named(&before, &first), 2, Some(receipt("naming", None, 2))).await.unwrap();
    let twice = store.rename(made.id, named(&first, &second), 2, Some(receipt("naming", None, 2))).await;
    assert!(matches!(twice, Err(StoreError::KeyTaken)), "{twice:?}");
    // At another sequence, or with another label, it changes nothing, and takes no key.
    for (wrong, from) in [(1, &first), (3, &first), (2, &second), (2, &None)] {
        let refused = store.rename(made.id, named(from, &late), wrong, Some(receipt("late", None, 2))).await;
        assert!(matches!(refused, Err(StoreError::Stale { found: 2 })), "{refused:?}");
    }
    assert!(store.receipt("late").await.unwrap().is_none());
    assert_eq!(store.extent(made.id).await.unwrap().label.as_deref(), Some("first"));
}

pub async fn moves_are_appended_at_the_expected_sequence_alone(store: &dyn Store) {
    let (mut session, mut past) = stored(store, 3).await;
    for wrong in [0, 2, 4] {
        let refused = store.append(session.id, wrong, records(wrong, wrong + 1), None).await;
        assert!(matches!(refused, Err(StoreError::Stale { found: 3 })), "{refused:?}");
    }
    assert_eq!(exact(&store.find(session.id).await.unwrap()), exact(&session));
    store.append(session.id, 3, records(3, 2_500), None).await.unwrap();
    past.extend(store.history(session.id, 3, 5_000).await.unwrap());
    (session.sequence, session.updated_at) = (2_500, past[2_499].at);
    assert_eq!(exact(&store.find(session.id).await.unwrap()), exact(&session));
    assert_eq!(past.iter().map(|item| item.sequence).collect::<Vec<_>>(), (1..=2_500).collect::<Vec<_>>());
    for (after, limit) in [(0, 1), (1_234, 1_000), (2_499, 10), (2_500, 10), (u64::MAX, 10)] {
        let page = store.history(session.id, after, limit).await.unwrap();
        let start = past.len().min(usize::try_from(after).unwrap_or(usize::MAX));
        assert_eq!(exact(&page), exact(&past[start..].iter().take(limit).collect::<Vec<_>>()));
    }
}

pub async fn a_fork_shares_the_past_and_nothing_else(store: &dyn Store) {
    let (original, past) = stored(store, 5).await;
    store.save_snapshot(original.id, snapshot(4), None).await.unwrap();
    let copy = Session { sequence: 5, label: None, ..session(None) };
    let late = Session { sequence: 6, ..session(None) };
    let refused = store.fork(original.id, late.clone(), None).await;
    assert!(matches!(refused, Err(StoreError::Stale { found: 5 })), "{refused:?}");
    assert!(matches!(store.find(late.id).await, Err(StoreError::NotFound)));
    // A part of the past, and a snapshot only if it is of that part.
    for (sequence, kept) in [(0, None), (3, None), (4, Some(snapshot(4)))] {
        let early = Session { sequence, ..session(Some("early")) };
        store.fork(original.id, early.clone(), None).await.unwrap();
        assert_eq!(exact(&store.find(early.id).await.unwrap()), exact(&early));
        let past = &past[..usize::try_from(sequence).unwrap()];
        assert_eq!(exact(&store.history(early.id, 0, 10).await.unwrap()), exact(&past.to_vec()));
        assert_eq!(store.snapshot(early.id).await.unwrap(), kept);
        store.append(early.id, sequence, vec![record(sequence + 1)], None).await.unwrap();
        assert_eq!(store.extent(early.id).await.unwrap().sequence, sequence + 1);
    }
    assert_eq!(exact(&store.history(original.id, 0, 10).await.unwrap()), exact(&past));
    store.fork(original.id, copy.clone(), None).await.unwrap();
    // Its times are its own, though its last move is older.
    assert_eq!(exact(&store.find(copy.id).await.unwrap()), exact(&copy));
    assert_eq!(exact(&store.history(copy.id, 0, 10).await.unwrap()), exact(&past));
    assert_eq!(store.snapshot(copy.id).await.unwrap(), Some(snapshot(4)));

    store.append(copy.id, 5, vec![record(6)], None).await.unwrap();
    assert_eq!(exact(&store.find(original.id).await.unwrap()), exact(&original));
    store.delete(original.id, 5).await.unwrap();
    assert_eq!(store.history(copy.id, 0, 10).await.unwrap().len(), 6);
    let of_a_fork = Session { sequence: 6, ..session(None) };
    store.fork(copy.id, of_a_fork.clone(), None).await.unwrap();
    store.delete(copy.id, 6).await.unwrap();
    assert_eq!(exact(&store.history(of_a_fork.id, 0, 5).await.unwrap()), exact(&past));
}

pub async fn a_long_past_is_forked_and_deleted_while_others_move(store: Arc<dyn Store>) {
    const LONG: u64 = 30_000;
    let (original, _) = stored(&*store, LONG).await;
    let (other, _) = stored(&*store, 0).await;
    let mut copies: Vec<Session> = (0..3).map(|_| Session { sequence: LONG, ..session(None) }).collect();
    let forks = join_all(copies.iter().map(|copy| store.fork(original.id, copy.clone(), None)));
    let moves = async {
        for sequence in 0..40 {
            store.append(other.id, sequence, vec![record(sequence + 1)], None).await.unwrap();
        }
        store.append(original.id, LONG, vec![record(LONG + 1)], None).await.unwrap();
    };
    let (forked, ()) = futures::join!(forks, moves);
    for (copy, fork) in copies.iter_mut().zip(forked) {
        // Whether the original has moved on first is open, but nothing is made of half a past.
        if let Err(error) = fork {
            assert!(matches!(error, StoreError::Stale { found } if found == LONG + 1), "{error}");
            assert!(matches!(store.find(copy.id).await, Err(StoreError::NotFound)));
            copy.sequence = LONG + 1;
            store.fork(original.id, copy.clone(), None).await.unwrap();
        }
    }
    let past = store.history(original.id, 0, LONG as usize + 1).await.unwrap();
    store.delete(original.id, LONG + 1).await.unwrap();
    store.delete(copies[0].id, copies[0].sequence).await.unwrap();
    assert!(matches!(store.history(original.id, 0, 1).await, Err(StoreError::NotFound)));
    for copy in &copies[1..] {
        assert_eq!(exact(&store.find(copy.id).await.unwrap()), exact(copy));
        let page = store.history(copy.id, 0, LONG as usize + 1).await.unwrap();
        assert!(exact(&page) == exact(&&past[..copy.sequence as usize]), "the past of the copy differs");
    }
    assert_eq!(store.find(other.id).await.unwrap().sequence, 40);
}

pub async fn what_is_deleted_is_gone(store: &dyn Store) {
    let (session, _) = stored(store, 2).await;
    store.save_snapshot(session.id, snapshot(2), None).await.unwrap();
    assert!(matches!(store.delete(session.id, 1).await, Err(StoreError::Stale { found: 2 })));
    assert_eq!(store.history(session.id, 0, 10).await.unwrap().len(), 2);
    store.delete(session.id, 2).await.unwrap();
    assert!(matches!(store.find(session.id).await, Err(StoreError::NotFound)));
    assert!(matches!(store.history(session.id, 0, 10).await, Err(StoreError::NotFound)));
    assert!(matches!(store.snapshot(session.id).await, Err(StoreError::NotFound)));
    assert!(matches!(store.append(session.id, 2, records(2, 3), None).await, Err(StoreError::NotFound)));
    assert!(matches!(store.delete(session.id, 2).await, Err(StoreError::NotFound)));
    let listed = store.list(None, None, Page::oldest(None, 1_000)).await.unwrap();
    assert!(listed.iter().all(|found| found.id != session.id));
}

pub async fn the_newest_snapshot_is_kept(store: &dyn Store) {
    let (session, _) = stored(store, 9).await;
    for (given, kept) in [(3, 3), (7, 7), (5, 7), (9, 9)] {
        store.save_snapshot(session.id, snapshot(given), None).await.unwrap();
        assert_eq!(store.snapshot(session.id).await.unwrap(), Some(snapshot(kept)));
    }
    // One that cannot be read is in nobody's way.
    for (unreadable, kept) in [(7, 9), (9, 4)] {
        store.save_snapshot(session.id, snapshot(4), Some(unreadable)).await.unwrap();
        assert_eq!(store.snapshot(session.id).await.unwrap(), Some(snapshot(kept)));
    }
    store.save_snapshot(Uuid::now_v7(), snapshot(1), None).await.unwrap();
}
