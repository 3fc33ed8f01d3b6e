//! Sessions, moves and receipts as rows, and back to the last bit.

use std::str::FromStr as _;
use std::sync::Arc;

use jiff::Timestamp;
use rusqlite::{CachedStatement, Row, params, types::Type};
use uuid::Uuid;

use crate::store::{Receipt, Record, Reply, RequestKey, Session, Tenant};
use stickslip_wire::{Move, Regime, SessionSummary, State};

/// The columns of a move beside its session, in the order of [`insert_move`] and [`record`].
pub(super) const MOVE_COLUMNS: &str = "sequence, at, to_displacement, to_force, to_indentation, to_normal_force, relative, \
     tolerance, displacement, force, indentation, normal_force, contact_radius, stick_radius, regime, dissipated_energy, \
     elastic_energy, memory_depth, negative_zeros";

/// The columns that [`summary`] reads, of contacts `c` with their last moves `m`.
pub(super) const SESSION_COLUMNS: &str = "c.id, c.label, coalesce(m.sequence, 0), c.created_at, \
     iif(m.sequence > c.inherited, m.at, c.initial_updated_at)";

/// Contacts `c`, each with its last move `m`.
pub(super) const SESSIONS: &str = "contacts AS c LEFT JOIN moves AS m ON m.contact = c.number \
     AND m.sequence = (SELECT max(sequence) FROM moves WHERE contact = c.number)";

/// Writes a move of the session with a number.
pub(super) fn insert_move(statement: &mut CachedStatement<'_>, number: i64, record: &Record) -> rusqlite::Result<()> {
    let Record { sequence, step, tolerance, state, at } = record;
    statement.execute(params![
        number,
        integer(*sequence)?,
        nanoseconds(*at)?,
        step.displacement,
        step.force,
        step.indentation,
        step.normal_force,
        step.relative,
        tolerance,
        state.displacement,
        state.force,
        state.indentation,
        state.normal_force,
        state.contact_radius,
        state.stick_radius,
        regime_name(state.regime),
        state.dissipated_energy,
        state.elastic_energy,
        integer(state.memory_depth as u64)?,
        negative_zeros(record),
    ])?;
    Ok(())
}

/// The move of a row that begins with [`MOVE_COLUMNS`].
pub(super) fn record(row: &Row<'_>) -> rusqlite::Result<Record> {
    let mut record = Record {
        sequence: natural(row, 0)?,
        at: timestamp(row, 1)?,
        step: Move {
            displacement: row.get(2)?,
            force: row.get(3)?,
            indentation: row.get(4)?,
            normal_force: row.get(5)?,
            relative: row.get(6)?,
        },
        tolerance: row.get(7)?,
        state: State {
            displacement: row.get(8)?,
            force: row.get(9)?,
            indentation: row.get(10)?,
            normal_force: row.get(11)?,
            contact_radius: row.get(12)?,
            stick_radius: row.get(13)?,
            regime: regime(row, 14)?,
            dissipated_energy: row.get(15)?,
            elastic_energy: row.get(16)?,
            memory_depth: usize::try_from(natural(row, 17)?).map_err(|error| unreadable(17, error))?,
        },
    };
    let zeros: i64 = row.get(18)?;
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
fn numbers(record: &mut Record) -> [Option<&mut f64>; 13] {
    let Record { step, tolerance, state, .. } = record;
    [
        step.displacement.as_mut(),
        step.force.as_mut(),
        step.indentation.as_mut(),
        step.normal_force.as_mut(),
        Some(tolerance),
        Some(&mut state.displacement),
        Some(&mut state.force),
        Some(&mut state.indentation),
        Some(&mut state.normal_force),
        Some(&mut state.contact_radius),
        Some(&mut state.stick_radius),
        Some(&mut state.dissipated_energy),
        Some(&mut state.elastic_energy),
    ]
}

/// Which numbers of a move are minus nought, bit by bit: SQLite stores minus nought as nought.
fn negative_zeros(record: &Record) -> i64 {
    let mut copy = *record;
    let flag = |number: Option<&mut f64>| number.is_some_and(|number| number.to_bits() == (-0.0_f64).to_bits());
    numbers(&mut copy).into_iter().enumerate().map(|(index, number)| i64::from(flag(number)) << index).sum()
}

/// The session of a row of [`SESSION_COLUMNS`].
pub(super) fn summary(row: &Row<'_>) -> rusqlite::Result<SessionSummary> {
    Ok(SessionSummary {
        id: identifier(row, 0)?,
        label: row.get(1)?,
        sequence: natural(row, 2)?,
        created_at: timestamp(row, 3)?,
        updated_at: timestamp(row, 4)?,
    })
}

/// The session of a row of [`SESSION_COLUMNS`], its definition and its tenant.
pub(super) fn session(row: &Row<'_>) -> rusqlite::Result<Session> {
    let definition = serde_json::from_str(row.get_ref(5)?.as_str()?).map_err(|error| unreadable(5, error))?;
    let SessionSummary { id, label, sequence, created_at, updated_at } = summary(row)?;
    Ok(Session {
        id,
        tenant: tenant(row, 6)?,
        label,
        definition: Arc::new(definition),
        sequence,
        created_at,
        updated_at,
    })
}

/// The tenant in a column.
pub(super) fn tenant(row: &Row<'_>, column: usize) -> rusqlite::Result<Tenant> {
    Ok(Tenant::new(row.get_ref(column)?.as_str()?))
}

/// The receipt of a row of key, fingerprint, created, sequence and body.
pub(super) fn receipt(row: &Row<'_>) -> rusqlite::Result<Receipt> {
    let created = row.get_ref(2)?.as_str_or_null()?;
    let created = created.map(Uuid::from_str).transpose().map_err(|error| unreadable(2, error))?;
    Ok(Receipt {
        request: RequestKey { key: row.get(0)?, fingerprint: row.get(1)? },
        reply: Reply { created, sequence: natural(row, 3)?, body: row.get(4)? },
    })
}

/// The identifier in a column.
pub(super) fn identifier(row: &Row<'_>, column: usize) -> rusqlite::Result<Uuid> {
    Uuid::from_str(row.get_ref(column)?.as_str()?).map_err(|error| unreadable(column, error))
}

/// A time as it is stored: nanoseconds since 1970, which reach from 1677 to 2262.
pub(super) fn nanoseconds(at: Timestamp) -> rusqlite::Result<i64> {
    i64::try_from(at.as_nanosecond()).map_err(unwritable)
}

/// A time to compare stored ones with.
pub(super) fn bound(at: Timestamp) -> i64 {
    i64::try_from(at.as_nanosecond()).unwrap_or(if at < Timestamp::UNIX_EPOCH { i64::MIN } else { i64::MAX })
}

/// The time in a column.
pub(super) fn timestamp(row: &Row<'_>, column: usize) -> rusqlite::Result<Timestamp> {
    let nanoseconds: i64 = row.get(column)?;
    Timestamp::from_nanosecond(nanoseconds.into()).map_err(|error| unreadable(column, error))
}

/// A count as it is stored.
pub(super) fn integer(count: u64) -> rusqlite::Result<i64> {
    i64::try_from(count).map_err(unwritable)
}

/// The count in a column.
pub(super) fn natural(row: &Row<'_>, column: usize) -> rusqlite::Result<u64> {
    let integer: i64 = row.get(column)?;
    u64::try_from(integer).map_err(|error| unreadable(column, error))
}

fn regime_name(regime: Regime) -> &'static str {
    match regime {
        Regime::Stick => "stick",
        Regime::PartialSlip => "partial_slip",
        Regime::GrossSlip => "gross_slip",
        Regime::Separated => "separated",
    }
}

fn regime(row: &Row<'_>, column: usize) -> rusqlite::Result<Regime> {
    match row.get_ref(column)?.as_str()? {
        "stick" => Ok(Regime::Stick),
        "partial_slip" => Ok(Regime::PartialSlip),
        "gross_slip" => Ok(Regime::GrossSlip),
        "separated" => Ok(Regime::Separated),
        other => Err(unreadable(column, format!("unknown regime {other}"))),
    }
}

fn unreadable(column: usize, error: impl Into<Box<dyn std::error::Error + Send + Sync>>) -> rusqlite::Error {
    rusqlite::Error::FromSqlConversionFailure(column, Type::Null, error.into())
}

fn unwritable(error: impl std::error::Error + Send + Sync + 'static) -> rusqlite::Error {
    rusqlite::Error::ToSqlConversionFailure(Box::new(error))
}
