//! What every store promises, whatever it is made of.

use crate::common;
use crate::promises;

use std::future::ready;
use std::sync::Arc;

use common::postgres::Cluster;
use stickslip::store::{MemoryStore, PostgresStore, SqliteStore, Store};
use tempfile::tempdir;

#[tokio::test]
async fn memory_keeps_the_promises() {
    promises::are_kept(|| ready(Arc::new(MemoryStore::new()) as Arc<dyn Store>)).await;
}

#[tokio::test]
async fn sqlite_keeps_the_promises() {
    let folder = tempdir().unwrap();
    let count = std::cell::Cell::new(0);
    promises::are_kept(|| {
        count.set(count.get() + 1);
        let path = folder.path().join(format!("{}.db", count.get()));
        ready(Arc::new(SqliteStore::open(&path).unwrap()) as Arc<dyn Store>)
    })
    .await;
}

#[tokio::test]
async fn postgres_keeps_the_promises() {
    promises::are_kept(async || {
        let url = Cluster::shared().database().await;
        Arc::new(PostgresStore::open(&url).await.unwrap()) as Arc<dyn Store>
    })
    .await;
}
