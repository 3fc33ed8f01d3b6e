//! What every store promises, whatever it is made of.

mod common;
mod promises;

use std::future::ready;
use std::sync::Arc;

use stickslip::store::{MemoryStore, SqliteStore, Store};
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
