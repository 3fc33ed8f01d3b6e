//! A store that does not answer: requests are refused after the time that the documentation gives, and nothing is lost
//! or doubled when it answers again.

use crate::common;

use std::sync::Arc;
use std::time::{Duration, Instant};

use common::postgres::Cluster;
use common::{Server, ball, until};
use futures::future::join_all;
use reqwest::{Method, StatusCode};
use rusqlite::Connection;
use serde_json::{Value, json};
use stickslip::sessions::CAPACITY;
use stickslip::store::{PostgresStore, SqliteStore};
use tempfile::tempdir;

/// The documentation gives 2 s for a file and 15 s for a database, and all wait at once: one after the other they would
/// take 24 s and minutes. A busy machine stays far below that.
const FILE_LIMIT: Duration = Duration::from_secs(20);
const DATABASE_LIMIT: Duration = Duration::from_secs(60);
const CONTACTS: usize = 12;

/// A request with an idempotency key; the time that it took, and its status.
async fn timed(server: &Server, method: Method, path: &str, body: Option<Value>, key: &str) -> (Duration, StatusCode) {
    let begin = Instant::now();
    let body = body.map(|body| body.to_string());
    let headers = [("idempotency-key", key)];
    let reply = server.send(method, path, body.as_deref(), if key.is_empty() { &[] } else { &headers }).await;
    (begin.elapsed(), reply.status())
}

/// Moves of all contacts, new contacts, and questions, all at once.
async fn all_at_once(server: &Server, ids: &[String], reads: bool) -> Vec<(Duration, StatusCode)> {
    let step = json!({"displacement": 1e-8, "relative": true});
    let moves = ids.iter().map(|id| {
        let path = format!("/contacts/{id}/move");
        let step = step.clone();
        async move { timed(server, Method::POST, &path, Some(step), id).await }
    });
    let new = join_all((0..CONTACTS).map(|_| timed(server, Method::POST, "/contacts", Some(ball()), "")));
    let ready = timed(server, Method::GET, "/readyz", None, "");
    let questions = ids.iter().filter(|_| reads).map(|id| {
        let path = format!("/contacts/{id}/history");
        async move { timed(server, Method::GET, &path, None, "").await }
    });
    let (mut moves, new, ready, questions) = futures::join!(join_all(moves), new, ready, join_all(questions));
    moves.extend(questions);
    moves.extend(new);
    moves.push(ready);
    moves
}

/// All are refused in time while the store is frozen, and made once when it is not. The contacts are made by another
/// server, which may be the same.
async fn is_survived<T>(maker: &Server, server: &Server, freeze: impl FnOnce() -> T, reads: bool, limit: Duration) {
    let ids = join_all((0..CONTACTS).map(|_| maker.contact())).await;
    let frozen = freeze();
    for round in 0..2 {
        for (time, status) in all_at_once(server, &ids, reads).await {
            assert_eq!(status, StatusCode::SERVICE_UNAVAILABLE);
            assert!(time < limit, "round {round}: an answer after {time:?}");
        }
    }
    assert_eq!(server.get("/healthz").await.status(), StatusCode::OK);
    drop(frozen);
    until("it is ready again", async || (server.get("/readyz").await.status() == StatusCode::OK).then_some(())).await;
    for id in &ids {
        let step = json!({"displacement": 1e-8, "relative": true});
        let path = format!("/contacts/{id}/move");
        assert_eq!(timed(server, Method::POST, &path, Some(step), id).await.1, StatusCode::OK);
        let contact: Value = server.get(&format!("/contacts/{id}")).await.json().await.unwrap();
        assert_eq!(contact["sequence"], 1);
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn a_frozen_database_is_admitted_in_time() {
    let cluster = Cluster::start();
    let url = cluster.database().await;
    let open = async || {
        let store = PostgresStore::open(&url).await.unwrap();
        Server::with(Arc::new(store), CAPACITY).await
    };
    // The second one has not counted yet what is stored when the database freezes.
    let (maker, server) = (open().await, open().await);
    is_survived(&maker, &server, || cluster.freeze(), true, DATABASE_LIMIT).await;
}

#[tokio::test(flavor = "multi_thread")]
async fn a_file_that_another_program_has_locked_is_admitted_in_time() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("locked.db");
    let server = Server::with(Arc::new(SqliteStore::open(&path).unwrap()), CAPACITY).await;
    let lock = || {
        let other = Connection::open(&path).unwrap();
        other.execute_batch("BEGIN IMMEDIATE").unwrap();
        other
    };
    // Readers do not wait for the writers of a file.
    is_survived(&server, &server, lock, false, FILE_LIMIT).await;
}
