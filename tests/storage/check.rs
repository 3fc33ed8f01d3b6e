//! `stickslip check`: it finds every kind of damage, and none in a sound store.

use crate::common;
use crate::fixtures::{along, url};

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;
use std::time::Duration;

use common::kill::{PATIENCE, Random};
use common::postgres::Cluster;
use common::process::Process;
use common::{create, run};
use jiff::Timestamp;
use rusqlite::Connection;
use stickslip::store::{ChunkResult, Job, JobLimits, PostgresStore, SqliteStore, Store, Tenant};
use stickslip_wire::client::{Client, Options};
use stickslip_wire::{ForkRequest, Move};
use tempfile::{TempDir, tempdir};
use uuid::Uuid;

async fn check(store: &str, more: &[&str]) -> Output {
    let arguments: Vec<String> =
        ["check", "--store", store].iter().chain(more).map(|word| (*word).to_owned()).collect();
    let run = move || run(&arguments.iter().map(String::as_str).collect::<Vec<_>>());
    tokio::task::spawn_blocking(run).await.unwrap()
}

async fn is_sound(store: &str, summary: &str) {
    let output = check(store, &[]).await;
    let said = String::from_utf8(output.stdout).unwrap();
    assert_eq!((output.status.code(), said.lines().count()), (Some(0), 1), "{said}");
    assert!(said.starts_with(summary), "{said}");
}

/// It finds what is wrong, each in a line that has these words, and nothing else.
async fn is_found(store: &str, findings: &[&str]) {
    let output = check(store, &[]).await;
    let said = String::from_utf8(output.stdout).unwrap();
    assert_eq!((output.status.code(), said.lines().count()), (Some(1), findings.len() + 1), "{findings:?}: {said}");
    for (finding, line) in findings.iter().zip(said.lines()) {
        assert!(line.contains(finding), "{finding}: {said}");
    }
    assert!(said.lines().last().unwrap().contains(&format!("{} findings", findings.len())), "{said}");
}

/// Sessions with all kinds of moves: one has a snapshot, one is a fork of it, one has a reply kept for retries, and one
/// has never moved. Returns their identifiers.
async fn fill(client: &Client) -> [Uuid; 4] {
    let options = Options::default();
    let mut random = Random(7);
    let new = async || client.create(&create(), &options).await.unwrap().id;
    let (long, keyed, still) = (new().await, new().await, new().await);
    for _ in 0..6 {
        let moves = (0..2_000).map(|_| random.step()).collect();
        client.path(long, &along(moves), &options).await.unwrap();
    }
    let fork = client.fork(long, &ForkRequest::default(), &options).await.unwrap().id;
    client.apply(fork, &Move::displacement(1e-9).into(), &options).await.unwrap();
    for number in 0..20 {
        let options =
            Options { idempotency_key: Some(format!("move {number}").replace(' ', "-")), ..Options::default() };
        client.apply(keyed, &random.step().into(), &options).await.unwrap();
    }
    // A database may change -0.0.
    client.apply(still, &Move::displacement(-0.0).into(), &options).await.unwrap();
    [long, fork, keyed, still]
}

/// Waits until statements find a snapshot.
async fn has_snapshot(path: &Path) {
    let database = Connection::open_with_flags(path, rusqlite::OpenFlags::SQLITE_OPEN_READ_ONLY).unwrap();
    let there = async {
        while !database.prepare("SELECT 1 FROM snapshots").unwrap().exists([]).unwrap() {
            tokio::time::sleep(Duration::from_millis(10)).await;
        }
    };
    tokio::time::timeout(PATIENCE, there).await.expect("no snapshot was kept");
}

/// A sound file that no process uses.
async fn sound(folder: &TempDir) -> (PathBuf, [Uuid; 4]) {
    let path = folder.path().join("sound.db");
    let server = Process::start(&url(&path)).await;
    let ids = fill(&server.client).await;
    has_snapshot(&path).await;
    is_sound(&url(&path), "checked 4 contacts, 24022 moves, ").await;
    server.stop().await;
    (path, ids)
}

#[tokio::test]
async fn every_kind_of_damage_is_found_in_a_file() {
    let folder = tempdir().unwrap();
    let (path, [long, fork, keyed, still]) = sound(&folder).await;
    let before = fs::read(&path).unwrap();
    is_sound(&url(&path), "checked 4 contacts, 24022 moves, ").await;
    assert!(fs::read(&path).unwrap() == before, "to check a file changes it");

    let number = |id: Uuid| format!("(SELECT number FROM contacts WHERE id = '{id}')");
    let (long_number, keyed_number, still_number) = (number(long), number(keyed), number(still));
    let force = |to: &str| format!("UPDATE moves SET force = {to} WHERE contact = {keyed_number} AND sequence = 3");
    // The snapshot of another session is a valid state, but not of this session.
    let swap = format!("UPDATE snapshots SET sequence = sequence - 1 WHERE contact = {long_number}");
    let damages: [(&str, String, &[&str]); 13] = [
        ("a force by one bit", force("force * (1 + 2.3e-16)"), &["move 3 is recorded with force"]),
        ("a lost sign", force("-force"), &["move 3 is recorded with force"]),
        (
            "a regime",
            format!("UPDATE moves SET regime = 'separated' WHERE contact = {still_number}"),
            &["regime Separated instead of Stick"],
        ),
        (
            "the sign of zero",
            format!("UPDATE moves SET negative_zeros = 1 << 6 WHERE contact = {still_number}"),
            &["move 1 is recorded with force -0e0 instead of 0e0"],
        ),
        (
            "a target",
            format!(
                "UPDATE moves SET to_force = 9e9, to_displacement = NULL, to_indentation = NULL, relative = 0
                 WHERE contact = {keyed_number} AND sequence = 20"
            ),
            &["move 20 cannot be made"],
        ),
        (
            "a move in the middle",
            format!("DELETE FROM moves WHERE contact = {long_number} AND sequence = 77"),
            &["move 77 is missing"],
        ),
        (
            "the last move",
            format!("DELETE FROM moves WHERE contact = {keyed_number} AND sequence = 20"),
            &["move 20 was acknowledged, and the last one stored is 19"],
        ),
        (
            "all moves",
            format!("DELETE FROM moves WHERE contact = {keyed_number}"),
            &["move 20 was acknowledged, and the last one stored is 0"],
        ),
        (
            "a damaged snapshot",
            format!("UPDATE snapshots SET state = zeroblob(500) WHERE contact = {long_number}"),
            &["its snapshot of move", ""],
        ),
        ("a wrong snapshot", swap, &["is not the state after that move", ""]),
        (
            "a snapshot of the future",
            format!("UPDATE snapshots SET sequence = 90000 WHERE contact = {long_number}"),
            &["its snapshot is of move 90000, and the last one stored is 12000", ""],
        ),
        (
            "a definition",
            format!("UPDATE contacts SET definition = replace(definition, '0.3', '0.2') WHERE id = '{keyed}'"),
            &["move ", "move ", "move ", "move ", "move ", "further moves differ"],
        ),
        ("a contact", format!("DELETE FROM contacts WHERE id = '{fork}'"), &["the moves of contact number"]),
    ];
    for (what, statement, findings) in damages {
        let copy = folder.path().join("damaged.db");
        fs::copy(&path, &copy).unwrap();
        let database = Connection::open(&copy).unwrap();
        database.pragma_update(None, "foreign_keys", true).unwrap();
        assert!(database.execute(&statement, []).unwrap() > 0, "{what}");
        database.close().unwrap();
        // Forks take the snapshot of the original along, which the damage did not touch.
        let findings: Vec<&str> = findings.iter().copied().filter(|finding| !finding.is_empty()).collect();
        is_found(&url(&copy), &findings).await;
    }

    // A tolerance forgives digits, and nothing else.
    let copy = folder.path().join("digits.db");
    fs::copy(&path, &copy).unwrap();
    Connection::open(&copy).unwrap().execute(&force("force * (1 + 1e-13)"), []).unwrap();
    assert_eq!(check(&url(&copy), &["--tolerance", "1e-12"]).await.status.code(), Some(0));
    assert_eq!(check(&url(&copy), &["--tolerance", "1e-14"]).await.status.code(), Some(1));

    // A page of the file that is overwritten.
    let mut bytes = fs::read(&path).unwrap();
    let middle = bytes.len() / 2 / 4096 * 4096;
    bytes[middle..middle + 4096].fill(0x5a);
    fs::write(&copy, bytes).unwrap();
    assert_eq!(check(&url(&copy), &[]).await.status.code(), Some(1));
}

#[tokio::test]
async fn damage_is_found_in_a_database_beside_its_service() {
    let store = Cluster::shared().database().await;
    let name = store.rsplit('/').next().unwrap();
    let empty = check(&store, &[]).await;
    assert_eq!((empty.status.code(), empty.stdout.len()), (Some(1), 0), "{empty:?}");
    let server = Process::start(&store).await;
    let [long, fork, keyed, still] = fill(&server.client).await;
    is_sound(&store, "checked 4 contacts, 24022 moves, ").await;

    let force = "UPDATE moves SET force = force + 1e-16 WHERE contact";
    Cluster::shared().execute(name, &format!("{force} = '{keyed}' AND sequence = 3")).await;
    is_found(&store, &["move 3 is recorded with force"]).await;
    Cluster::shared().execute(name, &format!("DELETE FROM moves WHERE contact = '{long}' AND sequence = 12000")).await;
    Cluster::shared().execute(name, &format!("DELETE FROM moves WHERE contact = '{still}'")).await;
    let missing = ["missing", "move 3", "missing"];
    let mut ordered = [(long, missing[0]), (keyed, missing[1]), (still, missing[2])];
    ordered.sort();
    is_found(&store, &ordered.map(|(_, words)| words)).await;
    Cluster::shared().execute(name, &format!("DELETE FROM contacts WHERE id = '{fork}'")).await;
    let words: Vec<&str> = ["but the contact is not"].into_iter().chain(ordered.map(|(_, words)| words)).collect();
    is_found(&store, &words).await;
    server.stop().await;
}

/// Two jobs: one is done, and of the other the first chunk is.
async fn fill_jobs(store: &dyn Store) -> [Uuid; 2] {
    let new = |points| Job {
        id: Uuid::now_v7(),
        tenant: Tenant::default(),
        created_at: Timestamp::now(),
        finished_at: None,
        error: None,
        points,
        chunk: 3,
        done: 0,
        failed: 0,
        bytes: 10,
        cost: 10,
    };
    let (done, begun, limits) = (new(3), new(7), JobLimits { jobs: 2, bytes: 20, cost: 20 });
    for job in [&done, &begun] {
        store.create_job(job.clone(), "{}".to_owned(), limits, None).await.unwrap();
        let claim = store.claim(Uuid::now_v7(), None, Duration::from_secs(600)).await.unwrap().unwrap();
        assert_eq!(claim.job, job.id);
        store.save_chunk(claim, ChunkResult { points: 3, failed: 1, content: vec![0; 24] }).await.unwrap();
    }
    [done.id, begun.id]
}

/// Statements that damage a job, and the words of what is found then.
fn damaged_jobs(done: Uuid, begun: Uuid, chunks_of: impl Fn(Uuid) -> String) -> Vec<(String, Vec<&'static str>)> {
    let job = |what: &str, id| format!("UPDATE jobs SET {what} WHERE id = '{id}'");
    let lost = format!("DELETE FROM job_chunks WHERE {}", chunks_of(done));
    vec![
        (job("done = 4", begun), vec!["4 points are counted as done, and 3 are stored"]),
        (job("failed = 4", begun), vec!["of 3 points 4 have no answer"]),
        (job("finished_at = NULL", done), vec!["all of its points are done, and it has not ended"]),
        (job("finished_at = created_at", begun), vec!["it has ended at 3 of 7 points without an error"]),
        (lost, vec!["3 points are counted as done, and 0 are stored"]),
    ]
}

#[tokio::test]
async fn damaged_jobs_are_found() {
    let folder = tempdir().unwrap();
    let (path, copy) = (folder.path().join("jobs.db"), folder.path().join("copy.db"));
    let store = SqliteStore::open(&path).unwrap();
    let [done, begun] = fill_jobs(&store).await;
    drop(store);
    is_sound(&url(&path), "checked 0 contacts").await;
    let number = |id: Uuid| format!("job = (SELECT number FROM jobs WHERE id = '{id}')");
    let mut damages = damaged_jobs(done, begun, number);
    damages.push((format!("UPDATE jobs SET request = 'x' WHERE id = '{done}'"), vec!["its request is not JSON"]));
    damages.push((format!("UPDATE job_chunks SET chunk = 9 WHERE {}", number(done)), vec!["3 points", "beyond its 3"]));
    damages.push((format!("DELETE FROM jobs WHERE id = '{done}'"), vec!["belongs to no job"]));
    for (statement, findings) in damages {
        fs::copy(&path, &copy).unwrap();
        let database = Connection::open(&copy).unwrap();
        database.pragma_update(None, "foreign_keys", false).unwrap();
        assert!(database.execute(&statement, []).unwrap() > 0, "{statement}");
        database.close().unwrap();
        is_found(&url(&copy), &findings).await;
    }

    let url = Cluster::shared().database().await;
    let name = url.rsplit('/').next().unwrap();
    let [done, begun] = fill_jobs(&PostgresStore::open(&url).await.unwrap()).await;
    is_sound(&url, "checked 0 contacts").await;
    for (statement, mut findings) in damaged_jobs(done, begun, |id| format!("job = '{id}'")) {
        if statement.starts_with("DELETE") {
            findings.push("it has 0 chunks for 3 points");
        }
        let kept = "CREATE TABLE kept_jobs AS TABLE jobs; CREATE TABLE kept_chunks AS TABLE job_chunks;";
        Cluster::shared().execute(name, &format!("{kept} {statement}")).await;
        is_found(&url, &findings).await;
        let restored = "DELETE FROM jobs; INSERT INTO jobs TABLE kept_jobs; INSERT INTO job_chunks TABLE kept_chunks;";
        Cluster::shared().execute(name, &format!("{restored} DROP TABLE kept_jobs, kept_chunks")).await;
    }
}

#[tokio::test]
async fn what_cannot_be_checked_is_refused_in_one_line() {
    let folder = tempdir().unwrap();
    let missing = url(&folder.path().join("missing.db"));
    for (store, why) in [
        ("memory:", "only in the process"),
        (&*missing, "No such file"),
        ("postgres://me:secret@127.0.0.1:1/x", "127.0.0.1"),
    ] {
        let output = check(store, &[]).await;
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!((output.status.code(), said.lines().count()), (Some(1), 1), "{said}");
        assert!(said.contains(why) && !said.contains("secret"), "{said}");
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}
