//! One order that every client agrees on: recorded histories of several clients, whose servers are killed, frozen and
//! stopped and whose store is cut off, locked, frozen or crashes, are linearizable; and those of services that break a
//! promise are not. Meanwhile the memory stays within the bound that the log states, and in the end the store is sound.
//!
//! `STICKSLIP_HISTORIES` says how many histories of each store are recorded and checked; without it they are a few. How
//! the operating system schedules the processes differs from run to run, and so do the histories; that they are
//! linearizable does not.

mod clients;
mod linearizability;
mod model;
mod service;

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Duration;

use rusqlite::Connection;
use tempfile::tempdir;
use tokio::time::sleep;

use crate::common::kill::Random;
use crate::common::postgres::Cluster;
use crate::common::process::Process;
use crate::common::{run, until};
use clients::{Load, Recorder};
use linearizability::{Call, History};
use service::{Fault, Service};

/// What is asked for between two looks at the histories.
const LOAD: Load = Load { contacts: 3, clients: 5, operations: 50, losses: true };
/// Accidents in that time.
const ACCIDENTS: usize = 10;
/// Histories of each store, unless the environment says otherwise.
const HISTORIES: usize = 20;
/// Limits that make the bound of the memory small.
const LIMITS: [&str; 8] =
    ["--cache-bytes", "8MiB", "--work-bytes", "256MiB", "--max-connections", "200", "--max-requests", "32"];

/// What happens to a process, to its connections or to its store.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Accident {
    Kill,
    Stop,
    Freeze,
    LostDatabaseConnections,
    LockedFile,
    FrozenDatabase,
    CrashedDatabase,
}

/// Where contacts are stored.
enum Store {
    File(PathBuf),
    Database(Cluster, String),
}

impl Store {
    fn url(&self) -> String {
        match self {
            Store::File(path) => format!("sqlite:{}", path.display()),
            Store::Database(_, url) => url.clone(),
        }
    }

    fn serve(&self) -> Process {
        Process::with(&self.url(), &[&["--log", "warn,stickslip::cli=info"][..], &LIMITS].concat())
    }

    /// What happens all the time, the more often the more often it is named; and what happens once.
    fn accidents(&self) -> [&'static [Accident]; 2] {
        use Accident::*;
        match self {
            Store::File(_) => [&[Kill, Freeze], &[LockedFile, Stop]],
            Store::Database(..) => {
                [&[Kill, Freeze, Freeze, Freeze, LostDatabaseConnections], &[FrozenDatabase, CrashedDatabase, Stop]]
            }
        }
    }
}

/// What has been recorded.
#[derive(Debug, Default)]
struct Figures {
    histories: usize,
    contradictions: usize,
    operations: usize,
    unknown_changes: usize,
    accidents: BTreeMap<Accident, usize>,
    peak: usize,
}

/// Processes over a store.
struct Scene {
    store: Store,
    processes: Vec<Option<Process>>,
    figures: Figures,
}

impl Scene {
    fn start(store: Store, processes: usize) -> Scene {
        let processes = (0..processes).map(|_| Some(store.serve())).collect();
        Scene { store, processes, figures: Figures::default() }
    }

    /// Ends a process. It has not taken more memory than the bound that its log states, and nothing in it has panicked.
    async fn end(&mut self, victim: usize, gracefully: bool) {
        let process = self.processes[victim].take().unwrap();
        let (peak, said) = (process.peak(), process.log());
        let bound = said.split_once("memory_bound=").unwrap().1.split_whitespace().next().unwrap();
        assert!(peak < bound.parse().unwrap() && !said.contains("panicked"), "{peak} bytes: {said}");
        self.figures.peak = self.figures.peak.max(peak);
        if gracefully { drop(process.stop().await) } else { process.kill().await }
    }

    async fn happens(&mut self, accident: Accident, recorder: &Recorder, random: &mut Random) {
        let victim = random.below(self.processes.len() as u64) as usize;
        let before = recorder.service.unavailable.load(Ordering::SeqCst);
        let refused = || recorder.service.unavailable.load(Ordering::SeqCst) > before;
        let is_noticed = until("a request is refused", async || refused().then_some(()));
        match (accident, &self.store) {
            (Accident::Freeze, _) => {
                let process = self.processes[victim].as_ref().unwrap();
                process.signal("STOP");
                sleep(Duration::from_micros(random.below(30_000))).await;
                process.signal("CONT");
            }
            (Accident::LockedFile, Store::File(path)) => {
                let other = Connection::open(path).unwrap();
                other.execute_batch("BEGIN IMMEDIATE").unwrap();
                is_noticed.await;
            }
            (Accident::FrozenDatabase, Store::Database(cluster, _)) => {
                let _frozen = cluster.freeze();
                is_noticed.await;
            }
            (Accident::CrashedDatabase, Store::Database(cluster, _)) => {
                cluster.crash();
                is_noticed.await;
                // However long that takes, few requests have an unknown outcome.
                recorder.paused.send_replace(true);
                cluster.resume();
                recorder.paused.send_replace(false);
            }
            (Accident::LostDatabaseConnections, Store::Database(cluster, _)) => {
                let end = "SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE application_name = 'stickslip'";
                cluster.execute("postgres", end).await;
            }
            _ => {
                self.end(victim, accident == Accident::Stop).await;
                let process = self.store.serve();
                recorder.service.replicas.lock().unwrap()[victim] = process.client.clone();
                self.processes[victim] = Some(process);
            }
        }
        *self.figures.accidents.entry(accident).or_default() += 1;
    }

    /// Lets accidents happen at fixed shares of the work; of the rare ones each in the first round.
    async fn accidents(&mut self, recorder: &Recorder, seed: u64) {
        let mut random = Random(!seed);
        let [common, once] = self.store.accidents();
        let mut rare = once.iter().filter(|_| seed == 1);
        for number in 1..=ACCIDENTS as u64 {
            while recorder.done.load(Ordering::Relaxed) < recorder.requests() * number / (ACCIDENTS as u64 + 1) {
                sleep(Duration::from_millis(1)).await;
            }
            sleep(Duration::from_micros(random.below(5_000))).await;
            let usual = common[random.below(common.len() as u64) as usize];
            let accident = if number % 2 == 0 { rare.next().copied() } else { None };
            self.happens(accident.unwrap_or(usual), recorder, &mut random).await;
        }
    }
}

fn wanted() -> usize {
    let text = std::env::var("STICKSLIP_HISTORIES").ok();
    text.map_or(HISTORIES, |text| text.parse().expect("STICKSLIP_HISTORIES is a number"))
}

/// Records histories on so many processes over a store, and checks each.
async fn are_linearizable(store: Store, processes: usize) {
    let mut scene = Scene::start(store, processes);
    for seed in 1.. {
        if scene.figures.histories >= wanted() {
            break;
        }
        let replicas = scene.processes.iter().map(|process| process.as_ref().unwrap().client.clone()).collect();
        let recorder = Arc::new(Recorder::start(Service::new(replicas, None), LOAD, seed).await);
        futures::join!(recorder.work(), scene.accidents(&recorder, seed));
        recorder.read_all().await;
        let figures = &mut scene.figures;
        for (_, history) in recorder.histories() {
            figures.histories += 1;
            figures.operations += history.calls.len();
            let unknown = history.calls.iter().filter(|call| call.returned.is_none() && call.request.changes());
            figures.unknown_changes += unknown.count();
            if let Some(contradiction) = history.first_contradiction() {
                println!("seed {seed}: no order explains\n{}", told(&history, contradiction));
                figures.contradictions += 1;
            }
        }
        if figures.contradictions == 0 {
            recorder.replay_all().await;
        }
    }
    for process in 0..processes {
        scene.end(process, true).await;
    }
    println!("{:?}", scene.figures);
    assert_eq!(scene.figures.contradictions, 0, "histories are not linearizable");
    assert!(scene.figures.unknown_changes > 0, "nothing was lost");
    let kinds = scene.store.accidents().concat();
    assert!(kinds.iter().all(|kind| scene.figures.accidents.contains_key(kind)), "{:?}", scene.figures.accidents);
    let checked = run(&["check", "--store", &scene.store.url()]);
    assert!(checked.status.success(), "{checked:?}");
}

/// A history up to a reply, a line for each request.
fn told(history: &History, last: usize) -> String {
    let calls = &history.calls;
    let end = calls[last].returned.as_ref().map_or(u64::MAX, |(end, _)| *end);
    let line = |(number, call): (usize, &Call)| {
        let mark = if number == last { ">>" } else { "  " };
        let reply = call.returned.as_ref().filter(|(at, _)| *at <= end);
        let returned = reply.map_or("lost".to_owned(), |(at, reply)| format!("{at}: {reply:?}"));
        format!("{mark} {} {:?}\n      {returned}\n", call.called, call.request)
    };
    let lines: String = calls.iter().enumerate().filter(|(_, call)| call.called < end).map(line).collect();
    format!("{:?}\n{lines}", history.initial)
}

#[tokio::test(flavor = "multi_thread")]
async fn histories_on_two_replicas_are_linearizable() {
    let cluster = Cluster::start();
    let url = cluster.database().await;
    are_linearizable(Store::Database(cluster, url), 2).await;
}

#[tokio::test(flavor = "multi_thread")]
async fn histories_on_a_file_are_linearizable() {
    let folder = tempdir().unwrap();
    are_linearizable(Store::File(folder.path().join("order.db")), 1).await;
}

#[tokio::test(flavor = "multi_thread")]
async fn a_service_that_breaks_a_promise_has_a_history_that_is_not_linearizable() {
    let process = Process::start("memory:").await;
    let load = Load { losses: false, operations: 60, ..LOAD };
    for (seed, fault) in (1..).zip([
        None,
        Some(Fault::ReplyBeforeCommit),
        Some(Fault::LostCompare),
        Some(Fault::LostKey),
        Some(Fault::StaleRead),
        Some(Fault::LostMove),
    ]) {
        let service = Service::new(vec![process.client.clone()], fault);
        let recorder = Arc::new(Recorder::start(service, load, seed).await);
        recorder.work().await;
        recorder.read_all().await;
        let histories = recorder.histories();
        let contradictions = histories.iter().filter(|(_, history)| history.first_contradiction().is_some()).count();
        println!("{fault:?}: {contradictions} of {} histories are not linearizable", histories.len());
        assert_eq!(contradictions > 0, fault.is_some(), "{fault:?}");
    }
}
