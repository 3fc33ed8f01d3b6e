//! What an error of the database means, and how long to go on trying.

use std::io;
use std::time::{Duration, Instant};

use deadpool_postgres::PoolError;
use parking_lot::Mutex;
use tokio_postgres::Error;
use tokio_postgres::error::{DbError, SqlState};

use crate::store::StoreError;

use super::connect::{causes, error_chain};

/// How long to wait for a lost database before requests fail. After that no request waits until it is back.
const PATIENCE: Duration = Duration::from_secs(2);
/// How soon to try again at first; the time doubles up to the longest.
const FIRST_PAUSE: Duration = Duration::from_millis(25);
const LONGEST_PAUSE: Duration = Duration::from_millis(400);

/// How long a change waits for locks that other transactions hold, from its arrival.
pub(super) const LOCK_WAIT: Duration = Duration::from_secs(5);
/// How soon to try it again at first, as most locks are held for the time of a commit.
const FIRST_LOCK_PAUSE: Duration = Duration::from_millis(2);

/// Why the database failed.
#[derive(Debug)]
pub(super) enum Fault {
    /// The connection is lost; whether the change was made is unknown.
    Lost(String),
    /// Nothing has changed, and a retry may succeed at once: two transactions conflicted.
    Conflict(String),
    /// Nothing has changed: another transaction holds a lock.
    Locked(String),
    /// Nothing has changed: a key or an identifier is there already.
    Duplicate(String),
    /// Nothing has changed, and another attempt would fail too.
    Refused(StoreError),
}

impl From<Error> for Fault {
    fn from(error: Error) -> Fault {
        match error.as_db_error() {
            Some(refusal) => refused(refusal),
            None if distrusted(&error) => Fault::Refused(StoreError::Failed(error_chain(&error))),
            None => Fault::Lost(error_chain(&error)),
        }
    }
}

impl From<PoolError> for Fault {
    fn from(error: PoolError) -> Fault {
        match error {
            PoolError::Backend(error) => error.into(),
            other => Fault::Lost(other.to_string()),
        }
    }
}

impl From<StoreError> for Fault {
    fn from(error: StoreError) -> Fault {
        Fault::Refused(error)
    }
}

/// Whether TLS failed, which a retry would not change.
fn distrusted(error: &Error) -> bool {
    causes(error).any(|cause| {
        let carried = cause.downcast_ref::<io::Error>().and_then(io::Error::get_ref);
        carried.is_some_and(|carried| carried.is::<rustls::Error>())
    })
}

/// The codes of `idle_in_transaction_session_timeout` and `transaction_timeout`.
const SILENT_IN_TRANSACTION: [&str; 2] = ["25P03", "25P04"];

/// The codes of `insufficient_privilege`, `undefined_table` and `untranslatable_character`.
const OPERATOR: [&str; 3] = ["42501", "42P01", "22P05"];

fn refused(refusal: &DbError) -> Fault {
    let text = format!("{} ({})", refusal.message(), refusal.code().code());
    let code = refusal.code();
    let class = code.code().get(..2).unwrap_or_default();
    match class {
        // The server stops, has crashed, is starting, has no connection left, or has become a standby; or it has ended
        // a transaction because this process was silent for too long.
        "08" | "57" if *code != SqlState::QUERY_CANCELED => Fault::Lost(text),
        _ if *code == SqlState::TOO_MANY_CONNECTIONS || *code == SqlState::READ_ONLY_SQL_TRANSACTION => {
            Fault::Lost(text)
        }
        _ if SILENT_IN_TRANSACTION.contains(&code.code()) => Fault::Lost(text),
        "40" => Fault::Conflict(text),
        _ if *code == SqlState::LOCK_NOT_AVAILABLE => Fault::Locked(text),
        _ if *code == SqlState::UNIQUE_VIOLATION => Fault::Duplicate(text),
        _ if *code == SqlState::DISK_FULL => Fault::Refused(StoreError::Full(text)),
        // No room or memory, or a fault that the operator of the database mends: no such login, database, right or
        // table, or an encoding without these letters.
        "53" | "28" | "3D" => Fault::Refused(StoreError::Unavailable(text)),
        _ if OPERATOR.contains(&code.code()) => Fault::Refused(StoreError::Unavailable(text)),
        _ if *code == SqlState::QUERY_CANCELED => Fault::Refused(StoreError::Unavailable(text)),
        _ => Fault::Refused(StoreError::Failed(text)),
    }
}

impl Fault {
    /// The database has not answered in time; whether the change was made is unknown.
    pub(super) fn no_answer() -> Fault {
        Fault::Lost("no answer in time".to_owned())
    }

    /// Another transaction holds the row of what is to be changed.
    pub(super) fn locked() -> Fault {
        Fault::Locked("another transaction holds its row".to_owned())
    }

    /// The error for the caller when there is no further attempt.
    pub(super) fn into_store_error(self) -> StoreError {
        match self {
            Fault::Lost(text) | Fault::Conflict(text) => StoreError::Unavailable(text),
            Fault::Locked(text) => StoreError::Locked(text),
            Fault::Duplicate(text) => StoreError::Failed(text),
            Fault::Refused(error) => error,
        }
    }
}

/// Since when the database has been unreachable, as observed by the last call.
#[derive(Default)]
pub(super) struct Outage {
    // Locked for a read, never across an await.
    since: Mutex<Option<Instant>>,
}

impl Outage {
    /// Notes that the database could be reached.
    pub(super) fn end(&self) {
        if let Some(begin) = self.since.lock().take() {
            tracing::info!(outage_ms = begin.elapsed().as_millis() as u64, "the database is back");
        }
    }

    /// Notes that the database has not answered what was sent to it at this time.
    pub(super) fn begin(&self, at: Instant) {
        let mut since = self.since.lock();
        if since.is_none() {
            tracing::warn!("the database does not answer");
        }
        since.get_or_insert(at);
    }

    /// Notes that it could not be reached; returns whether another attempt is worth waiting for.
    pub(super) fn worth_waiting(&self, fault: &str) -> bool {
        let mut since = self.since.lock();
        if since.is_none() {
            tracing::warn!(error = fault, "the database is unreachable");
        }
        since.get_or_insert_with(Instant::now).elapsed() < PATIENCE
    }
}

/// Waits that grow from attempt to attempt.
pub(super) struct Backoff(Duration);

impl Default for Backoff {
    fn default() -> Backoff {
        Backoff(FIRST_PAUSE)
    }
}

impl Backoff {
    /// Waits for a lock.
    pub(super) fn for_lock() -> Backoff {
        Backoff(FIRST_LOCK_PAUSE)
    }

    /// Waits, each time longer.
    pub(super) async fn pause(&mut self) {
        let pause = self.0;
        self.0 = (2 * pause).min(LONGEST_PAUSE);
        tokio::time::sleep(pause).await;
    }
}
