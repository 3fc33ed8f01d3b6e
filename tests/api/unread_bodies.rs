//! Requests that are refused by their heads while their bodies are on the way: the next request of the connection is
//! served, or the reply says that there will be none.

use crate::common::PATIENCE;
use crate::common::raw::Service;

use std::time::Duration;

use stickslip::access::{Role, new_key};
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::TcpStream;
use tokio::time::{sleep, timeout};

const NEXT: &str = "GET /healthz HTTP/1.1\r\nhost: localhost\r\nconnection: close\r\n\r\n";
const BODY: usize = 1024 * 1024;

fn head(line: &str, key: &str, more: &str) -> String {
    format!("{line} HTTP/1.1\r\nhost: localhost\r\n{key}{more}content-length: {BODY}\r\n\r\n")
}

#[tokio::test(flavor = "multi_thread")]
async fn a_refusal_by_the_head_leaves_the_connection_usable_or_says_that_it_ends() {
    let keys =
        [("reader", Role::Read), ("writer", Role::Write)].map(|(name, role)| new_key(name, &[role], "", None).unwrap());
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("keys");
    std::fs::write(&file, keys.each_ref().map(|key| key.entry.as_str()).join("\n")).unwrap();
    let service = Service::start(&["--keys", file.to_str().unwrap()]);
    let [read, write] = keys.each_ref().map(|key| format!("authorization: Bearer {}\r\n", key.key));
    let json = "content-type: application/json\r\n";
    for (status, line, key, more) in [
        (401, "POST /simulate", "", json),
        (403, "POST /contacts", &*read, json),
        (404, "POST /nowhere", &*write, json),
        (405, "POST /healthz", &*write, json),
        (415, "POST /simulate", &*read, "content-type: text/plain\r\n"),
        (422, "GET /contacts?limit=none", &*write, json),
    ] {
        let head = head(line, key, more);
        // All at once: nothing is in the way of the next request.
        let answer = service.exchange(&[head.as_bytes(), &vec![b' '; BODY], NEXT.as_bytes()].concat()).await;
        assert_eq!(answer.statuses, [status, 200], "{line}: {}", answer.text);
        // The body some time later.
        let (mut reader, mut writer) = TcpStream::connect(service.address).await.unwrap().into_split();
        writer.write_all(head.as_bytes()).await.unwrap();
        sleep(Duration::from_millis(300)).await;
        let rest = [&vec![b' '; BODY], NEXT.as_bytes()].concat();
        // The server may have closed the connection, if it says so.
        let write = tokio::spawn(async move {
            let _ = writer.write_all(&rest).await;
            writer
        });
        let mut bytes = Vec::new();
        let _ = timeout(PATIENCE, reader.read_to_end(&mut bytes)).await.expect("the connection stays open");
        drop(write.await);
        let text = String::from_utf8_lossy(&bytes).into_owned();
        let first = text.split("\r\n\r\n").next().unwrap().to_lowercase();
        assert!(first.starts_with(&format!("http/1.1 {status}")), "{line}: {text}");
        let served = text.matches("HTTP/1.1").count() == 2 && text.contains("HTTP/1.1 200");
        assert!(served || first.contains("connection: close"), "{line}: {text}");
        // A client that waits to be asked for its body is not asked.
        let expecting = head.replace("content-length", "expect: 100-continue\r\ncontent-length");
        let answer = service.exchange(expecting.as_bytes()).await;
        assert_eq!(answer.statuses, [status], "{line}: {}", answer.text);
        assert!(answer.text.to_lowercase().contains("connection: close"), "{line}: {}", answer.text);
    }
}
