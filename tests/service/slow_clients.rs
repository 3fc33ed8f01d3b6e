//! Clients that send or read slowly keep what others need free: permits while a body arrives, places of memory until
//! the last byte of a reply. Those that read steadily are served, however slowly.

use std::time::Duration;

use crate::common::raw::{Service, get, post};
use crate::common::{PATIENCE, ball, create, until};
use futures::future::join_all;
use serde_json::json;
use stickslip_wire::client::Options;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::{TcpSocket, TcpStream};
use tokio::time::{sleep, timeout};

const HONEST: &str = "127.0.0.2";

/// A simulation whose work and reply take so many KiB or more.
fn simulation(kib: usize) -> String {
    post("/simulate", &json!({"contact": ball(), "path": {"falling_amplitude": {"reversals": kib}}}).to_string())
}

#[tokio::test]
async fn replies_that_one_client_does_not_read_leave_memory_to_others() {
    let service = Service::with("--max-wait 500ms --log warn");
    let slow = (0..8).map(|_| async {
        let socket = TcpSocket::new_v4().unwrap();
        socket.set_recv_buffer_size(4096).unwrap();
        let mut stream = socket.connect(service.address).await.unwrap();
        stream.write_all(simulation(99_999).as_bytes()).await.unwrap();
        // Its head, and nothing else.
        let mut head = [0; 12];
        timeout(PATIENCE, stream.read_exact(&mut head)).await.unwrap().unwrap();
        (String::from_utf8(head.to_vec()).unwrap(), stream)
    });
    let slow = join_all(slow).await;
    let served = slow.iter().filter(|(head, _)| head == "HTTP/1.1 200").count();
    assert_eq!(served, 1, "half of the places for the largest");
    for kib in [2_000, 99_999] {
        let answer = service.ask(HONEST, &simulation(kib)).await.unwrap();
        assert_eq!(answer.statuses, [200], "{kib} KiB: {:.300}", answer.text);
    }
}

#[tokio::test]
async fn a_rename_takes_one_permit_and_slow_bodies_of_any_method_take_none() {
    let service = Service::with("--max-requests 1 --max-requests-per-client 9 --max-wait 500ms --log warn");
    let contact = service.client.create(&create(), &Options::default()).await.unwrap().id;
    service.client.rename(contact, Some("a"), &Options::default()).await.unwrap();
    let mut slow = Vec::new();
    for method in ["PATCH", "DELETE", "GET", "POST", "HEAD"] {
        let path = if method == "POST" { "/contacts".to_owned() } else { format!("/contacts/{contact}") };
        let head = format!("{method} {path} HTTP/1.1\r\nhost: localhost\r\ncontent-type: application/json\r\n");
        let mut stream = TcpStream::connect(service.address).await.unwrap();
        stream.write_all(format!("{head}content-length: 20\r\n\r\n{{").as_bytes()).await.unwrap();
        slow.push(stream);
    }
    let page = async || service.ask(HONEST, &get("/metrics")).await.unwrap().text;
    let waits = "stickslip_http_requests_in_flight{method=\"PATCH\",route=\"/contacts/{id}\"} 1";
    until("a rename waits for its body", async || page().await.contains(waits).then_some(())).await;
    for _ in 0..3 {
        let answer = service.ask(HONEST, &get("/contacts")).await.unwrap();
        assert_eq!(answer.statuses, [200], "{}", answer.text);
    }
}

/// Far more than the 64 KiB that a client must take in this time, and far less than the buffer of the socket would take
/// at once, and then not for a while.
#[tokio::test]
async fn a_steady_reader_is_not_cut_off() {
    let service = Service::with("--stall-time 1s --log info");
    let socket = TcpSocket::new_v4().unwrap();
    socket.set_recv_buffer_size(64 * 1024).unwrap();
    let mut stream = socket.connect(service.address).await.unwrap();
    stream.write_all(simulation(60_000).as_bytes()).await.unwrap();
    let mut piece = vec![0; 128 * 1024];
    for _ in 0..24 {
        timeout(PATIENCE, stream.read_exact(&mut piece)).await.unwrap().expect("it was cut off");
        sleep(Duration::from_millis(250)).await;
    }
    let mut rest = Vec::new();
    timeout(PATIENCE, stream.read_to_end(&mut rest)).await.unwrap().expect("it was cut off");
    assert!(rest.ends_with(b"}"), "the reply is whole");
    // One that stops is, and the log says so.
    let mut deaf = TcpStream::connect(service.address).await.unwrap();
    deaf.write_all(simulation(99_999).as_bytes()).await.unwrap();
    until("it is cut off", async || service.log().contains("too long to read a reply").then_some(())).await;
}
