//! The cost of a sweep, and how it scales with cores and replicas: `cargo bench --bench sweep`. Needs PostgreSQL.
//!
//! A million points of a sphere after 20 reversals: the simulation alone, the sweep on one thread up to one a core
//! beside as many threads that do nothing but the simulation, and as a job that replicas share over PostgreSQL, each of
//! them bound to one core.

mod load;
#[path = "../tests/common/port.rs"]
mod port;
#[allow(dead_code, reason = "the benchmark uses a part of it")]
#[path = "../tests/common/postgres.rs"]
mod postgres;

use std::hint::black_box;
use std::process::Command;
use std::time::{Duration, Instant};

use load::{Connection, Process, serve};
use serde_json::json;
use stickslip_compute::Flag;
use stickslip_compute::simulation::{Sweep, SweepResult, simulate};
use stickslip_wire::{self as wire, PrepareAnew, SimulateRequest, SweepRequest};

const POINTS: usize = 1_000_000;
/// Number of single simulations of a thread, for comparison.
const SIMULATIONS: u32 = 200_000;

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

fn request() -> String {
    let axis = json!({"pointer": "/contact/friction", "linear": {"from": 0.1, "to": 0.6, "count": POINTS}});
    json!({"base": base(), "axes": [axis], "outputs": ["/residual/max"], "job": true}).to_string()
}

fn plan() -> Sweep {
    let draft = wire::read::<SweepRequest>(request().as_bytes()).expect("a valid sweep");
    Sweep::plan(draft, &PrepareAnew).expect("a sweep with outputs")
}

/// The time of so many simulations on each of the threads at once: what the machine can do.
fn time_of_simulations(threads: usize) -> Duration {
    let checked = wire::read::<SimulateRequest>(base().to_string().as_bytes()).expect("a valid simulation");
    let work = || {
        for _ in 0..SIMULATIONS {
            black_box(simulate(black_box(&checked), &Flag::default()).expect("an answer"));
        }
    };
    let begin = Instant::now();
    std::thread::scope(|scope| (0..threads).for_each(|_| drop(scope.spawn(work))));
    begin.elapsed()
}

fn time_of_sweep(threads: usize) -> (SweepResult, Duration) {
    let plan = plan();
    let begin = Instant::now();
    let rows = plan.compute(0..POINTS, threads, &Flag::default()).expect("it is not stopped");
    (rows, begin.elapsed())
}

/// The service on one core, with a store.
fn serve_on_core(core: usize, store: &str) -> Command {
    let service = serve(store);
    let mut command = Command::new("taskset");
    command.args(["--cpu-list", &core.to_string()]).arg(service.get_program()).args(service.get_args());
    command
}

/// The time of the job with so many replicas.
async fn time_of_job(replicas: usize) -> Duration {
    let store = postgres::Cluster::shared().database().await;
    let processes: Vec<Process> = (0..replicas).map(|core| Process::start(serve_on_core(core, &store))).collect();
    let mut connection = Connection::open(&processes[0].address).await;
    let begin = Instant::now();
    let reply: serde_json::Value =
        serde_json::from_slice(connection.post("/sweep", request().as_bytes()).await).expect("a job");
    let path = format!("/jobs/{}", reply["id"].as_str().expect("an identifier"));
    loop {
        let job: serde_json::Value = serde_json::from_slice(connection.get(&path).await).expect("a job");
        match job["state"].as_str() {
            Some("done") => return begin.elapsed(),
            Some("running") => tokio::time::sleep(Duration::from_millis(50)).await,
            _ => panic!("{job}"),
        }
    }
}

fn main() {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let alone = time_of_simulations(1);
    println!("the simulation alone: {:.2} µs", alone.as_secs_f64() * 1e6 / f64::from(SIMULATIONS));
    let mut first: Option<(SweepResult, Duration)> = None;
    for threads in [1, 2, 4, 8, 16].into_iter().filter(|threads| *threads <= cores) {
        let machine = threads as f64 * alone.as_secs_f64() / time_of_simulations(threads).as_secs_f64();
        let (rows, time) = time_of_sweep(threads);
        let rate = POINTS as f64 / time.as_secs_f64();
        let speedup = first.as_ref().map_or(1.0, |(_, alone)| alone.as_secs_f64() / time.as_secs_f64());
        println!(
            "{POINTS} points, {threads} threads: {:.1} s, {rate:.0} points/s, {speedup:.2} times one; the simulation \
                alone {machine:.2}",
            time.as_secs_f64()
        );
        match &first {
            Some((expected, _)) => assert!(*expected == rows, "another result on {threads} threads"),
            None => first = Some((rows, time)),
        }
    }
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().expect("a runtime");
    let mut one: Option<Duration> = None;
    for replicas in [1, 2, 4].into_iter().filter(|replicas| *replicas <= cores) {
        let time = runtime.block_on(time_of_job(replicas));
        let (rate, speedup) = (
            POINTS as f64 / time.as_secs_f64(),
            one.map_or(1.0, |alone: Duration| alone.as_secs_f64() / time.as_secs_f64()),
        );
        println!(
            "the same as a job of {replicas} replicas: {:.1} s, {rate:.0} points/s, {speedup:.2} times one",
            time.as_secs_f64()
        );
        one.get_or_insert(time);
    }
}
