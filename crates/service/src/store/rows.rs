//! Rows of the databases as values. The order of the columns of a value is defined here, for all databases.

use std::error::Error;
use std::sync::Arc;

use jiff::Timestamp;
use serde::Deserialize as _;
use serde::de::IntoDeserializer;
use serde::de::value::Error as NameError;
use uuid::Uuid;

use super::{Extent, Job, Measured, Receipt, Record, Reply, RequestKey, Session, Snapshot, StoreError, Tenant};
use stickslip_wire::{Move, Regime, SessionSummary, State};

/// A type that every database reads by itself.
#[cfg(feature = "postgres")]
pub(super) trait Scalar: rusqlite::types::FromSql + for<'a> tokio_postgres::types::FromSql<'a> {}
/// A column of a row in SQLite.
#[cfg(not(feature = "postgres"))]
pub(super) trait Scalar: rusqlite::types::FromSql {}

#[cfg(feature = "postgres")]
impl<T: rusqlite::types::FromSql + for<'a> tokio_postgres::types::FromSql<'a>> Scalar for T {}
#[cfg(not(feature = "postgres"))]
impl<T: rusqlite::types::FromSql> Scalar for T {}

/// Reads the columns of a row one after the other.
pub(super) trait RowReader {
    /// What a column that cannot be read is reported as.
    type Error;

    fn next<T: Scalar>(&mut self) -> Result<T, Self::Error>;

    fn text<T, E: Error + Send + Sync + 'static>(
        &mut self,
        parse: impl FnOnce(&str) -> Result<T, E>,
    ) -> Result<T, Self::Error>;

    fn optional_uuid(&mut self) -> Result<Option<Uuid>, Self::Error>;

    fn time(&mut self) -> Result<Timestamp, Self::Error>;

    fn optional_time(&mut self) -> Result<Option<Timestamp>, Self::Error>;

    /// The last column read has a value that this program does not write.
    fn invalid(&self, error: impl Into<Box<dyn Error + Send + Sync>>) -> Self::Error;

    fn uuid(&mut self) -> Result<Uuid, Self::Error> {
        self.optional_uuid()?.ok_or_else(|| self.invalid("an identifier is missing"))
    }

    fn count(&mut self) -> Result<u64, Self::Error> {
        u64::try_from(self.next::<i64>()?).map_err(|error| self.invalid(error))
    }
}

/// Identifier, label, sequence, and the times of creation and of the last move.
pub(super) fn summary<R: RowReader>(row: &mut R) -> Result<SessionSummary, R::Error> {
    Ok(SessionSummary {
        id: row.uuid()?,
        label: row.next()?,
        sequence: row.count()?,
        created_at: row.time()?,
        updated_at: row.time()?,
    })
}

/// Tenant, sequence, label, and the bytes of definition and snapshot.
pub(super) fn extent<R: RowReader>(row: &mut R) -> Result<Extent, R::Error> {
    Ok(Extent {
        tenant: tenant(row)?,
        sequence: row.count()?,
        label: row.next()?,
        definition: row.count()?,
        snapshot: row.count()?,
        moved_at: None,
    })
}

/// The columns of [`summary`], definition and tenant.
pub(super) fn session<R: RowReader>(row: &mut R) -> Result<Session, R::Error> {
    let SessionSummary { id, label, sequence, created_at, updated_at } = summary(row)?;
    let definition = Arc::new(row.text(|text| serde_json::from_str(text))?);
    let tenant = tenant(row)?;
    Ok(Session { id, tenant, label, definition, sequence, created_at, updated_at })
}

pub(super) fn tenant<R: RowReader>(row: &mut R) -> Result<Tenant, R::Error> {
    row.text(|name| Ok::<_, std::convert::Infallible>(Tenant::new(name)))
}

/// Sequence, time, the six targets, whether they are relative, how long the move takes, the tolerance, the state in
/// the order of [`State`], and the columns of [`measured`], and the name of the key that made the move.
pub(super) fn record<R: RowReader>(row: &mut R) -> Result<Record, R::Error> {
    let mut record = Record {
        sequence: row.count()?,
        at: row.time()?,
        step: Move {
            displacement: row.next()?,
            force: row.next()?,
            indentation: row.next()?,
            normal_force: row.next()?,
            twist: row.next()?,
            torque: row.next()?,
            relative: row.next()?,
            duration: row.next()?,
        },
        tolerance: row.next()?,
        state: State {
            displacement: row.next()?,
            force: row.next()?,
            indentation: row.next()?,
            normal_force: row.next()?,
            contact_radius: row.next()?,
            stick_radius: row.next()?,
            // It follows from the rest and the definition, and is not stored.
            stick_centre: None,
            regime: row.text(|name| Regime::deserialize(IntoDeserializer::<NameError>::into_deserializer(name)))?,
            dissipated_energy: row.next()?,
            elastic_energy: row.next()?,
            memory_depth: usize::try_from(row.count()?).map_err(|error| row.invalid(error))?,
            electrical_conductance: None,
            thermal_conductance: None,
            time: row.next()?,
            viscous_work: row.next()?,
            surface_energy: None,
            adhesion_loss: None,
            twist: row.next()?,
            torque: row.next()?,
        },
        measured: measured(row)?,
        by: row.next::<Option<String>>()?.map(Arc::from),
    };
    if record.state.twist.is_some() {
        // Their columns allow no null.
        (record.state.displacement, record.state.force) = (None, None);
    }
    Ok(record)
}

/// Refuses a page of at most `limit` moves after the move `after` in which a move is missing; `last` is that of the
/// contact.
pub(super) fn check_page(
    contact: Uuid,
    after: u64,
    page: &[Record],
    limit: usize,
    last: u64,
) -> Result<(), StoreError> {
    let mut reached = after;
    for record in page {
        if record.sequence - reached != 1 {
            break;
        }
        reached = record.sequence;
    }
    let is_whole = page.last().is_none_or(|record| record.sequence == reached);
    if is_whole && (page.len() == limit || reached >= last) {
        return Ok(());
    }
    Err(StoreError::Damaged { contact, what: format!("move {} is missing", reached + 1) })
}

/// Measured force, and the instant of the measurement in nanoseconds since 1970; both empty if nothing was measured.
fn measured<R: RowReader>(row: &mut R) -> Result<Option<Measured>, R::Error> {
    let (force, at): (Option<f64>, Option<i64>) = (row.next()?, row.next()?);
    let at = at.map(|at| Timestamp::from_nanosecond(at.into())).transpose().map_err(|error| row.invalid(error))?;
    match (force, at) {
        (None, Some(_)) => Err(row.invalid("a measurement has an instant, but no force")),
        (force, at) => Ok(force.map(|force| Measured { force, at })),
    }
}

/// Fingerprint, created session, sequence and body of the receipt for a key.
pub(super) fn receipt<R: RowReader>(key: &str, row: &mut R) -> Result<Receipt, R::Error> {
    let fingerprint = <[u8; 32]>::try_from(row.next::<Vec<u8>>()?);
    let fingerprint = fingerprint.map_err(|_| row.invalid("a fingerprint has 32 bytes"))?;
    let reply = Reply { created: row.optional_uuid()?, sequence: row.count()?, body: row.next()? };
    Ok(Receipt { request: RequestKey { key: key.to_owned(), fingerprint }, reply })
}

/// Sequence and state.
pub(super) fn snapshot<R: RowReader>(row: &mut R) -> Result<Snapshot, R::Error> {
    Ok(Snapshot { sequence: row.count()?, state: row.next()? })
}

/// The columns of a job in the order of [`Job`].
pub(super) fn job<R: RowReader>(row: &mut R) -> Result<Job, R::Error> {
    Ok(Job {
        id: row.uuid()?,
        tenant: tenant(row)?,
        created_at: row.time()?,
        finished_at: row.optional_time()?,
        error: row.next()?,
        points: row.count()?,
        chunk: row.count()?,
        done: row.count()?,
        failed: row.count()?,
        bytes: row.count()?,
        cost: row.count()?,
    })
}
