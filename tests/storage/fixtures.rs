//! Fixtures of the storage tests.

use std::future::Future;
use std::path::Path;
use std::time::Duration;

use jiff::{SignedDuration, Timestamp};
use stickslip::store::{
    Job, JobLimits, Measured, Receipt, Record, Reply, RequestKey, Session, Snapshot, Store, Tenant,
};
use stickslip_wire::client::Options;
use stickslip_wire::{Move, Regime, State};
use uuid::Uuid;

use crate::common;
pub use crate::common::along;

/// The store in a file, as a URL.
pub fn url(path: &Path) -> String {
    format!("sqlite:{}", path.display())
}

/// The result of a future, which must be ready within seconds.
pub async fn soon<T>(future: impl Future<Output = T>) -> T {
    tokio::time::timeout(common::PATIENCE, future).await.expect("nothing happened")
}

/// The options of a request with an idempotency key.
pub fn keyed(key: impl ToString) -> Options {
    Options { idempotency_key: Some(key.to_string()), ..Options::default() }
}

/// A session that is not stored yet.
pub fn session(label: Option<&str>) -> Session {
    Session { label: label.map(str::to_owned), ..common::session(common::ball()) }
}

/// The identifier of a stored session without moves.
pub async fn made(store: &dyn Store, label: Option<&str>) -> Uuid {
    let new = session(label);
    store.create(new.clone(), None).await.unwrap();
    new.id
}

/// A move whose numbers differ from those of every other; of three the last is an observation, every other one with its
/// time, and of four the last was made without a key.
pub fn record(sequence: u64) -> Record {
    let number = sequence as f64 + 0.1;
    Record {
        sequence,
        step: Move {
            displacement: (!sequence.is_multiple_of(5)).then_some(number * 1e-9),
            twist: sequence.is_multiple_of(5).then_some(number * 1e-3),
            torque: sequence.is_multiple_of(7).then_some(number * 1e-4),
            duration: sequence.is_multiple_of(4).then_some(number / 9.0),
            relative: sequence.is_multiple_of(2),
            ..Move::default()
        },
        tolerance: 1e-10 / number,
        state: State {
            stick_centre: None,
            displacement: (!sequence.is_multiple_of(5)).then_some(number * 1e-9),
            force: (!sequence.is_multiple_of(5)).then_some(number / 3.0),
            indentation: 1.0 / number,
            normal_force: number.sqrt(),
            contact_radius: number.ln_1p(),
            stick_radius: number.sin(),
            regime: [Regime::Stick, Regime::PartialSlip, Regime::GrossSlip, Regime::Separated][sequence as usize % 4],
            dissipated_energy: number.cos(),
            elastic_energy: number.exp_m1(),
            memory_depth: sequence as usize,
            electrical_conductance: None,
            thermal_conductance: None,
            time: sequence.is_multiple_of(4).then_some(number * 0.7),
            viscous_work: sequence.is_multiple_of(4).then_some(number * 0.3),
            surface_energy: None,
            adhesion_loss: None,
            twist: sequence.is_multiple_of(5).then_some(number * 2e-3),
            torque: sequence.is_multiple_of(5).then_some(number * 0.9),
        },
        measured: sequence.is_multiple_of(3).then(|| Measured {
            force: -number / 7.0,
            at: (sequence.is_multiple_of(2))
                .then(|| Timestamp::UNIX_EPOCH + SignedDuration::from_nanos(sequence as i64)),
        }),
        by: (!sequence.is_multiple_of(4)).then(|| format!("key_{}.a-B", sequence % 4).into()),
        at: Timestamp::now() + SignedDuration::from_nanos(sequence as i64),
    }
}

/// Moves `after + 1` to `upto`.
pub fn records(after: u64, upto: u64) -> Vec<Record> {
    (after + 1..=upto).map(record).collect()
}

pub fn receipt(key: &str, created: Option<Uuid>, sequence: u64) -> Receipt {
    let body = format!(r#"{{"key":"{key}"}}"#).into_bytes();
    Receipt {
        request: RequestKey { key: key.to_owned(), fingerprint: [7; 32] },
        reply: Reply { created, sequence, body },
    }
}

pub fn snapshot(sequence: u64) -> Snapshot {
    Snapshot { sequence, state: (0..=u8::MAX).rev().chain([0, sequence as u8]).collect() }
}

/// How long a chunk is claimed for: nothing ends it.
pub const LEASE: Duration = Duration::from_secs(600);
/// More than any test asks for.
pub const JOB_LIMITS: JobLimits = JobLimits { jobs: 100, bytes: 1_000_000, cost: 1_000_000 };

/// A job that is not stored yet, of three chunks.
pub fn job(tenant: &str) -> Job {
    Job {
        id: Uuid::now_v7(),
        tenant: Tenant::new(tenant),
        created_at: Timestamp::now(),
        finished_at: None,
        error: None,
        points: 7,
        chunk: 3,
        done: 0,
        failed: 0,
        bytes: 100,
        cost: 100,
    }
}

/// A stored session with this many moves, and its moves.
pub async fn stored(store: &dyn Store, moves: u64) -> (Session, Vec<Record>) {
    let mut session = session(Some("stored"));
    store.create(session.clone(), None).await.unwrap();
    let records = records(0, moves);
    if let Some(last) = records.last() {
        store.append(session.id, 0, records.clone(), None).await.unwrap();
        (session.sequence, session.updated_at) = (last.sequence, last.at);
    }
    (session, records)
}
