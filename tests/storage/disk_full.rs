//! A disk without room: changes are refused, nothing acknowledged is lost, and the service resumes by itself.

use crate::common;
use crate::fixtures::{along, keyed};

use std::fs::File;
use std::io::{BufRead as _, BufReader, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use common::create;
use common::kill::{Random, exact, history, replays_to_the_last_bit};
use common::process::Process;
use futures::future::join_all;
use stickslip_wire::client::{Client, Error, Options};
use stickslip_wire::{Move, MoveReply};
use tempfile::{TempDir, tempdir};
use uuid::Uuid;

/// Bytes of the disk.
const SIZE: usize = 3 << 20;
/// Bytes that are left when it is almost full.
const ROOM: u64 = 300 << 10;

/// A disk of its own kind: a tmpfs in a mount namespace, which a process keeps alive. No rights are needed where user
/// namespaces are allowed.
struct SmallDisk {
    keeper: Child,
    folder: TempDir,
}

impl SmallDisk {
    fn new() -> SmallDisk {
        let folder = tempdir().unwrap();
        let script = r#"mount -t tmpfs -o size="$1" tmpfs "$0" && echo mounted && exec sleep 600"#;
        let mut keeper = Command::new("unshare")
            .args(["--map-root-user", "--mount", "sh", "-c", script])
            .arg(folder.path())
            .arg(SIZE.to_string())
            .stdout(Stdio::piped())
            .spawn()
            .expect("unshare (util-linux) is needed to mount a small disk");
        let mut line = String::new();
        BufReader::new(keeper.stdout.take().unwrap()).read_line(&mut line).unwrap();
        assert_eq!(line.trim(), "mounted", "this test mounts a small disk, and may not");
        SmallDisk { keeper, folder }
    }

    /// The prefix of a command that is to see the disk.
    fn entrance(&self) -> Vec<String> {
        let keeper = self.keeper.id().to_string();
        ["nsenter", "--preserve-credentials", "--user", "--mount", "--target", &keeper].map(str::to_owned).to_vec()
    }

    /// A file on the disk, as it is seen from outside.
    fn file(&self, name: &str) -> PathBuf {
        let root = PathBuf::from(format!("/proc/{}/root", self.keeper.id()));
        root.join(self.folder.path().strip_prefix(Path::new("/")).unwrap()).join(name)
    }

    /// Leaves this many bytes free.
    fn fill(&self, room: u64) {
        let mut filler = File::create(self.file("filler")).unwrap();
        while filler.write_all(&[1; 4096]).is_ok() {}
        let length = filler.metadata().unwrap().len();
        filler.set_len(length - room).unwrap();
    }

    fn clear(&self) {
        std::fs::remove_file(self.file("filler")).unwrap();
    }
}

impl Drop for SmallDisk {
    fn drop(&mut self) {
        let _ = self.keeper.kill();
        let _ = self.keeper.wait();
    }
}

fn refusal(error: &Error) -> (u16, &str) {
    let problem = error.problem().unwrap_or_else(|| panic!("{error}"));
    (problem.status, &problem.code)
}

async fn apply(client: &Client, id: Uuid, step: Move, key: u64) -> Result<MoveReply, Error> {
    client.apply(id, &step.into(), &keyed(key)).await
}

#[tokio::test(flavor = "multi_thread")]
async fn a_full_disk_refuses_changes_and_loses_none() {
    let disk = SmallDisk::new();
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
    for (id, acknowledged) in sessions.iter().zip(&acknowledged) {
        let past: Vec<_> = history(&client, *id).await.iter().map(|item| exact(&item.state)).collect();
        assert_eq!(past, acknowledged.iter().map(exact).collect::<Vec<_>>());
    }

    disk.clear();
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
