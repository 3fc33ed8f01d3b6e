//! What is kept for a time and is gone after it, in a file and in a database.

use futures::future::join_all;
use jiff::Timestamp;
use stickslip::store::{Session, StoreError};

use crate::common::place::Place;
use crate::fixtures::{receipt, records, session};

#[tokio::test]
async fn a_key_may_be_used_again_after_a_day() {
    for place in Place::both().await {
        let (store, made) = (place.open().await, session(None));
        let column = if place.path().is_some() { "at" } else { "created_at" };
        let age = async |hours| place.age("receipts", column, hours, "key = 'key'").await;
        let key = || Some(receipt("key", None, 1));
        store.create(made.clone(), key()).await.unwrap();
        age(23).await;
        let refused = store.append(made.id, 0, records(0, 1), key()).await;
        assert!(matches!(refused, Err(StoreError::KeyTaken)), "{refused:?}");
        age(2).await;
        assert_eq!(store.receipt("key").await.unwrap(), None);
        // Past its time a key names another request, swept or not.
        store.append(made.id, 0, records(0, 1), key()).await.unwrap();
        age(25).await;
        store.fork(made.id, Session { sequence: 1, ..session(None) }, key()).await.unwrap();
        age(25).await;
        store.keep(receipt("young", None, 0)).await.unwrap();
        store.purge_expired(None).await.unwrap();
        // Without the key by which a database is asked whether it takes changes.
        assert_eq!(place.number("SELECT count(*) FROM receipts WHERE key <> ''").await, 1);
        assert!(store.receipt("young").await.unwrap().is_some());
    }
}

#[tokio::test]
async fn a_contact_that_expired_a_month_ago_leaves_nothing() {
    for place in Place::both().await {
        let store = place.open().await;
        // More than are removed at a time.
        let idle: Vec<Session> = (0..2_500).map(|_| session(None)).collect();
        join_all(idle.iter().map(|idle| store.create(idle.clone(), None))).await;
        assert_eq!(store.purge_expired(Some(Timestamp::now())).await.unwrap(), 2_500);
        let (old, young) = (idle[7].id, idle[0].id);
        for (days, is_kept) in [(29, true), (2, false)] {
            place.age("expired", "at", 24 * days, &format!("id <> '{young}'")).await;
            store.purge_expired(None).await.unwrap();
            match store.find(old).await {
                Err(StoreError::Expired(_)) => assert!(is_kept),
                Err(StoreError::NotFound) => assert!(!is_kept),
                other => panic!("{other:?}"),
            }
        }
        assert!(matches!(store.find(young).await, Err(StoreError::Expired(_))));
        assert_eq!(place.number("SELECT count(*) FROM expired").await, 1);
    }
}
