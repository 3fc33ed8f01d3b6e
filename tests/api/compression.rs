//! Compressed replies hold the same bytes, and their tags work as the client got them.

use crate::common;

use std::io::Read as _;
use std::time::Duration;

use common::{Server, ball, problem, until};
use flate2::read::GzDecoder;
use reqwest::{Method, Response};
use serde_json::{Value, json};
use stickslip::admission::Pool;

use crate::formats::moved;

const CODINGS: [&str; 2] = ["gzip", "zstd"];

async fn get(server: &Server, path: &str, headers: &[(&str, &str)]) -> Response {
    server.send(Method::GET, path, None, headers).await
}

fn header<'a>(response: &'a Response, name: &str) -> Option<&'a str> {
    response.headers().get(name).map(|value| value.to_str().unwrap())
}

/// The fields that a reply varies by.
fn vary(response: &Response) -> Vec<&str> {
    response.headers().get_all("vary").iter().map(|value| value.to_str().unwrap()).collect()
}

fn decoded(coding: &str, bytes: &[u8]) -> Vec<u8> {
    let mut plain = Vec::new();
    match coding {
        "gzip" => GzDecoder::new(bytes).read_to_end(&mut plain).unwrap(),
        _ => zstd::Decoder::new(bytes).unwrap().read_to_end(&mut plain).unwrap(),
    };
    plain
}

#[tokio::test]
async fn each_format_decodes_to_the_bytes_that_it_has_without_a_coding() {
    let (server, contact) = moved().await;
    for format in ["columns", "rows", "csv", "ndjson", "arrow", "svg"] {
        let path = format!("{contact}/stress?points=500&format={format}");
        let plain = get(&server, &path, &[]).await;
        assert_eq!((header(&plain, "content-encoding"), vary(&plain)), (None, vec!["accept", "accept-encoding"]));
        let tag = header(&plain, "etag").unwrap().to_owned();
        let plain = plain.bytes().await.unwrap();
        for coding in CODINGS {
            let response = get(&server, &path, &[("accept-encoding", coding)]).await;
            assert_eq!(response.status(), 200);
            assert_eq!(header(&response, "content-encoding"), Some(coding), "{format}");
            assert_eq!(header(&response, "content-length"), None);
            assert_eq!(vary(&response), ["accept", "accept-encoding"]);
            assert_eq!(header(&response, "etag"), Some(&*tag), "a version is the same in every coding");
            let packed = response.bytes().await.unwrap();
            assert!(packed.len() < plain.len(), "{format} {coding}: {} {}", packed.len(), plain.len());
            assert_eq!(decoded(coding, &packed), plain, "{format} {coding}");
        }
        // The coding that a client prefers is used, and none that it refuses.
        let response = get(&server, &path, &[("accept-encoding", "gzip;q=0.5, zstd;q=0.2, br")]).await;
        assert_eq!(header(&response, "content-encoding"), Some("gzip"));
        // A list may be sent in several lines.
        let response = get(&server, &path, &[("accept-encoding", "br"), ("accept-encoding", "gzip")]).await;
        assert_eq!(header(&response, "content-encoding"), Some("gzip"));
        for refusal in ["identity", "br", "gzip;q=0", "*;q=0"] {
            let response = get(&server, &path, &[("accept-encoding", refusal)]).await;
            assert_eq!((response.status().as_u16(), header(&response, "content-encoding")), (200, None), "{refusal}");
            assert_eq!(response.bytes().await.unwrap(), plain);
        }
    }
}

#[tokio::test]
async fn short_compressed_and_streamed_replies_stay_unchanged() {
    let (server, contact) = moved().await;
    let accept = [("accept-encoding", "gzip, zstd")];
    for path in ["/healthz", &format!("{contact}/stress?format=png"), &format!("{contact}/events"), "/none"] {
        let response = get(&server, path, &accept).await;
        assert_eq!(header(&response, "content-encoding"), None, "{path}");
        assert!(!vary(&response).contains(&"accept-encoding"), "{path}");
    }
    // An event comes at once, and does not wait for others to be packed with.
    let path = format!("{contact}/events");
    let mut events = get(&server, &path, &[accept[0], ("last-event-id", "0")]).await;
    assert_eq!(header(&events, "content-type"), Some("text/event-stream"));
    let first = tokio::time::timeout(Duration::from_secs(30), events.chunk()).await.unwrap().unwrap().unwrap();
    assert!(!first.is_empty());

    // The files of the page were packed when the program was built.
    let source = std::fs::read("src/page/main.js").unwrap();
    let mut tags = Vec::new();
    for (accepted, coding) in [("identity", None), ("br, gzip;q=0.5", Some("gzip")), ("gzip;q=0", None)] {
        let accept = ("accept-encoding", accepted);
        let reply = get(&server, "/page/main.js", &[accept]).await;
        assert_eq!((reply.status().as_u16(), header(&reply, "content-encoding")), (200, coding), "{accepted}");
        assert_eq!(vary(&reply), ["accept-encoding"]);
        let tag = header(&reply, "etag").unwrap().to_owned();
        assert_eq!(reply.bytes().await.unwrap() == source, coding.is_none(), "{accepted}");
        let again = get(&server, "/page/main.js", &[accept, ("if-none-match", &tag)]).await;
        assert_eq!(
            (again.status().as_u16(), header(&again, "etag"), vary(&again)),
            (304, Some(&*tag), vec!["accept-encoding"])
        );
        assert!(again.bytes().await.unwrap().is_empty());
        tags.push(tag);
    }
    // Weak, because it is that of two forms.
    assert!(tags.iter().all(|tag| tag == &tags[0] && tag.starts_with("W/\"")), "{tags:?}");
    assert_eq!(problem(get(&server, "/page/..%2Fmain.rs", &[]).await).await.code, "not_found");
}

#[tokio::test]
async fn the_page_of_the_api_has_all_of_its_files_and_opens_the_document() {
    let server = Server::start().await;
    let page = server.get("/docs/").await.text().await.unwrap();
    let named = ["src=\"", "href=\""].iter().flat_map(|start| page.split(start).skip(1));
    let files: Vec<&str> = named.filter_map(|rest| rest.split('"').next()).collect();
    assert!(files.len() >= 7, "{files:?}");
    for file in files {
        let path = format!("/docs/{}", file.trim_start_matches("./"));
        let plain = get(&server, &path, &[]).await;
        let kind = header(&plain, "content-type").unwrap();
        let end = file.rsplit('.').next().unwrap();
        assert!(kind.contains(if end == "js" { "javascript" } else { end }), "{path}: {kind}");
        let plain = plain.bytes().await.unwrap();
        let packed = get(&server, &path, &[("accept-encoding", "gzip")]).await;
        assert_eq!(header(&packed, "content-encoding"), Some("gzip"), "{path}");
        assert!(decoded("gzip", &packed.bytes().await.unwrap()) == plain && !plain.is_empty(), "{path}");
    }
    let opening = server.get("/docs/swagger-initializer.js").await.text().await.unwrap();
    assert!(opening.contains("url: \"/openapi.json\"") && !opening.contains("://"), "{opening}");
}

#[tokio::test]
async fn a_whole_history_is_compressed_as_it_is_sent() {
    let (server, contact) = moved().await;
    let path = json!({"path": {"falling_amplitude": {"reversals": 1200, "amplitude": 1e-8}}, "steps": "last"});
    let moved = server.send(Method::POST, &format!("{contact}/path"), Some(&path.to_string()), &[]).await;
    assert_eq!(moved.status(), 200);
    for format in ["csv", "ndjson", "arrow"] {
        let path = format!("{contact}/history?format={format}");
        let plain = get(&server, &path, &[]).await.bytes().await.unwrap();
        for coding in CODINGS {
            let reply = get(&server, &path, &[("accept-encoding", coding)]).await;
            assert_eq!(header(&reply, "content-encoding"), Some(coding), "{format}");
            let packed = reply.bytes().await.unwrap();
            assert!(packed.len() < plain.len() / 2, "{format} {coding}: {} of {}", packed.len(), plain.len());
            assert_eq!(decoded(coding, &packed), plain, "{format} {coding}");
        }
    }
}

#[tokio::test]
async fn the_head_is_that_of_the_reply() {
    let (server, contact) = moved().await;
    let path = format!("{contact}/stress?points=500");
    for accept in [&[][..], &[("accept-encoding", "gzip")], &[("accept-encoding", "zstd")]] {
        let whole = get(&server, &path, accept).await;
        let head = server.send(Method::HEAD, &path, None, accept).await;
        for name in ["content-type", "content-encoding", "content-length", "etag"] {
            assert_eq!(header(&head, name), header(&whole, name), "{name} {accept:?}");
        }
        assert_eq!(vary(&head), vary(&whole));
        assert_eq!(head.bytes().await.unwrap().len(), 0);
    }
}

#[tokio::test]
async fn a_client_that_accepts_nothing_gets_the_reply_to_what_was_done() {
    let (server, contact) = moved().await;
    let body = json!({"displacement": 1e-9, "relative": true}).to_string();
    let headers = [("accept-encoding", "identity;q=0")];
    let response = server.send(Method::POST, &format!("{contact}/move"), Some(&body), &headers).await;
    assert_eq!((response.status().as_u16(), header(&response, "etag")), (200, Some("\"4\"")));
    let state: Value = get(&server, &contact, &[]).await.json().await.unwrap();
    assert_eq!(state["sequence"], 4);
}

#[tokio::test]
async fn an_encoder_counts_as_memory_until_its_reply_is_sent() {
    let pool = Pool::with_defaults();
    let server = Server::in_pool(pool.clone()).await;
    let contact = format!("/contacts/{}", server.contact().await);
    let long = json!({"contact": ball(), "path": {"falling_amplitude": {"reversals": 1900}}}).to_string();
    for coding in CODINGS {
        let response = server.send(Method::POST, "/simulate", Some(&long), &[("accept-encoding", coding)]).await;
        assert_eq!(header(&response, "content-encoding"), Some(coding));
        // More than the sockets between the two hold is still to come.
        let whole = response.bytes().await.unwrap();
        assert!(serde_json::from_slice::<Value>(&decoded(coding, &whole)).unwrap()["steps"][1899].is_object());
        until("its memory is released", async || (pool.taken().bytes == 0).then_some(())).await;
    }
    // Without memory for an encoder the reply goes as it is.
    let mut all = Vec::new();
    while let Some(encoder) = pool.try_reserve_encoder() {
        all.push(encoder);
    }
    let path = format!("{contact}/stress?points=500");
    let response = get(&server, &path, &[("accept-encoding", "gzip")]).await;
    assert_eq!((response.status().as_u16(), header(&response, "content-encoding")), (200, None));
    drop(all);
    let response = get(&server, &path, &[("accept-encoding", "gzip")]).await;
    assert_eq!(header(&response, "content-encoding"), Some("gzip"));
}
