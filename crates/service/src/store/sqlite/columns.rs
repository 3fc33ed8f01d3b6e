//! Values as columns of the file, and rows back to the last bit.

use std::error::Error;
use std::str::FromStr as _;

use jiff::Timestamp;
use rusqlite::types::Type;
use rusqlite::{CachedStatement, Connection, OptionalExtension as _, Params, Row};
use uuid::Uuid;

use crate::store::Record;
use crate::store::rows::{self, RowReader, Scalar};

/// The columns of a move beside its contact, in the order of [`insert_move`] and [`record`].
pub(super) const MOVE_COLUMNS: &str = "sequence, at, to_displacement, to_force, to_indentation, to_normal_force, \
     to_twist, to_torque, relative, duration, tolerance, displacement, force, indentation, normal_force, \
     contact_radius, stick_radius, regime, dissipated_energy, elastic_energy, memory_depth, time, viscous_work, \
     twist, torque, observed_force, observed_at, made_by, negative_zeros";

/// The columns of [`rows::summary`], of [`CONTACTS`].
pub(super) const SUMMARY_COLUMNS: &str = "c.id, c.label, coalesce(m.sequence, 0), c.created_at, \
     iif(m.sequence > c.inherited, m.at, c.initial_updated_at)";

/// Contacts `c`, each with its last move `m`.
pub(super) const CONTACTS: &str = "contacts AS c LEFT JOIN moves AS m ON m.contact = c.number \
     AND m.sequence = (SELECT max(sequence) FROM moves WHERE contact = c.number)";

/// The columns of a row, read one after the other.
pub(super) struct Reader<'a, 'b> {
    row: &'a Row<'b>,
    next: usize,
}

/// Reads a row from its first column on.
pub(super) fn reader<'a, 'b>(row: &'a Row<'b>) -> Reader<'a, 'b> {
    Reader { row, next: 0 }
}

/// Runs a statement, which is prepared once on each connection; returns how many rows it has changed.
pub(super) fn execute(database: &Connection, sql: &str, parameters: impl Params) -> rusqlite::Result<usize> {
    database.prepare_cached(sql)?.execute(parameters)
}

/// The first row of a query, if there is one.
pub(super) fn first<T>(
    database: &Connection,
    sql: &str,
    parameters: impl Params,
    read: impl FnOnce(&mut Reader<'_, '_>) -> rusqlite::Result<T>,
) -> rusqlite::Result<Option<T>> {
    database.prepare_cached(sql)?.query_row(parameters, |row| read(&mut reader(row))).optional()
}

/// The rows of a query.
pub(super) fn all<T>(
    database: &Connection,
    sql: &str,
    parameters: impl Params,
    mut read: impl FnMut(&mut Reader<'_, '_>) -> rusqlite::Result<T>,
) -> rusqlite::Result<Vec<T>> {
    database.prepare_cached(sql)?.query_map(parameters, |row| read(&mut reader(row)))?.collect()
}

impl RowReader for Reader<'_, '_> {
    type Error = rusqlite::Error;

    fn next<T: Scalar>(&mut self) -> rusqlite::Result<T> {
        self.next += 1;
        self.row.get(self.next - 1)
    }

    fn text<T, E: Error + Send + Sync + 'static>(
        &mut self,
        parse: impl FnOnce(&str) -> Result<T, E>,
    ) -> rusqlite::Result<T> {
        self.next += 1;
        parse(self.row.get_ref(self.next - 1)?.as_str()?).map_err(|error| self.invalid(error))
    }

    fn optional_uuid(&mut self) -> rusqlite::Result<Option<Uuid>> {
        self.next += 1;
        let text = self.row.get_ref(self.next - 1)?.as_str_or_null()?;
        text.map(Uuid::from_str).transpose().map_err(|error| self.invalid(error))
    }

    fn time(&mut self) -> rusqlite::Result<Timestamp> {
        let nanoseconds: i64 = self.next()?;
        Timestamp::from_nanosecond(nanoseconds.into()).map_err(|error| self.invalid(error))
    }

    fn optional_time(&mut self) -> rusqlite::Result<Option<Timestamp>> {
        let nanoseconds: Option<i64> = self.next()?;
        nanoseconds.map(|at| Timestamp::from_nanosecond(at.into())).transpose().map_err(|error| self.invalid(error))
    }

    fn invalid(&self, error: impl Into<Box<dyn Error + Send + Sync>>) -> rusqlite::Error {
        rusqlite::Error::FromSqlConversionFailure(self.next - 1, Type::Null, error.into())
    }
}

/// Writes a move of the contact with a number, by a statement to which nothing is bound.
pub(super) fn insert_move(statement: &mut CachedStatement<'_>, number: i64, record: &Record) -> rusqlite::Result<()> {
    let Record { sequence, step, tolerance, state, measured, by, at } = record;
    let mut index = 0;
    // What is not bound is NULL, and so is a third of the columns of most moves.
    macro_rules! bind {
        ($($value:expr),+) => {
            $(index += 1;
            if let Some(value) = $value {
                statement.raw_bind_parameter(index, value)?;
            })+
        };
    }
    bind!(Some(number), Some(to_integer(*sequence)?), Some(to_nanoseconds(*at)?));
    bind!(step.displacement, step.force, step.indentation, step.normal_force, step.twist, step.torque);
    bind!(Some(step.relative), step.duration, Some(*tolerance));
    bind!(Some(state.displacement.unwrap_or_default()), Some(state.force.unwrap_or_default()));
    bind!(Some(state.indentation), Some(state.normal_force), Some(state.contact_radius), Some(state.stick_radius));
    bind!(Some(state.regime.name()), Some(state.dissipated_energy), Some(state.elastic_energy));
    bind!(Some(to_integer(state.memory_depth as u64)?), state.time, state.viscous_work, state.twist, state.torque);
    bind!(measured.map(|measured| measured.force));
    bind!(measured.and_then(|measured| measured.at).map(to_nanoseconds).transpose()?);
    bind!(by.as_deref(), Some(negative_zeros(record)));
    statement.raw_execute().map(drop)
}

/// The move of a row of [`MOVE_COLUMNS`].
pub(super) fn record(row: &mut Reader<'_, '_>) -> rusqlite::Result<Record> {
    let mut record = rows::record(row)?;
    let zeros: i64 = row.next()?;
    if zeros != 0 {
        for (index, number) in numbers(&mut record).into_iter().enumerate() {
            if let Some(number) = number.filter(|_| zeros & (1 << index) != 0) {
                *number = -0.0;
            }
        }
    }
    Ok(record)
}

/// The numbers of a move, in the order of the bits of `negative_zeros`.
fn numbers(record: &mut Record) -> [Option<&mut f64>; 21] {
    let Record { step, tolerance, state, measured, .. } = record;
    [
        step.displacement.as_mut(),
        step.force.as_mut(),
        step.indentation.as_mut(),
        step.normal_force.as_mut(),
        Some(tolerance),
        state.displacement.as_mut(),
        state.force.as_mut(),
        Some(&mut state.indentation),
        Some(&mut state.normal_force),
        Some(&mut state.contact_radius),
        Some(&mut state.stick_radius),
        Some(&mut state.dissipated_energy),
        Some(&mut state.elastic_energy),
        measured.as_mut().map(|measured| &mut measured.force),
        step.duration.as_mut(),
        state.time.as_mut(),
        state.viscous_work.as_mut(),
        step.twist.as_mut(),
        step.torque.as_mut(),
        state.twist.as_mut(),
        state.torque.as_mut(),
    ]
}

/// Which numbers of a move are -0.0, bit by bit: SQLite stores -0.0 as 0.0.
fn negative_zeros(record: &Record) -> i64 {
    let mut copy = record.clone();
    let flag = |number: Option<&mut f64>| number.is_some_and(|number| number.to_bits() == (-0.0_f64).to_bits());
    numbers(&mut copy).into_iter().enumerate().map(|(index, number)| i64::from(flag(number)) << index).sum()
}

/// A time as it is stored: nanoseconds since 1970, which reach from 1677 to 2262.
pub(super) fn to_nanoseconds(at: Timestamp) -> rusqlite::Result<i64> {
    i64::try_from(at.as_nanosecond()).map_err(|error| rusqlite::Error::ToSqlConversionFailure(Box::new(error)))
}

/// A time to compare stored ones with: beyond their range, the end of it.
pub(super) fn clamped_nanoseconds(at: Timestamp) -> i64 {
    i64::try_from(at.as_nanosecond()).unwrap_or(if at < Timestamp::UNIX_EPOCH { i64::MIN } else { i64::MAX })
}

/// A count as it is stored.
pub(super) fn to_integer(count: u64) -> rusqlite::Result<i64> {
    i64::try_from(count).map_err(|error| rusqlite::Error::ToSqlConversionFailure(Box::new(error)))
}
