//! Everything in one SQLite file: durable when it is acknowledged, for one process at a time.
//!
//! One thread writes (`writer.rs`): requests that wait share a transaction and its wait for the disk. Reads have connections
//! of their own (`readers.rs`) and wait for nobody. Long work, such as the copy of a million moves, is done in small steps
//! between the transactions of others (`fork.rs`). The tables are in `schema.rs`, and explained in `docs/storage.md`. What may
//! fail, and what it means then, is in `fault.rs`.

mod backup;
mod change;
mod fault;
mod file;
mod fork;
mod jobs;
mod read;
mod readers;
mod rows;
mod schema;
mod sequence_cache;
mod wal_check;
mod writer;

use std::path::Path;
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::Duration;

use futures::FutureExt as _;
use jiff::Timestamp;
use tokio::sync::{mpsc, oneshot};
use uuid::Uuid;

use super::jobs::Board;
use super::{Answer, Changes, Commits, Receipt, Record, Session, Snapshot, Store, StoreError, Tenant};
use change::{Change, Fork};
use readers::{ReadError, Readers};
use rusqlite::Connection;
use stickslip_wire::SessionSummary;
use writer::{Request, Writer};

/// Requests that may wait for the writer; further ones wait for a place.
const QUEUE: usize = 1_024;
/// How long to wait for a foreign program that holds the file.
const BUSY: Duration = Duration::from_secs(5);
/// Sessions that expire in one transaction.
const EXPIRE_AT_ONCE: usize = 200;

/// Sessions in an SQLite file.
pub struct SqliteStore {
    // Gone once the store is being dropped, which is what ends the writer.
    queue: Option<mpsc::Sender<Request>>,
    writer: Option<JoinHandle<()>>,
    readers: Readers,
    changes: Arc<Changes>,
    commits: Arc<Commits>,
    board: Board,
}

impl SqliteStore {
    /// Opens a file, brings its tables up to date, and keeps other processes from opening it so; or makes one.
    ///
    /// # Errors
    /// Why it cannot be used, in one line. The file is as it was then.
    pub fn open(path: &Path) -> Result<SqliteStore, String> {
        let file::Opened { database, lock } = file::open(path)?;
        let board = Board::default();
        jobs::unfinished(&database, &board).map_err(|error| error.to_string())?;
        let changes = Arc::new(Changes::default());
        let commits = Arc::new(Commits::new("sqlite"));
        let writer =
            Writer::new(database, Arc::clone(&changes), Arc::clone(&commits)).map_err(|error| error.to_string())?;
        let (queue, requests) = mpsc::channel(QUEUE);
        let held = Arc::clone(&lock);
        let thread = std::thread::Builder::new().name("sqlite-writer".to_owned()).spawn(move || {
            writer.run(requests);
            drop(held);
        });
        let thread = thread.map_err(|error| error.to_string())?;
        let readers = Readers::new(path.to_owned(), Some(lock));
        Ok(SqliteStore { queue: Some(queue), writer: Some(thread), readers, changes, commits, board })
    }

    /// Opens a file to look at, beside the process that serves it or alone. Changes fail.
    ///
    /// # Errors
    /// Why it cannot be read, in one line.
    pub fn open_to_read(path: &Path) -> Result<SqliteStore, String> {
        backup::look(path)?;
        let (changes, commits) = (Arc::default(), Arc::new(Commits::new("sqlite")));
        let (readers, board) = (Readers::new(path.to_owned(), None), Board::default());
        Ok(SqliteStore { queue: None, writer: None, readers, changes, commits, board })
    }

    /// Copies the store in a file to another that is not there yet, while it is in use or not; says how many bytes that has.
    ///
    /// # Errors
    /// Why there is no copy, in one line.
    pub fn backup(path: &Path, copy: &Path) -> Result<u64, String> {
        backup::backup(path, copy)
    }

    async fn change(&self, change: Change) -> Result<u64, StoreError> {
        let gone = || StoreError::Failed("the writer of the database has ended".to_owned());
        let _pending = self.commits.pending.enter();
        let (reply, outcome) = oneshot::channel();
        let queue = self.queue.as_ref().ok_or_else(gone)?;
        queue.send(Request { change, reply }).await.map_err(|_| gone())?;
        outcome.await.map_err(|_| gone())?
    }

    fn changing(&self, change: Change) -> Answer<'_, ()> {
        self.change(change).map(|made| made.map(drop)).boxed()
    }

    fn look<T: Send + 'static>(
        &self,
        look: impl FnOnce(&Connection) -> Result<T, ReadError> + Send + 'static,
    ) -> Answer<'_, T> {
        self.readers.run(look).boxed()
    }

    async fn sweep_all(&self, idle_since: Option<Timestamp>) -> Result<u64, StoreError> {
        while self.change(Change::SweepReceipts).await? > 0 {}
        self.sweep_jobs().await?;
        let Some(since) = idle_since else { return Ok(0) };
        let (mut gone, mut next) = (0, Some(0));
        while let Some(after) = next {
            let idle;
            (idle, next) = self.readers.run(move |database| read::idle(database, since, after)).await?;
            for ids in idle.chunks(EXPIRE_AT_ONCE) {
                gone += self.change(Change::Expire { ids: ids.to_vec(), since }).await?;
            }
        }
        Ok(gone)
    }
}

impl Drop for SqliteStore {
    /// Ends the writer, which does what it has accepted and merges the log into the file.
    fn drop(&mut self) {
        self.readers.close();
        self.queue = None;
        if self.writer.take().is_some_and(|writer| writer.join().is_err()) {
            tracing::error!("the writer of the database panicked");
        }
    }
}

impl Store for SqliteStore {
    fn ready(&self) -> Answer<'_, ()> {
        let writes = self.queue.as_ref().is_some_and(|queue| !queue.is_closed());
        if !writes {
            return std::future::ready(Err(StoreError::Failed("the writer has ended".to_owned()))).boxed();
        }
        self.look(read::alive)
    }

    fn create(&self, session: Session, receipt: Option<Receipt>) -> Answer<'_, ()> {
        self.changing(Change::Create { session, receipt })
    }

    fn find(&self, id: Uuid) -> Answer<'_, Session> {
        self.look(move |database| read::find(database, id))
    }

    fn sequence(&self, id: Uuid) -> Answer<'_, u64> {
        self.look(move |database| read::sequence(database, id))
    }

    fn list(&self, of: Option<Tenant>, after: Option<Uuid>, limit: usize) -> Answer<'_, Vec<SessionSummary>> {
        self.look(move |database| read::list(database, of.as_ref(), after, limit))
    }

    fn append(&self, id: Uuid, expected: u64, records: Vec<Record>, receipt: Option<Receipt>) -> Answer<'_, ()> {
        self.changing(Change::Append { id, expected, records, receipt })
    }

    fn history(&self, id: Uuid, after: u64, limit: usize) -> Answer<'_, Vec<Record>> {
        self.look(move |database| read::history(database, id, after, limit))
    }

    fn fork(&self, id: Uuid, copy: Session, receipt: Option<Receipt>) -> Answer<'_, ()> {
        self.changing(Change::Fork(Box::new(Fork { id, copy, receipt })))
    }

    fn delete(&self, id: Uuid, expected: u64) -> Answer<'_, ()> {
        self.changing(Change::Delete { id, expected })
    }

    fn receipt<'a>(&'a self, key: &'a str) -> Answer<'a, Option<Receipt>> {
        let key = key.to_owned();
        self.look(move |database| read::kept(database, &key, change::receipts_from()))
    }

    fn snapshot(&self, id: Uuid) -> Answer<'_, Option<Snapshot>> {
        self.look(move |database| read::snapshot(database, id))
    }

    fn keep_snapshot(&self, id: Uuid, snapshot: Snapshot) -> Answer<'_, ()> {
        self.changing(Change::KeepSnapshot { id, snapshot })
    }

    fn sweep(&self, idle_since: Option<Timestamp>) -> Answer<'_, u64> {
        self.sweep_all(idle_since).boxed()
    }

    fn changes(&self) -> &Changes {
        &self.changes
    }

    fn commits(&self) -> Option<&Commits> {
        Some(&self.commits)
    }

    fn examine(&self) -> Answer<'_, Vec<String>> {
        self.look(read::examine)
    }
}
