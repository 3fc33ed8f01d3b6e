//! Values as columns of the database, and rows back to the last bit and nanosecond.
//!
//! The database's timestamps have microseconds. The nanoseconds beyond them have a column of their own.

use std::error::Error;
use std::time::SystemTime;

use jiff::Timestamp;
use tokio_postgres::Row;
use uuid::Uuid;

use crate::store::rows::{RowReader, Scalar};
use crate::store::{Receipt, Record, Result, Session, StoreError};

/// The columns of a row, read one after the other; a time is two of them.
pub(super) struct Reader<'a> {
    row: &'a Row,
    next: usize,
}

pub(super) fn reader(row: &Row) -> Reader<'_> {
    reader_from(row, 0)
}

pub(super) fn reader_from(row: &Row, next: usize) -> Reader<'_> {
    Reader { row, next }
}

impl<'a> Reader<'a> {
    fn get<T: tokio_postgres::types::FromSql<'a>>(&mut self) -> Result<T> {
        self.next += 1;
        self.row.try_get(self.next - 1).map_err(|error| self.invalid(error))
    }
}

impl RowReader for Reader<'_> {
    type Error = StoreError;

    fn next<T: Scalar>(&mut self) -> Result<T> {
        self.get()
    }

    fn text<T, E: Error + Send + Sync + 'static>(&mut self, parse: impl FnOnce(&str) -> Result<T, E>) -> Result<T> {
        parse(self.get()?).map_err(|error| self.invalid(error))
    }

    fn optional_uuid(&mut self) -> Result<Option<Uuid>> {
        self.get()
    }

    fn time(&mut self) -> Result<Timestamp> {
        let whole = self.optional_time()?.ok_or_else(|| self.invalid("a time is missing"))?;
        let beyond: i16 = self.get()?;
        Timestamp::from_nanosecond(whole.as_nanosecond() + i128::from(beyond)).map_err(|error| self.invalid(error))
    }

    fn optional_time(&mut self) -> Result<Option<Timestamp>> {
        let time: Option<SystemTime> = self.get()?;
        time.map(Timestamp::try_from).transpose().map_err(|error| self.invalid(error))
    }

    fn invalid(&self, error: impl Into<Box<dyn Error + Send + Sync>>) -> StoreError {
        StoreError::Failed(format!("column {} of a row cannot be read: {}", self.next, error.into()))
    }
}

/// A timestamp as two columns.
pub(super) fn split_time(at: Timestamp) -> (SystemTime, i16) {
    let beyond = at.as_nanosecond().rem_euclid(1000);
    let whole = Timestamp::from_nanosecond(at.as_nanosecond() - beyond).unwrap_or(at);
    (whole.into(), i16::try_from(beyond).unwrap_or_default())
}

/// A time from 1678 to 2261 as nanoseconds since 1970.
fn to_nanoseconds(at: Timestamp) -> i64 {
    i64::try_from(at.as_nanosecond()).unwrap_or(i64::MAX)
}

/// A count as `bigint`; a larger one is an error.
pub(super) fn to_bigint(count: u64) -> i64 {
    i64::try_from(count).unwrap_or(i64::MAX)
}

/// The same back.
pub(super) fn from_bigint(count: i64) -> u64 {
    u64::try_from(count).unwrap_or_default()
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

columns!(Requests, "Requested changes, a row a session.", (Uuid, u64, u64, Option<Timestamp>), |request| {
    id: Uuid = request.0,
    expected: i64 = to_bigint(request.1),
    sequence: i64 = to_bigint(request.2),
    at: Option<SystemTime> = request.3.map(|at| split_time(at).0),
    ns: Option<i16> = request.3.map(|at| split_time(at).1),
});

columns!(Pasts, "When the sessions to append to last moved, a row a session.", Option<Timestamp>, |moved_at| {
    at: Option<SystemTime> = moved_at.map(|at| split_time(at).0),
    ns: Option<i16> = moved_at.map(|at| split_time(at).1),
});

columns!(Moves, "Moves, with the states after them.", (Uuid, i64, &Record), |request| {
    contact: Uuid = request.0,
    sequence: i64 = to_bigint(request.2.sequence),
    at: SystemTime = split_time(request.2.at).0,
    at_ns: i16 = split_time(request.2.at).1,
    target_displacement: Option<f64> = request.2.step.displacement,
    target_force: Option<f64> = request.2.step.force,
    target_indentation: Option<f64> = request.2.step.indentation,
    target_normal_force: Option<f64> = request.2.step.normal_force,
    target_twist: Option<f64> = request.2.step.twist,
    target_torque: Option<f64> = request.2.step.torque,
    relative: bool = request.2.step.relative,
    duration: Option<f64> = request.2.step.duration,
    tolerance: f64 = request.2.tolerance,
    displacement: f64 = request.2.state.displacement.unwrap_or_default(),
    force: f64 = request.2.state.force.unwrap_or_default(),
    indentation: f64 = request.2.state.indentation,
    normal_force: f64 = request.2.state.normal_force,
    contact_radius: f64 = request.2.state.contact_radius,
    stick_radius: f64 = request.2.state.stick_radius,
    regime: &'static str = request.2.state.regime.name(),
    dissipated_energy: f64 = request.2.state.dissipated_energy,
    elastic_energy: f64 = request.2.state.elastic_energy,
    memory_depth: i64 = to_bigint(request.2.state.memory_depth as u64),
    time: Option<f64> = request.2.state.time,
    viscous_work: Option<f64> = request.2.state.viscous_work,
    twist: Option<f64> = request.2.state.twist,
    torque: Option<f64> = request.2.state.torque,
    observed_force: Option<f64> = request.2.measured.map(|measured| measured.force),
    observed_at: Option<i64> = request.2.measured.and_then(|measured| measured.at).map(to_nanoseconds),
    made_by: Option<String> = request.2.by.as_deref().map(str::to_owned),
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
