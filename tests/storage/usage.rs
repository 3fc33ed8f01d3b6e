//! The bytes that count against a quota, beside those that a file and a database take.

use stickslip::store::{Store, Tenant};

use crate::common::place::Place;
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

#[tokio::test]
async fn what_is_counted_is_what_a_file_or_a_database_takes() {
    for place in Place::both().await {
        let taken = async || match place.path() {
            Some(path) => path.metadata().unwrap().len(),
            None => place.number("SELECT pg_total_relation_size('moves')").await as u64,
        };
        drop(place.open().await);
        let empty = taken().await;
        let store = place.open().await;
        fill(&*store).await;
        let counted = store.usage(&Tenant::default()).await.unwrap().bytes;
        drop(store);
        let taken = taken().await - empty;
        println!("{} bytes a move, counted as {}", taken / MOVES, counted / MOVES);
        assert!(taken <= counted && counted <= 2 * taken, "{taken} bytes are taken, and {counted} counted");
    }
}

/// Ten million replies would be beyond the time limit of a statement.
#[tokio::test]
async fn the_space_of_kept_replies_is_read_from_an_index_of_the_database() {
    let url = Cluster::shared().database().await;
    drop(stickslip::store::open(&url).await.unwrap());
    let database = connected(&url).await;
    for statement in ["VACUUM receipts", "SET enable_seqscan = off", "SET enable_bitmapscan = off"] {
        database.batch_execute(statement).await.unwrap();
    }
    let sum = "EXPLAIN SELECT coalesce(sum(256 + bytes), 0) FROM receipts WHERE tenant = 'lab'";
    let plan = database.query(sum, &[]).await.unwrap().iter().map(|row| row.get::<_, String>(0)).collect::<String>();
    assert!(plan.contains("Index Only Scan using receipts_by_tenant"), "{plan}");
}
