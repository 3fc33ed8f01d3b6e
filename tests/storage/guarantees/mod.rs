//! The guarantees of the `Store` trait, which every store gives: one function each. Each function gets a store of its
//! own, and assumes that it may hold contacts of others.

mod contacts;
mod exactness;
mod expiry;
mod idempotency;
mod jobs;
mod tenants;
mod wake_ups;

use std::future::{Future, ready};
use std::sync::Arc;

use stickslip::store::{PostgresStore, SqliteStore, Store};
use tempfile::tempdir;
use uuid::Uuid;

use crate::common::postgres::Cluster;

#[tokio::test]
async fn memory_gives_the_guarantees() {
    are_given(|| ready(Arc::new(SqliteStore::in_memory().unwrap()) as Arc<dyn Store>)).await;
}

#[tokio::test]
async fn sqlite_gives_the_guarantees() {
    let folder = tempdir().unwrap();
    let count = std::cell::Cell::new(0);
    are_given(|| {
        count.set(count.get() + 1);
        let path = folder.path().join(format!("{}.db", count.get()));
        ready(Arc::new(SqliteStore::open(&path).unwrap()) as Arc<dyn Store>)
    })
    .await;
}

#[tokio::test]
async fn postgres_gives_the_guarantees() {
    are_given(async || {
        let url = Cluster::shared().database().await;
        Arc::new(PostgresStore::open(&url).await.unwrap()) as Arc<dyn Store>
    })
    .await;
}

/// Checks all guarantees, each with a store of its own.
async fn are_given<F: Future<Output = Arc<dyn Store>>>(store: impl Fn() -> F) {
    contacts::what_is_stored_is_found(&*store().await).await;
    contacts::sessions_are_listed_in_order_and_by_pages(&*store().await).await;
    contacts::a_label_changes_alone_and_finds_its_session(&*store().await).await;
    contacts::moves_are_appended_at_the_expected_sequence_alone(&*store().await).await;
    contacts::a_fork_shares_the_past_and_nothing_else(&*store().await).await;
    contacts::a_long_past_is_forked_and_deleted_while_others_move(store().await).await;
    contacts::what_is_deleted_is_gone(&*store().await).await;
    contacts::the_newest_snapshot_is_kept(&*store().await).await;
    exactness::every_number_is_read_to_the_last_bit(&*store().await).await;
    exactness::times_are_read_to_the_nanosecond(&*store().await).await;
    idempotency::a_receipt_is_returned_as_it_was_stored(&*store().await).await;
    idempotency::a_taken_key_refuses_every_change_and_changes_nothing(&*store().await).await;
    idempotency::a_refused_change_takes_no_key(&*store().await).await;
    idempotency::one_of_many_with_the_same_key_or_sequence_wins(store().await).await;
    expiry::idle_sessions_expire_and_the_others_stay(&*store().await).await;
    expiry::receipts_in_their_time_survive_a_sweep(&*store().await).await;
    tenants::a_session_is_its_tenants_for_ever(&*store().await).await;
    tenants::a_request_for_an_expired_contact_gets_its_tenant(&*store().await).await;
    tenants::what_a_tenant_takes_is_counted_apart_and_given_back(&*store().await).await;
    jobs::each_chunk_is_given_once_and_heard_once(&*store().await).await;
    jobs::a_taken_key_or_a_full_tenant_takes_no_job(&*store().await).await;
    wake_ups::a_waiting_listener_is_woken_by_a_change(&*store().await).await;
}

#[test]
fn timestamps_and_identifiers_agree_on_the_order() {
    let ids: Vec<Uuid> = (0..1000).map(|_| Uuid::now_v7()).collect();
    assert!(ids.is_sorted());
}
