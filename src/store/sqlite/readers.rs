//! Reading the database beside the writer. In write-ahead mode readers and the writer do not wait for each other.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use rusqlite::{Connection, OpenFlags};
use tokio::sync::Semaphore;
use tokio::task::spawn_blocking;

use crate::store::{Result, StoreError};

use super::fault::{Fault, Stage, store_error};

/// Reads at a time; more would only slow each other down.
const READERS: usize = 4;
/// Statements that a connection keeps prepared.
const STATEMENTS: usize = 32;

/// Connections that can only read, made when they are first needed.
pub(super) struct Readers {
    permits: Arc<Semaphore>,
    idle: Arc<Idle>,
}

/// The idle connections, and what is needed to open more.
struct Idle {
    // A std mutex: held for a push or a pop.
    connections: Mutex<Vec<Connection>>,
    path: PathBuf,
    // Dropped after the connections: to close any handle of the file would end the locks that SQLite holds on it.
    _lock: Option<Arc<File>>,
}

impl Readers {
    pub(super) fn new(path: PathBuf, lock: Option<Arc<File>>) -> Readers {
        let idle = Idle { connections: Mutex::default(), path, _lock: lock };
        Readers { permits: Arc::new(Semaphore::new(READERS)), idle: Arc::new(idle) }
    }

    /// Runs a query in one transaction, on the blocking pool.
    pub(super) async fn read<T: Send + 'static>(
        &self,
        question: impl FnOnce(&Connection) -> Result<T, Fault> + Send + 'static,
    ) -> Result<T> {
        let permit = Arc::clone(&self.permits).acquire_owned().await;
        let idle = Arc::clone(&self.idle);
        let task = spawn_blocking(move || {
            let connection = idle.take()?;
            let found =
                connection.unchecked_transaction().map_err(Fault::from).and_then(|transaction| question(&transaction));
            idle.put(connection);
            drop(permit);
            found
        });
        match task.await {
            Ok(Ok(found)) => Ok(found),
            Ok(Err(Fault::Refused(error))) => Err(error),
            Ok(Err(Fault::Sqlite(error))) => Err(store_error(&error, Stage::Before)),
            Err(_) => Err(StoreError::Failed("a read of the database panicked".to_owned())),
        }
    }

    /// Closes the idle connections.
    pub(super) fn close(&self) {
        self.idle.lock().clear();
    }
}

impl Idle {
    fn take(&self) -> rusqlite::Result<Connection> {
        if let Some(connection) = self.lock().pop() {
            return Ok(connection);
        }
        let connection = open_reader(&self.path)?;
        connection.set_prepared_statement_cache_capacity(STATEMENTS);
        Ok(connection)
    }

    fn put(&self, connection: Connection) {
        self.lock().push(connection);
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Vec<Connection>> {
        self.connections.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A connection that can only read.
pub(super) fn open_reader(path: &Path) -> rusqlite::Result<Connection> {
    let connection =
        Connection::open_with_flags(path, OpenFlags::SQLITE_OPEN_READ_ONLY | OpenFlags::SQLITE_OPEN_NO_MUTEX)?;
    connection.busy_timeout(super::BUSY)?;
    Ok(connection)
}
