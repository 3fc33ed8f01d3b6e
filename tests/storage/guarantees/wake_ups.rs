//! Waiting for changes.

use jiff::{SignedDuration, Timestamp};
use stickslip::store::{Session, Store};

use crate::fixtures::{records, session, soon, stored};

pub async fn a_waiting_listener_is_woken_by_a_change(store: &dyn Store) {
    let (moved, _) = stored(store, 0).await;
    let mut waits = store.changes().subscribe(moved.id);
    store.append(moved.id, 0, records(0, 1), None).await.unwrap();
    soon(waits.changed()).await.unwrap();
    // The change that woke the listener can be read by then.
    assert_eq!(store.find(moved.id).await.unwrap().sequence, 1);
    waits.mark_unchanged();
    store.delete(moved.id, 1).await.unwrap();
    soon(waits.changed()).await.unwrap();

    let long_ago = Timestamp::now() - SignedDuration::from_hours(5);
    let idle = Session { created_at: long_ago, updated_at: long_ago, ..session(None) };
    store.create(idle.clone(), None).await.unwrap();
    let mut waits = store.changes().subscribe(idle.id);
    assert!(store.purge_expired(Some(long_ago + SignedDuration::from_hours(1))).await.unwrap() >= 1);
    soon(waits.changed()).await.unwrap();
}
