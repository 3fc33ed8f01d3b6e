//! Admission: permits for places and memory, work that is ended, and the estimate that decides where work runs.

use std::time::Duration;

use stickslip::admission::{Capacity, INLINE, Interrupted, Pool, PoolError, Stop};
use stickslip::simulation::cost::Work;
use stickslip_mechanics::profile::Cone;
use stickslip_mechanics::{Profile, Sphere};

/// Bytes are reserved in units of this size.
const UNIT: usize = 1024;

fn small() -> Pool {
    let wait = Duration::from_millis(20);
    Pool::new(Capacity { requests: 2, queue: 1, wait, bytes: 200 * UNIT, ..Capacity::default() })
}

#[tokio::test]
async fn requests_beyond_the_capacity_wait_and_are_refused() {
    let pool = small();
    let places = (pool.enter().await.unwrap(), pool.enter().await.unwrap());
    let (second, third) = tokio::join!(pool.enter(), pool.enter());
    assert_eq!((second.unwrap_err(), third.unwrap_err()), (PoolError::Busy, PoolError::QueueFull));
    drop(places);
    assert!(pool.enter().await.is_ok());
    assert_eq!((pool.taken().requests, pool.taken().waiting), (0, 0));
}

#[tokio::test]
async fn bytes_are_reserved_once() {
    let pool = small();
    let mut first = pool.reserve(80 * UNIT).await.unwrap();
    let second = pool.reserve(90 * UNIT).await.unwrap();
    assert_eq!(pool.reserve(60 * UNIT).await.unwrap_err(), PoolError::Busy);
    pool.resize(&mut first, 30 * UNIT).await.unwrap();
    assert_eq!(pool.taken().bytes, 120 * UNIT);
    let third = pool.reserve(60 * UNIT).await.unwrap();
    assert_eq!(pool.resize(&mut first, 60 * UNIT).await.unwrap_err(), PoolError::Busy);
    assert_eq!(pool.taken().bytes, 180 * UNIT);
    drop((first, second, third));
    // A request for more than there is gets everything, alone.
    let all = pool.reserve(1_000 * UNIT).await.unwrap();
    assert_eq!(pool.taken().bytes, 200 * UNIT);
    drop(all);
    assert_eq!(pool.taken().bytes, 0);
}

#[test]
fn work_ends_with_the_guard() {
    let (stop, guard) = Stop::guarded();
    assert_eq!(stop.check(), Ok(()));
    drop(guard);
    assert_eq!(stop.check(), Err(Interrupted::Abandoned));
}

#[test]
fn the_time_limit_runs_from_the_first_check() {
    let allowed = Duration::from_millis(20);
    let (stop, _guard) = Stop::within(allowed);
    std::thread::sleep(2 * allowed);
    assert_eq!(stop.check(), Ok(()));
    std::thread::sleep(2 * allowed);
    assert_eq!(stop.check(), Err(Interrupted::TimeLimit(allowed)));
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
