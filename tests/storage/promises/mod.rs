//! The promises of the `Store` trait, one function each. Every function gets a store that nobody else uses, which may
//! hold sessions of others.

#![allow(dead_code, reason = "each test binary uses a part of it")]

mod changes;
mod jobs;
mod keys;
mod life;
mod numbers;
mod sweeping;
mod tenants;

use std::future::Future;
use std::sync::Arc;

use jiff::{SignedDuration, Timestamp};
use stickslip::store::{Receipt, Record, Reply, RequestKey, Session, Snapshot, Store, Tenant};
use stickslip_wire::{CreateRequest, Document as _, Move, Regime, State};
use uuid::Uuid;

use crate::common;

/// Checks all promises, each with a store of its own.
pub async fn are_kept<F: Future<Output = Arc<dyn Store>>>(store: impl Fn() -> F) {
    life::what_is_stored_is_found(&*store().await).await;
    life::sessions_are_listed_in_order_and_by_pages(&*store().await).await;
    life::moves_are_appended_at_the_expected_sequence_alone(&*store().await).await;
    life::a_fork_shares_the_past_and_nothing_else(&*store().await).await;
    life::a_long_past_is_forked_and_deleted_while_others_move(store().await).await;
    life::what_is_deleted_is_gone(&*store().await).await;
    life::the_newest_snapshot_is_kept(&*store().await).await;
    numbers::every_number_comes_back_to_the_last_bit(&*store().await).await;
    numbers::times_come_back_to_the_nanosecond(&*store().await).await;
    keys::a_receipt_comes_back_as_it_was_given(&*store().await).await;
    keys::a_taken_key_refuses_every_change_and_changes_nothing(&*store().await).await;
    keys::a_refused_change_takes_no_key(&*store().await).await;
    keys::one_of_many_with_the_same_key_or_sequence_wins(store().await).await;
    sweeping::idle_sessions_expire_and_the_others_stay(&*store().await).await;
    sweeping::receipts_in_their_time_survive_a_sweep(&*store().await).await;
    tenants::a_session_is_its_tenants_for_ever(&*store().await).await;
    tenants::who_asks_for_what_has_expired_is_told_whose_it_was(&*store().await).await;
    jobs::each_chunk_is_given_once_and_heard_once(&*store().await).await;
    jobs::a_taken_key_or_a_full_tenant_takes_no_job(&*store().await).await;
    changes::whoever_waits_is_woken_by_a_change(&*store().await).await;
}

/// Every digit, and the sign of nought, which `==` does not see.
fn exact(value: &impl std::fmt::Debug) -> String {
    format!("{value:?}")
}

/// A session that is not stored yet.
fn session(label: Option<&str>) -> Session {
    let definition = serde_json::from_value::<CreateRequest>(common::ball()).unwrap().check().unwrap().definition;
    let now = Timestamp::now();
    Session {
        id: Uuid::now_v7(),
        tenant: Tenant::default(),
        label: label.map(str::to_owned),
        definition: Arc::new(definition),
        sequence: 0,
        created_at: now,
        updated_at: now,
    }
}

/// A move whose numbers tell it from every other.
fn record(sequence: u64) -> Record {
    let number = sequence as f64 + 0.1;
    Record {
        sequence,
        step: Move { displacement: Some(number * 1e-9), relative: sequence.is_multiple_of(2), ..Move::default() },
        tolerance: 1e-10 / number,
        state: State {
            displacement: number * 1e-9,
            force: number / 3.0,
            indentation: 1.0 / number,
            normal_force: number.sqrt(),
            contact_radius: number.ln_1p(),
            stick_radius: number.sin(),
            regime: [Regime::Stick, Regime::PartialSlip, Regime::GrossSlip, Regime::Separated][sequence as usize % 4],
            dissipated_energy: number.cos(),
            elastic_energy: number.exp_m1(),
            memory_depth: sequence as usize,
        },
        at: Timestamp::now() + SignedDuration::from_nanos(sequence as i64),
    }
}

/// Moves `after + 1` to `upto`.
fn records(after: u64, upto: u64) -> Vec<Record> {
    (after + 1..=upto).map(record).collect()
}

fn receipt(key: &str, created: Option<Uuid>, sequence: u64) -> Receipt {
    let body = format!(r#"{{"key":"{key}"}}"#).into_bytes();
    Receipt {
        request: RequestKey { key: key.to_owned(), fingerprint: [7; 32] },
        reply: Reply { created, sequence, body },
    }
}

fn snapshot(sequence: u64) -> Snapshot {
    Snapshot { sequence, state: (0..=u8::MAX).rev().chain([0, sequence as u8]).collect() }
}

/// A session with so many moves, stored; as it is now, and its moves.
async fn stored(store: &dyn Store, moves: u64) -> (Session, Vec<Record>) {
    let mut session = session(Some("stored"));
    store.create(session.clone(), None).await.unwrap();
    let records = records(0, moves);
    if let Some(last) = records.last() {
        store.append(session.id, 0, records.clone(), None).await.unwrap();
        (session.sequence, session.updated_at) = (last.sequence, last.at);
    }
    (session, records)
}
