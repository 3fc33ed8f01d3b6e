//! The outcome of a change whose answer was lost: a connection may be lost between a commit and its answer.

use crate::store::{RECEIPT_LIFETIME, Result, StoreError, Tenant};

use super::client_pool::ClientPool;
use super::columns::{from_bigint, to_bigint};
use super::request::{Change, WriteRequest};
use super::sql;

/// Reads whether a request is stored, or why it was refused; one that is neither may be tried again.
pub(super) async fn outcome_of(pool: &ClientPool, request: &WriteRequest) -> Result<bool> {
    let (id, expected, last) = match &request.change {
        Change::Create(session, _) => (session.id, None, 0),
        Change::Append { id, expected, records } => {
            (*id, Some(*expected), records.last().map_or(0, |record| record.sequence))
        }
    };
    let lifetime = RECEIPT_LIFETIME.as_secs_f64();
    let row = pool.row(sql::OUTCOME, &[&id, &request.key(), &lifetime, &to_bigint(last)]).await?;
    let row = row.ok_or_else(|| StoreError::Failed("the database returned no row".to_owned()))?;
    let (sequence, expired, taken): (Option<i64>, Option<&str>, bool) = (row.get(0), row.get(1), row.get(2));
    let stored = match expected {
        Some(_) => row.get::<_, Option<i64>>(3) == Some(request.stamp),
        None => sequence.is_some(),
    };
    match (expected, sequence.map(from_bigint)) {
        _ if request.in_doubt && stored => Ok(true),
        _ if taken => Err(StoreError::KeyTaken),
        (None, None) => Ok(false),
        (None, Some(_)) => Err(StoreError::Failed(format!("there is a contact {id} already"))),
        (Some(_), None) => Err(expired.map(Tenant::new).map_or(StoreError::NotFound, StoreError::Expired)),
        (Some(expected), Some(found)) if found == expected => Ok(false),
        (Some(_), Some(found)) => Err(StoreError::Stale { found }),
    }
}
