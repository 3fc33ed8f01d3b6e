//! Clients that hang up at any moment of a change: what follows from its commit is done all the same. Every request is
//! dropped after each number of awaits, over a store that yields before each change and between its commit and its
//! answer.

use crate::common;
use crate::fixtures::{JOB_LIMITS, job};

use std::future::poll_fn;
use std::pin::pin;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::task::Poll;
use std::time::Duration;

use async_trait::async_trait;
use common::kill::exact;
use common::place::Place;
use common::{ball, create, until};
use jiff::Timestamp;
use serde_json::json;
use stickslip::admission::{Capacity, Pool, QuotaLimits};
use stickslip::jobs::{JobError, Jobs, LEASE};
use stickslip::sessions::{CAPACITY, SessionError, Sessions};
use stickslip::store::{
    Changes, ChunkResult, Claim, Commits, Extent, IsSmall, Job, JobLimits, JobStore, LabelChange, Page, Receipt,
    Record, Reply, RequestKey, Session, Snapshot, SqliteStore, Store, StoreError, Tenant, Usage, Whole,
};
use stickslip_compute::simulation::Sweep;
use stickslip_wire::{
    Document as _, ForkRequest, JobState, Move, MoveRequest, PrepareAnew, SessionSummary, SweepRequest,
};
use tokio::task::yield_now;
use uuid::Uuid;

type Stored<T = ()> = Result<T, StoreError>;
type Past = (u64, Option<Timestamp>);

/// A store that yields around each change.
struct Yielding {
    inner: Arc<dyn Store>,
    /// Whether it refuses to count what a tenant has stored.
    uncountable: AtomicBool,
}

/// A change, with awaits before it is sent and between its commit and its answer.
async fn around<T>(change: impl Future<Output = T>) -> T {
    yield_now().await;
    let answer = change.await;
    yield_now().await;
    yield_now().await;
    answer
}

/// Passes the calls of a trait on; the changes among them with awaits around.
macro_rules! passed_on {
    ($of:ident { $($how:ident $name:ident($($given:ident: $kind:ty),*) -> $answer:ty;)* } $($rest:tt)*) => {
        #[async_trait]
        impl $of for Yielding {
            $(async fn $name(&self, $($given: $kind),*) -> Stored<$answer> {
                passed_on!($how self.inner.$name($($given),*))
            })*
            $($rest)*
        }
    };
    (change $call:expr) => { around($call).await };
    (read $call:expr) => { $call.await };
}

passed_on! {
    Store {
        read ready() -> ();
        change create(session: Session, receipt: Option<Receipt>) -> ();
        read extent(id: Uuid) -> Extent;
        read load(id: Uuid, is_small: IsSmall) -> (Extent, Option<Whole>);
        read find(id: Uuid) -> Session;
        read list(tenant: Option<Tenant>, label: Option<String>, page: Page) -> Vec<SessionSummary>;
        change rename(id: Uuid, label: LabelChange, at: u64, receipt: Option<Receipt>) -> ();
        change append_after(id: Uuid, past: Past, records: Vec<Record>, receipt: Option<Receipt>) -> ();
        read history(id: Uuid, after: u64, limit: usize) -> Vec<Record>;
        read count_moves(id: Uuid, end: u64) -> u64;
        change fork(id: Uuid, copy: Session, receipt: Option<Receipt>) -> ();
        change delete(id: Uuid, expected: u64) -> ();
        change keep(receipt: Receipt) -> ();
        read receipt(key: &str) -> Option<Receipt>;
        read snapshot(id: Uuid) -> Option<Snapshot>;
        change save_snapshot(id: Uuid, snapshot: Snapshot, unreadable: Option<u64>) -> ();
        read check_integrity() -> Vec<String>;
        read purge_expired(idle_since: Option<Timestamp>) -> u64;
    }
    async fn usage(&self, tenant: &Tenant) -> Stored<Usage> {
        if self.uncountable.load(Ordering::SeqCst) {
            return Err(StoreError::Unavailable("it does not count".to_owned()));
        }
        self.inner.usage(tenant).await
    }
    fn move_bytes(&self) -> u64 {
        self.inner.move_bytes()
    }
    fn changes(&self) -> &Changes {
        self.inner.changes()
    }
    fn commits(&self) -> &Commits {
        self.inner.commits()
    }
}

passed_on! {
    JobStore {
        change create_job(job: Job, request: String, limits: JobLimits, receipt: Option<Receipt>) -> ();
        read job(id: Uuid) -> Job;
        read jobs(tenant: Tenant) -> Vec<Job>;
        read job_request(id: Uuid) -> String;
        read claim(owner: Uuid, after: Option<Uuid>, lease: Duration) -> Option<Claim>;
        read renew(claim: Claim, lease: Duration) -> bool;
        read release(claim: Claim) -> ();
        change save_chunk(claim: Claim, result: ChunkResult) -> ();
        change fail_job(id: Uuid, error: String) -> ();
        read chunks(id: Uuid, first: u64, limit: usize) -> Vec<Vec<u8>>;
        change delete_job(id: Uuid) -> ();
    }
}

/// The answer to a request, unless it is still pending after so many awaits: then it is dropped.
async fn dropped_after<T>(awaits: usize, request: impl Future<Output = T>) -> Option<T> {
    let (mut request, mut left) = (pin!(request), awaits);
    poll_fn(|context| match request.as_mut().poll(context) {
        Poll::Ready(answer) => Poll::Ready(Some(answer)),
        Poll::Pending if left == 0 => Poll::Ready(None),
        Poll::Pending => {
            left -= 1;
            Poll::Pending
        }
    })
    .await
}

/// Long enough for most changes under way to end. Nothing depends on it: a check that comes too early finds no fault.
async fn pause() {
    tokio::time::sleep(Duration::from_millis(5)).await;
}

fn keyed(key: String) -> Option<RequestKey> {
    Some(RequestKey { key, fingerprint: [7; 32] })
}

async fn count(store: &dyn Store) -> usize {
    store.list(None, None, Page::oldest(None, 10_000)).await.unwrap().len()
}

fn is_gone<T>(found: &Stored<T>) -> bool {
    matches!(found, Err(StoreError::NotFound))
}

/// Whatever a client hangs up in, its retry gets the reply to the one change that was made, and the cached state is the
/// stored one.
async fn keys_replay_and_the_cache_is_true(store: Arc<Yielding>) {
    let pool = Pool::with_defaults();
    let fresh = || Sessions::new(store.clone(), pool.clone(), CAPACITY);
    let (sessions, mut made) = (fresh(), count(&*store).await);
    let new = || create().check().unwrap();
    let contact = sessions.create(new(), None).await.unwrap().created.unwrap();
    made += 1;
    for awaits in 0.. {
        let key = |what: &str| keyed(format!("{what}-{awaits}"));
        let step = |to: f64| MoveRequest::from(Move::displacement(to * 1e-9)).check().unwrap();
        let label = Some(format!("label {awaits}"));
        let fork = || ForkRequest { label: Some("fork".to_owned()), sequence: None };
        // Reads do not wait for what dropped requests have begun.
        let at = sessions.friction(contact).await.unwrap().sequence;

        let firsts: [Option<Result<Reply, SessionError>>; 4] = [
            dropped_after(awaits, sessions.create(new(), key("create"))).await,
            dropped_after(awaits, sessions.apply(contact, step(1.0 + awaits as f64), None, key("move"))).await,
            dropped_after(awaits, sessions.fork(contact, fork(), key("fork"))).await,
            dropped_after(awaits, sessions.rename(contact, label.clone(), None, key("rename"))).await,
        ];
        let again = [
            sessions.create(new(), key("create")).await.unwrap(),
            sessions.apply(contact, step(1.0 + awaits as f64), None, key("move")).await.unwrap(),
            sessions.fork(contact, fork(), key("fork")).await.unwrap(),
            sessions.rename(contact, label.clone(), None, key("rename")).await.unwrap(),
        ];
        let mut all = true;
        for (first, again) in firsts.into_iter().zip(&again) {
            match first {
                Some(first) => assert_eq!(first.unwrap(), *again),
                None => all = false,
            }
        }
        made += 2;
        assert_eq!(count(&*store).await, made, "after {awaits} awaits");
        let now = sessions.get(contact).await.unwrap();
        assert_eq!((now.sequence, &now.label), (at + 1, &label), "after {awaits} awaits");

        // Without a key it is made or not; what is shown is what is stored.
        let first = dropped_after(awaits, sessions.apply(contact, step(-1.0 - awaits as f64), None, None)).await;
        all &= first.is_some();
        sessions.friction(contact).await.unwrap();
        let now = sessions.get(contact).await.unwrap();
        assert!((at + 1..=at + 2).contains(&now.sequence));
        assert_eq!(exact(&now), exact(&fresh().get(contact).await.unwrap()));
        if all {
            println!("dropped after 0 to {awaits} awaits");
            break;
        }
    }
}

/// A deleted contact is not cached, whether its client has waited for the reply or not.
async fn what_is_deleted_is_not_cached(store: Arc<Yielding>) {
    for awaits in 0.. {
        let sessions = Sessions::new(store.clone(), Pool::with_defaults(), CAPACITY);
        let id = sessions.create(create().check().unwrap(), None).await.unwrap().created.unwrap();
        assert_eq!(sessions.held().1, 1);
        let first = dropped_after(awaits, sessions.delete(id, None)).await;
        pause().await;
        if is_gone(&store.find(id).await) {
            until("the cache forgets it", async || (sessions.held() == (0, 0)).then_some(())).await;
        }
        if first.is_some() {
            break;
        }
    }
}

/// The quota counts what is stored: no more fits after clients have hung up in making contacts, and no less after they
/// have hung up in deleting some. The store counts once; from then on the server must know by itself.
async fn quotas_count_what_is_stored(store: Arc<Yielding>) {
    const MORE: usize = 40;
    let limit = count(&*store).await + MORE;
    let quotas = QuotaLimits { contacts: limit, ..QuotaLimits::default() };
    let pool = Pool::new(Capacity { quotas, ..Capacity::default() });
    let sessions = Sessions::new(store.clone(), pool, CAPACITY);
    let make = || sessions.create(create().check().unwrap(), None);
    let mut ids = vec![make().await.unwrap().created.unwrap()];
    store.uncountable.store(true, Ordering::SeqCst);
    let fill = async |ids: &mut Vec<Uuid>| {
        until("the quota is full", async || {
            while let Ok(reply) = make().await {
                ids.extend(reply.created);
            }
            let stored = count(&*store).await;
            assert!(stored <= limit, "{stored} contacts, {limit} are allowed");
            (stored == limit).then_some(())
        })
        .await;
    };
    for awaits in 0..MORE / 2 {
        if dropped_after(awaits, make()).await.is_some() {
            break;
        }
        pause().await;
    }
    fill(&mut ids).await;
    for awaits in 0..MORE / 2 {
        let Some(id) = ids.pop() else { break };
        if dropped_after(awaits, sessions.delete(id, None)).await.is_some() {
            break;
        }
        pause().await;
    }
    fill(&mut ids).await;
    store.uncountable.store(false, Ordering::SeqCst);
}

/// Whether a worker could claim a chunk.
async fn is_claimable(store: &dyn Store) -> bool {
    store.claim(Uuid::now_v7(), None, LEASE).await.unwrap().is_some()
}

/// A chunk is no longer claimed once its result is stored, its job has failed or is deleted; and a new job is claimed.
async fn claims_follow_what_is_stored(store: Arc<Yielding>) {
    let new_job = || Job { points: 2, chunk: 1, ..job("") };
    let result = ChunkResult { points: 1, failed: 0, content: vec![1] };
    for awaits in 0.. {
        let (new, mut all) = (new_job(), true);
        all &= dropped_after(awaits, store.create_job(new.clone(), String::new(), JOB_LIMITS, None)).await.is_some();
        pause().await;
        if is_gone(&store.job(new.id).await) {
            // Refused if the first is stored late.
            let _ = store.create_job(new.clone(), String::new(), JOB_LIMITS, None).await;
        }
        let claim =
            async || store.claim(Uuid::now_v7(), None, LEASE).await.unwrap().filter(|claim| claim.job == new.id);
        let claims = [until("it is claimed", claim).await, until("it is claimed", claim).await];
        assert!(!is_claimable(&*store).await);
        let let_go = async |claim: Claim| {
            until("it lets go", async || (!store.renew(claim, LEASE).await.unwrap()).then_some(())).await;
        };

        all &= dropped_after(awaits, store.save_chunk(claims[0], result.clone())).await.is_some();
        pause().await;
        if store.job(new.id).await.unwrap().done == 1 {
            let_go(claims[0]).await;
        }
        all &= dropped_after(awaits, store.fail_job(new.id, "no use".to_owned())).await.is_some();
        pause().await;
        if store.job(new.id).await.unwrap().finished_at.is_some() {
            let_go(claims[1]).await;
        }
        store.delete_job(new.id).await.unwrap();

        let deleted = new_job();
        store.create_job(deleted.clone(), String::new(), JOB_LIMITS, None).await.unwrap();
        let claim = store.claim(Uuid::now_v7(), None, LEASE).await.unwrap().unwrap();
        all &= dropped_after(awaits, store.delete_job(deleted.id)).await.is_some();
        pause().await;
        if is_gone(&store.job(deleted.id).await) {
            let_go(claim).await;
            until("none is left", async || (!is_claimable(&*store).await).then_some(())).await;
        } else {
            // Refused if the first has been made late.
            let _ = store.delete_job(deleted.id).await;
        }
        if all {
            break;
        }
    }
}

/// A sweep of two points that is a job.
fn sweep() -> Sweep {
    let request = json!({
        "base": {"contact": ball(), "path": {"displacement": [1e-7]}},
        "axes": [{"pointer": "/contact/friction", "values": [0.1, 0.2]}],
        "outputs": ["/steps/0/force"], "job": true
    });
    let request: SweepRequest = serde_json::from_value(request).unwrap();
    Sweep::plan(request.check().unwrap(), &PrepareAnew).unwrap()
}

/// Every stored job runs to its end, and a retry gets the job that is stored.
async fn stored_jobs_run_to_their_end(store: Arc<Yielding>) {
    let jobs = Jobs::new(store.clone(), Pool::with_defaults());
    let working = tokio::spawn(jobs.clone().work(LEASE));
    let (sweep, mut ids) = (sweep(), Vec::new());
    for awaits in 0.. {
        let start = || jobs.start(&sweep, keyed(format!("sweep-{awaits}")));
        let first: Option<Result<Reply, JobError>> = dropped_after(awaits, start()).await;
        let again = start().await.unwrap();
        ids.push(again.created.unwrap());
        if let Some(first) = first {
            assert_eq!(first.unwrap(), again);
            break;
        }
    }
    let listed = jobs.list(None).await.unwrap().items;
    assert_eq!(listed.iter().map(|job| job.id).collect::<Vec<_>>(), ids);
    for id in ids {
        let ended = async || Some(jobs.get(id).await.unwrap()).filter(|job| job.state != JobState::Running);
        assert_eq!(until("the job ends", ended).await.state, JobState::Done);
    }
    jobs.end();
    working.await.unwrap();
}

async fn all_of_it(store: Arc<dyn Store>) {
    let store = Arc::new(Yielding { inner: store, uncountable: AtomicBool::new(false) });
    keys_replay_and_the_cache_is_true(store.clone()).await;
    what_is_deleted_is_not_cached(store.clone()).await;
    quotas_count_what_is_stored(store.clone()).await;
    claims_follow_what_is_stored(store.clone()).await;
    stored_jobs_run_to_their_end(store).await;
}

#[tokio::test]
async fn no_step_after_a_commit_in_memory_needs_its_client() {
    all_of_it(Arc::new(SqliteStore::in_memory().unwrap())).await;
}

#[tokio::test]
async fn no_step_after_a_commit_in_a_file_or_a_database_needs_its_client() {
    for place in Place::both().await {
        all_of_it(place.open().await).await;
    }
}
