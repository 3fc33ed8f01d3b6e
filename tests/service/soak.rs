//! A soak: mixed load on the real binary while it is killed, its disk fills, its file is locked, its database freezes,
//! and hostile heads arrive. In the end nothing acknowledged is lost, nothing is doubled, and the memory has stayed
//! within the bound that the log states.
//!
//! `STICKSLIP_SOAK_MINUTES` says how long it takes, roughly. Without it each accident happens once, after a fixed
//! number of operations.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::io::{BufRead as _, BufReader};
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use futures::future::join_all;
use stickslip_wire::client::{Client, Error, Options};
use tempfile::{TempDir, tempdir};
use tokio::time::{sleep, timeout};

use crate::common::kill::{Random, exact};
use crate::common::postgres::Cluster;
use crate::common::process::Process;
use crate::common::small_disk::SmallDisk;
use crate::common::{self, PATIENCE, create, until};
use crate::soak_round::{Round, simulation};

const CLIENTS: u64 = 8;
/// Contacts that all clients move.
const CONTACTS: usize = 4;
/// Operations between two accidents, at least.
const OPERATIONS: u64 = 60;
/// Bytes of the disk of a short soak, and how many more each minute needs: receipts are kept for a day.
const DISK: usize = 192 << 20;
const DISK_PER_MINUTE: usize = 48 << 20;
/// Limits that make the bound of the memory small.
const LIMITS: [&str; 8] =
    ["--cache-bytes", "8MiB", "--work-bytes", "256MiB", "--max-connections", "200", "--max-requests", "32"];

const BINARY: &str = env!("CARGO_BIN_EXE_stickslip");
/// Another program that locks the file to write, until it is killed.
const LOCK: &str = "import sqlite3, sys, time
database = sqlite3.connect(sys.argv[1], timeout=60, isolation_level=None)
database.execute('BEGIN IMMEDIATE')
print('locked', flush=True)
time.sleep(600)";

/// What happens to a server or to its store.
#[derive(Clone, Copy, Debug)]
enum Accident {
    Kill,
    Stop,
    FullDisk,
    LockedFile,
    FrozenDatabase,
    CrashedDatabase,
    LostConnections,
}

/// Where contacts are stored.
enum Store {
    File(SmallDisk),
    Database(Cluster, String),
}

impl Store {
    fn accidents(&self) -> &'static [Accident] {
        match self {
            Store::File(_) => &[Accident::Kill, Accident::FullDisk, Accident::LockedFile, Accident::Stop],
            Store::Database(..) => &[
                Accident::Kill,
                Accident::FrozenDatabase,
                Accident::LostConnections,
                Accident::CrashedDatabase,
                Accident::Stop,
            ],
        }
    }

    /// Its URL for the server.
    fn url(&self) -> String {
        match self {
            Store::File(disk) => format!("sqlite:{}", disk.folder.path().join("soak.db").display()),
            Store::Database(_, url) => url.clone(),
        }
    }

    /// A command where the store is seen.
    fn command(&self, words: &[&str]) -> Command {
        let entrance = if let Store::File(disk) = self { disk.entrance() } else { Vec::new() };
        let words: Vec<String> = entrance.into_iter().chain(words.iter().map(|word| (*word).to_owned())).collect();
        let mut command = common::clean(Command::new(&words[0]));
        command.args(&words[1..]);
        command
    }

    async fn serve(&self, log: &PathBuf) -> Process {
        let mut command = self.command(&[BINARY, "serve", "--listen", "127.0.0.1:0"]);
        command.args(["--log", "warn,stickslip::cli=info"]);
        command.args(LIMITS).args(["--store", &self.url()]);
        command.stderr(std::fs::OpenOptions::new().create(true).append(true).open(log).unwrap());
        Process::of(command).await
    }
}

/// Counts for the summary.
#[derive(Debug, Default)]
pub struct Figures {
    pub operations: u64,
    pub moves: u64,
    pub contacts: u64,
    pub forks: u64,
    pub reads: u64,
    pub hostile: u64,
    accidents: BTreeMap<String, u64>,
    /// Refusals by status; 0 is a lost connection.
    refusals: BTreeMap<u16, u64>,
    peak: u64,
}

/// A server, its store, and what has happened so far.
pub struct Soak {
    store: Store,
    folder: TempDir,
    process: RefCell<Option<Process>>,
    pub client: RefCell<Client>,
    pub base: RefCell<String>,
    pub figures: RefCell<Figures>,
    pub simulation: String,
}

impl Soak {
    async fn start(store: Store) -> Soak {
        let folder = tempdir().unwrap();
        let process = store.serve(&folder.path().join("log")).await;
        let (client, base) = (process.client.clone(), RefCell::new(process.base.clone()));
        let simulation = exact(&client.simulate(&simulation()).await.unwrap().steps);
        let (process, client) = (RefCell::new(Some(process)), RefCell::new(client));
        Soak { store, folder, process, client, base, figures: RefCell::default(), simulation }
    }

    /// Counts an operation that is done.
    pub fn count(&self, add: impl FnOnce(&mut Figures)) {
        let mut figures = self.figures.borrow_mut();
        figures.operations += 1;
        add(&mut figures);
    }

    fn refused(&self, status: u16) -> u64 {
        self.figures.borrow().refusals.get(&status).copied().unwrap_or_default()
    }

    /// Repeats a call until the server does not fail to answer it; the status of a refusal that is the client's fault.
    pub async fn insist<T>(&self, call: impl AsyncFn(&Client) -> Result<T, Error>) -> Result<T, u16> {
        loop {
            let client = self.client.borrow().clone();
            let answer = timeout(PATIENCE, call(&client)).await.expect("a request gets no answer");
            let status = match answer {
                Ok(answer) => return Ok(answer),
                Err(Error::Problem(problem)) if problem.status < 500 && problem.status != 408 => {
                    return Err(problem.status);
                }
                Err(Error::Problem(problem)) => {
                    assert!(problem.status != 500, "{problem:?}");
                    problem.status
                }
                Err(_) => 0,
            };
            *self.figures.borrow_mut().refusals.entry(status).or_default() += 1;
            sleep(Duration::from_millis(20)).await;
        }
    }

    /// Ends the server, gracefully or not, and starts it again.
    async fn restart(&self, gracefully: bool) {
        let process = self.process.borrow_mut().take().unwrap();
        let peak = process.peak();
        if gracefully {
            process.stop().await;
        } else {
            process.kill().await;
        }
        let known = self.figures.borrow().peak;
        self.figures.borrow_mut().peak = peak.max(known);
        let process = self.store.serve(&self.log()).await;
        self.client.replace(process.client.clone());
        self.base.replace(process.base.clone());
        self.process.replace(Some(process));
    }

    fn log(&self) -> PathBuf {
        self.folder.path().join("log")
    }

    /// Waits until a request has been refused by this status.
    async fn until_refused(&self, status: u16) {
        let before = self.refused(status);
        until("a request is refused", async || (self.refused(status) > before).then_some(())).await;
    }

    async fn happens(&self, accident: Accident) {
        match (accident, &self.store) {
            (Accident::FullDisk, Store::File(disk)) => {
                disk.fill(1 << 16);
                self.until_refused(507).await;
                // A start without room, and one with it.
                self.restart(false).await;
                disk.clear();
                self.restart(false).await;
            }
            (Accident::LockedFile, Store::File(disk)) => {
                let mut other = self.store.command(&["python3", "-c", LOCK]);
                let mut other = other.arg(disk.folder.path().join("soak.db")).stdout(Stdio::piped()).spawn().unwrap();
                let mut line = String::new();
                BufReader::new(other.stdout.take().unwrap()).read_line(&mut line).unwrap();
                assert_eq!(line.trim(), "locked");
                self.until_refused(503).await;
                other.kill().unwrap();
                other.wait().unwrap();
            }
            (Accident::FrozenDatabase, Store::Database(cluster, _)) => {
                let _frozen = cluster.freeze();
                self.until_refused(503).await;
            }
            (Accident::CrashedDatabase, Store::Database(cluster, _)) => {
                cluster.crash();
                self.until_refused(503).await;
                cluster.resume();
            }
            (Accident::LostConnections, Store::Database(cluster, _)) => {
                let end = "SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE application_name = 'stickslip'";
                cluster.execute("postgres", end).await;
            }
            (accident, _) => self.restart(matches!(accident, Accident::Stop)).await,
        }
        println!("{accident:?} after {} operations", self.figures.borrow().operations);
        *self.figures.borrow_mut().accidents.entry(format!("{accident:?}")).or_default() += 1;
    }

    /// All accidents of the store, once, under load; then everything is compared with what was acknowledged.
    async fn round(&self, seed: u64) {
        let options = |key: String| Options { idempotency_key: Some(key), ..Options::default() };
        let mut ids = Vec::new();
        for number in 0..CONTACTS {
            let options = options(format!("{seed}-contact-{number}"));
            ids.push(self.insist(async |client| client.create(&create(), &options).await).await.unwrap().id);
        }
        let round = Round::of(self, ids);
        let accidents = async {
            for accident in self.store.accidents() {
                let enough = self.figures.borrow().operations + OPERATIONS;
                let progress = async || (self.figures.borrow().operations >= enough).then_some(());
                until("clients are served", progress).await;
                self.happens(*accident).await;
            }
            round.end();
        };
        let clients = join_all((0..CLIENTS).map(|client| round.work(Random(seed << 8 | client), seed, client)));
        futures::join!(accidents, clients);
        round.compare().await;
    }

    async fn end(self) -> Figures {
        let process = self.process.take().unwrap();
        let mut figures = self.figures.take();
        figures.peak = figures.peak.max(process.peak());
        let log = std::fs::read_to_string(self.folder.path().join("log")).unwrap();
        let bound = log.lines().rev().find_map(|line| line.split_once("memory_bound=")).unwrap().1;
        let bound: u64 = bound.split_whitespace().next().unwrap().parse().unwrap();
        assert!(!log.contains("panicked"), "{log}");
        assert!(figures.peak < bound, "{} bytes of memory, and the bound is {bound}", figures.peak);
        println!("{figures:#?}, bound of the memory {bound}");
        process.stop().await;
        let checked = self.store.command(&[BINARY, "check", "--store", &self.store.url()]).output().unwrap();
        assert!(checked.status.success(), "{checked:?}");
        figures
    }
}

/// The minutes that the soak shall take, if they are given.
fn minutes() -> Option<u64> {
    std::env::var("STICKSLIP_SOAK_MINUTES").ok().map(|text| text.parse().expect("STICKSLIP_SOAK_MINUTES is a number"))
}

async fn soak(store: Store) {
    let end = minutes().map(|minutes| Instant::now() + Duration::from_secs(60 * minutes));
    let soak = Soak::start(store).await;
    for seed in 1.. {
        soak.round(seed).await;
        if end.is_none_or(|end| Instant::now() >= end) {
            break;
        }
    }
    let figures = soak.end().await;
    assert!(figures.moves > 0 && figures.forks > 0 && figures.hostile > 0 && figures.reads > 0, "{figures:?}");
}

#[tokio::test]
async fn a_file_survives_accidents_under_load() {
    let size = DISK + DISK_PER_MINUTE * minutes().unwrap_or_default() as usize;
    soak(Store::File(SmallDisk::new(size))).await;
}

#[tokio::test]
async fn a_database_survives_accidents_under_load() {
    let cluster = Cluster::start();
    let url = cluster.database().await;
    soak(Store::Database(cluster, url)).await;
}
