//! Why a change was not made, and whether it was after all: a connection may be lost between a commit and its answer.

use crate::store::{RECEIPT_LIFETIME, StoreError, Tenant};

use super::job::{Change, Job};
use super::link::Link;
use super::rows::{count, counted};
use super::sql;

/// What became of a request.
pub(super) enum Verdict {
    /// It is stored.
    Stored,
    /// It is not, and this is why.
    Refused(StoreError),
    /// It is not, and nothing forbids it now.
    Open,
}

/// Looks what became of a request; `in_doubt` if an earlier attempt at it may have been committed.
pub(super) async fn explain(link: &Link, job: &Job, in_doubt: bool) -> Verdict {
    let (id, expected, last) = match &job.change {
        Change::Create(session, _) => (session.id, None, 0),
        Change::Append { id, expected, records } => {
            (*id, Some(*expected), records.last().map_or(0, |record| record.sequence))
        }
    };
    let lifetime = RECEIPT_LIFETIME.as_secs_f64();
    let row = match link.row(sql::EXPLAIN, &[&id, &job.key(), &lifetime, &counted(last)]).await {
        Ok(Some(row)) => row,
        Ok(None) => return Verdict::Refused(StoreError::Failed("a question without an answer".to_owned())),
        Err(error) => return Verdict::Refused(error),
    };
    let (sequence, expired, taken): (Option<i64>, Option<&str>, bool) = (row.get(0), row.get(1), row.get(2));
    let stored = match expected {
        Some(_) => row.get::<_, Option<i64>>(3) == Some(job.stamp),
        None => sequence.is_some(),
    };
    match (expected, sequence.map(count)) {
        _ if in_doubt && stored => Verdict::Stored,
        _ if taken => Verdict::Refused(StoreError::KeyTaken),
        (None, None) => Verdict::Open,
        (None, Some(_)) => Verdict::Refused(StoreError::Failed(format!("there is a session {id} already"))),
        (Some(_), None) => Verdict::Refused(expired.map(Tenant::new).map_or(StoreError::NotFound, StoreError::Expired)),
        (Some(expected), Some(found)) if found == expected => Verdict::Open,
        (Some(_), Some(found)) => Verdict::Refused(StoreError::Stale { found }),
    }
}
