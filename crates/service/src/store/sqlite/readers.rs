//! Reading the database beside the writer. In write-ahead mode readers and the writer do not wait for each other.

use std::fs::File;
use std::os::unix::ffi::OsStrExt as _;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Weak};

use parking_lot::Mutex;
use percent_encoding::{NON_ALPHANUMERIC, percent_encode};
use rusqlite::{Connection, OpenFlags};
use tokio::sync::Semaphore;
use tokio::task::spawn_blocking;

use crate::store::{Result, StoreError};

use super::fault::{Fault, is_locked};
use super::file;
use super::open_files::OpenFiles;
use super::{BUSY, STILL_BUSY};

/// Reads at a time; more would only slow each other down.
const READERS: usize = 4;
/// Searches among them at a time, so that other reads never wait behind searches.
const SEARCHES: usize = 2;
/// Instructions of SQLite's virtual machine between two checks whether anybody waits for a search.
const CHECKED: i32 = 10_000;
/// Statements that a connection keeps prepared.
const STATEMENTS: usize = 32;

/// Connections that can only read, made when they are first needed.
pub(super) struct Readers {
    permits: Arc<Semaphore>,
    searches: Arc<Semaphore>,
    idle: Arc<Idle>,
}

/// The idle connections, and what is needed to open more.
struct Idle {
    // Locked for a push or a pop.
    connections: Mutex<Vec<Connection>>,
    path: PathBuf,
    files: Arc<OpenFiles>,
    /// Whether nobody writes to the file, so that it is read without a log and without shared memory.
    immutable: bool,
    /// Whether another program had locked the file at the last read.
    locked: AtomicBool,
    // Dropped after the connections: to close any handle of the file would end the locks that SQLite holds on it.
    _lock: Option<Arc<File>>,
}

impl Readers {
    pub(super) fn new(path: PathBuf, files: Arc<OpenFiles>, lock: Option<Arc<File>>, immutable: bool) -> Readers {
        let (connections, locked) = (Mutex::default(), AtomicBool::new(false));
        let idle = Idle { connections, path, files, immutable, locked, _lock: lock };
        let [permits, searches] = [READERS, SEARCHES].map(|number| Arc::new(Semaphore::new(number)));
        Readers { permits, searches, idle: Arc::new(idle) }
    }

    /// Runs a query in one transaction, on the blocking pool.
    pub(super) async fn read<T: Send + 'static>(
        &self,
        question: impl FnOnce(&Connection) -> Result<T, Fault> + Send + 'static,
    ) -> Result<T> {
        self.run(None, question).await
    }

    /// Runs a query that ends once nobody waits for it.
    async fn run<T: Send + 'static>(
        &self,
        waiting: Option<Weak<()>>,
        question: impl FnOnce(&Connection) -> Result<T, Fault> + Send + 'static,
    ) -> Result<T> {
        let permit = Arc::clone(&self.permits).acquire_owned().await;
        let idle = Arc::clone(&self.idle);
        let task = spawn_blocking(move || {
            idle.files.check()?;
            let mut connection = idle.take()?;
            // In place of that of the last query. An interrupt would be lost on a statement that has not begun.
            let ends = waiting.map(|waiting| move || waiting.strong_count() == 0);
            connection.progress_handler(CHECKED, ends)?;
            let found =
                connection.unchecked_transaction().map_err(Fault::from).and_then(|transaction| question(&transaction));
            let locked = matches!(&found, Err(Fault::Sqlite(error)) if is_locked(error));
            idle.locked.store(locked, Ordering::Relaxed);
            idle.connections.lock().push(connection);
            drop(permit);
            found
        });
        let found = task.await.map_err(|_| StoreError::Failed("a read of the database panicked".to_owned()))?;
        found.map_err(Fault::into_store_error)
    }

    /// The same for a query that may read much. It ends when its request is dropped.
    pub(super) async fn search<T: Send + 'static>(
        &self,
        question: impl FnOnce(&Connection) -> Result<T, Fault> + Send + 'static,
    ) -> Result<T> {
        let permit = Arc::clone(&self.searches).acquire_owned().await;
        // Dropped with the request.
        let waiting = Arc::new(());
        self.run(Some(Arc::downgrade(&waiting)), move |database| {
            let _permit = permit;
            question(database)
        })
        .await
    }

    /// Whether the files are still those that were opened, as far as is known.
    pub(super) fn are_ours(&self) -> bool {
        self.idle.files.are_ours()
    }

    pub(super) fn log_bytes(&self) -> u64 {
        file::length_at(&file::beside(&self.idle.path, "-wal"))
    }

    pub(super) fn close(&self) {
        self.idle.connections.lock().clear();
    }
}

impl Idle {
    fn take(&self) -> rusqlite::Result<Connection> {
        let pooled = self.connections.lock().pop();
        let connection = pooled.map_or_else(|| open_reader(&self.path, self.immutable), Ok)?;
        connection.busy_timeout(if self.locked.load(Ordering::Relaxed) { STILL_BUSY } else { BUSY })?;
        Ok(connection)
    }
}

/// A connection that can only read; for a file that nobody writes to (`immutable`), SQLite makes no files beside it.
pub(super) fn open_reader(path: &Path, immutable: bool) -> rusqlite::Result<Connection> {
    let name = percent_encode(path.as_os_str().as_bytes(), NON_ALPHANUMERIC);
    let flags = OpenFlags::SQLITE_OPEN_READ_ONLY | OpenFlags::SQLITE_OPEN_NO_MUTEX | OpenFlags::SQLITE_OPEN_URI;
    let connection = Connection::open_with_flags(format!("file:{name}?immutable={}", u8::from(immutable)), flags)?;
    connection.busy_timeout(BUSY)?;
    connection.set_prepared_statement_cache_capacity(STATEMENTS);
    Ok(connection)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;
    use std::time::Duration;

    use rusqlite::Connection;
    use tokio::sync::oneshot;
    use tokio::time::timeout;

    use super::{OpenFiles, Readers, SEARCHES};

    const PATIENCE: Duration = Duration::from_secs(60);
    /// Takes minutes.
    const LONG: &str = "WITH RECURSIVE numbers (n) AS (SELECT 1 UNION ALL SELECT n + 1 FROM numbers WHERE n < 1e9)
        SELECT count(*) FROM numbers";

    #[tokio::test]
    async fn a_search_ends_when_nobody_waits_for_it_and_others_are_read_meanwhile() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("numbers.db");
        Connection::open(&path).unwrap().execute_batch("PRAGMA journal_mode = WAL; CREATE TABLE t (n)").unwrap();
        let readers =
            Arc::new(Readers::new(path.clone(), Arc::new(OpenFiles::at([path.as_path()]).unwrap()), None, false));
        let count = |database: &Connection| Ok(database.query_row("SELECT count(*) FROM t", [], |row| row.get(0))?);
        // More than run at a time, so that some wait and are given up before they begin.
        for _ in 0..2 {
            let mut searches = Vec::new();
            for number in 0..2 * SEARCHES {
                let (begin, begun) = oneshot::channel();
                let readers = Arc::clone(&readers);
                searches.push(tokio::spawn(async move {
                    let long = move |database: &Connection| {
                        let _ = begin.send(());
                        Ok(database.query_row(LONG, [], |row| row.get::<_, i64>(0))?)
                    };
                    readers.search(long).await
                }));
                if number < SEARCHES {
                    timeout(PATIENCE, begun).await.expect("it begins").unwrap();
                }
            }
            assert_eq!(
                timeout(PATIENCE, readers.read::<i64>(count)).await.expect("searches hold up reads").unwrap(),
                0
            );
            searches.iter().for_each(|search| search.abort());
            let found = timeout(PATIENCE, readers.search::<i64>(count)).await;
            assert_eq!(found.expect("a search goes on that nobody waits for").unwrap(), 0);
        }
    }
}
