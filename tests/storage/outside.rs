//! What others do to the files of the SQLite store: replaced, removed, lost in a crash, read by strangers.

use crate::common;
use crate::fixtures::url;

use std::fs;
use std::os::unix::fs::{FileExt as _, PermissionsExt as _};
use std::path::{Path, PathBuf};

use common::kill::{exact, history};
use common::process::{Process, refused};
use common::{Server, ball, create, problem, run, until};
use serde_json::json;
use stickslip_wire::client::Options;
use stickslip_wire::{Observation, ObservationsRequest};
use tempfile::tempdir;

fn beside(path: &Path, ending: &str) -> PathBuf {
    format!("{}{ending}", path.display()).into()
}

/// Every change and every question is refused, and the service is not ready.
async fn is_unavailable(server: &Server, id: &str) {
    for (changes, refusal) in [
        (true, server.post(&format!("/contacts/{id}/move"), &json!({"force": 0.3})).await),
        (true, server.post("/contacts", &ball()).await),
        (false, server.get(&format!("/contacts/{id}")).await),
        (false, server.get(&format!("/contacts/{id}/history")).await),
        (
            false,
            server.post(&format!("/contacts/{id}/subsurface"), &json!({"body": "first", "points": [[0, 0, 0]]})).await,
        ),
    ] {
        let refusal = problem(refusal).await;
        assert_eq!(refusal.code, "storage_unavailable");
        // Only a change may have been stored.
        let told = ["may have been stored", "nothing has changed"].map(|text| refusal.detail.contains(text));
        assert_eq!(told, [changes, !changes], "{refusal:?}");
    }
    until("it is not ready", async || (server.get("/readyz").await.status() == 503).then_some(())).await;
}

#[tokio::test]
async fn a_file_that_is_replaced_or_removed_takes_no_more_changes() {
    let folder = tempdir().unwrap();
    let (path, other) = (folder.path().join("mine.db"), folder.path().join("other.db"));
    Process::start(&url(&other)).await.stop().await;
    let process = Process::with(&url(&path), &["--log", "warn"]);
    let server = Server::at(&process.base);
    let id = server.contact().await;
    let force = async |force: f64| server.post(&format!("/contacts/{id}/move"), &json!({"force": force})).await;
    assert_eq!(force(0.1).await.status(), 200);
    let (kept, mut sequence) = (folder.path().join("kept"), 1);
    for (file, replacement) in [("", Some(&other)), ("", None), ("-wal", None), ("-shm", None)] {
        let file = beside(&path, file);
        fs::hard_link(&file, &kept).unwrap();
        match replacement {
            Some(other) => {
                drop(fs::copy(other, beside(&path, ".copy")).and_then(|_| fs::rename(beside(&path, ".copy"), &file)))
            }
            None => fs::remove_file(&file).unwrap(),
        }
        is_unavailable(&server, &id).await;
        // The same file again: nothing was lost, and the service goes on.
        fs::rename(&kept, &file).unwrap();
        sequence += 1;
        let reply: serde_json::Value = force(0.1).await.json().await.unwrap();
        assert_eq!(reply["sequence"], sequence, "{}", file.display());
        until("it is ready again", async || (server.get("/readyz").await.status() == 200).then_some(())).await;
    }
    let lines = process.log();
    assert!(
        lines.contains("mine.db has been replaced or removed") && lines.contains("mine.db-wal has been"),
        "{lines}"
    );

    // At its end the server leaves the files of the other database alone.
    fs::rename(&path, &kept).unwrap();
    fs::copy(&other, &path).unwrap();
    fs::write(beside(&path, "-wal.other"), "the log of another").unwrap();
    fs::rename(beside(&path, "-wal.other"), beside(&path, "-wal")).unwrap();
    process.stop().await;
    assert_eq!(fs::read_to_string(beside(&path, "-wal")).unwrap(), "the log of another");
    assert!(fs::read(&path).unwrap() == fs::read(&other).unwrap());
}

/// The same file, with other bytes: what is acknowledged after that would be lost.
#[tokio::test]
async fn a_file_that_is_overwritten_in_place_takes_no_more_changes() {
    let folder = tempdir().unwrap();
    let (path, copy) = (folder.path().join("mine.db"), folder.path().join("copy.db"));
    for how in 0..4 {
        let process = Process::start(&url(&path)).await;
        let server = Server::at(&process.base);
        let id = server.contact().await;
        let force = async |force: f64| server.post(&format!("/contacts/{id}/move"), &json!({"force": force})).await;
        assert_eq!(force(0.1).await.status(), 200);
        assert!(run(&["backup", copy.to_str().unwrap(), "--store", &url(&path)]).status.success());
        assert_eq!(force(0.2).await.status(), 200);
        let (mut whole, length) = (fs::read(&path).unwrap(), fs::metadata(&path).unwrap().len());
        let file = fs::File::options().write(true).open(&path).unwrap();
        match how {
            0 => drop(fs::copy(&copy, &path).unwrap()),
            1 => file.set_len(length / 2).unwrap(),
            2 => fs::write(&path, vec![0; whole.len()]).unwrap(),
            _ => {
                // An older state of the same file.
                whole[27] = whole[27].wrapping_sub(1);
                file.write_all_at(&whole[..100], 0).unwrap();
            }
        }
        is_unavailable(&server, &id).await;
        let log = fs::read(beside(&path, "-wal")).unwrap();
        process.stop().await;
        assert!(fs::read(beside(&path, "-wal")).unwrap() == log, "the log of another file is cut");
        for file in [&path, &copy, &beside(&path, "-wal"), &beside(&path, "-shm")] {
            fs::remove_file(file).unwrap();
        }
    }
}

#[tokio::test]
async fn a_store_that_is_made_is_a_warning() {
    let folder = tempdir().unwrap();
    let file = url(&folder.path().join("new.db"));
    for is_new in [true, false] {
        let log = Process::with(&file, &["--log", "warn"]).stop().await;
        assert_eq!(log.contains("an empty one has been made"), is_new, "{log}");
    }
}

/// SQLite reads a log up to its first damaged frame: the moves after it would be gone without a word.
#[tokio::test]
async fn acknowledged_commits_behind_damage_in_the_log_are_noticed() {
    let folder = tempdir().unwrap();
    let (path, copy) = (folder.path().join("flipped.db"), folder.path().join("copy.db"));
    let (file, log) = (url(&path), beside(&path, "-wal"));
    let process = Process::start(&file).await;
    let id = process.client.create(&create(), &Options::default()).await.unwrap().id;
    for index in 0..20 {
        let step = stickslip_wire::Move::displacement(f64::from(index) * 1e-9);
        process.client.apply(id, &step.into(), &Options::default()).await.unwrap();
    }
    process.kill().await;
    let whole = fs::read(&log).unwrap();
    let frames = (whole.len() - 32) / 4120;
    // In the header, in a frame and in its header, and in the last frame, which a crash may have torn.
    for (at, is_lost) in
        [(12, true), (32 + 4120 * 3 + 900, true), (32 + 4120 * 4 + 9, true), (32 + 4120 * frames - 9, false)]
    {
        let mut flipped = whole.clone();
        flipped[at] ^= 4;
        fs::write(&log, &flipped).unwrap();
        let said = run(&["check", "--store", &file]);
        assert_eq!(String::from_utf8_lossy(&said.stderr).contains("acknowledged commits"), is_lost, "{at}: {said:?}");
        if is_lost {
            let said = [refused(&file).stderr, run(&["backup", copy.to_str().unwrap(), "--store", &file]).stderr];
            for said in said.map(|said| String::from_utf8(said).unwrap()) {
                assert!(said.contains("flipped.db-wal is damaged at byte"), "{said}");
            }
            assert!(fs::read(&log).unwrap() == flipped && !copy.exists());
        }
    }
    fs::write(&log, &whole).unwrap();
    let process = Process::start(&file).await;
    assert_eq!(process.client.contact(id).await.unwrap().sequence, 20);
}

#[tokio::test]
async fn a_log_that_is_missing_after_a_crash_is_noticed_and_with_it_no_measurement_is_lost() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("crashed.db");
    let log = beside(&path, "-wal");
    let process = Process::start(&url(&path)).await;
    let id = process.client.create(&create(), &Options::default()).await.unwrap().id;
    let at = Some("2026-03-01T12:00:00.000000001Z".parse().unwrap());
    let observations = [1e-7, -2e-7].map(|displacement| Observation { displacement, force: -0.0, at }).to_vec();
    process.client.observe(id, &ObservationsRequest { observations }, &Options::default()).await.unwrap();
    let measured = history(&process.client, id).await;
    process.kill().await;
    let kept = folder.path().join("kept");
    fs::rename(&log, &kept).unwrap();
    let (file, copy) = (url(&path), folder.path().join("copy.db"));
    let said = refused(&file).stderr;
    let asked = [&["check", "--store", &file][..], &["backup", copy.to_str().unwrap(), "--store", &file]];
    for said in asked.map(|arguments| run(arguments).stderr).into_iter().chain([said]) {
        let said = String::from_utf8(said).unwrap();
        assert!(said.contains("not closed") && said.contains("crashed.db-wal is missing"), "{said}");
        assert_eq!(said.lines().count(), 1, "{said}");
    }
    assert!(!log.exists() && !copy.exists());
    // With its log it is whole; and a copy of the file in use is a store that is closed.
    fs::rename(&kept, &log).unwrap();
    let process = Process::start(&file).await;
    assert_eq!(exact(&history(&process.client, id).await), exact(&measured));
    assert!(run(&["backup", copy.to_str().unwrap(), "--store", &file]).status.success());
    Process::start(&url(&copy)).await.stop().await;
    process.stop().await;
    // Closed, it needs no log.
    assert!(!log.exists());
    Process::start(&file).await.kill().await;
    // An operator may accept the file as it is.
    fs::write(&log, "").unwrap();
    let process = Process::start(&file).await;
    assert_eq!(process.client.contact(id).await.unwrap().sequence, 2);
}

#[tokio::test]
async fn the_files_are_for_their_owner_alone() {
    let folder = tempdir().unwrap();
    let (path, copy) = (folder.path().join("private.db"), folder.path().join("copy.db"));
    // Left by a program that was interrupted, for all to read.
    for partial in [beside(&path, ".new"), beside(&copy, ".new")] {
        fs::write(&partial, "").unwrap();
        fs::set_permissions(&partial, fs::Permissions::from_mode(0o644)).unwrap();
    }
    let process = Process::start(&url(&path)).await;
    process.client.create(&create(), &Options::default()).await.unwrap();
    assert!(run(&["backup", copy.to_str().unwrap(), "--store", &url(&path)]).status.success());
    for file in [&path, &beside(&path, "-wal"), &beside(&path, "-shm"), &copy] {
        assert_eq!(fs::metadata(file).unwrap().permissions().mode() & 0o777, 0o600, "{}", file.display());
    }
}
