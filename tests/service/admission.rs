//! Admission: turns on threads, permits for places and memory, quotas, work that is ended, and the estimate that
//! decides where work runs.

use std::net::{IpAddr, Ipv4Addr, Ipv6Addr};
use std::pin::pin;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, mpsc};
use std::time::Duration;

use futures::future::join_all;
use stickslip::admission::{
    Capacity, Client, Deadline, INLINE, Kind, Pool, PoolError, Quota, QuotaLimits, Reservation, Stage,
};
use stickslip_compute::simulation::Worker as _;
use stickslip_compute::simulation::cost::Work;
use stickslip_compute::{Interrupted, LONGEST_WORK, Nanoseconds, Stop as _};
use stickslip_mechanics::profile::Cone;
use stickslip_mechanics::{Profile, Sphere};
use tokio::sync::Mutex as AsyncMutex;
use tokio::task::JoinHandle;
use tokio::time::sleep;

use crate::common::{PATIENCE, until};

/// Bytes are reserved in units of this size.
const UNIT: usize = 1024;

fn small() -> Pool {
    let wait = Duration::from_millis(20);
    Pool::new(Capacity { requests: 2, queue: 1, wait, bytes: 200 * UNIT, ..Capacity::default() })
}

#[tokio::test]
async fn requests_beyond_the_capacity_wait_and_are_refused() {
    let pool = small();
    let places = (pool.admit_request().await.unwrap(), pool.admit_request().await.unwrap());
    let (second, third) = tokio::join!(pool.admit_request(), pool.admit_request());
    assert_eq!((second.unwrap_err(), third.unwrap_err()), (PoolError::Busy, PoolError::QueueFull));
    drop(places);
    assert!(pool.admit_request().await.is_ok());
    assert_eq!((pool.taken().requests, pool.taken().waiting), (0, 0));
}

#[tokio::test]
async fn bytes_are_reserved_once() {
    let pool = small();
    let mut first = pool.reserve(80 * UNIT).await.unwrap();
    let second = pool.reserve(90 * UNIT).await.unwrap();
    // The reserve is as large as all that there is, and for one at a time.
    let turn = pool.reserve(60 * UNIT).await.unwrap();
    assert_eq!(pool.reserve(60 * UNIT).await.unwrap_err(), PoolError::Busy);
    pool.resize(&mut first, 30 * UNIT).await.unwrap();
    assert_eq!(pool.taken().bytes, 180 * UNIT);
    let third = pool.reserve(60 * UNIT).await.unwrap();
    assert_eq!(pool.resize(&mut first, 60 * UNIT).await.unwrap_err(), PoolError::Busy);
    assert_eq!(pool.taken().bytes, 240 * UNIT);
    drop(turn);
    // Whoever has the turn finds all that it asks for.
    pool.resize(&mut first, 60 * UNIT).await.unwrap();
    pool.resize(&mut first, 1_000 * UNIT).await.unwrap();
    assert_eq!(pool.taken().bytes, 350 * UNIT);
    // It gives up the turn as soon as there is as much beside it.
    drop((second, third));
    pool.resize(&mut first, 150 * UNIT).await.unwrap();
    let other = pool.reserve(200 * UNIT).await.unwrap();
    assert_eq!(pool.taken().bytes, 350 * UNIT);
    drop((first, other));
    assert_eq!(pool.taken().bytes, 0);
}

#[tokio::test]
async fn small_needs_do_not_wait_behind_large_ones() {
    let pool = Pool::new(Capacity { bytes: 200 * UNIT, ..Capacity::default() });
    let small = 20 * UNIT;
    let first = pool.reserve(150 * UNIT).await.unwrap();
    let turn = pool.reserve(100 * UNIT).await.unwrap();
    let mut large = pin!(pool.reserve(100 * UNIT));
    assert!(futures::poll!(large.as_mut()).is_pending());
    let mut beside = pool.reserve(small).await.unwrap();
    // They have a share, and no more.
    let mut next = pin!(pool.reserve(small));
    assert!(futures::poll!(next.as_mut()).is_pending());
    assert!(pool.taken().bytes <= pool.capacity().reservable_bytes());
    pool.resize(&mut beside, 0).await.unwrap();
    let next = next.await.unwrap();
    drop((first, turn));
    let large = large.await.unwrap();
    assert_eq!(pool.taken().bytes, 120 * UNIT);
    // What is reserved in both ways is one.
    let mut both = next;
    both.add(pool.try_reserve(30 * UNIT).unwrap());
    pool.resize(&mut both, 25 * UNIT).await.unwrap();
    assert_eq!(pool.taken().bytes, 125 * UNIT);
    drop((both, large));
    assert_eq!(pool.taken().bytes, 0);
}

/// What a request does one after the other: its body arrives and doubles, it gets its permit, is parsed, asks for what
/// its work takes, locks its contact, and loads it.
async fn request(pool: &Pool, locks: &[AsyncMutex<()>], number: usize) -> Result<(), PoolError> {
    let need = |stage: usize| UNIT * (20 + (number * 37 + stage * 53) % 180);
    let pause = async || sleep(Duration::from_millis(1)).await;
    let mut memory = Reservation::default();
    for bytes in [need(0) / 4, need(0) / 2, need(0)] {
        pool.resize_in(Stage::Body, &mut memory, bytes).await?;
        pause().await;
    }
    let _permit = pool.admit_request().await?;
    for stage in 1..4 {
        pool.resize(&mut memory, need(stage)).await?;
        pause().await;
    }
    let _lock = pool.wait(locks[number % locks.len()].lock()).await?;
    let _state = pool.reserve_states(need(4)).await?;
    pause().await;
    assert!(pool.taken().bytes <= pool.capacity().reservable_bytes());
    Ok(())
}

/// Were some of them to wait for each other, they would wait until they are refused.
#[tokio::test]
async fn requests_never_wait_for_each_other_in_a_circle() {
    for requests in [1, 2, 3, 50] {
        let pool = Pool::new(Capacity { requests, bytes: 200 * UNIT, wait: PATIENCE, ..Capacity::default() });
        let locks = [const { AsyncMutex::const_new(()) }; 3];
        let all = join_all((0..80).map(|number| request(&pool, &locks, number))).await;
        assert_eq!(all.iter().filter(|done| done.is_err()).count(), 0, "{requests} at a time");
        assert_eq!((pool.taken().bytes, pool.taken().waiting), (0, 0));
    }
}

#[test]
fn work_ends_with_the_guard() {
    let (stop, guard) = Deadline::within(LONGEST_WORK, Duration::ZERO);
    assert_eq!(stop.check(), Ok(()));
    drop(guard);
    assert_eq!(stop.check(), Err(Interrupted::Abandoned));
}

#[test]
fn the_time_limit_runs_from_the_first_check() {
    let allowed = Duration::from_millis(20);
    let (stop, _guard) = Deadline::within(allowed, Duration::ZERO);
    std::thread::sleep(2 * allowed);
    assert_eq!(stop.check(), Ok(()));
    std::thread::sleep(2 * allowed);
    assert_eq!(stop.check(), Err(Interrupted::TimeLimit(allowed)));
}

fn client(number: u8) -> Client {
    Client::of_address(Ipv4Addr::new(192, 0, 2, number).into())
}

/// Work that checks its flag again and again until it is told to end, and fails if nobody does.
fn patient(ended: &Arc<AtomicBool>) -> impl Fn() -> bool + Clone + Send + Sync + 'static {
    let ended = Arc::clone(ended);
    move || {
        let (stop, _guard) = Deadline::within(Duration::from_secs(20), Duration::ZERO);
        while !ended.load(Ordering::Relaxed) {
            if stop.check().is_err() {
                return false;
            }
            std::thread::sleep(Duration::from_millis(1));
        }
        true
    }
}

#[tokio::test]
async fn long_work_of_some_yields_to_short_work_of_others_on_a_single_thread() {
    const LONG: Nanoseconds = 100_000_000_000;
    let pool = Pool::new(Capacity { threads: 1, ..Capacity::default() });
    let ended = Arc::default();
    let job = {
        let (pool, work) = (pool.clone(), patient(&ended));
        client(1).serve(async move {
            pool.share(Kind::Job, move |turns| turns.into_iter().all(|turn| turn.work(&work))).await
        })
    };
    let mut heavy = vec![tokio::spawn(job)];
    for number in 2..6 {
        let (pool, work) = (pool.clone(), patient(&ended));
        heavy.push(tokio::spawn(client(number).serve(async move { pool.run(LONG, work).await })));
    }
    // All of them have begun, on one thread.
    until("none keeps it to itself", async || (pool.meters().running.get() == 5).then_some(())).await;
    for _ in 0..10 {
        assert_eq!(client(9).serve(pool.run(2 * INLINE, || 7)).await, Ok(7));
        assert!(pool.taken().threads <= 2, "one, and one beside it if its work does not check");
    }
    ended.store(true, Ordering::Relaxed);
    for work in heavy {
        assert_eq!(work.await.unwrap(), Ok(true));
    }
    assert_eq!((pool.taken().threads, pool.meters().waiting.get()), (0, 0));
}

/// Work is asked for one after the other, and says its name when it is its turn.
#[derive(Clone, Default)]
struct Order(Arc<Mutex<Vec<&'static str>>>);

impl Order {
    /// Asks for work that takes some time, and waits until it is in the queue.
    async fn ask(&self, pool: &Pool, who: u8, cost: Nanoseconds, name: &'static str, time: Duration) -> Asked {
        let (said, queued) = (self.clone(), pool.meters().waiting.get() + 1);
        let work = move || {
            said.0.lock().unwrap().push(name);
            std::thread::sleep(time);
        };
        let asked = client(who).serve({
            let pool = pool.clone();
            async move { pool.run(cost, work).await }
        });
        let asked = tokio::spawn(asked);
        // Or has had its turn already, where this machine is slow.
        let is_queued = || pool.meters().waiting.get() >= queued || self.0.lock().unwrap().contains(&name);
        until("it waits for the only thread", async || is_queued().then_some(())).await;
        asked
    }

    /// The order in which all of it was done.
    async fn done(self, all: Vec<Asked>) -> Vec<&'static str> {
        for asked in all {
            asked.await.unwrap().unwrap();
        }
        std::mem::take(&mut *self.0.lock().unwrap())
    }
}

type Asked = JoinHandle<Result<(), PoolError>>;

/// Takes the only thread of a pool until the sender is used, and a little longer.
async fn occupy(pool: &Pool, who: u8, cost: Nanoseconds, longer: Duration) -> (mpsc::Sender<()>, Asked) {
    let (release, held) = mpsc::channel();
    let busy = pool.clone();
    let work = move || {
        held.recv().unwrap();
        std::thread::sleep(longer);
    };
    let asked = tokio::spawn(client(who).serve(async move { busy.run(cost, work).await }));
    until("it has the thread", async || (pool.meters().running.get() == 1).then_some(())).await;
    (release, asked)
}

#[tokio::test]
async fn a_client_that_has_had_the_thread_waits_for_one_that_came_later() {
    const LONG: Nanoseconds = 100_000_000_000;
    let pool = Pool::new(Capacity { threads: 1, ..Capacity::default() });
    let (release, first) = occupy(&pool, 1, LONG, Duration::from_millis(5)).await;
    let (order, none) = (Order::default(), Duration::ZERO);
    let mut all = vec![first];
    for (who, name) in [(1, "one"), (1, "one again"), (2, "two")] {
        all.push(order.ask(&pool, who, LONG, name, none).await);
    }
    release.send(()).unwrap();
    assert_eq!(order.done(all).await, ["two", "one", "one again"]);
}

#[tokio::test]
async fn interactive_work_may_take_more_time_than_long_work_before_it_waits() {
    const LONG: Nanoseconds = 100_000_000_000;
    let pool = Pool::new(Capacity { threads: 1, ..Capacity::default() });
    let (release, first) = occupy(&pool, 1, LONG, Duration::from_millis(10)).await;
    let (order, none) = (Order::default(), Duration::ZERO);
    // It has taken three times what the long work has, which counts eight times.
    let mut all = vec![first, order.ask(&pool, 1, LONG, "long", none).await];
    for (name, time) in [("short", Duration::from_millis(30)), ("short again", none)] {
        all.push(order.ask(&pool, 2, 2 * INLINE, name, time).await);
    }
    release.send(()).unwrap();
    assert_eq!(order.done(all).await, ["short", "short again", "long"]);
}

#[tokio::test]
async fn jobs_leave_the_last_thread() {
    let pool = Pool::new(Capacity { threads: 3, ..Capacity::default() });
    assert_eq!(pool.share(Kind::Job, |turns| turns.len()).await, Ok(2));
    assert_eq!(pool.share(Kind::Interactive, |turns| turns.len()).await, Ok(3));
}

#[tokio::test]
async fn a_quota_of_one_client_takes_nothing_from_others() {
    let quotas = QuotaLimits { streams: 2, ..QuotaLimits::default() };
    let pool = Pool::new(Capacity { quotas, ..Capacity::default() });
    let take = |client: &Client| client.within(|| pool.share_of(Quota::Streams));
    let mine = (take(&client(1)).unwrap(), take(&client(1)).unwrap());
    assert!(matches!(take(&client(1)), Err(PoolError::Quota(why)) if why.quota == Quota::Streams && why.limit == 2));
    assert!(take(&client(2)).is_ok());
    drop(mine);
    assert!(take(&client(1)).is_ok());
    // One client owns all addresses of an IPv6 network.
    let address = |last| Client::of_address(IpAddr::V6(Ipv6Addr::new(0x2001, 0xdb8, 0, 0, 0, 0, 0, last)));
    assert_eq!(address(1), address(2));
}

#[test]
fn a_move_runs_inline_and_a_long_path_does_not() {
    let (sphere, cone) = (Sphere::new(0.01).map(Profile::Sphere), Cone::new(0.1).map(Profile::Cone));
    for profile in [sphere.unwrap(), cone.unwrap()] {
        let cost = |work: Work| work.cost(&profile);
        assert!(cost(Work { moves: 1, depth: 1_000, ..Work::default() }) < INLINE);
        assert!(cost(Work { moves: 1_000, ..Work::default() }) > INLINE);
        assert!(cost(Work { moves: 1, curved: 1, ..Work::default() }) > INLINE);
        assert!(cost(Work { depth: 1_000, radii: 200, ..Work::default() }) > INLINE);
        let most = usize::MAX / 4_000;
        assert!(cost(Work { moves: most, radii: most, residual: true, ..Work::default() }) > INLINE);
    }
}
