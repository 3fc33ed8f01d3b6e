//! Admission: turns on threads, permits for places and memory, quotas, work that is ended, and the estimate that
//! decides where work runs.

use std::net::{IpAddr, Ipv4Addr, Ipv6Addr};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, mpsc};
use std::time::Duration;

use futures::future::join_all;
use stickslip::admission::{
    Admission, Capacity, Class, Client, Deadline, FREE, INLINE, Kind, LARGEST, LARGEST_BODY, Pool, PoolError, Quota,
    QuotaLimits, Reservation,
};
use stickslip_compute::simulation::Worker as _;
use stickslip_compute::simulation::cost::Work;
use stickslip_compute::{Interrupted, LONGEST_WORK, Nanoseconds, Stop as _, begin_work, processor_time};
use stickslip_mechanics::profile::Cone;
use stickslip_mechanics::{Profile, Sphere};
use tokio::sync::Mutex as AsyncMutex;
use tokio::task::JoinHandle;
use tokio::time::sleep;

use crate::common::{PATIENCE, until};

fn small() -> Pool {
    let wait = Duration::from_millis(20);
    Pool::new(Capacity { requests: 2, queue: 1, wait, ..Capacity::default() })
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

/// Two places for large requests and sixteen for others.
fn classes() -> Pool {
    Pool::new(Capacity { wait: Duration::from_millis(20), ..Capacity::default() })
}

#[tokio::test]
async fn no_client_has_more_than_half_of_a_class() {
    let pool = classes();
    let take = |who: u8, bytes| {
        client(who).serve({
            let pool = pool.clone();
            async move { pool.reserve(bytes).await }
        })
    };
    let first = take(1, LARGEST_BODY + 1).await.unwrap();
    assert_eq!(take(1, LARGEST).await.unwrap_err(), PoolError::Busy);
    let second = take(2, LARGEST).await.unwrap();
    assert_eq!(take(3, LARGEST).await.unwrap_err(), PoolError::Busy);
    let mine: Vec<_> = join_all((0..8).map(|_| take(1, FREE + 1))).await.into_iter().collect::<Result<_, _>>().unwrap();
    assert_eq!(take(1, FREE + 1).await.unwrap_err(), PoolError::Busy);
    // What needs no place waits for none.
    assert!(take(1, FREE).await.is_ok());
    assert!(take(2, LARGEST_BODY).await.is_ok());
    assert_eq!(pool.taken().bytes, 2 * LARGEST + 8 * LARGEST_BODY);
    drop((first, second, mine));
    assert_eq!(pool.taken().bytes, 0);
}

#[tokio::test]
async fn a_reservation_becomes_smaller_when_there_is_room_and_its_clones_with_it() {
    let pool = classes();
    let large = pool.reserve(LARGEST).await.unwrap();
    let mut same = large.clone();
    let all: Vec<_> = (0..16).filter_map(|who| client(who).within(|| pool.try_reserve(LARGEST_BODY))).collect();
    assert_eq!(all.len(), 16);
    // The other class is full.
    pool.resize(&mut same, LARGEST_BODY).await.unwrap();
    assert_eq!(large.class(), Some(Class::Large));
    drop(all);
    pool.resize(&mut same, LARGEST_BODY).await.unwrap();
    assert_eq!((large.class(), large.bytes()), (Some(Class::Medium), LARGEST_BODY));
    let mut other = pool.reserve(FREE + 1).await.unwrap();
    other.take_over(&large);
    assert_eq!((large.class(), other.class(), pool.taken().bytes), (None, Some(Class::Medium), LARGEST_BODY));
    pool.resize(&mut other, FREE).await.unwrap();
    assert_eq!((same.class(), pool.taken().bytes), (None, 0));
}

/// Work that nobody waits for any more owns what its request holds.
#[tokio::test]
async fn work_that_outlives_its_request_keeps_its_memory_until_it_ends() {
    let pool = classes();
    let (release, held) = mpsc::channel::<()>();
    let under_way = Admission::begin(&pool, client(1), None);
    let (admission, busy) = (Arc::clone(under_way.admission()), pool.clone());
    pool.resize(&mut admission.memory.clone(), LARGEST).await.unwrap();
    let work = move || held.recv().is_ok();
    let asked = tokio::spawn(admission.serve(async move { busy.run(2 * INLINE, work).await }));
    until("it has a thread", async || (pool.meters().running.get() == 1).then_some(())).await;
    asked.abort();
    assert!(asked.await.is_err());
    let stop = under_way.admission().deadline.clone();
    drop(under_way);
    assert_eq!(stop.check(), Err(Interrupted::Abandoned));
    assert_eq!(pool.taken().bytes, LARGEST);
    release.send(()).unwrap();
    until("it has ended", async || (pool.taken().bytes == 0).then_some(())).await;
}

/// What a request does one after the other: its body arrives, it gets its permit, is parsed, asks for what its work
/// takes, locks its contact, and loads it.
async fn request(pool: &Pool, locks: &[AsyncMutex<()>], number: usize) -> Result<(), PoolError> {
    let need = |stage: usize| (number * 37 + stage * 53) % 200 * (LARGEST / 190);
    let pause = async || sleep(Duration::from_millis(1)).await;
    let mut memory = Reservation::default();
    let small = pool.reserve_arriving(need(0)).await?;
    pause().await;
    pool.resize(&mut memory, need(0).min(LARGEST_BODY)).await?;
    pause().await;
    let _permit = pool.admit_request().await?;
    drop(small);
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
        let pool = Pool::new(Capacity { requests, wait: PATIENCE, ..Capacity::default() });
        let locks = [const { AsyncMutex::const_new(()) }; 3];
        let all = (0..80).map(|number| client(number as u8 % 7).serve(request(&pool, &locks, number)));
        let all = join_all(all).await;
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
fn the_time_limit_is_of_processor_time_from_the_first_check() {
    let busy = |time: Duration| {
        let begin = processor_time();
        while processor_time() - begin < time {}
    };
    let allowed = Duration::from_millis(50);
    let (stop, _guard) = Deadline::within(allowed, Duration::ZERO);
    begin_work();
    busy(2 * allowed);
    assert_eq!(stop.check(), Ok(()));
    // What waits takes none.
    std::thread::sleep(2 * allowed);
    assert_eq!(stop.check(), Ok(()));
    // Another piece of work for the same request, on another thread.
    let spent = std::thread::scope(|scope| {
        let other = || {
            stop.check().unwrap();
            busy(allowed / 2);
            stop.check()
        };
        scope.spawn(other).join().unwrap()
    });
    assert_eq!(spent, Ok(()));
    busy(allowed);
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
