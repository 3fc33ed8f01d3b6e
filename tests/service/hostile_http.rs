//! Hostile HTTP on plain sockets: every request is refused by a 4xx or a closed connection, nothing of it is served in
//! another way than it was meant, and the process neither grows nor fails.

use crate::common::raw::{Answer, Service, get};
use futures::future::join_all;

const MIB: usize = 1024 * 1024;

/// A request line and headers, unchanged.
fn head(lines: &[&str]) -> Vec<u8> {
    let mut bytes: Vec<u8> = lines.iter().flat_map(|line| [line.as_bytes(), b"\r\n"].concat()).collect();
    bytes.extend_from_slice(b"\r\n");
    bytes
}

/// A sound beginning of `POST /simulate`, these headers, and what follows.
fn simulate(headers: &[&str], body: &[u8]) -> Vec<u8> {
    let start = ["POST /simulate HTTP/1.1", "Host: localhost", "Content-Type: application/json"];
    [head(&[&start, headers].concat()), body.to_vec()].concat()
}

fn line(line: &str) -> Vec<u8> {
    head(&[line, "Host: localhost"])
}

/// Hidden behind a request, and never to be answered.
const HIDDEN: &[u8] = b"GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n";

/// The bytes that are sent, and the one status of the reply; 0 if the connection is closed without a reply.
fn cases() -> Vec<(&'static str, Vec<u8>, u16)> {
    let chunked = "Transfer-Encoding: chunked";
    let with = |body: &[u8]| [body, HIDDEN].concat();
    vec![
        // Two lengths, of which a proxy may believe the other.
        // Here the coding counts (RFC 9112, 6.3), the body is empty, and the connection ends after it.
        ("length, then coding", simulate(&["Content-Length: 5", chunked], &with(b"0\r\n\r\n")), 400),
        ("coding, then length", simulate(&[chunked, "Content-Length: 5"], &with(b"0\r\n\r\n")), 400),
        ("two lengths", simulate(&["Content-Length: 5", "Content-Length: 6"], b"{} {}x"), 400),
        ("chunks are not the last coding", simulate(&["Transfer-Encoding: chunked, gzip"], &with(b"0\r\n\r\n")), 400),
        ("a list of lengths", simulate(&["Content-Length: 2, 2"], b"{}"), 400),
        ("a length with a sign", simulate(&["Content-Length: +2"], b"{}"), 400),
        ("a negative length", simulate(&["Content-Length: -2"], b"{}"), 400),
        ("a length in hexadecimal", simulate(&["Content-Length: 0x2"], b"{}"), 400),
        ("no number can hold the length", simulate(&["Content-Length: 99999999999999999999"], b"{}"), 400),
        ("the largest length", simulate(&["Content-Length: 18446744073709551615"], b"{}"), 431),
        ("two codings", simulate(&[chunked, "Transfer-Encoding: identity"], &with(b"0\r\n\r\n")), 400),
        ("an unknown coding", simulate(&["Transfer-Encoding: xchunked"], b"0\r\n\r\n"), 400),
        ("a hidden coding", simulate(&["Transfer-Encoding:\x0bchunked"], &with(b"0\r\n\r\n")), 400),
        (
            "a coding in an old version",
            head(&["POST /simulate HTTP/1.0", "Content-Type: application/json", chunked]),
            400,
        ),
        ("chunks without a number", simulate(&[chunked], b"zz\r\n{}\r\n0\r\n\r\n"), 400),
        ("a chunk of more than can be", simulate(&[chunked], b"fffffffffffffffff\r\n"), 400),
        ("chunks with a bare line feed", simulate(&[chunked], b"2\n{}\n0\n\n"), 400),
        ("an endless chunk extension", simulate(&[chunked], &[b"2;".as_slice(), &[b'a'; 200_000]].concat()), 400),
        (
            "endless trailers",
            simulate(&[chunked], &[b"2\r\n{}\r\n0\r\n".as_slice(), &b"a: b\r\n".repeat(100_000)].concat()),
            400,
        ),
        // Lines that two readers end in different places.
        ("a folded header", head(&["GET /healthz HTTP/1.1", "Host: localhost", "A: b", " c"]), 400),
        ("a bare carriage return", head(&["GET /healthz HTTP/1.1", "Host: localhost\rA: b"]), 400),
        ("a zero byte in a header", head(&["GET /healthz HTTP/1.1", "Host: localhost", "A: b\0c"]), 400),
        ("a space before the colon", head(&["GET /healthz HTTP/1.1", "Host : x"]), 400),
        ("a header without a name", head(&["GET /healthz HTTP/1.1", "Host: localhost", ": b"]), 400),
        ("a header without a colon", head(&["GET /healthz HTTP/1.1", "Host: localhost", "b"]), 400),
        ("two hosts", head(&["GET /healthz HTTP/1.1", "Host: localhost", "Host: y"]), 400),
        ("two hosts to delete", head(&["DELETE /contacts/7 HTTP/1.1", "Host: localhost", "Host: y"]), 400),
        ("two hosts with a body", simulate(&["Host: y", "Content-Length: 2"], b"{}"), 400),
        ("no host", head(&["GET /healthz HTTP/1.1", "A: b"]), 400),
        ("two types", simulate(&["Content-Type: text/plain", "Content-Length: 2"], b"{}"), 400),
        (
            "two idempotency keys",
            simulate(&["Idempotency-Key: a", "Idempotency-Key: b", "Content-Length: 2"], b"{}"),
            400,
        ),
        (
            "two conditions",
            head(&["DELETE /contacts/7 HTTP/1.1", "Host: x", "If-Match: \"1\"", "If-Match: \"2\""]),
            400,
        ),
        ("two events", head(&["GET /contacts/7 HTTP/1.1", "Host: x", "Last-Event-ID: 1", "Last-Event-ID: 2"]), 400),
        // Too much of it.
        ("a long header", head(&["GET /healthz HTTP/1.1", &format!("A: {}", "b".repeat(100_000))]), 431),
        ("many headers", head(&[&["GET /healthz HTTP/1.1"], vec!["A: b"; 200].as_slice()].concat()), 431),
        ("endless headers", [b"GET /healthz HTTP/1.1\r\n".as_slice(), &b"A: b\r\n".repeat(MIB)].concat(), 431),
        ("a long path", line(&format!("GET /{} HTTP/1.1", "a".repeat(70_000))), 431),
        ("a path almost too long", line(&format!("GET /{} HTTP/1.1", "a".repeat(30_000))), 404),
        ("a long method", line(&format!("{} / HTTP/1.1", "A".repeat(20_000))), 405),
        ("many keys", line(&format!("GET /contacts?{} HTTP/1.1", "k=1&".repeat(7_000))), 422),
        ("many keys, no two alike", line(&format!("GET /contacts?{} HTTP/1.1", keys())), 422),
        ("broken keys", line(&format!("GET /contacts?{} HTTP/1.1", "%ff=%&%=&=".repeat(2_000))), 422),
        // Versions and methods.
        ("the first version", b"GET /healthz\r\n\r\n".to_vec(), 400),
        ("a version to come", line("GET /healthz HTTP/1.7"), 400),
        ("the next version", b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n".to_vec(), 0),
        ("TRACE", line("TRACE /healthz HTTP/1.1"), 405),
        ("CONNECT", line("CONNECT x:443 HTTP/1.1"), 403),
        ("OPTIONS of everything", line("OPTIONS * HTTP/1.1"), 404),
        ("an invented method", line("FROB /healthz HTTP/1.1"), 405),
        ("a method in small letters", line("get /healthz HTTP/1.1"), 405),
        ("no method", line(" /healthz HTTP/1.1"), 400),
        ("no path", line("GET HTTP/1.1"), 400),
        // Paths.
        ("upwards", line("GET /../../etc/passwd HTTP/1.1"), 404),
        ("upwards in disguise", line("GET /contacts/%2e%2e/healthz HTTP/1.1"), 404),
        ("upwards from the documentation", line("GET /docs/%2e%2e%2f%2e%2e%2fetc%2fpasswd HTTP/1.1"), 404),
        ("two slashes", line("GET //healthz HTTP/1.1"), 404),
        ("a zero byte in the path", line("GET /contacts/%00 HTTP/1.1"), 404),
        ("no text in the path", line("GET /contacts/%ff%fe/events HTTP/1.1"), 404),
        ("a control character in the path", line("GET /\x01 HTTP/1.1"), 400),
        ("another host in the path", line("GET http://elsewhere/contacts/7 HTTP/1.1"), 403),
        // Bodies.
        ("a compressed body", simulate(&["Content-Encoding: gzip", "Content-Length: 2"], b"\x1f\x8b"), 415),
        ("a body compressed twice", simulate(&["Content-Encoding: br, gzip", "Content-Length: 2"], b"\x1f\x8b"), 415),
        ("more than a body may have", simulate(&["Content-Length: 9000000"], b"{}"), 413),
        ("half a body", simulate(&["Content-Length: 20"], b"{\"contact\":"), 408),
        ("half a chunk", simulate(&[chunked], b"ff\r\n{\"contact\":"), 408),
        // No HTTP at all.
        ("TLS", [b"\x16\x03\x01\x00\xa5\x01\x00\x00\xa1\x03\x03".as_slice(), &[0; 200]].concat(), 400),
        ("zero bytes", vec![0; 10_000], 400),
        ("empty lines", b"\r\n".repeat(50_000), 431),
        ("half a head", b"GET /healthz HTTP/1.1\r\nHost: localhost".to_vec(), 0),
        ("nothing", Vec::new(), 0),
    ]
}

fn keys() -> String {
    (0..3_000).map(|number| format!("k{number}=1&")).collect()
}

/// The answer to a hostile request of this length, alone or in one segment with a sound one before it.
fn check(name: &str, length: usize, status: u16, behind: bool, answer: &Answer) {
    let sound = behind.then_some(200);
    let expected: Vec<u16> = sound.into_iter().chain((status != 0).then_some(status)).collect();
    // A reply can be lost where the server closes a connection that still carries data.
    let lost = answer.statuses.len() < expected.len() && length > 50_000;
    assert!(answer.statuses == expected || lost, "{name}: expected {expected:?}, got {}", answer.text);
    // What our own code refuses is a document.
    if [403, 404, 405, 408, 415, 422].contains(&status) && !lost {
        assert!(answer.text.contains("application/problem+json"), "{name}: {}", answer.text);
    }
}

#[tokio::test]
async fn every_hostile_request_is_refused() {
    let times = ["--head-time", "1s", "--idle-time", "200ms", "--body-time", "500ms"];
    let service = Service::start(&times);
    assert_eq!(service.exchange(get("/healthz").as_bytes()).await.statuses, [200]);
    let before = service.peak();
    let cases = cases();
    for before in [&[], HIDDEN] {
        let all: Vec<_> = cases.iter().map(|(_, bytes, _)| [before, bytes].concat()).collect();
        let answers = join_all(all.iter().map(|bytes| service.exchange(bytes))).await;
        for ((name, bytes, status), answer) in cases.iter().zip(answers) {
            check(name, bytes.len(), *status, !before.is_empty(), &answer);
        }
    }
    // All that they send and the buffers of so many connections; the allocator keeps some of what it has freed.
    let grown = service.peak() - before;
    assert!(grown < 48 * MIB, "{grown} bytes more");
    assert_eq!(service.exchange(get("/healthz").as_bytes()).await.statuses, [200]);
    let log = service.log();
    assert!(!log.contains("panicked"), "{log}");
}

#[tokio::test]
async fn a_body_that_is_announced_may_come_and_need_not() {
    let service = Service::start(&["--head-time", "1s", "--idle-time", "200ms", "--body-time", "500ms"]);
    let announced = simulate(&["Expect: 100-continue", "Content-Length: 2"], b"");
    assert_eq!(service.exchange(&announced).await.statuses, [100, 408]);
    let too_long = simulate(&["Expect: 100-continue", "Content-Length: 9000000000"], b"");
    assert_eq!(service.exchange(&too_long).await.statuses, [413]);
    let sent = simulate(&["Expect: 100-continue", "Content-Length: 2"], b"{}");
    assert_eq!(service.exchange(&sent).await.statuses.last(), Some(&422));
}

/// The other limits are longer than the test waits: what closes the connection is the reply.
#[tokio::test]
async fn a_body_that_stalls_ends_its_connection() {
    let service = Service::start(&["--body-time", "200ms", "--head-time", "1h", "--idle-time", "1h"]);
    for stalled in [
        simulate(&["Content-Length: 20"], b"{\"contact\":"),
        simulate(&["Transfer-Encoding: chunked"], b"ff\r\n{\"contact\":"),
    ] {
        let answer = service.exchange(&stalled).await;
        assert_eq!(answer.statuses, [408]);
        assert!(answer.text.to_ascii_lowercase().contains("\r\nconnection: close\r\n"), "{}", answer.text);
    }
}

#[tokio::test]
async fn several_sound_requests_on_one_connection_are_answered_in_order() {
    let service = Service::start(&["--idle-time", "200ms"]);
    let body = simulate(&["Content-Length: 2"], b"{}");
    let sound = [line("GET /healthz HTTP/1.1"), body, line("GET /nowhere HTTP/1.1"), line("GET /readyz HTTP/1.1")];
    assert_eq!(service.exchange(&sound.concat()).await.statuses, [200, 422, 404, 200]);
    // More than is read at a time.
    assert_eq!(service.exchange(&sound.concat().repeat(400)).await.statuses, [200, 422, 404, 200].repeat(400));
    // Chunks end a connection: what follows them is not read.
    let chunks = simulate(&["Transfer-Encoding: chunked"], &[b"2\r\n{}\r\n0\r\n\r\n", HIDDEN].concat());
    let answer = service.exchange(&chunks).await;
    assert_eq!(answer.statuses, [422]);
    assert!(answer.text.contains("connection: close"), "{}", answer.text);
    // The version before this one names no host.
    assert_eq!(service.exchange(&head(&["GET /healthz HTTP/1.0"])).await.statuses, [200]);
}
