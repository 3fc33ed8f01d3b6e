//! `stickslip check`: it finds every kind of damage, and none in a sound store.

use crate::common;
use crate::fixtures::{JOB_LIMITS, LEASE, along, job, keyed, url};

use std::fs;
use std::process::Output;

use common::kill::Random;
use common::place::Place;
use common::postgres::Cluster;
use common::process::Process;
use common::{create, run};
use stickslip::store::{ChunkResult, Job};
use stickslip_wire::client::{Client, Options};
use stickslip_wire::{ForkRequest, Move};
use tempfile::tempdir;
use uuid::Uuid;

fn check(store: &str, more: &[&str]) -> Output {
    run(&[&["check", "--store", store], more].concat())
}

fn is_sound(store: &str, summary: &str) {
    let output = check(store, &[]);
    let said = String::from_utf8(output.stdout).unwrap();
    assert_eq!((output.status.code(), said.lines().count()), (Some(0), 1), "{said}");
    assert!(said.starts_with(summary), "{said}");
}

/// It finds what is wrong, each in a line that has these words, and nothing else.
fn is_found(store: &str, findings: &[&str]) {
    let output = check(store, &[]);
    let said = String::from_utf8(output.stdout).unwrap();
    assert_eq!((output.status.code(), said.lines().count()), (Some(1), findings.len() + 1), "{findings:?}: {said}");
    for (finding, line) in findings.iter().zip(said.lines()) {
        assert!(line.contains(finding), "{finding}: {said}");
    }
    let counted = if findings.len() == 1 { "1 finding".to_owned() } else { format!("{} findings", findings.len()) };
    assert!(said.trim_end().ends_with(&format!(": {counted}")), "{said}");
}

/// Sessions with all kinds of moves: one has a snapshot, one is a fork of it, one has a reply kept for retries, and one
/// has never moved. Returns their identifiers.
async fn fill(client: &Client) -> [Uuid; 4] {
    let options = Options::default();
    let mut random = Random(7);
    let new = async || client.create(&create(), &options).await.unwrap().id;
    let (long, retried, still) = (new().await, new().await, new().await);
    for _ in 0..6 {
        let moves = (0..2_000).map(|_| random.step()).collect();
        client.path(long, &along(moves), &options).await.unwrap();
    }
    let fork = client.fork(long, &ForkRequest::default(), &options).await.unwrap().id;
    client.apply(fork, &Move::displacement(1e-9).into(), &options).await.unwrap();
    for number in 0..20 {
        client.apply(retried, &random.step().into(), &keyed(number)).await.unwrap();
    }
    // A database may change -0.0.
    client.apply(still, &Move::displacement(-0.0).into(), &options).await.unwrap();
    [long, fork, retried, still]
}

/// A statement that does damage, and the words of what is found then.
type Damage = (String, Vec<&'static str>);

/// Finds each damage in a copy of a place that nobody uses.
async fn are_found(place: &Place, damages: Vec<Damage>) {
    for (statement, findings) in damages {
        let copy = place.copy().await;
        copy.change(&statement).await;
        is_found(&copy.url(), &findings);
    }
}

#[tokio::test]
async fn every_kind_of_damage_is_found() {
    for place in Place::both().await {
        let server = Process::start(&place.url()).await;
        let [long, fork, keyed, still] = fill(&server.client).await;
        place.has_snapshot().await;
        // Beside the service, and of what it has left.
        is_sound(&place.url(), "checked 4 contacts, 24022 moves, ");
        server.stop().await;
        let bytes = || place.path().map(|path| fs::read(path).unwrap());
        let before = bytes();
        is_sound(&place.url(), "checked 4 contacts, 24022 moves, ");
        assert!(bytes() == before, "to check a file changes it");

        let of = |id: Uuid| format!("contact = {}", place.key("contacts", id));
        let moves = |what: &str, id: Uuid, sequence: u64| {
            format!("UPDATE moves SET {what} WHERE {} AND sequence = {sequence}", of(id))
        };
        let lost = |id: Uuid, which: &str| format!("DELETE FROM moves WHERE {} AND sequence {which}", of(id));
        let snapshot = |what: &str| format!("UPDATE snapshots SET {what} WHERE {}", of(long));
        let (target, zero, blob, last, unowned) = match place {
            Place::File(_) => {
                let unowned = vec!["the moves of contact number", "the snapshot of contact number"];
                ("to", "negative_zeros = 1 << 6", "blob", "move 20 was acknowledged, and the last one stored", unowned)
            }
            Place::Database(_) => ("target", "force = '-0'", "bytea", "missing", vec!["but the contact is not"]),
        };
        let target = format!(
            "{target}_force = 9e9, {target}_displacement = NULL, {target}_indentation = NULL, relative = {}",
            place.path().map_or("false", |_| "0")
        );
        let damages = vec![
            (moves("force = force * (1 + 2.3e-16)", keyed, 3), vec!["move 3 is recorded with force"]),
            (moves("force = -force", keyed, 3), vec!["move 3 is recorded with force"]),
            (moves("regime = 'separated'", still, 1), vec!["regime Separated instead of Stick"]),
            (moves(zero, still, 1), vec!["move 1 is recorded with force -0e0 instead of 0e0"]),
            (moves(&target, keyed, 20), vec!["move 20 cannot be made"]),
            (lost(long, "= 77"), vec!["move 77 is missing"]),
            (lost(keyed, "= 20"), vec![last]),
            (lost(keyed, "> 0"), vec![last]),
            (snapshot(&format!("state = CAST('damaged' AS {blob})")), vec!["its snapshot of move"]),
            // A valid state, but not that of this move.
            (snapshot("sequence = sequence - 1"), vec!["is not the state after that move"]),
            (snapshot("sequence = 90000"), vec!["its snapshot is of move 90000, and the last one stored is 12000"]),
            (
                format!("UPDATE contacts SET definition = replace(definition, '0.3', '0.2') WHERE id = '{keyed}'"),
                vec!["move ", "move ", "move ", "move ", "move ", "further moves differ"],
            ),
            (format!("DELETE FROM contacts WHERE id = '{fork}'"), unowned),
        ];
        are_found(&place, damages).await;
        // A tolerance forgives digits, and nothing else.
        let copy = place.copy().await;
        copy.change(&moves("force = force * (1 + 1e-13)", keyed, 3)).await;
        for (tolerance, code) in [("1e-12", 0), ("1e-14", 1)] {
            assert_eq!(check(&copy.url(), &["--tolerance", tolerance]).status.code(), Some(code));
        }
        // A page of the file that is overwritten.
        if let (Some(mut bytes), Some(path)) = (before, copy.path()) {
            let middle = bytes.len() / 2 / 4096 * 4096;
            bytes[middle..middle + 4096].fill(0x5a);
            fs::write(path, bytes).unwrap();
            assert_eq!(check(&copy.url(), &[]).status.code(), Some(1));
        }
    }
}

#[tokio::test]
async fn damaged_jobs_are_found() {
    for place in Place::both().await {
        // One is done, and of the other the first chunk is.
        let store = place.open().await;
        let (done, begun) = (Job { points: 3, ..job("") }, job(""));
        for job in [&done, &begun] {
            store.create_job(job.clone(), "{}".to_owned(), JOB_LIMITS, None).await.unwrap();
            let claim = store.claim(Uuid::now_v7(), None, LEASE).await.unwrap().unwrap();
            assert_eq!(claim.job, job.id);
            store.save_chunk(claim, ChunkResult { points: 3, failed: 1, content: vec![0; 24] }).await.unwrap();
        }
        drop(store);
        is_sound(&place.url(), "checked 0 contacts");
        let set = |what: &str, job: &Job| format!("UPDATE jobs SET {what} WHERE id = '{}'", job.id);
        let chunks = format!("job = {}", place.key("jobs", done.id));
        let mut damages = vec![
            (set("done = 4", &begun), vec!["4 points are counted as done, and 3 are stored"]),
            (set("failed = 4", &begun), vec!["of 3 points 4 have no answer"]),
            (set("finished_at = NULL", &done), vec!["all of its points are done, and it has not ended"]),
            (set("finished_at = created_at", &begun), vec!["it has ended at 3 of 7 points without an error"]),
            (format!("DELETE FROM job_chunks WHERE {chunks}"), vec!["3 points are counted as done, and 0 are stored"]),
        ];
        match place {
            Place::File(_) => damages.extend([
                (set("request = 'x'", &done), vec!["its request is not JSON"]),
                (format!("UPDATE job_chunks SET chunk = 9 WHERE {chunks}"), vec!["3 points", "beyond its 3"]),
                (format!("DELETE FROM jobs WHERE id = '{}'", done.id), vec!["belongs to no job"]),
            ]),
            Place::Database(_) => damages.last_mut().unwrap().1.push("it has 0 chunks for 3 points"),
        }
        are_found(&place, damages).await;
    }
}

#[tokio::test]
async fn what_cannot_be_checked_is_refused_in_one_line() {
    let folder = tempdir().unwrap();
    let (missing, empty) = (url(&folder.path().join("missing.db")), Cluster::shared().database().await);
    for (store, why) in [
        (&*empty, "schema"),
        ("memory:", "only in the process"),
        (&*missing, "No such file"),
        ("postgres://me:secret@127.0.0.1:1/x", "127.0.0.1"),
    ] {
        let output = check(store, &[]);
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!((output.status.code(), said.lines().count()), (Some(1), 1), "{said}");
        assert!(said.contains(why) && !said.contains("secret") && output.stdout.is_empty(), "{said}");
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}
