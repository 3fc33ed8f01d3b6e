//! How cost grows: `cargo bench --bench growth`. For cores see `cargo bench --bench sweep`.
//!
//! Moves with the length of the path, stresses with radii and pieces of slip history, the service with its contacts; the memory
//! of a contact and of a piece of history; the time to start.

mod load;

use std::hint::black_box;
use std::time::{Duration, Instant};

use load::{Connection, Process, join, median, serve};
use stickslip_mechanics::protocol::falling_amplitude;
use stickslip_mechanics::{Contact, Elasticity, Move, Preload, Profile, Setup, Sphere, Tangential};

/// Shorter work is repeated for this time.
const MIN_TIME: Duration = Duration::from_millis(20);
const MEASUREMENTS: usize = 7;
const CONNECTIONS: usize = 16;
/// How long moves are made on each number of contacts.
const ROUND: Duration = Duration::from_secs(2);
const CONTACT_COUNTS: [usize; 6] = [1, 10, 100, 1_000, 10_000, 100_000];

/// The median time of one call, in seconds.
fn seconds(mut work: impl FnMut()) -> f64 {
    let mut once = || {
        let (begin, mut count) = (Instant::now(), 0_u32);
        while count == 0 || begin.elapsed() < MIN_TIME {
            work();
            count += 1;
        }
        begin.elapsed().as_secs_f64() / f64::from(count)
    };
    median(&(0..MEASUREMENTS).map(|_| once()).collect::<Vec<_>>())
}

fn virgin() -> Contact {
    let setup = Setup {
        profile: Profile::Sphere(Sphere::new(0.01).expect("a valid radius")),
        elasticity: Elasticity::effective(1.15e11, 8.5e10).expect("valid moduli"),
        friction: 0.3,
        preload: Preload::NormalForce(10.0),
    };
    Contact::new(setup).expect("a valid contact")
}

fn follow(contact: &mut Contact, path: impl IntoIterator<Item = f64>) {
    for target in path {
        let to = Move { tangential: Some(Tangential::Displacement(target)), ..Move::default() };
        contact.apply(&to).expect("a displacement has no limit");
    }
}

/// The contact after `reversals` reversals of falling amplitude: about as many pieces of slip history.
fn after_reversals(reversals: usize) -> Contact {
    let mut contact = virgin();
    let amplitude = contact.summary().gross_slip_displacement;
    follow(&mut contact, falling_amplitude(reversals, amplitude));
    contact
}

fn paths() {
    println!("| random moves in a path | time of a move |\n|---|---|");
    let unit = virgin().summary().gross_slip_displacement;
    let mut seed = 0x9e37_79b9_7f4a_7c15_u64;
    let mut next = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (2.0 * ((seed >> 11) as f64 / (1_u64 << 53) as f64) - 1.0) * unit
    };
    for length in [1, 10, 100, 1_000, 10_000, 100_000, 1_000_000] {
        let path: Vec<f64> = (0..length).map(|_| next()).collect();
        let start = virgin();
        let time = seconds(|| follow(black_box(&mut start.clone()), path.iter().copied()));
        println!("| {length} | {:.0} ns |", 1e9 * time / length as f64);
    }
}

fn radii() {
    println!("\n| radii | pieces | time | of a radius and piece |\n|---|---|---|---|");
    for (count, reversals) in [(1, 20), (10, 20), (100, 20), (1_000, 20), (10_000, 20), (100_000, 20), (1_000, 1_000)] {
        let contact = after_reversals(reversals);
        let (edge, pieces) = (contact.contact_radius(), contact.memory_depth());
        let radii: Vec<f64> = (0..count).map(|index| edge * f64::from(index) / f64::from(count)).collect();
        let time = seconds(|| drop(black_box(contact.shears(&radii))));
        let each = 1e9 * time / f64::from(count) / pieces as f64;
        println!("| {count} | {pieces} | {:.1} us | {each:.2} ns |", 1e6 * time);
    }
    let (shallow, thousand) = (virgin(), after_reversals(1_000));
    let pieces = thousand.memory_depth() - shallow.memory_depth();
    let bytes = (thousand.memory_bytes() - shallow.memory_bytes()) as f64 / pieces as f64;
    println!("\nA contact takes {} bytes, and {bytes:.0} for each piece more.", shallow.memory_bytes());
}

/// Creates contacts; returns the paths of their moves.
async fn create_contacts(address: &str, count: usize) -> Vec<String> {
    let workers = (0..CONNECTIONS).map(|worker| {
        let (address, own) = (address.to_owned(), (count + worker) / CONNECTIONS);
        tokio::spawn(async move {
            let mut connection = Connection::open(&address).await;
            let mut paths = Vec::new();
            for _ in 0..own {
                paths.push(format!("/contacts/{}/move", connection.create().await));
            }
            paths
        })
    });
    join(workers).await.into_iter().flatten().collect()
}

/// Moves a second, one contact after the other.
async fn rate(address: &str, paths: &[String]) -> f64 {
    let begin = Instant::now();
    let workers = (0..CONNECTIONS).map(|worker| {
        let (paths, address) = (paths.to_vec(), address.to_owned());
        tokio::spawn(async move {
            let mut connection = Connection::open(&address).await;
            let mut count = 0;
            while begin.elapsed() < ROUND {
                let path = &paths[(worker + count * CONNECTIONS) % paths.len()];
                let target = (count % 97) as f64 * 1e-9;
                connection.post(path, format!(r#"{{"displacement":{target:e}}}"#).as_bytes()).await;
                count += 1;
            }
            count
        })
    });
    join(workers).await.into_iter().sum::<usize>() as f64 / begin.elapsed().as_secs_f64()
}

async fn contacts(name: &str, store: &str) {
    println!("\n| contacts, {name} | moves a second | bytes of memory a contact |\n|---|---|---|");
    let process = Process::start(serve(store));
    let before = process.resident();
    let mut paths = Vec::new();
    for count in CONTACT_COUNTS {
        paths.extend(create_contacts(&process.address, count - paths.len()).await);
        let held = (process.resident() - before) / count as i64;
        let rate = rate(&process.address, &paths).await;
        // With fewer contacts, the pool, the buffers and the store dominate.
        let held = if count < 1_000 { "".to_owned() } else { held.to_string() };
        println!("| {count} | {rate:.0} | {held} |");
    }
}

/// The median time until the service listens, s.
fn start(store: &str) -> f64 {
    let once = || {
        let begin = Instant::now();
        let process = Process::start(serve(store));
        let time = begin.elapsed().as_secs_f64();
        drop(process);
        time
    };
    median(&(0..MEASUREMENTS).map(|_| once()).collect::<Vec<_>>())
}

#[tokio::main]
async fn main() {
    paths();
    radii();
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = format!("sqlite:{}", folder.path().join("growth.db").display());
    println!("\nFrom the start of the process to listening: {:.1} ms with memory:", 1e3 * start("memory:"));
    println!("{:.1} ms with an SQLite file that holds nothing", 1e3 * start(&file));
    contacts("memory:", "memory:").await;
    contacts("sqlite:", &file).await;
    println!("\n{:.1} ms with that file", 1e3 * start(&file));
}
