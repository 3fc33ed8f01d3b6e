//! The time to open a session that is not cached, by each store: `cargo bench --bench sessions`. Needs PostgreSQL, as
//! the tests do.
//!
//! A session of a million moves, its slip history some ten pieces deep and a hundred thousand, opened from its snapshot
//! and the moves beyond it, half as many as there can be; and the same without a snapshot, from the first move on.
//! Before that, how much the process grows by sessions that are stored and not cached.

#[path = "../tests/common/port.rs"]
mod port;
// Made for the tests, of which this uses a part.
#[allow(dead_code)]
#[path = "../tests/common/postgres.rs"]
mod postgres;

mod load;

use std::sync::Arc;
use std::time::Duration;

use criterion::{Criterion, criterion_group, criterion_main};
use load::resident;
use stickslip::admission::Pool;
use stickslip::sessions::Sessions;
use stickslip::store::{Snapshot, SqliteStore, Store};
use stickslip_wire::session::Advance;
use stickslip_wire::{CreateRequest, Plan, Steps, read};
use uuid::Uuid;

const MOVES: usize = 1_000_000;
/// Moves of one path.
const PATH: usize = 100_000;
/// Moves after the last snapshot: so few that not even a busy machine stores another one.
const TAIL: usize = 5_000;
/// Displacement of gross slip, m, roughly.
const SLIDE: f64 = 2e-7;
/// Idle sessions, at which the memory of the process is measured.
const AT_REST: [usize; 3] = [20_000, 120_000, 320_000];
/// Sessions that are made at a time.
const AT_ONCE: usize = 500;
const DEFINITION: &[u8] = br#"{"profile": {"type": "sphere", "radius": 0.01}, "friction": 0.3,
    "preload": {"normal_force": 10.0}, "material": {"effective": {"e_star": 1.15e11, "g_star": 8.5e10}}}"#;

fn sessions(store: &Arc<dyn Store>) -> Sessions {
    Sessions::new(store.clone(), Pool::with_defaults(), 0)
}

/// Back and forth at random, the first `turns` of the turning points ever closer together and the rest within them.
fn displacements(turns: usize) -> Vec<f64> {
    let mut seed = 0x9e37_79b9_7f4a_7c15_u64;
    let mut next = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        2.0 * ((seed >> 11) as f64 / (1_u64 << 53) as f64) - 1.0
    };
    let turn = |index: usize| if index.is_multiple_of(2) { SLIDE } else { -SLIDE };
    let inside = if turns > 0 { 0.1 } else { 1.0 };
    let falling = (0..turns).map(|index| turn(index) * (1.0 - 0.9 * index as f64 / turns as f64)).collect::<Vec<f64>>();
    falling.into_iter().chain(std::iter::repeat_with(|| inside * SLIDE * next())).take(MOVES).collect()
}

async fn create(sessions: &Sessions) -> Uuid {
    let creation = read::<CreateRequest>(DEFINITION).expect("a valid definition");
    sessions.create(creation, None).await.expect("room").created.expect("a new session")
}

async fn make(store: &Arc<dyn Store>, turns: usize) -> Uuid {
    let sessions = Sessions::new(store.clone(), Pool::with_defaults(), usize::MAX);
    let id = create(&sessions).await;
    let displacements = displacements(turns);
    let (body, tail) = displacements.split_at(MOVES - TAIL);
    for path in body.chunks(PATH).chain([tail]) {
        let plan = Plan::Displacement(path.to_vec());
        let advance =
            Advance { plan, stress: None, steps: Steps::Last, tolerance: 1e-10, asked_tolerance: None, relax: None };
        sessions.apply(id, advance, None, None).await.expect("a displacement has no limit");
        // The snapshot is kept behind the reply.
        tokio::time::sleep(Duration::from_millis(200)).await;
    }
    id
}

/// Prints by how much the process grows with the number of sessions that are stored.
async fn rest(store: Arc<dyn Store>) {
    let sessions = sessions(&store);
    let (mut made, mut held) = (0, 0);
    for count in AT_REST {
        while made < count {
            futures::future::join_all((0..AT_ONCE).map(|_| create(&sessions))).await;
            made += AT_ONCE;
        }
        let grown = resident("self") - held;
        held += grown;
        println!("{count} sessions at rest in SQLite: {} kB held, {} kB more than before", held / 1024, grown / 1024);
    }
}

fn opening(criterion: &mut Criterion) {
    let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().build().expect("threads are to be had");
    let folder = tempfile::tempdir().expect("a temporary folder");
    let sqlite = |name| Arc::new(SqliteStore::open(&folder.path().join(name)).expect("a new file"));
    runtime.block_on(rest(sqlite("rest.db")));
    let url = runtime.block_on(postgres::Cluster::shared().database());
    let stores: [(&str, Arc<dyn Store>); 3] = [
        ("memory", Arc::new(SqliteStore::in_memory().unwrap())),
        ("sqlite", sqlite("opening.db")),
        ("postgres", runtime.block_on(stickslip::store::open(&url)).expect("a database")),
    ];
    let mut group = criterion.benchmark_group("open a session of a million moves");
    group.sample_size(10);
    for (name, store) in &stores {
        for turns in [0, PATH] {
            let id = runtime.block_on(make(store, turns));
            let cold = sessions(store);
            let session = runtime.block_on(cold.get(id)).expect("it is there");
            let kept = runtime.block_on(store.snapshot(id)).expect("it is there").expect("a snapshot");
            let beyond = session.sequence - kept.sequence;
            println!("{name}: snapshot of {} bytes, {beyond} moves before the end", kept.state.len());
            group.bench_function(format!("{name}, {} pieces deep", session.state.memory_depth), |bencher| {
                bencher.iter(|| runtime.block_on(cold.get(id)).expect("it is there"));
            });
            if turns == 0 {
                // Bytes that are no snapshot are ignored.
                let nothing = Snapshot { sequence: session.sequence + 1, state: Vec::new() };
                runtime.block_on(store.save_snapshot(id, nothing, None)).expect("it is there");
                group.bench_function(format!("{name}, without a snapshot"), |bencher| {
                    bencher.iter(|| runtime.block_on(cold.get(id)).expect("it is there"));
                });
            }
        }
    }
    group.finish();
}

criterion_group!(benches, opening);
criterion_main!(benches);
