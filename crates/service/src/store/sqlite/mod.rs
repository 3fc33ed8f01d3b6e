//! Everything in one SQLite file: durable when it is acknowledged, for one process at a time. Or in the memory of the
//! process (`memory.rs`), by the same statements.
//!
//! One thread writes (`writer.rs`): requests that wait share a transaction and its wait for the disk. Reads have
//! connections of their own (`readers.rs`) and do not wait. Long work, such as the copy of a million moves, is done in
//! small steps between the transactions of others (`fork.rs`). The tables are in `schema.rs`, and explained in
//! `docs/storage.md`. Failures and their meanings are in `fault.rs`.

pub(super) mod backup;
mod change;
mod columns;
mod fault;
mod file;
mod fork;
mod jobs;
mod memory;
mod open_files;
mod read;
mod readers;
pub mod schema;
mod statements;
mod wal_check;
mod writer;

use std::collections::HashSet;
use std::path::Path;
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::Duration;

use async_trait::async_trait;
use jiff::Timestamp;
use parking_lot::Mutex;
use rusqlite::Connection;
use tokio::sync::{mpsc, oneshot};
use uuid::Uuid;

use super::probe::Probe;
use super::{
    Changes, Clock, Commits, Extent, IsSmall, LabelChange, Page, Receipt, Record, Result, Session, Snapshot, Store,
    StoreError, Tenant, Usage, Whole,
};
use crate::metrics::Counted;
use change::{Change, Done, Transaction};
use fault::Fault;
use fork::Fork;
use memory::InMemory;
use open_files::OpenFiles;
use readers::Readers;
use stickslip_wire::SessionSummary;
use writer::Writer;

/// Requests that may wait for the writer; further ones wait for a place.
const QUEUE: usize = 1_024;
/// How long to wait for another program that has locked the file.
const BUSY: Duration = Duration::from_secs(2);
/// The same after one request has waited for nothing: until the lock is released no request waits for it.
const STILL_BUSY: Duration = Duration::from_millis(50);
/// Sessions that expire in one transaction.
const EXPIRE_AT_ONCE: usize = 200;

/// Sessions in an SQLite file, or in memory.
pub struct SqliteStore {
    place: Place,
    /// The thread that writes to the file, if one may; it ends without senders.
    writer: Option<(mpsc::Sender<Change>, JoinHandle<()>)>,
    changes: Arc<Changes>,
    commits: Arc<Commits>,
    /// The chunks that are worked on: none of them outlives the process.
    claims: Mutex<HashSet<(Uuid, u64)>>,
    probe: Probe,
    clock: Clock,
}

enum Place {
    File {
        readers: Readers,
        /// Why nothing can be changed, if the disk was full at start.
        full: Option<String>,
    },
    Memory(InMemory),
}

impl SqliteStore {
    /// Opens a file, migrates its tables, and locks it against other writers; or makes one. Where there is no room to
    /// write, it is opened to read.
    ///
    /// # Errors
    /// Why it cannot be used, in one line. The file is as it was then.
    pub fn open(path: &Path) -> Result<SqliteStore, String> {
        // The last write tells the time, if the clock of the system is ahead by now.
        let clock = Clock::starting_at(file::last_write(path).unwrap_or_else(Timestamp::now));
        let file::Opened { database, lock, files } = match file::open(path)? {
            file::Access::Writable(opened) => opened,
            file::Access::Full { why, readers } => {
                tracing::error!(
                    why,
                    "no room to write: contacts can be read; they can be changed again after a start with room"
                );
                return Ok(SqliteStore::reading(readers, Some(why)));
            }
        };
        let readers = Readers::new(path.to_owned(), Arc::clone(&files), Some(Arc::clone(&lock)), false);
        let mut store = SqliteStore::reading(readers, None);
        store.clock = clock;
        let (changes, commits) = (Arc::clone(&store.changes), Arc::clone(&store.commits));
        let writer = Writer::new(database, files, changes, commits, clock).map_err(|error| error.to_string())?;
        let (sender, requests) = mpsc::channel(QUEUE);
        let thread = std::thread::Builder::new().name("sqlite-writer".to_owned()).spawn(move || {
            writer.run(requests);
            drop(lock);
        });
        store.writer = Some((sender, thread.map_err(|error| error.to_string())?));
        Ok(store)
    }

    /// A store in the memory of the process, which is lost with it.
    ///
    /// # Errors
    /// Why it cannot be made, in one line.
    pub fn in_memory() -> Result<SqliteStore, String> {
        let (changes, commits) = (Arc::default(), Arc::new(Commits::new("memory")));
        let clock = Clock::starting_at(Timestamp::now());
        let database = InMemory::new(Arc::clone(&changes), Arc::clone(&commits), clock);
        let place = Place::Memory(database.map_err(|error| error.to_string())?);
        Ok(SqliteStore::at(place, changes, commits))
    }

    /// A store in a file, without a writer.
    fn reading(readers: Readers, full: Option<String>) -> SqliteStore {
        SqliteStore::at(Place::File { readers, full }, Arc::default(), Arc::new(Commits::new("sqlite")))
    }

    fn at(place: Place, changes: Arc<Changes>, commits: Arc<Commits>) -> SqliteStore {
        let (claims, probe, clock) = (Mutex::default(), Probe::default(), Clock::starting_at(Timestamp::now()));
        SqliteStore { writer: None, place, changes, commits, claims, probe, clock }
    }

    /// Opens a file for reading, while a process may serve it. Changes fail.
    ///
    /// # Errors
    /// Why it cannot be read, in one line.
    pub fn open_to_read(path: &Path) -> Result<SqliteStore, String> {
        backup::open_read_only(path)?;
        let files = Arc::new(OpenFiles::at([path]).map_err(|error| error.to_string())?);
        Ok(SqliteStore::reading(Readers::new(path.to_owned(), files, None, false), None))
    }

    /// Answers a question that reads a few rows.
    async fn look_up<T: Send + 'static>(
        &self,
        question: impl FnOnce(&Connection) -> Result<T, Fault> + Send + 'static,
    ) -> Result<T> {
        match &self.place {
            Place::File { readers, .. } => readers.read(question).await,
            Place::Memory(database) => database.look_up(question).await,
        }
    }

    /// Answers a question that reads a page of rows, or a row or two of each contact.
    async fn read<T: Send + 'static>(
        &self,
        question: impl FnOnce(&Connection) -> Result<T, Fault> + Send + 'static,
    ) -> Result<T> {
        match &self.place {
            Place::File { readers, .. } => readers.read(question).await,
            Place::Memory(database) => database.read(question).await,
        }
    }

    /// Has the writer make a change of about `weight` rows and keep the receipt, and returns its count when it is
    /// durable. The listeners of `touched` are woken then.
    async fn change(
        &self,
        weight: usize,
        touched: impl Into<Vec<Uuid>>,
        receipt: Option<Receipt>,
        apply: impl Fn(&mut Transaction<'_>) -> Result<Done, Fault> + Send + 'static,
    ) -> Result<u64> {
        let (reply, outcome) = oneshot::channel();
        let (apply, touched) = (Box::new(apply), touched.into());
        self.send(Change { apply, weight, is_append: false, touched, receipt, reply }, outcome).await
    }

    async fn send(&self, request: Change, outcome: oneshot::Receiver<Result<u64>>) -> Result<u64> {
        let _pending = Counted::by(&self.commits.pending);
        match (&self.place, &self.writer) {
            (Place::Memory(database), _) => database.change(request).await,
            // A request that is not sent is dropped, and has no outcome.
            (_, Some((requests, _))) => drop(requests.send(request).await),
            (_, None) => drop(request),
        }
        outcome.await.map_err(|_| match &self.place {
            Place::File { full: Some(why), .. } => StoreError::Full(why.clone()),
            _ => StoreError::Failed("the writer of the database has ended".to_owned()),
        })?
    }
}

impl Drop for SqliteStore {
    /// Ends the writer, which does what it has accepted and merges the log into the file.
    fn drop(&mut self) {
        if let Place::File { readers, .. } = &self.place {
            readers.close();
        }
        if let Some((requests, writer)) = self.writer.take() {
            drop(requests);
            if writer.join().is_err() {
                tracing::error!("the writer of the database panicked");
            }
        }
    }
}

#[async_trait]
impl Store for SqliteStore {
    async fn ready(&self) -> Result<()> {
        self.read(read::alive).await?;
        self.probe.outcome(async { self.change(1, [], None, |transaction| transaction.probe()).await.map(drop) }).await
    }

    async fn create(&self, session: Session, receipt: Option<Receipt>) -> Result<()> {
        self.change(1, [], receipt, move |transaction| transaction.create(&session)).await.map(drop)
    }

    async fn extent(&self, id: Uuid) -> Result<Extent> {
        self.look_up(move |database| read::extent(database, id)).await
    }

    async fn load(&self, id: Uuid, is_small: IsSmall) -> Result<(Extent, Option<Whole>)> {
        self.look_up(move |database| read::load(database, id, is_small)).await
    }

    async fn usage(&self, tenant: &Tenant) -> Result<Usage> {
        let tenant = tenant.clone();
        self.read(move |database| read::usage(database, &tenant)).await
    }

    fn move_bytes(&self) -> u64 {
        read::MOVE_BYTES
    }

    async fn find(&self, id: Uuid) -> Result<Session> {
        self.look_up(move |database| read::find(database, id)).await
    }

    async fn list(&self, tenant: Option<Tenant>, label: Option<String>, page: Page) -> Result<Vec<SessionSummary>> {
        let is_search = label.is_some();
        let list = move |database: &_| read::list(database, tenant.as_ref(), label.as_deref(), page);
        match &self.place {
            Place::File { readers, .. } if is_search => readers.search(list).await,
            _ => self.read(list).await,
        }
    }

    async fn rename(&self, id: Uuid, label: LabelChange, expected: u64, receipt: Option<Receipt>) -> Result<()> {
        let rename = move |transaction: &mut Transaction<'_>| transaction.rename(id, &label, expected);
        self.change(1, [id], receipt, rename).await.map(drop)
    }

    async fn append_after(
        &self,
        id: Uuid,
        (expected, _): (u64, Option<Timestamp>),
        records: Vec<Record>,
        receipt: Option<Receipt>,
    ) -> Result<()> {
        let ((reply, outcome), weight) = (oneshot::channel(), records.len().max(1));
        let apply = Box::new(move |transaction: &mut Transaction<'_>| transaction.append(id, expected, &records));
        let touched = vec![id];
        self.send(Change { apply, weight, is_append: true, touched, receipt, reply }, outcome).await.map(drop)
    }

    async fn history(&self, id: Uuid, after: u64, limit: usize) -> Result<Vec<Record>> {
        self.read(move |database| read::history(database, id, after, limit)).await
    }

    async fn count_moves(&self, id: Uuid, end: u64) -> Result<u64> {
        self.read(move |database| read::count_moves(database, id, end)).await
    }

    async fn fork(&self, id: Uuid, copy: Session, receipt: Option<Receipt>) -> Result<()> {
        let weight = usize::try_from(copy.sequence).unwrap_or(usize::MAX).max(1);
        let fork = Arc::new(Fork { id, copy });
        self.change(weight, [], receipt, move |transaction| transaction.fork(&fork)).await.map(drop)
    }

    async fn delete(&self, id: Uuid, expected: u64) -> Result<()> {
        self.change(1, [id], None, move |transaction| transaction.delete(id, expected)).await.map(drop)
    }

    async fn keep(&self, receipt: Receipt) -> Result<()> {
        self.change(1, [], Some(receipt), |_| Ok(Done::Made(0))).await.map(drop)
    }

    async fn receipt(&self, key: &str) -> Result<Option<Receipt>> {
        let (key, clock) = (key.to_owned(), self.clock);
        self.look_up(move |database| read::receipt(database, &key, clock)).await
    }

    async fn snapshot(&self, id: Uuid) -> Result<Option<Snapshot>> {
        self.look_up(move |database| read::snapshot(database, id)).await
    }

    async fn save_snapshot(&self, id: Uuid, snapshot: Snapshot, unreadable: Option<u64>) -> Result<()> {
        let save = move |transaction: &mut Transaction<'_>| transaction.save_snapshot(id, &snapshot, unreadable);
        self.change(1, [], None, save).await.map(drop)
    }

    async fn purge_expired(&self, idle_since: Option<Timestamp>) -> Result<u64> {
        while self.change(1, [], None, |transaction| transaction.purge_records()).await? > 0 {}
        self.purge_jobs().await?;
        if let Place::Memory(_) = self.place {
            self.change(usize::MAX, [], None, memory::forget).await?;
        }
        let Some(since) = idle_since else { return Ok(0) };
        let (mut expired, mut next) = (0, Some(0));
        while let Some(after) = next {
            let idle;
            (idle, next) = self.read(move |database| read::idle(database, since, after)).await?;
            for ids in idle.chunks(EXPIRE_AT_ONCE) {
                let idle = ids.to_vec();
                expired +=
                    self.change(ids.len(), ids, None, move |transaction| transaction.expire(&idle, since)).await?;
            }
        }
        Ok(expired)
    }

    fn is_exclusive(&self) -> bool {
        match &self.place {
            Place::File { readers, .. } => readers.are_ours(),
            Place::Memory(_) => true,
        }
    }

    async fn now(&self) -> Result<Timestamp> {
        Ok(self.clock.now())
    }

    fn changes(&self) -> &Changes {
        &self.changes
    }

    fn commits(&self) -> &Commits {
        &self.commits
    }

    fn log_bytes(&self) -> Option<u64> {
        match &self.place {
            Place::File { readers, .. } => Some(readers.log_bytes()),
            Place::Memory(_) => None,
        }
    }

    async fn check_integrity(&self) -> Result<Vec<String>> {
        self.read(read::check_integrity).await
    }
}
