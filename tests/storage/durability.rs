//! Nothing acknowledged is lost: by a kill, by a stop, or by another version.

use crate::common;

use common::kill;
use tempfile::tempdir;

#[tokio::test(flavor = "multi_thread")]
async fn kills_under_load_lose_nothing_and_double_nothing() {
    let folder = tempdir().unwrap();
    let store = format!("sqlite:{}", folder.path().join("killed.db").display());
    kill::survives(&store, 20, 4).await;
}

#[tokio::test(flavor = "multi_thread")]
async fn kills_under_load_lose_nothing_and_double_nothing_in_postgres() {
    let store = common::postgres::Cluster::shared().database().await;
    kill::survives(&store, 20, 5).await;
}
