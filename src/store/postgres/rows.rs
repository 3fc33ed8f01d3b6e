//! Rows and columns: values in and the same out, to the last bit and nanosecond.
//!
//! The engine's timestamps have microseconds. The nanoseconds beyond them stand in a column of their own.

use std::sync::Arc;
use std::time::SystemTime;

use jiff::Timestamp;
use tokio_postgres::Row;
use uuid::Uuid;

use crate::store::{Receipt, Record, Reply, RequestKey, Session, Snapshot, StoreError, Tenant};
use stickslip_wire::{Move, Regime, SessionSummary, State};

/// A timestamp as two columns.
pub(super) fn split_time(at: Timestamp) -> (SystemTime, i16) {
    let beyond = at.as_nanosecond().rem_euclid(1000);
    let whole = Timestamp::from_nanosecond(at.as_nanosecond() - beyond).unwrap_or(at);
    (whole.into(), i16::try_from(beyond).unwrap_or_default())
}

/// The same back.
pub(super) fn join_time(whole: SystemTime, beyond: i16) -> Result<Timestamp, StoreError> {
    let whole = Timestamp::try_from(whole).map_err(|error| unreadable(&error))?;
    Timestamp::from_nanosecond(whole.as_nanosecond() + i128::from(beyond)).map_err(|error| unreadable(&error))
}

/// A row that is not as this program writes it.
pub(super) fn unreadable(error: &dyn std::fmt::Display) -> StoreError {
    StoreError::Failed(format!("a row cannot be read: {error}"))
}

/// A number that counts, as the engine knows it; beyond its range nothing is stored.
pub(super) fn to_bigint(number: u64) -> i64 {
    i64::try_from(number).unwrap_or(i64::MAX)
}

/// The same back.
pub(super) fn from_bigint(number: i64) -> u64 {
    u64::try_from(number).unwrap_or_default()
}

/// A session from the columns of [`super::sql::FIND`].
pub(super) fn session(row: &Row) -> Result<Session, StoreError> {
    let definition: &str = row.get(2);
    Ok(Session {
        id: row.get(0),
        label: row.get(1),
        definition: Arc::new(serde_json::from_str(definition).map_err(|error| unreadable(&error))?),
        sequence: from_bigint(row.get(3)),
        created_at: join_time(row.get(4), row.get(5))?,
        updated_at: join_time(row.get(6), row.get(7))?,
        tenant: Tenant::new(row.get(8)),
    })
}

/// A line of a list from the columns of [`super::sql::LIST`].
pub(super) fn summary(row: &Row) -> Result<SessionSummary, StoreError> {
    Ok(SessionSummary {
        id: row.get(0),
        label: row.get(1),
        sequence: from_bigint(row.get(2)),
        created_at: join_time(row.get(3), row.get(4))?,
        updated_at: join_time(row.get(5), row.get(6))?,
    })
}

/// A move from the columns of [`super::sql::HISTORY`].
pub(super) fn record(row: &Row) -> Result<Record, StoreError> {
    Ok(Record {
        sequence: from_bigint(row.get(0)),
        step: Move {
            displacement: row.get(1),
            force: row.get(2),
            indentation: row.get(3),
            normal_force: row.get(4),
            relative: row.get(5),
        },
        tolerance: row.get(6),
        state: State {
            displacement: row.get(7),
            force: row.get(8),
            indentation: row.get(9),
            normal_force: row.get(10),
            contact_radius: row.get(11),
            stick_radius: row.get(12),
            regime: regime(row.get(13))?,
            dissipated_energy: row.get(14),
            elastic_energy: row.get(15),
            memory_depth: usize::try_from(row.get::<_, i64>(16)).map_err(|error| unreadable(&error))?,
        },
        at: join_time(row.get(17), row.get(18))?,
    })
}

/// The receipt for a key from the columns of [`super::sql::RECEIPT`].
pub(super) fn receipt(key: &str, row: &Row) -> Result<Receipt, StoreError> {
    let fingerprint: &[u8] = row.get(0);
    let fingerprint = fingerprint.try_into().map_err(|error| unreadable(&error))?;
    let reply = Reply { created: row.get(1), sequence: from_bigint(row.get(2)), body: row.get(3) };
    Ok(Receipt { request: RequestKey { key: key.to_owned(), fingerprint }, reply })
}

/// A snapshot from the columns of [`super::sql::SNAPSHOT`].
pub(super) fn snapshot(row: &Row) -> Snapshot {
    Snapshot { sequence: from_bigint(row.get(0)), state: row.get(1) }
}

const REGIMES: [(Regime, &str); 4] = [
    (Regime::Stick, "stick"),
    (Regime::PartialSlip, "partial_slip"),
    (Regime::GrossSlip, "gross_slip"),
    (Regime::Separated, "separated"),
];

fn regime(name: &str) -> Result<Regime, StoreError> {
    let known = REGIMES.iter().find(|(_, known)| *known == name);
    known.map(|(regime, _)| *regime).ok_or_else(|| unreadable(&format_args!("there is no regime {name}")))
}

fn regime_name(regime: Regime) -> &'static str {
    REGIMES.iter().find(|(known, _)| *known == regime).map_or("", |(_, name)| name)
}

/// Columns from values, one function of a value each.
macro_rules! columns {
    ($name:ident, $doc:literal, $from:ty, |$value:ident| { $($field:ident: $type:ty = $expression:expr,)* }) => {
        #[doc = $doc]
        #[derive(Default)]
        pub(super) struct $name { $(pub(super) $field: Vec<$type>,)* }

        impl $name {
            pub(super) fn push(&mut self, $value: $from) {
                $(self.$field.push($expression);)*
            }

            /// The columns as parameters, in their order.
            pub(super) fn parameters(&self) -> Vec<&(dyn tokio_postgres::types::ToSql + Sync)> {
                vec![$(&self.$field,)*]
            }
        }
    };
}

columns!(Requests, "What is asked for, a row a session.", (Uuid, u64, u64, Option<Timestamp>), |request| {
    id: Uuid = request.0,
    expected: i64 = to_bigint(request.1),
    sequence: i64 = to_bigint(request.2),
    at: Option<SystemTime> = request.3.map(|at| split_time(at).0),
    ns: Option<i16> = request.3.map(|at| split_time(at).1),
});

columns!(Moves, "Moves, with what came of them.", (Uuid, i64, &Record), |request| {
    contact: Uuid = request.0,
    sequence: i64 = to_bigint(request.2.sequence),
    target_displacement: Option<f64> = request.2.step.displacement,
    target_force: Option<f64> = request.2.step.force,
    target_indentation: Option<f64> = request.2.step.indentation,
    target_normal_force: Option<f64> = request.2.step.normal_force,
    relative: bool = request.2.step.relative,
    tolerance: f64 = request.2.tolerance,
    displacement: f64 = request.2.state.displacement,
    force: f64 = request.2.state.force,
    indentation: f64 = request.2.state.indentation,
    normal_force: f64 = request.2.state.normal_force,
    contact_radius: f64 = request.2.state.contact_radius,
    stick_radius: f64 = request.2.state.stick_radius,
    regime: &'static str = regime_name(request.2.state.regime),
    dissipated_energy: f64 = request.2.state.dissipated_energy,
    elastic_energy: f64 = request.2.state.elastic_energy,
    memory_depth: i64 = to_bigint(request.2.state.memory_depth as u64),
    at: SystemTime = split_time(request.2.at).0,
    at_ns: i16 = split_time(request.2.at).1,
    stamp: i64 = request.1,
});

columns!(Receipts, "Receipts, each beside the session that has to win for it.", (Uuid, &Receipt), |receipt| {
    contact: Uuid = receipt.0,
    key: String = receipt.1.request.key.clone(),
    fingerprint: Vec<u8> = receipt.1.request.fingerprint.to_vec(),
    created: Option<Uuid> = receipt.1.reply.created,
    sequence: i64 = to_bigint(receipt.1.reply.sequence),
    body: Vec<u8> = receipt.1.reply.body.clone(),
});

columns!(Sessions, "New sessions.", (&Session, String), |new| {
    id: Uuid = new.0.id,
    label: Option<String> = new.0.label.clone(),
    definition: String = new.1.clone(),
    sequence: i64 = to_bigint(new.0.sequence),
    created_at: SystemTime = split_time(new.0.created_at).0,
    created_ns: i16 = split_time(new.0.created_at).1,
    updated_at: SystemTime = split_time(new.0.updated_at).0,
    updated_ns: i16 = split_time(new.0.updated_at).1,
    tenant: String = new.0.tenant.name().to_owned(),
});
