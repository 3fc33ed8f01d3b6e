//! One order that every client agrees on: recorded histories of several clients, over replicas that are killed, frozen
//! and cut off from the database, are linearizable; and those of services that break a promise are not.
//!
//! `STICKSLIP_HISTORIES` says how many histories of each store are recorded and checked; without it they are a few. How
//! the operating system schedules the processes differs from run to run, and so do the histories; that they are
//! linearizable does not.

mod clients;
mod linearizability;
mod model;
mod service;

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Duration;

use tempfile::tempdir;
use tokio::time::sleep;

use crate::common::kill::Random;
use crate::common::postgres::Cluster;
use crate::common::process::Process;
use clients::{Load, Recorder};
use linearizability::{Call, History};
use service::{Fault, Service};

/// What is asked for between two starts of the processes.
const LOAD: Load = Load { contacts: 3, clients: 5, operations: 50, losses: true };
/// Accidents in that time.
const ACCIDENTS: u64 = 10;
/// Histories of each store, unless the environment says otherwise.
const HISTORIES: usize = 20;

/// What happens to a process, or to its connections.
#[derive(Clone, Copy, Debug)]
enum Accident {
    Kill,
    Freeze,
    LostDatabaseConnections,
}

/// What has been recorded.
#[derive(Debug, Default)]
struct Figures {
    histories: usize,
    contradictions: usize,
    operations: usize,
    unknown_changes: usize,
    kills: usize,
    freezes: usize,
    lost_database_connections: usize,
}

fn wanted() -> usize {
    let text = std::env::var("STICKSLIP_HISTORIES").ok();
    text.map_or(HISTORIES, |text| text.parse().expect("STICKSLIP_HISTORIES is a number"))
}

/// Lets accidents happen to the processes, at fixed shares of the work.
async fn accidents(
    recorder: &Recorder,
    store: &str,
    processes: &mut [Option<Process>],
    accidents: &[Accident],
    figures: &mut Figures,
    random: &mut Random,
) {
    for number in 1..=ACCIDENTS {
        while recorder.done.load(Ordering::Relaxed) < recorder.requests() * number / (ACCIDENTS + 1) {
            sleep(Duration::from_millis(1)).await;
        }
        sleep(Duration::from_micros(random.below(5_000))).await;
        let victim = random.below(processes.len() as u64) as usize;
        match accidents[random.below(accidents.len() as u64) as usize] {
            Accident::Kill => {
                processes[victim].take().unwrap().kill().await;
                let process = Process::start(store).await;
                recorder.service.replicas.lock().unwrap()[victim] = process.client.clone();
                processes[victim] = Some(process);
                figures.kills += 1;
            }
            Accident::Freeze => {
                let process = processes[victim].as_ref().unwrap();
                process.signal("STOP");
                sleep(Duration::from_micros(random.below(30_000))).await;
                process.signal("CONT");
                figures.freezes += 1;
            }
            Accident::LostDatabaseConnections => {
                let database = store.rsplit_once('/').unwrap().1;
                let end = format!(
                    "SELECT pg_terminate_backend(pid) FROM pg_stat_activity
                     WHERE application_name = 'stickslip' AND datname = '{database}'"
                );
                Cluster::shared().execute("postgres", &end).await;
                figures.lost_database_connections += 1;
            }
        }
    }
}

/// What several clients see of these processes over a store.
async fn record(
    store: &str,
    processes: &mut [Option<Process>],
    kinds: &[Accident],
    figures: &mut Figures,
    seed: u64,
) -> Arc<Recorder> {
    let replicas = processes.iter().map(|process| process.as_ref().unwrap().client.clone()).collect();
    let recorder = Arc::new(Recorder::start(Service::new(replicas, None), LOAD, seed).await);
    let mut random = Random(!seed);
    let happens = accidents(&recorder, store, processes, kinds, figures, &mut random);
    futures::join!(recorder.work(), happens);
    recorder.read_all().await;
    recorder
}

/// Records histories on so many processes over a store, and checks each.
async fn are_linearizable(store: &str, processes: usize, kinds: &[Accident]) {
    let mut figures = Figures::default();
    let mut running = Vec::new();
    for _ in 0..processes {
        running.push(Some(Process::start(store).await));
    }
    for seed in 1.. {
        if figures.histories >= wanted() {
            break;
        }
        let recorder = record(store, &mut running, kinds, &mut figures, seed).await;
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
    println!("{figures:?}");
    assert_eq!(figures.contradictions, 0, "histories are not linearizable");
    assert!(figures.unknown_changes > 0 && figures.freezes + figures.kills > 0, "nothing was lost: {figures:?}");
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
    let store = Cluster::shared().database().await;
    let kinds =
        [Accident::Kill, Accident::Freeze, Accident::Freeze, Accident::Freeze, Accident::LostDatabaseConnections];
    are_linearizable(&store, 2, &kinds).await;
}

#[tokio::test(flavor = "multi_thread")]
async fn histories_on_a_file_are_linearizable() {
    let folder = tempdir().unwrap();
    let store = format!("sqlite:{}", folder.path().join("order.db").display());
    are_linearizable(&store, 1, &[Accident::Kill, Accident::Freeze]).await;
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
