//! `last` shows the newest moves, plots show them by default, and tables that are read row by row have all of them.

use crate::common::{Server, good, problem};

use arrow_ipc::reader::StreamReader;
use reqwest::Method;
use serde_json::{Value, json};

/// More than two pages of a table that is sent piece by piece.
const MOVES: usize = 1_234;

/// A server, and the path of a contact with that many moves behind it.
async fn moved() -> (Server, String) {
    let server = Server::start().await;
    let contact = format!("/contacts/{}", server.contact().await);
    let targets: Vec<f64> = (0..MOVES).map(|index| 1e-7 * f64::from(index as u32).sin()).collect();
    let path = json!({"path": {"displacement": targets}, "steps": "last"});
    assert!(server.post(&format!("{contact}/path"), &path).await.status().is_success());
    (server, contact)
}

async fn text(server: &Server, path: &str) -> String {
    let response = server.get(path).await;
    assert!(response.status().is_success(), "{path}");
    response.text().await.unwrap()
}

/// All items of the history, page by page.
async fn pages(server: &Server, contact: &str) -> Vec<Value> {
    let (mut items, mut after) = (Vec::new(), json!(0));
    while !after.is_null() {
        let page = good(server.get(&format!("{contact}/history?limit=1000&after={after}")).await).await;
        items.extend(page["items"].as_array().unwrap().clone());
        after = page["next"].clone();
    }
    items
}

#[tokio::test]
async fn last_is_the_newest_moves() {
    let (server, contact) = moved().await;
    let all = pages(&server, &contact).await;
    let newest = good(server.get(&format!("{contact}/history?last=3")).await).await;
    assert_eq!(newest["items"].as_array().unwrap()[..], all[MOVES - 3..]);
    assert_eq!(newest["next"], json!(null));
    let newest = good(server.get(&format!("{contact}/loop?last=2&points_per_move=2")).await).await;
    let sequence = newest["sequence"].as_array().unwrap();
    assert_eq!(sequence[sequence.len() - 4..], [MOVES - 1, MOVES - 1, MOVES, MOVES].map(|number| json!(number)));
    assert_eq!(newest["force"].as_array().unwrap().last(), Some(&all[MOVES - 1]["state"]["force"]));
    for refused in ["last=0", "last=1001", "last=5&after=3", "last=5&limit=3"] {
        let fault = problem(server.get(&format!("{contact}/history?{refused}")).await).await;
        assert_eq!(fault.errors[0].pointer, "/last", "{refused}: {fault:?}");
    }
}

#[tokio::test]
async fn a_plot_shows_the_newest_moves_and_says_which() {
    let (server, contact) = moved().await;
    for (query, shown) in [
        ("history?format=svg", "moves 1135 to 1234"),
        ("loop?format=svg", "moves 1135 to 1234"),
        ("loop?format=svg&limit=10", "moves 1225 to 1234"),
        ("history?format=svg&last=1", "move 1234"),
        ("history?format=svg&after=0&limit=50", "moves 1 to 50"),
    ] {
        let plot = text(&server, &format!("{contact}/{query}")).await;
        assert!(plot.contains(shown), "{query} does not say {shown}");
    }
}

#[tokio::test]
async fn tables_that_are_read_row_by_row_have_all_moves() {
    let (server, contact) = moved().await;
    for resource in ["history", "loop?points_per_move=3"] {
        let join = if resource.contains('?') { '&' } else { '?' };
        let path = |rest: &str| format!("{contact}/{resource}{join}{rest}");
        // The same rows as those of its pages, under one line of names.
        let mut expected = text(&server, &path("format=csv&limit=1000&after=0")).await;
        let rest = text(&server, &path("format=csv&limit=1000&after=1000")).await;
        let (_, rest) = rest.split_once('\n').unwrap();
        expected.push_str(rest);
        let all = text(&server, &path("format=csv")).await;
        assert!(all == expected, "{resource}: all rows are not those of the pages");
        let rows = all.lines().count() - 1;
        let lines = text(&server, &path("format=ndjson")).await;
        assert_eq!(lines.lines().count(), rows);
        assert!(lines.lines().all(|line| serde_json::from_str::<Value>(line).is_ok()));
        let arrow = server.get(&path("format=arrow")).await;
        let tag = arrow.headers()["etag"].to_str().unwrap().to_owned();
        let bytes = arrow.bytes().await.unwrap();
        let batches = StreamReader::try_new(&bytes[..], None).unwrap().map(|batch| batch.unwrap().num_rows());
        assert_eq!(batches.sum::<usize>(), rows);
        let known = [("if-none-match", &tag[..])];
        assert_eq!(server.send(Method::GET, &path("format=arrow"), None, &known).await.status(), 304);
    }
}

#[tokio::test]
async fn a_contact_that_has_not_moved_has_an_empty_table() {
    let server = Server::start().await;
    let contact = format!("/contacts/{}", server.contact().await);
    let csv = text(&server, &format!("{contact}/history?format=csv")).await;
    assert!(csv.starts_with("sequence,at,displacement") && csv.lines().count() == 1, "{csv}");
    let arrow = server.get(&format!("{contact}/history?format=arrow")).await.bytes().await.unwrap();
    let mut batches = StreamReader::try_new(&arrow[..], None).unwrap();
    assert!(batches.all(|batch| batch.unwrap().num_rows() == 0));
    assert_eq!(server.get("/contacts/01980000-0000-7000-8000-000000000000/history?format=csv").await.status(), 404);
}
