//! Expiry: contacts that have not moved for long expire, and nothing else does.

use jiff::{SignedDuration, Timestamp};
use stickslip::store::{Page, Record, Session, Store, StoreError};

use crate::fixtures::{receipt, record, records, session, snapshot, stored};

pub async fn idle_sessions_expire_and_the_others_stay(store: &dyn Store) {
    let limit = Timestamp::now() - SignedDuration::from_hours(1);
    let old = |hours| limit - SignedDuration::from_hours(hours);
    // Made long ago and never moved; moved long ago; made long ago and moved since; made from an old one just now.
    let idle = Session { created_at: old(2), updated_at: old(2), ..session(None) };
    let moved_then = Session { created_at: old(9), updated_at: old(9), ..session(None) };
    let moved_since = Session { created_at: old(9), updated_at: old(9), ..session(None) };
    for made in [&idle, &moved_then, &moved_since] {
        store.create(made.clone(), None).await.unwrap();
    }
    store.append(moved_then.id, 0, vec![Record { at: old(1), ..record(1) }], None).await.unwrap();
    store.append(moved_since.id, 0, records(0, 1), None).await.unwrap();
    store.save_snapshot(moved_then.id, snapshot(1), None).await.unwrap();
    let copy = Session { sequence: 1, ..session(None) };
    store.fork(moved_then.id, copy.clone(), None).await.unwrap();
    let (fresh, _) = stored(store, 0).await;
    let (deleted, _) = stored(store, 0).await;
    store.delete(deleted.id, 0).await.unwrap();

    assert_eq!(store.purge_expired(None).await.unwrap(), 0);
    store.find(idle.id).await.unwrap();
    assert_eq!(store.purge_expired(Some(limit)).await.unwrap(), 2);
    assert_eq!(store.purge_expired(Some(limit)).await.unwrap(), 0);
    for gone in [idle.id, moved_then.id] {
        assert!(matches!(store.find(gone).await, Err(StoreError::Expired(_))));
        assert!(matches!(store.history(gone, 0, 1).await, Err(StoreError::Expired(_))));
        assert!(matches!(store.snapshot(gone).await, Err(StoreError::Expired(_))));
        assert!(matches!(store.append(gone, 0, records(0, 1), None).await, Err(StoreError::Expired(_))));
        assert!(matches!(store.fork(gone, session(None), None).await, Err(StoreError::Expired(_))));
        assert!(matches!(store.delete(gone, 0).await, Err(StoreError::Expired(_))));
    }
    for stays in [moved_since.id, copy.id, fresh.id] {
        store.find(stays).await.unwrap();
    }
    assert_eq!(store.history(copy.id, 0, 10).await.unwrap().len(), 1);
    assert!(matches!(store.find(deleted.id).await, Err(StoreError::NotFound)));
    let listed = store.list(None, None, Page::oldest(None, 1_000)).await.unwrap();
    assert!(listed.iter().all(|found| found.id != idle.id && found.id != moved_then.id));
}

pub async fn receipts_in_their_time_survive_a_sweep(store: &dyn Store) {
    let (session, _) = stored(store, 0).await;
    store.append(session.id, 0, records(0, 1), Some(receipt("young", None, 1))).await.unwrap();
    store.purge_expired(None).await.unwrap();
    assert!(store.receipt("young").await.unwrap().is_some());
}
