//! What a sweep costs: `cargo bench --bench sweep`. A million points of a sphere after 20 reversals, on one thread and on
//! more, up to one a core; and how much of it is the simulation itself.

use std::hint::black_box;
use std::time::{Duration, Instant};

use serde_json::json;
use stickslip::simulation::{Rows, Stop, Sweep, Workers, simulate};
use stickslip::wire::{self, SimulateRequest, SweepRequest};

const POINTS: usize = 1_000_000;
/// Simulations that are timed for comparison.
const ALONE: u32 = 20_000;

fn base() -> serde_json::Value {
    json!({
        "contact": {
            "profile": {"type": "sphere", "radius": 0.01},
            "material": {"bodies": [{"youngs_modulus": 2.1e11, "poisson_ratio": 0.3}, "rigid"]},
            "friction": 0.3,
            "preload": {"normal_force": 10.0}
        },
        "path": {"falling_amplitude": {"reversals": 20}}, "steps": "last", "residual": true
    })
}

fn plan() -> Sweep {
    let request = json!({
        "base": base(),
        "axes": [{"pointer": "/contact/friction", "linear": {"from": 0.1, "to": 0.6, "count": POINTS}}],
        "outputs": ["/residual/max"]
    });
    let draft = wire::read::<SweepRequest>(request.to_string().as_bytes()).expect("a valid sweep");
    Sweep::plan(draft).expect("a sweep with outputs")
}

fn timed(threads: usize) -> (Rows, Duration) {
    let (plan, workers) = (plan(), Workers::new(threads).expect("threads"));
    let (mut rows, begin) = (Rows::default(), Instant::now());
    while rows.values.len() < POINTS {
        let rest = rows.values.len()..POINTS;
        rows.append(plan.slice(rest, &workers, threads, &Stop::default(), None).expect("nobody stops it"));
    }
    (rows, begin.elapsed())
}

fn main() {
    let checked = wire::read::<SimulateRequest>(base().to_string().as_bytes()).expect("a valid simulation");
    let begin = Instant::now();
    for _ in 0..ALONE {
        black_box(simulate(black_box(&checked), &Stop::default()).expect("an answer"));
    }
    let alone = begin.elapsed() / ALONE;
    println!("the simulation alone: {:.2} µs", alone.as_secs_f64() * 1e6);
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let mut first: Option<(Rows, Duration)> = None;
    for threads in [1, 2, 4, 8, 16].into_iter().filter(|threads| *threads <= cores) {
        let (rows, time) = timed(threads);
        let rate = POINTS as f64 / time.as_secs_f64();
        let speedup = first.as_ref().map_or(1.0, |(_, alone)| alone.as_secs_f64() / time.as_secs_f64());
        println!(
            "{POINTS} points, {threads} threads: {:.1} s, {rate:.0} points/s, {speedup:.2} times one",
            time.as_secs_f64()
        );
        match &first {
            Some((expected, _)) => assert!(*expected == rows, "another result on {threads} threads"),
            None => first = Some((rows, time)),
        }
    }
}
