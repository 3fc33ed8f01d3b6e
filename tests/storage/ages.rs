//! What is kept for a time and is gone after it, in a file and in a database.

use std::time::Duration;

use futures::future::join_all;
use jiff::{SignedDuration, Timestamp};
use stickslip::sessions;
use stickslip::store::{ChunkResult, Job, Session, StoreError};
use uuid::Uuid;

use crate::common::place::Place;
use crate::common::postgres::Cluster;
use crate::common::process::Process;
use crate::common::until;
use crate::fixtures::{JOB_LIMITS, LEASE, job, receipt, records, session};

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

/// The clock is ahead at the start, if it was right at the last write.
#[tokio::test]
async fn a_clock_that_is_ahead_deletes_nothing() {
    let (place, then) = (Place::file(), Timestamp::now() - SignedDuration::from_hours(24 * 365));
    let old = Session { created_at: then, updated_at: then, ..session(None) };
    let store = place.open().await;
    store.create(old.clone(), Some(receipt("key", None, 1))).await.unwrap();
    let job = Job { created_at: then, ..job("") };
    store.create_job(job.clone(), "{}".to_owned(), JOB_LIMITS, None).await.unwrap();
    drop(store);
    place.age("receipts", "at", 24 * 365, "key = 'key'").await;
    let file = std::fs::File::options().write(true).open(place.path().unwrap()).unwrap();
    file.set_modified(then.into()).unwrap();
    let store = place.open().await;
    let purged = tokio::spawn(sessions::run_expiry_loop(store.clone(), Some(Duration::from_secs(1))));
    for _ in 0..5 {
        tokio::time::sleep(Duration::from_millis(100)).await;
        store.find(old.id).await.unwrap();
    }
    purged.abort();
    store.purge_expired(None).await.unwrap();
    store.job(job.id).await.unwrap();
    assert!(store.receipt("key").await.unwrap().is_some());
    assert!(matches!(store.keep(receipt("key", None, 0)).await, Err(StoreError::KeyTaken)));
}

/// The clock of this process, by which contacts are made, is ahead of that of the database.
#[tokio::test]
async fn the_time_is_that_of_the_database_and_nothing_expires_at_the_start() {
    let place = Place::Database(Cluster::shared().database().await);
    let (store, idle) = (place.open().await, session(None));
    let here = store.now().await.unwrap().duration_since(Timestamp::now());
    assert!(here.abs() < SignedDuration::from_mins(5), "{here}");
    let old = idle.updated_at - SignedDuration::from_hours(9);
    store.create(Session { updated_at: old, ..idle.clone() }, None).await.unwrap();
    let purges = tokio::spawn(sessions::run_expiry_loop(store.clone(), Some(Duration::from_secs(60 * 60))));
    tokio::time::sleep(Duration::from_millis(500)).await;
    store.find(idle.id).await.unwrap();
    purges.abort();
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

#[tokio::test]
async fn a_server_removes_results_after_a_day_and_jobs_that_do_not_end_after_a_week() {
    for place in Place::both().await {
        let store = place.open().await;
        let mut kept = Vec::new();
        for (is_done, hours, is_kept) in
            [(true, 25, false), (true, 23, true), (false, 24 * 7 + 1, false), (false, 24 * 7 - 1, true)]
        {
            let job = Job { points: 1, ..job("") };
            store.create_job(job.clone(), "{}".to_owned(), JOB_LIMITS, None).await.unwrap();
            if is_done {
                let claim = store.claim(Uuid::now_v7(), None, LEASE).await.unwrap().unwrap();
                store.save_chunk(claim, ChunkResult { points: 1, failed: 0, content: vec![7] }).await.unwrap();
            }
            let column = if is_done { "finished_at" } else { "created_at" };
            place.age("jobs", column, hours, &format!("id = '{}'", job.id)).await;
            kept.extend(is_kept.then_some(job.id));
        }
        drop(store);
        // Nothing is deleted in the first period, which is short then.
        let server = Process::with(&place.url(), &["--expire-after", "1s"]);
        let left = async || server.client.jobs(None).await.unwrap().items.iter().map(|job| job.id).collect::<Vec<_>>();
        until("the others are gone", async || (left().await == kept).then_some(())).await;
        let results = "SELECT count(*) FROM job_chunks WHERE content = ";
        let content = if place.path().is_some() { "x'07'" } else { "'\\x07'" };
        assert_eq!(place.number(&format!("{results}{content}")).await, 1);
    }
}
