//! Signals and the log, on the real binary: a signal does what it is meant to from the start on, one deadline holds for
//! all of a stop, and a log that nobody reads holds up nothing.

use std::process::Stdio;
use std::time::{Duration, Instant};

use crate::common::binary;
use crate::common::process::{Process, listening};
use crate::common::raw::{Service, get};
use tokio::io::AsyncWriteExt as _;
use tokio::net::{TcpListener, TcpStream};
use tokio::time::timeout;

use crate::common::PATIENCE;

#[tokio::test]
async fn a_signal_has_its_handler_before_the_store_is_opened() {
    // A database that accepts, and never answers.
    let frozen = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let store = format!("postgres://a@{}/b", frozen.local_addr().unwrap());
    let child = binary(&["serve", "--listen", "127.0.0.1:0", "--store", &store]).spawn().unwrap();
    let process = Process::running(child, "http://127.0.0.1:0");
    let _connection = timeout(PATIENCE, frozen.accept()).await.unwrap().unwrap();
    process.signal("HUP");
    // It ends by this one, and with success.
    process.stop().await;
}

#[tokio::test]
async fn a_log_that_nobody_reads_holds_up_neither_requests_nor_the_stop() {
    let mut command = binary(&["serve", "--listen", "127.0.0.1:0", "--store", "memory:", "--log", "info"]);
    command.stderr(Stdio::piped());
    let (mut child, base) = listening(command);
    // A pipe holds 64 KiB.
    let _unread = child.stderr.take().unwrap();
    let process = Process::running(child, &base);
    let client = reqwest::Client::new();
    for _ in 0..1_000 {
        let asked = client.get(format!("{base}/healthz")).timeout(PATIENCE).send();
        assert_eq!(asked.await.unwrap().status(), 200);
    }
    process.stop().await;
}

/// Half a head, a body that stalls, a collector that does not answer: each had a time of its own once.
#[tokio::test]
async fn one_deadline_holds_for_all_of_a_stop() {
    let dead = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let collector = format!("http://{}", dead.local_addr().unwrap());
    let long = "--drain-time 100ms --head-time 1h --body-time 1h --stall-time 1h --idle-time 1h --otlp-endpoint";
    let service = Service::with(&format!("{long} {collector}"));
    let mut open = Vec::new();
    for half in [
        "GET /healthz HT",
        "POST /simulate HTTP/1.1\r\nhost: a\r\ncontent-type: application/json\r\n\
        content-length: 9\r\n\r\n{",
    ] {
        let mut stream = TcpStream::connect(service.address).await.unwrap();
        stream.write_all(half.as_bytes()).await.unwrap();
        open.push(stream);
    }
    // These came later and are served: those before them have been accepted, and there is a trace to be sent.
    assert_eq!(service.ask("127.0.0.1", &get("/contacts")).await.unwrap().statuses, [200]);
    let begin = Instant::now();
    service.signal("TERM");
    let running = format!("/proc/{}/stat", service.id());
    crate::common::until("it ends", async || {
        // What has ended and is not awaited is a zombie.
        let stat = std::fs::read_to_string(&running).unwrap_or_default();
        (stat.is_empty() || stat.contains(") Z ")).then_some(())
    })
    .await;
    // 100 ms, and 1.2 s for the rest. The sum of the single ones was eight.
    let took = begin.elapsed();
    assert!(took < Duration::from_secs(5), "{took:?}");
}

#[tokio::test]
async fn limits_take_any_number_and_few_open_files_leave_connections() {
    let most = usize::MAX;
    let service = Service::with(&format!("--max-requests {most} --max-queue {most} --max-connections {most}"));
    assert_eq!(service.ask("127.0.0.1", &get("/contacts")).await.unwrap().statuses, [200]);
    let few = ["prlimit", "--nofile=256:256"].map(str::to_owned);
    let process = Process::start_by(&few, "memory:").await;
    let address = process.base.trim_start_matches("http://").to_owned();
    let mut open = Vec::new();
    for _ in 0..16 {
        open.push(TcpStream::connect(&address).await.unwrap());
    }
    // A spare connection would answer for the health alone.
    process.client.newest_contacts(None, None).await.unwrap();
}
