//! Quotas, on the real binary: what one client may take of the store and of memory, and that the others have theirs.

use crate::common::raw::{Answer, Service, get, post};
use crate::common::{PATIENCE, ball, create, metric, until};
use serde_json::json;
use stickslip_wire::ForkRequest;
use stickslip_wire::client::{Error, Options};
use tokio::io::AsyncWriteExt as _;
use tokio::net::TcpStream;
use tokio::time::timeout;
use uuid::Uuid;

/// A client that takes all it may, and another one.
const GREEDY: &str = "127.0.0.3";
const HONEST: &str = "127.0.0.2";

const MIB: u64 = 1024 * 1024;

fn assert_refused(answer: &Answer, quota: &str) {
    assert_eq!(answer.statuses, [429], "{}", answer.text);
    for part in ["quota_exceeded", quota, "retry-after: "] {
        assert!(answer.text.contains(part), "{part}: {}", answer.text);
    }
}

/// How many requests were beyond a quota.
async fn refusals(service: &Service, quota: &str) -> u64 {
    metric(&service.base, &format!("stickslip_quota_refused_total{{quota=\"{quota}\"}}")).await
}

/// Bytes of a file and of its write-ahead log.
fn bytes(path: &std::path::Path) -> u64 {
    let log = path.with_extension("db-wal");
    [path, &log].iter().filter_map(|path| path.metadata().ok()).map(|file| file.len()).sum()
}

#[tokio::test]
async fn forks_fill_the_store_up_to_the_quota_also_after_a_restart_and_deleting_makes_room() {
    const QUOTA: &str = "max-store-bytes-per-tenant";
    const LIMIT: u64 = 32 * MIB;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("contacts.db");
    let url = format!("sqlite:{}", path.display());
    let arguments = ["--max-store-bytes-per-tenant", "32MiB", "--log", "warn"];
    let service = Service::start_on(&url, &arguments);
    let id = service.client.create(&create(), &Options::default()).await.unwrap().id;
    let way = json!({"path": {"falling_amplitude": {"reversals": 9_999}}, "steps": "last"}).to_string();
    let moved = service.ask(GREEDY, &post(&format!("/contacts/{id}/path"), &way)).await.unwrap();
    assert_eq!(moved.statuses, [200], "{}", moved.text);
    let fork = post(&format!("/contacts/{id}/fork"), "{}");
    let mut forks = Vec::new();
    let refused = loop {
        let answer = service.ask(GREEDY, &fork).await.unwrap();
        if answer.statuses != [201] {
            break answer;
        }
        forks.push(answer.text.split("\"id\":\"").nth(1).unwrap()[..36].to_owned());
        assert!(forks.len() < 100, "{} forks of 10 000 moves", forks.len());
    };
    assert_refused(&refused, QUOTA);
    let taken = bytes(&path);
    println!("{} forks of 10 000 moves take {} KiB", forks.len(), taken / 1024);
    assert!(forks.len() >= 4 && taken < 2 * LIMIT, "{} forks take {taken} bytes", forks.len());
    assert!(refusals(&service, QUOTA).await >= 1);

    // Longer than a fork with its snapshot takes.
    let far = json!({"path": {"falling_amplitude": {"reversals": 14_999}}, "steps": "last"}).to_string();
    let far = post(&format!("/contacts/{id}/path"), &far);
    assert_refused(&service.ask(GREEDY, &far).await.unwrap(), QUOTA);
    let service = {
        drop(service);
        Service::start_on(&url, &arguments)
    };
    for request in [&fork, &far] {
        assert_refused(&service.ask(GREEDY, request).await.unwrap(), QUOTA);
    }
    assert_eq!(service.client.contact(id).await.unwrap().sequence, 10_000, "a refused path has changed nothing");
    // Two of them, because the snapshot of the first counts once it is counted again.
    for id in [id.to_string(), forks.swap_remove(0)] {
        let delete = get(&format!("/contacts/{id}")).replacen("GET", "DELETE", 1);
        assert_eq!(service.ask(GREEDY, &delete).await.unwrap().statuses, [204]);
    }
    let other = service.client.create(&create(), &Options::default()).await.unwrap().id;
    let path = post(&format!("/contacts/{other}/path"), &way);
    let served = async || service.ask(GREEDY, &path).await.unwrap().statuses == [200];
    until("there is room again", async || served().await.then_some(())).await;
}

/// Replies that are kept for retries fill the store too, and stay when their contact is deleted.
#[tokio::test]
async fn kept_replies_count_and_a_retry_gets_its_reply_all_the_same() {
    let service = Service::start(&["--max-store-bytes-per-tenant", "4MiB", "--log", "warn"]);
    let path = json!({"path": {"falling_amplitude": {"reversals": 499}}, "steps": "all"}).to_string();
    let send = async |key: usize, id: Uuid| {
        let request = post(&format!("/contacts/{id}/path"), &path);
        service.ask(GREEDY, &request.replacen("host:", &format!("idempotency-key: {key}\r\nhost:"), 1)).await.unwrap()
    };
    let mut first = None;
    let mut count = 0;
    let refused = loop {
        let id = service.client.create(&create(), &Options::default()).await;
        let id = match id {
            Ok(made) => made.id,
            Err(Error::Problem(problem)) if problem.code == "quota_exceeded" => break None,
            Err(other) => panic!("{other}"),
        };
        let answer = send(count, id).await;
        if answer.statuses != [200] {
            break Some(answer);
        }
        first.get_or_insert((id, answer.text));
        service.client.delete(id, &Options::default()).await.unwrap();
        count += 1;
        assert!(count < 200, "{count} replies of some 100 kB");
    };
    if let Some(answer) = refused {
        assert_refused(&answer, "max-store-bytes-per-tenant");
    }
    assert!(count > 5, "{count}");
    let (id, reply) = first.unwrap();
    let again = send(0, id).await;
    let body = |text: &str| text.split("\r\n\r\n").nth(1).unwrap().to_owned();
    assert_eq!((&again.statuses[..], body(&again.text)), (&[200][..], body(&reply)));
}

#[tokio::test]
async fn beyond_its_bytes_a_tenant_may_read_and_delete() {
    let service = Service::start(&["--max-store-bytes-per-tenant", "8KiB", "--log", "warn"]);
    let mut made = vec![service.client.create(&create(), &Options::default()).await.unwrap().id];
    let why = loop {
        let label = Some(format!("fork {}", made.len()));
        let request = ForkRequest { label, sequence: None };
        match service.client.fork(made[0], &request, &Options::default()).await {
            Ok(fork) => made.push(fork.id),
            Err(Error::Problem(problem)) => break problem,
            Err(other) => panic!("{other}"),
        }
        assert!(made.len() < 20, "8 KiB have room for {} contacts", made.len());
    };
    assert_eq!((why.status, why.code.as_str()), (429, "quota_exceeded"));
    assert!(why.detail.contains("8.0 KiB") && why.detail.contains("max-store-bytes-per-tenant"), "{}", why.detail);
    // To read and to delete is always allowed.
    for id in made {
        assert_eq!(service.client.contact(id).await.unwrap().id, id);
        service.client.delete(id, &Options::default()).await.unwrap();
    }
}

#[tokio::test]
async fn what_a_client_has_under_way_is_bounded_and_takes_nothing_from_others() {
    let sound = post("/simulate", &json!({"contact": ball(), "path": {"displacement": [1e-7]}}).to_string());
    // Blank, and no JSON.
    let large = post("/simulate", &" ".repeat(4 * MIB as usize));
    for (quota, limit, whole, sent, status, beside) in [
        // Each of these holds room for its 4 MiB, and sends no more; a small body is always read.
        ("max-body-bytes-per-client", "8MiB", &large, 3 * MIB as usize, 400, &sound),
        // These wait for the end of their bodies.
        ("max-requests-per-client", "3", &sound, sound.len() - 1, 200, &get("/healthz")),
    ] {
        let service = Service::start(&[&format!("--{quota}"), limit, "--log", "warn"]);
        let ask = async |source: &str| service.ask(source, whole).await.unwrap();
        // One may be refused beside a whole one: then another takes its place.
        let mut waiting: Vec<TcpStream> = Vec::new();
        let refused = async {
            loop {
                let mut stream = service.connect_from(GREEDY).await.unwrap();
                stream.write_all(&whole.as_bytes()[..sent]).await.unwrap();
                waiting.push(stream);
                let answer = ask(GREEDY).await;
                if answer.statuses == [429] {
                    return answer;
                }
                assert_eq!(answer.statuses, [status], "{}", answer.text);
            }
        };
        assert_refused(&timeout(PATIENCE, refused).await.expect("never refused"), quota);
        assert!(refusals(&service, quota).await >= 1);
        assert_eq!(service.ask(GREEDY, beside).await.unwrap().statuses, [200]);
        assert_eq!(ask(HONEST).await.statuses, [status]);
        drop(waiting);
        until("there is room again", async || (ask(GREEDY).await.statuses == [status]).then_some(())).await;
    }
}
