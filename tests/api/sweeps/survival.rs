//! Jobs survive the end of processes.

use std::os::unix::fs::MetadataExt as _;
use std::process::Command;
use std::sync::OnceLock;

use serde_json::Value;
use tempfile::tempdir;
use tokio::io::AsyncWriteExt as _;

use super::long;
use crate::common::postgres::{Cluster, connected};
use crate::common::process::Process;
use crate::common::raw::{Service, post};
use crate::common::{Server, metric, run, until};

/// Enough points that a process can be killed in the middle of them.
const POINTS: usize = 100_000;

/// The result of the sweep without a failure.
fn undisturbed() -> &'static str {
    static RESULT: OnceLock<String> = OnceLock::new();
    RESULT.get_or_init(|| {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(&file, long(POINTS).to_string()).unwrap();
        let printed = run(&["sweep", file.path().to_str().unwrap(), "--format", "columns"]);
        assert!(printed.status.success());
        String::from_utf8(printed.stdout).unwrap()
    })
}

async fn done(server: &Server, path: &str) -> u64 {
    server.job(path).await["progress"]["done"].as_u64().unwrap()
}

#[tokio::test(flavor = "multi_thread")]
async fn a_job_goes_on_after_a_kill_with_what_it_had() {
    let folder = tempdir().unwrap();
    let store = format!("sqlite:{}", folder.path().join("jobs.db").display());
    let (process, sweep) = (Process::start(&store).await, long(POINTS));
    let path = Server::at(&process.base).start_job(&sweep).await;
    let mut process = Some(process);
    let (mut seen, mut kills) = (0, 0);
    for wanted in [1, POINTS as u64 / 3] {
        let server = Server::at(&process.as_ref().unwrap().base);
        seen = until("more is done", async || Some(done(&server, &path).await).filter(|done| *done >= wanted)).await;
        kills += u32::from(seen < POINTS as u64);
        process.take().unwrap().kill().await;
        process = Some(Process::start(&store).await);
        let server = Server::at(&process.as_ref().unwrap().base);
        assert!(done(&server, &path).await >= seen, "what was done is done");
    }
    assert!(kills > 0, "the job was over before the first kill: {seen}");
    let process = process.unwrap();
    let server = Server::at(&process.base);
    assert_eq!(server.job_result(&path).await, undisturbed());
    // The result outlives a stop too, and a cancelled job leaves nothing behind.
    process.stop().await;
    let process = Process::start(&store).await;
    let server = Server::at(&process.base);
    assert!(server.job_result(&path).await.starts_with("{\"points\":100000,"));
    assert_eq!(server.send(reqwest::Method::DELETE, &path, None, &[]).await.status(), 204);
    process.stop().await;
    let database = rusqlite::Connection::open(folder.path().join("jobs.db")).unwrap();
    let left: i64 = database
        .query_row("SELECT (SELECT count(*) FROM jobs) + (SELECT count(*) FROM job_chunks)", [], |row| row.get(0))
        .unwrap();
    assert_eq!(left, 0);
}

#[tokio::test(flavor = "multi_thread")]
async fn replicas_share_a_job_and_one_that_is_killed_leaves_its_part_to_the_other() {
    let url = Cluster::shared().database().await;
    let client = connected(&url).await;
    let [first, second] = [(); 2].map(|()| Process::with(&url, &["--job-lease", "2s"]));
    let sweep = long(POINTS);
    let path = Server::at(&first.base).start_job(&sweep).await;
    let count =
        async |of: &str| client.query_one(&format!("SELECT {of} FROM job_chunks"), &[]).await.unwrap().get::<_, i64>(0);
    until("both work on it", async || {
        (count("count(DISTINCT owner) FILTER (WHERE content IS NULL)").await == 2).then_some(())
    })
    .await;
    first.kill().await;
    let left = count("count(*) FILTER (WHERE content IS NULL)").await;
    assert!(left > 0, "the job was over before the kill");
    let server = Server::at(&second.base);
    assert_eq!(server.job_result(&path).await, undisturbed());
    assert_eq!(count("count(*) FILTER (WHERE owner IS NOT NULL)").await, 0, "finished chunks have no owner");
    second.stop().await;
}

#[tokio::test(flavor = "multi_thread")]
async fn a_replica_that_stops_gives_its_part_back_at_once() {
    let url = Cluster::shared().database().await;
    let client = connected(&url).await;
    let process = Process::start(&url).await;
    let path = Server::at(&process.base).start_job(&long(POINTS)).await;
    let held = async || {
        let of =
            "SELECT count(*) FILTER (WHERE owner IS NOT NULL), count(*) FILTER (WHERE content IS NULL) FROM job_chunks";
        let row = client.query_one(of, &[]).await.unwrap();
        (row.get::<_, i64>(0), row.get::<_, i64>(1))
    };
    until("it works on it", async || (held().await.0 > 0).then_some(())).await;
    process.stop().await;
    let (held, left) = held().await;
    assert!(left > 0, "the job was over before the stop");
    assert_eq!(held, 0, "the lease is thirty seconds");
    let process = Process::start(&url).await;
    assert_eq!(Server::at(&process.base).send(reqwest::Method::DELETE, &path, None, &[]).await.status(), 204);
    process.stop().await;
}

#[tokio::test(flavor = "multi_thread")]
async fn a_chunk_for_which_the_system_has_no_thread_is_computed_later() {
    // No limit of processes holds for root.
    let another = ["setpriv", "--reuid", "54321", "--regid", "54321", "--clear-groups"].map(str::to_owned);
    let is_root = std::fs::metadata("/proc/self").unwrap().uid() == 0;
    let prefix = if is_root { &another[..] } else { &[] };
    let process = Process::start_by(prefix, "memory:").await;
    let (server, id) = (Server::at(&process.base), process.id().to_string());
    let path = server.start_job(&long(POINTS)).await;
    let limits = std::fs::read_to_string(format!("/proc/{id}/limits")).unwrap();
    let most =
        limits.lines().find(|line| line.starts_with("Max processes")).unwrap().split_whitespace().nth(3).unwrap();
    let limit = |most: &str| {
        let most = format!("--nproc={most}:");
        let words: Vec<_> = prefix.iter().map(String::as_str).chain(["prlimit", "--pid", &id, &most]).collect();
        assert!(Command::new(words[0]).args(&words[1..]).status().unwrap().success());
    };
    limit("1");
    let returned = async || metric(&server.base, "stickslip_job_chunks_returned_total").await;
    until("chunks are released", async || (returned().await >= 2).then_some(())).await;
    limit(most);
    assert_eq!(server.job_result(&path).await, undisturbed());
}

/// Another program has locked the file, so that the clients hang up after their jobs have been sent to the store and
/// before they are stored.
#[tokio::test(flavor = "multi_thread")]
async fn a_job_whose_client_hangs_up_before_the_reply_runs_to_its_end() {
    let folder = tempdir().unwrap();
    let file = folder.path().join("jobs.db");
    let service = Service::start_on(&format!("sqlite:{}", file.display()), &[]);
    let server = Server::at(&service.base);
    let pending = async || metric(&server.base, "stickslip_store_pending_changes{store=\"sqlite\"}").await;
    let mut other = rusqlite::Connection::open(&file).unwrap();
    let sweep = super::small_job();
    for key in ["first", "second"] {
        let lock = other.transaction_with_behavior(rusqlite::TransactionBehavior::Immediate).unwrap();
        let request =
            post("/sweep", &sweep.to_string()).replacen("host:", &format!("idempotency-key: {key}\r\nhost:"), 1);
        let mut client = service.connect_from("127.0.0.1").await.unwrap();
        client.write_all(request.as_bytes()).await.unwrap();
        until("its job waits to be stored", async || (pending().await == 1).then_some(())).await;
        drop(client);
        until("the server has noticed", async || (pending().await == 0).then_some(())).await;
        drop(lock);
        let headers = [("idempotency-key", key)];
        let again = async || {
            let response = server.send(reqwest::Method::POST, "/sweep", Some(&sweep.to_string()), &headers).await;
            // The writer refuses changes for a moment if the lock was held for long.
            Some(response).filter(|response| response.status() == 202)
        };
        let again = until("the job is stored", again).await;
        server.job_result(again.headers()["location"].to_str().unwrap()).await;
    }
    let listed = server.get("/jobs").await.json::<Value>().await.unwrap();
    assert_eq!(listed["items"].as_array().unwrap().len(), 2);
}
