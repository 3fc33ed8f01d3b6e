//! A disk without room: changes are refused, nothing acknowledged is lost, and the service resumes by itself.

use crate::common;
use crate::fixtures::{along, keyed};

use common::kill::{Random, exact, history, replays_to_the_last_bit};
use common::process::Process;
use common::small_disk::SmallDisk;
use common::{Server, create, problem, until};
use futures::future::join_all;
use stickslip_wire::client::{Client, Error, Options};
use stickslip_wire::{Move, MoveReply};
use tempfile::tempdir;
use uuid::Uuid;

/// Bytes of the disk.
const SIZE: usize = 3 << 20;
/// Bytes that are left when it is almost full.
const ROOM: u64 = 300 << 10;

fn refusal(error: &Error) -> (u16, &str) {
    let problem = error.problem().unwrap_or_else(|| panic!("{error}"));
    (problem.status, &problem.code)
}

async fn apply(client: &Client, id: Uuid, step: Move, key: u64) -> Result<MoveReply, Error> {
    client.apply(id, &step.into(), &keyed(key)).await
}

#[tokio::test(flavor = "multi_thread")]
async fn a_full_disk_refuses_changes_and_loses_none() {
    let disk = SmallDisk::new(SIZE);
    let store = format!("sqlite:{}", disk.folder.path().join("full.db").display());
    let process = Process::start_by(&disk.entrance(), &store).await;
    let client = process.client.clone();
    let mut sessions = Vec::new();
    for _ in 0..8 {
        sessions.push(client.create(&create(), &Options::default()).await.unwrap().id);
    }
    disk.fill(ROOM);

    // A change that is too large for the remaining space does not block smaller ones.
    let moves = (0..5_000).map(|index| Move::displacement(f64::from(index % 2) * 1e-8)).collect();
    let long = along(moves);
    let (plain, first) = (Options::default(), sessions[0]);
    let (path, beside) =
        futures::join!(client.path(first, &long, &plain), apply(&client, sessions[1], Move::force(0.1), 0));
    assert_eq!(refusal(&path.unwrap_err()), (507, "storage_full"));
    let mut acknowledged = vec![Vec::new(); sessions.len()];
    acknowledged[1].push(beside.unwrap().state);

    let (mut random, mut key) = (Random(8), 0);
    let refused = loop {
        let steps: Vec<Move> = sessions.iter().map(|_| random.step()).collect();
        let calls = sessions.iter().zip(&steps).zip(key + 1..).map(|((id, step), key)| apply(&client, *id, *step, key));
        let mut refused = Vec::new();
        for (index, outcome) in join_all(calls).await.into_iter().enumerate() {
            match outcome {
                Ok(reply) => {
                    acknowledged[index].push(reply.state);
                    assert_eq!(reply.sequence, acknowledged[index].len() as u64);
                }
                Err(error) => {
                    assert_eq!(refusal(&error), (507, "storage_full"));
                    refused.push((index, steps[index], key + 1 + index as u64));
                }
            }
        }
        if refused.len() == sessions.len() {
            break refused;
        }
        key += sessions.len() as u64;
    };
    // A new contact may need less room than a move with its receipt, but not for ever.
    let unborn = loop {
        if let Err(error) = client.create(&create(), &plain).await {
            break error;
        }
    };
    assert_eq!(refusal(&unborn), (507, "storage_full"));
    let server = Server::at(&process.base);
    let ready = async |expected: u16| (server.get("/readyz").await.status() == expected).then_some(());
    until("it is not ready", async || ready(507).await).await;
    assert_eq!(problem(server.get("/readyz").await).await.code, "storage_full");
    for (id, acknowledged) in sessions.iter().zip(&acknowledged) {
        let past: Vec<_> = history(&client, *id).await.iter().map(|item| exact(&item.state)).collect();
        assert_eq!(past, acknowledged.iter().map(exact).collect::<Vec<_>>());
    }

    disk.clear();
    until("it is ready again", async || ready(200).await).await;
    for (index, step, key) in refused {
        let reply = apply(&client, sessions[index], step, key).await.unwrap();
        acknowledged[index].push(reply.state);
        assert_eq!(reply.sequence, acknowledged[index].len() as u64);
    }
    process.kill().await;
    let process = Process::start_by(&disk.entrance(), &store).await;
    for (id, acknowledged) in sessions.iter().zip(&acknowledged) {
        let past = history(&process.client, *id).await;
        assert_eq!(
            past.iter().map(|item| exact(&item.state)).collect::<Vec<_>>(),
            acknowledged.iter().map(exact).collect::<Vec<_>>()
        );
        replays_to_the_last_bit(&past);
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn a_disk_that_is_full_at_start_is_read() {
    for gracefully in [true, false] {
        let disk = SmallDisk::new(SIZE);
        let store = format!("sqlite:{}", disk.folder.path().join("full.db").display());
        let process = Process::start_by(&disk.entrance(), &store).await;
        let id = process.client.create(&create(), &Options::default()).await.unwrap().id;
        let step = apply(&process.client, id, Move::force(0.1), 0).await.unwrap();
        if gracefully {
            process.stop().await;
        } else {
            process.kill().await;
        }
        disk.fill(0);
        let process = Process::start_by(&disk.entrance(), &store).await;
        assert_eq!(exact(&process.client.contact(id).await.unwrap().state), exact(&step.state));
        let server = Server::at(&process.base);
        if gracefully {
            assert_eq!(
                refusal(&apply(&process.client, id, Move::force(0.2), 1).await.unwrap_err()),
                (507, "storage_full")
            );
            assert_eq!(problem(server.get("/readyz").await).await.code, "storage_full");
        }
        process.stop().await;
        disk.clear();
        let process = Process::start_by(&disk.entrance(), &store).await;
        assert_eq!(apply(&process.client, id, Move::force(0.2), 1).await.unwrap().sequence, 2);
    }
}

/// A mark that does not fit on the disk leaves the log, without which the file would be refused.
#[tokio::test(flavor = "multi_thread")]
async fn a_stop_on_a_full_disk_leaves_a_store_that_starts_again() {
    for room in [0, 4 << 10, 8 << 10, 16 << 10, 64 << 10] {
        let disk = SmallDisk::new(SIZE);
        let store = format!("sqlite:{}", disk.folder.path().join("full.db").display());
        let process = Process::start_by(&disk.entrance(), &store).await;
        let id = process.client.create(&create(), &Options::default()).await.unwrap().id;
        disk.fill(room);
        let mut acknowledged = 0;
        while let Ok(reply) = apply(&process.client, id, Move::force(0.1), acknowledged).await {
            acknowledged = reply.sequence;
        }
        process.stop().await;
        disk.clear();
        let process = Process::start_by(&disk.entrance(), &store).await;
        assert_eq!(process.client.contact(id).await.unwrap().sequence, acknowledged, "{room}");
        process.stop().await;
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn a_limit_of_the_size_of_files_is_like_a_full_disk() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("limited.db");
    let limited = ["sh", "-c", r#"ulimit -f 1024; exec "$0" "$@""#].map(str::to_owned);
    let process = Process::start_by(&limited, &format!("sqlite:{}", path.display())).await;
    let (client, options) = (&process.client, Options::default());
    let id = client.create(&create(), &options).await.unwrap().id;
    let moves = || along((0..1_000).map(|index| Move::displacement(f64::from(index % 2) * 1e-8)).collect());
    let mut acknowledged = 0;
    let refused = loop {
        match client.path(id, &moves(), &options).await {
            Ok(reply) => acknowledged = reply.sequence,
            Err(error) => break error,
        }
    };
    assert_eq!(refusal(&refused), (507, "storage_full"));
    assert!(acknowledged > 0);
    assert_eq!(client.contact(id).await.unwrap().sequence, acknowledged);
    process.kill().await;
    let process = Process::start(&format!("sqlite:{}", path.display())).await;
    assert_eq!(process.client.path(id, &moves(), &options).await.unwrap().sequence, acknowledged + 1_000);
}
