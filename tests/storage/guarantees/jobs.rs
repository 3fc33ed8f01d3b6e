//! Jobs: chunks are given and heard once, and what a tenant may have is bounded.

use std::collections::BTreeSet;

use stickslip::store::{ChunkResult, Claim, Job, JobLimits, Store, StoreError};
use uuid::Uuid;

use crate::fixtures::{LEASE, job, receipt};

const LIMITS: JobLimits = JobLimits { jobs: 3, bytes: 1_000, cost: 1_000 };

async fn create(store: &dyn Store, job: &Job) -> Result<(), StoreError> {
    store.create_job(job.clone(), format!("request of {}", job.id), LIMITS, None).await
}

pub async fn each_chunk_is_given_once_and_heard_once(store: &dyn Store) {
    let owner = Uuid::now_v7();
    let (first, second) = (job("lab"), job(""));
    for job in [&first, &second] {
        create(store, job).await.unwrap();
        assert_eq!(store.job(job.id).await.unwrap(), *job);
        assert_eq!(store.job_request(job.id).await.unwrap(), format!("request of {}", job.id));
    }
    // In turns, and each once.
    let (mut claims, mut last) = (Vec::new(), None);
    while let Some(claim) = store.claim(owner, last, LEASE).await.unwrap() {
        last = Some(claim.job);
        claims.push(claim);
    }
    let jobs: Vec<Uuid> = claims.iter().map(|claim| claim.job).collect();
    assert_eq!(jobs, [first.id, second.id, first.id, second.id, first.id, second.id]);
    assert_eq!(claims.iter().map(|claim| (claim.job, claim.chunk)).collect::<BTreeSet<_>>().len(), 6);
    // A released chunk is claimed again.
    assert!(store.renew(claims[0], LEASE).await.unwrap());
    store.release(claims[0]).await.unwrap();
    assert!(!store.renew(claims[0], LEASE).await.unwrap());
    assert_eq!(store.claim(owner, None, LEASE).await.unwrap(), Some(claims[0]));
    // The first result of a chunk counts.
    let content = |claim: Claim| vec![claim.chunk as u8; 10];
    for claim in claims.iter().rev().filter(|claim| claim.job == first.id) {
        let points = if claim.chunk == 2 { 1 } else { 3 };
        let result = ChunkResult { points, failed: 1, content: content(*claim) };
        store.save_chunk(*claim, result.clone()).await.unwrap();
        if claim.chunk > 0 {
            store.save_chunk(*claim, ChunkResult { content: vec![9], ..result }).await.unwrap();
            assert_eq!(store.job(first.id).await.unwrap().finished_at, None);
        }
    }
    let done = store.job(first.id).await.unwrap();
    assert_eq!((done.done, done.failed, done.error), (7, 3, None));
    assert!(done.finished_at.unwrap() >= first.created_at);
    let all: Vec<Vec<u8>> = (0..3).map(|chunk| vec![chunk; 10]).collect();
    assert_eq!(store.chunks(first.id, 0, 10).await.unwrap(), all);
    assert_eq!(store.chunks(first.id, 1, 1).await.unwrap(), all[1..2]);
    // Chunks of a failed or a deleted job are not claimed.
    store.fail_job(second.id, "no use".to_owned()).await.unwrap();
    let failed = store.job(second.id).await.unwrap();
    assert!(failed.finished_at.is_some() && failed.error.as_deref() == Some("no use"));
    assert!(!store.renew(claims[1], LEASE).await.unwrap());
    store.release(claims[1]).await.unwrap();
    assert_eq!(store.claim(owner, None, LEASE).await.unwrap(), None);
    store.purge_expired(None).await.unwrap();
    for id in [first.id, second.id] {
        store.delete_job(id).await.unwrap();
        assert!(matches!(store.job(id).await, Err(StoreError::NotFound)));
        assert!(matches!(store.delete_job(id).await, Err(StoreError::NotFound)));
    }
    let late = ChunkResult { points: 3, failed: 0, content: Vec::new() };
    assert!(matches!(store.save_chunk(claims[1], late).await, Err(StoreError::NotFound)));
}

pub async fn a_taken_key_or_a_full_tenant_takes_no_job(store: &dyn Store) {
    let refused = |result: Result<(), StoreError>| matches!(result, Err(StoreError::TooManyJobs(_)));
    assert!(refused(create(store, &Job { bytes: 1_001, ..job("lab") }).await));
    assert!(refused(create(store, &Job { cost: 1_001, ..job("lab") }).await));
    let keyed = job("lab");
    let owed = receipt("sweep", Some(keyed.id), 0);
    store.create_job(keyed.clone(), String::new(), LIMITS, Some(owed.clone())).await.unwrap();
    assert_eq!(store.receipt("sweep").await.unwrap(), Some(owed));
    let again = job("lab");
    let twin = store.create_job(again.clone(), String::new(), LIMITS, Some(receipt("sweep", Some(again.id), 0))).await;
    assert!(matches!(twin, Err(StoreError::KeyTaken)), "{twin:?}");
    assert!(matches!(store.job(again.id).await, Err(StoreError::NotFound)));
    // The work of a job counts until it has ended, its place until it is deleted.
    create(store, &Job { cost: 900, ..job("lab") }).await.unwrap();
    assert!(refused(create(store, &job("lab")).await));
    store.fail_job(keyed.id, String::new()).await.unwrap();
    create(store, &job("lab")).await.unwrap();
    assert!(refused(create(store, &Job { cost: 0, ..job("lab") }).await));
    create(store, &job("other")).await.unwrap();
    store.delete_job(keyed.id).await.unwrap();
    create(store, &Job { cost: 0, ..job("lab") }).await.unwrap();
}
