//! Overload, on the real binary: memory stays within the bound that `server::memory_budget` states, health checks
//! succeed, honest clients are served while it lasts as far as they can be, and all of them when it is over.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Duration;

use crate::common::raw::{Service, get, post, room_for};
use crate::common::{PATIENCE, ball, create, long_path, long_simulation};
use futures::future::join_all;
use serde_json::json;
use stickslip::admission::Capacity;
use stickslip::server::connection_limits::SPARE_CONNECTIONS;
use stickslip::server::{ConnectionLimits, memory_budget};
use stickslip_wire::Move;
use stickslip_wire::client::Options;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::TcpStream;
use tokio::time::{sleep, timeout};

const MIB: usize = 1024 * 1024;
/// The address of the clients that flood the server.
const FLOOD: &str = "127.0.0.1";
/// The address of the other clients.
const HONEST: &str = "127.0.0.2";

/// Waits until a condition holds.
async fn until(what: &str, condition: impl AsyncFn() -> bool) {
    crate::common::until(what, async || condition().await.then_some(())).await;
}

/// Whether a request gets a 200.
async fn served(service: &Service, source: &str, request: &str) -> bool {
    service.ask(source, request).await.is_some_and(|answer| answer.statuses == [200])
}

fn sound_simulation() -> String {
    json!({"contact": ball(), "path": {"displacement": [1e-7, 0.0]}}).to_string()
}

#[tokio::test]
async fn two_thousand_slow_clients_use_little_memory_and_delay_no_others() {
    const SLOW: usize = 2_000;
    room_for(SLOW + 100);
    let service = Service::with("--cache-bytes 16MiB --head-time 8s --max-requests-per-client 2000 --log warn");
    let contact = service.client.create(&create(), &Options::default()).await.unwrap().id;
    let (over, closed) = (Arc::new(AtomicBool::new(false)), Arc::new(AtomicUsize::new(0)));
    let mut slow = Vec::new();
    for number in 0..SLOW {
        let mut stream = service.connect_from(FLOOD).await.unwrap();
        let (over, closed) = (Arc::clone(&over), Arc::clone(&closed));
        slow.push(tokio::spawn(async move {
            // Half of them never end a head, half never a body.
            let start = if number % 2 == 0 { "GET / HTTP/1.1\r\nx: " } else { &post("/simulate", &" ".repeat(4_000)) };
            let start = &start.as_bytes()[..start.len().min(3_000)];
            let mut alive = stream.write_all(start).await.is_ok();
            while alive && !over.load(Ordering::Relaxed) {
                sleep(Duration::from_millis(200)).await;
                alive = stream.write_all(b" ").await.is_ok();
            }
            closed.fetch_add(usize::from(!alive && number % 2 == 0), Ordering::Relaxed);
        }));
    }
    assert!(served(&service, HONEST, &get("/healthz")).await);
    for index in 0..50 {
        assert!(served(&service, HONEST, &post("/simulate", &sound_simulation())).await);
        let step = Move::displacement(1e-9 * f64::from(index));
        service.client.apply(contact, &step.into(), &Options::default()).await.unwrap();
    }
    // Clients that never end a head are closed at their time limit.
    until("slow heads are closed", async || closed.load(Ordering::Relaxed) >= SLOW / 2).await;
    over.store(true, Ordering::Relaxed);
    join_all(slow).await;
    let capacity = Capacity::default();
    // Beside what the bound allows for large bodies, of which there are none here.
    let allowed = memory_budget::memory(&ConnectionLimits::default(), &capacity, 16 << 20, false) as usize
        - capacity.reservable_bytes();
    let peak = service.peak();
    println!("{SLOW} slow clients: at most {} MiB, {} KiB each", peak / MIB, peak / 1024 / SLOW);
    assert!(peak < allowed && peak < 150 * MIB, "{peak} of {allowed}");
    assert!(served(&service, FLOOD, &get("/healthz")).await);
}

#[tokio::test]
async fn a_flood_of_ten_times_the_capacity_is_survived() {
    const MOST: usize = 200;
    room_for(10 * MOST + 100);
    let service = Service::with(
        "--max-connections 200 --max-connections-per-client 150 --max-requests 16 --max-queue 32 \
         --max-requests-per-client 1000 --max-wait 200ms --work-bytes 256MiB --cache-bytes 16MiB \
         --head-time 2s --log off",
    );
    let over = Arc::new(AtomicBool::new(false));
    let (good, refused) = (Arc::new(AtomicUsize::new(0)), Arc::new(AtomicUsize::new(0)));
    let service = Arc::new(service);
    let flood = (0..10 * MOST).map(|number| {
        let (service, over) = (Arc::clone(&service), Arc::clone(&over));
        let (good, refused) = (Arc::clone(&good), Arc::clone(&refused));
        tokio::spawn(async move {
            while !over.load(Ordering::Relaxed) {
                let request = match number % 4 {
                    0 => post("/simulate", &sound_simulation()),
                    1 => post("/contacts", &ball().to_string()),
                    2 => get("/contacts?limit=1000"),
                    // Half a body, and no more.
                    _ => post("/simulate", &" ".repeat(500_000))[..300_000].to_owned(),
                };
                if number % 4 == 3 {
                    let Ok(mut stream) = service.connect_from(FLOOD).await else { continue };
                    let _ = stream.write_all(request.as_bytes()).await;
                    sleep(Duration::from_millis(500)).await;
                } else if let Some(answer) = service.ask(FLOOD, &request).await {
                    let status = answer.statuses[0];
                    assert!([200, 201, 503].contains(&status), "{}", answer.text);
                    if status == 503 {
                        assert!(answer.text.contains("retry-after: 1") && answer.text.contains("overloaded"));
                        refused.fetch_add(1, Ordering::Relaxed);
                    } else {
                        good.fetch_add(1, Ordering::Relaxed);
                    }
                } else {
                    sleep(Duration::from_millis(50)).await;
                }
            }
        })
    });
    let flood: Vec<_> = flood.collect();
    until("some are served and some refused", async || {
        good.load(Ordering::Relaxed) > 500 && refused.load(Ordering::Relaxed) > 100
    })
    .await;
    // While it lasts: the flood is of one address, and leaves room for others.
    until("health checks succeed", async || served(&service, HONEST, &get("/healthz")).await).await;
    for _ in 0..5 {
        // With the spare connections, and what else the process has open.
        let open = service.open_files();
        assert!(open < MOST + SPARE_CONNECTIONS + 50, "{open} files are open");
        let simulated = async || served(&service, HONEST, &post("/simulate", &sound_simulation())).await;
        until("an honest client is served", simulated).await;
    }
    over.store(true, Ordering::Relaxed);
    for client in flood {
        client.await.unwrap();
    }
    // After the flood.
    until("the server is free", async || served(&service, FLOOD, &get("/contacts?limit=1")).await).await;
    for _ in 0..50 {
        assert!(served(&service, FLOOD, &post("/simulate", &sound_simulation())).await);
    }
    let connections = ConnectionLimits { most: MOST, ..ConnectionLimits::default() };
    let capacity = Capacity { requests: 16, queue: 32, bytes: 256 * MIB, ..Capacity::default() };
    // What was created is kept in memory by this store, some 4 KiB each.
    let kept = good.load(Ordering::Relaxed) * 4 * 1024;
    let (peak, allowed) =
        (service.peak(), memory_budget::memory(&connections, &capacity, 16 << 20, false) as usize + kept);
    println!(
        "flood: {} served, {} refused, at most {} MiB",
        good.load(Ordering::Relaxed),
        refused.load(Ordering::Relaxed),
        peak / MIB
    );
    assert!(peak < allowed, "{peak} of {allowed}");
}

#[tokio::test]
async fn large_bodies_wait_for_memory_or_are_refused() {
    let service = Service::with(
        "--work-bytes 256MiB --cache-bytes 16MiB --max-wait 1s --log off \
         --max-body-bytes-per-client 1GiB",
    );
    // Each becomes some 200 MiB while it is parsed, or would become more.
    let moves = vec!["{}"; 2_700_000].join(",");
    let simulation = post("/simulate", &format!("{{\"contact\":{},\"path\":{{\"moves\":[{moves}]}}}}", ball()));
    let objects = vec![r#"{"":0}"#; 1_100_000].join(",");
    let sweep = post("/sweep", &format!("{{\"base\":{{\"path\":[{objects}]}},\"axes\":[],\"outputs\":[]}}"));
    let request = |number| if number % 2 == 0 { &simulation } else { &sweep };
    let answers = join_all((0..60).map(|number| service.ask(FLOOD, request(number)))).await;
    let (mut refused, mut read) = (0, 0);
    for answer in answers.into_iter().flatten() {
        match answer.statuses[..] {
            [422] => read += 1,
            [503] => refused += 1,
            _ => panic!("{}", answer.text),
        }
    }
    assert!(read > 0 && refused > 0, "{read} read, {refused} refused");
    let capacity = Capacity { bytes: 256 * MIB, ..Capacity::default() };
    let connections = ConnectionLimits { most: 60, ..ConnectionLimits::default() };
    let (peak, allowed) = (service.peak(), memory_budget::memory(&connections, &capacity, 16 << 20, false) as usize);
    println!("large bodies: {read} read, {refused} refused, at most {} MiB", peak / MIB);
    assert!(peak < allowed, "{peak} of {allowed}");
    assert!(served(&service, FLOOD, &post("/simulate", &sound_simulation())).await);
}

#[tokio::test]
async fn a_request_without_a_place_is_refused_soon_and_health_is_not() {
    let few = ["--max-requests", "1", "--max-queue", "1", "--max-requests-per-client", "9"];
    let service = Service::start(&[&few[..], &["--max-wait", "300ms", "--deadline", "20s"]].concat());
    let mut busy = TcpStream::connect(service.address).await.unwrap();
    busy.write_all(post("/simulate", &long_simulation().to_string()).as_bytes()).await.unwrap();
    until("the place is taken", async || !served(&service, FLOOD, &get("/contacts")).await).await;
    let asked = [get("/contacts"), post("/simulate", &sound_simulation()), get("/contacts")];
    for answer in join_all(asked.iter().map(|request| service.ask(FLOOD, request))).await {
        let answer = answer.unwrap();
        assert_eq!(answer.statuses, [503], "{}", answer.text);
        assert!(answer.text.contains("retry-after: 1") && answer.text.contains("application/problem+json"));
    }
    for path in ["/healthz", "/readyz"] {
        assert!(served(&service, FLOOD, &get(path)).await);
    }
    // A client that hangs up frees its place.
    drop(busy);
    until("the place is free", async || served(&service, FLOOD, &get("/contacts")).await).await;
}

#[tokio::test]
async fn many_moves_of_one_contact_queue_up_to_a_bound() {
    let service = Service::start(&["--max-queue", "5", "--max-wait", "100ms", "--deadline", "20s", "--log", "off"]);
    let contact = service.client.create(&create(), &Options::default()).await.unwrap().id;
    let mut long = TcpStream::connect(service.address).await.unwrap();
    long.write_all(post(&format!("/contacts/{contact}/path"), &long_path().to_string()).as_bytes()).await.unwrap();
    // It waits for its turn, which reads of the contact do not.
    let look = get(&format!("/contacts/{contact}/friction"));
    until("the contact is at work", async || !served(&service, FLOOD, &look).await).await;
    let step = post(&format!("/contacts/{contact}/move"), r#"{"displacement": 1e-8}"#);
    let answers = join_all((0..40).map(|_| service.ask(FLOOD, &step))).await;
    let full = answers.iter().flatten().filter(|answer| answer.text.contains("its queue is full")).count();
    assert!(full >= 30, "{full}");
    assert!(answers.iter().flatten().all(|answer| answer.statuses == [503]));
    // Other contacts do not wait for this one.
    assert!(service.client.create(&create(), &Options::default()).await.is_ok());
    drop(long);
    until("the contact is free", async || served(&service, FLOOD, &look).await).await;
    assert_eq!(service.client.contact(contact).await.unwrap().sequence, 0);
}

#[tokio::test]
async fn a_client_that_never_reads_is_let_go() {
    let service = Service::start(&["--stall-time", "500ms", "--head-time", "500ms", "--cache-bytes", "16MiB"]);
    let contact = service.client.create(&create(), &Options::default()).await.unwrap().id;
    let path = json!({"path": {"falling_amplitude": {"reversals": 99_999}}, "steps": "last"}).to_string();
    assert!(served(&service, FLOOD, &post(&format!("/contacts/{contact}/path"), &path)).await);
    let (files, peak) = (service.open_files(), service.peak());
    let events = format!("GET /contacts/{contact}/events HTTP/1.1\r\nhost: localhost\r\nLast-Event-ID: 0\r\n\r\n");
    let simulation = json!({"contact": ball(), "path": {"falling_amplitude": {"reversals": 99_999}}}).to_string();
    let mut deaf = Vec::new();
    for _ in 0..10 {
        for request in [&events, &post("/simulate", &simulation)] {
            let mut stream = service.connect_from(FLOOD).await.unwrap();
            stream.write_all(request.as_bytes()).await.unwrap();
            deaf.push(stream);
        }
    }
    // A client that does read stays, however long nothing happens.
    let mut listener = service.connect_from(HONEST).await.unwrap();
    let quiet = service.client.create(&create(), &Options::default()).await.unwrap().id;
    listener
        .write_all(format!("GET /contacts/{quiet}/events HTTP/1.1\r\nhost: localhost\r\n\r\n").as_bytes())
        .await
        .unwrap();
    until("the replies have begun", async || service.open_files() >= files + 20).await;
    until("only the listener is open", async || service.open_files() <= files + 1).await;
    // Each reply has some 30 MB, and as much work before it; two at a time are worked on.
    assert!(service.peak() < peak + 400 * MIB, "{} MiB", service.peak() / MIB);
    service.client.apply(quiet, &Move::displacement(1e-8).into(), &Options::default()).await.unwrap();
    let mut text = String::new();
    while !text.contains("id: 1\n") {
        let mut bytes = [0; 4096];
        let read = timeout(PATIENCE, listener.read(&mut bytes)).await.expect("no event").unwrap();
        assert!(read > 0, "the listener was cut off: {text}");
        text.push_str(std::str::from_utf8(&bytes[..read]).unwrap());
    }
    drop(deaf);
}
