//! The bytes that count against a quota, beside those that a file and a database take.

use std::path::Path;

use stickslip::store::{PostgresStore, SqliteStore, Store, Tenant};
use tempfile::tempdir;

use crate::common::postgres::{Cluster, connected};
use crate::fixtures::{records, session};

const MOVES: u64 = 20_000;

/// Stores moves in paths of 1000, as the numbers of real ones: none of them is short.
async fn fill(store: &dyn Store) {
    let made = session(None);
    store.create(made.clone(), None).await.unwrap();
    for after in (0..MOVES).step_by(1_000) {
        store.append(made.id, after, records(after, after + 1_000), None).await.unwrap();
    }
}

fn agree(counted: u64, taken: u64, moves: u64) {
    println!("{} bytes a move, counted as {}", taken / moves, counted / moves);
    assert!(taken <= counted && counted <= 2 * taken, "{taken} bytes are taken, and {counted} counted");
}

#[tokio::test]
async fn what_is_counted_is_what_a_file_takes() {
    let folder = tempdir().unwrap();
    let [empty, full] = ["empty.db", "full.db"].map(|name| folder.path().join(name));
    let size = |path: &Path| std::fs::metadata(path).unwrap().len();
    drop(SqliteStore::open(&empty).unwrap());
    let store = SqliteStore::open(&full).unwrap();
    fill(&store).await;
    let counted = store.usage(&Tenant::default()).await.unwrap().bytes;
    drop(store);
    agree(counted, size(&full) - size(&empty), MOVES);
}

#[tokio::test]
async fn what_is_counted_is_what_a_database_takes() {
    let url = Cluster::shared().database().await;
    let store = PostgresStore::open(&url).await.unwrap();
    fill(&store).await;
    let counted = store.usage(&Tenant::default()).await.unwrap().bytes;
    let client = connected(&url).await;
    let taken: i64 = client.query_one("SELECT pg_total_relation_size('moves')", &[]).await.unwrap().get(0);
    agree(counted, taken as u64, MOVES);
}
