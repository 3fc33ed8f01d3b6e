//! How cost grows: `cargo bench --bench growth`. For cores see `cargo bench --bench sweep`.
//!
//! Each law is fitted to the times by least squares, and the table says how far the worst of them is off. The engine on
//! every shape; the service with its contacts, and the time to start.

mod engine;
mod law;
#[path = "../load/mod.rs"]
mod load;
#[path = "../../crates/mechanics/benches/scenes/mod.rs"]
mod scenes;

use std::time::{Duration, Instant};

use load::{Connection, Process, join, median, serve};

const STARTS: usize = 7;
const CONNECTIONS: usize = 16;
/// How long moves are made on each number of contacts.
const ROUND: Duration = Duration::from_secs(2);
const CONTACT_COUNTS: [usize; 6] = [1, 10, 100, 1_000, 10_000, 100_000];

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
    median(&(0..STARTS).map(|_| once()).collect::<Vec<_>>())
}

#[tokio::main]
async fn main() {
    engine::all();
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = format!("sqlite:{}", folder.path().join("growth.db").display());
    println!("\nFrom the start of the process to listening: {:.1} ms with memory:", 1e3 * start("memory:"));
    println!("{:.1} ms with an SQLite file that holds nothing", 1e3 * start(&file));
    contacts("memory:", "memory:").await;
    contacts("sqlite:", &file).await;
    println!("\n{:.1} ms with that file", 1e3 * start(&file));
}
