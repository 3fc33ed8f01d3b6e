//! PostgreSQL, shared by many processes: all of them read what one has acknowledged.
//!
//! Moves and new sessions queue at a writer, which sends the waiting requests as one transaction in one round trip. The
//! sequence of a contact decides which of several processes that move it at once wins; the primary key of the moves is
//! a second barrier. A change whose contact another transaction holds waits apart from the others. Everything else goes
//! through a pool of connections. A lost connection is replaced, and statements that are safe to repeat are repeated
//! for a while; then the callers get an error.
//!
//! `docs/postgres.md` describes the tables and what the database must support.

mod batch_tx;
mod client_pool;
mod columns;
mod committer;
mod connect;
mod fault;
mod jobs;
mod listen;
mod request;
pub mod schema;
mod sql;
mod transactions;
mod writer;

use std::sync::Arc;
use std::time::{Duration, Instant, SystemTime};

use async_trait::async_trait;
use jiff::Timestamp;
use tokio::task::AbortHandle;
use tokio::time::timeout;
use tokio_postgres::Row;
use uuid::Uuid;

use stickslip_wire::{ContactOrder, SessionSummary};

use super::probe::Probe;
use super::rows::{self, RowReader as _};
use super::schema::SchemaError;
use super::{
    CONTACT_BYTES, Changes, Commits, Extent, LabelChange, Page, RECEIPT_LIFETIME, RECEIPT_OVERHEAD, Receipt, Record,
    Result, Session, Snapshot, Store, StoreError, Tenant, Usage,
};

use client_pool::{ANSWER, ClientPool};
use columns::{from_bigint, reader, reader_from, to_bigint};
use connect::ConnectTarget;
use fault::{Backoff, Fault, LOCK_WAIT};
use request::Change;
use writer::Writer;

/// How long a start waits for the database.
const START: Duration = Duration::from_secs(15);
/// How long changes may wait without a commit before the store counts as not ready.
const STALLED: Duration = LOCK_WAIT;
/// How long the check whether the database takes changes may take.
const READY: Duration = Duration::from_secs(2);

/// Sessions in a PostgreSQL database.
pub struct PostgresStore {
    pool: Arc<ClientPool>,
    writer: Writer,
    changes: Arc<Changes>,
    /// None where it is open for reading alone.
    listener: Option<AbortHandle>,
    probe: Probe,
}

impl PostgresStore {
    /// Connects to the database of a URL (`postgres://…` or `postgresql://…`), and makes or updates its tables. A
    /// database that does not answer is waited for a little, as it may be starting too.
    ///
    /// # Errors
    /// [`StoreError::Unavailable`] if it cannot be reached, [`StoreError::Failed`] if it or its tables cannot be used.
    pub async fn open(url: &str) -> Result<PostgresStore> {
        let target = ConnectTarget::parse(url).map_err(StoreError::Failed)?;
        let address = target.address();
        prepare(&target).await.map_err(|error| match error {
            StoreError::Unavailable(text) => StoreError::Unavailable(format!("{address}: {text}")),
            StoreError::Failed(text) => StoreError::Failed(format!("{address}: {text}")),
            other => other,
        })?;
        let mut store = PostgresStore::start(target)?;
        let listening = listen::listen(Arc::clone(&store.pool), Arc::clone(&store.changes));
        store.listener = Some(tokio::spawn(listening).abort_handle());
        Ok(store)
    }

    /// Connects to a database for reading, while other processes may use it. Its tables must exist.
    ///
    /// # Errors
    /// [`StoreError::Unavailable`] if it cannot be reached, [`StoreError::Failed`] if its tables cannot be used.
    pub async fn open_to_read(url: &str) -> Result<PostgresStore> {
        let target = ConnectTarget::parse(url).map_err(StoreError::Failed)?;
        let address = target.address();
        let checked = async { schema::check(&target.open().await?).await };
        checked.await.map_err(|error: SchemaError<_>| {
            StoreError::Failed(format!("{address}: {}", Fault::from(error).into_store_error()))
        })?;
        PostgresStore::start(target)
    }

    /// A store of which the tables have been looked at.
    fn start(target: ConnectTarget) -> Result<PostgresStore> {
        let (pool, changes) = (Arc::new(ClientPool::new(target)?), Arc::default());
        let writer = Writer::start(Arc::clone(&pool), Arc::clone(&changes));
        Ok(PostgresStore { pool, writer, changes, listener: None, probe: Probe::default() })
    }

    /// Which database it is, without the password.
    pub fn address(&self) -> String {
        self.pool.target.address()
    }
}

impl Drop for PostgresStore {
    fn drop(&mut self) {
        self.listener.iter().for_each(AbortHandle::abort);
    }
}

/// Migrates the tables, and checks that the database has notifications.
async fn prepare(target: &ConnectTarget) -> Result<()> {
    let (begin, mut backoff) = (Instant::now(), Backoff::default());
    loop {
        let prepared = async {
            let opened = timeout(ANSWER, target.open()).await.map_err(|_| Fault::no_answer())?;
            let mut client = opened?;
            let encoding: String = client.query_one(sql::ENCODING, &[]).await?.get(0);
            if encoding != "UTF8" {
                let why = format!("it has the encoding {encoding}: make one with ENCODING 'UTF8' TEMPLATE template0");
                return Err(Fault::Refused(StoreError::Failed(why)));
            }
            schema::migrate(&mut client, schema::MIGRATIONS).await?;
            client.batch_execute(sql::PROBE_NOTIFY).await?;
            Ok::<_, Fault>(())
        };
        match prepared.await {
            Ok(()) => return Ok(()),
            Err(Fault::Lost(_) | Fault::Conflict(_) | Fault::Locked(_)) if begin.elapsed() < START => {
                backoff.pause().await;
            }
            Err(fault) => return Err(fault.into_store_error()),
        }
    }
}

impl From<SchemaError<tokio_postgres::Error>> for Fault {
    fn from(error: SchemaError<tokio_postgres::Error>) -> Fault {
        match error {
            SchemaError::Database(error) => error.into(),
            SchemaError::Version(why) => Fault::Refused(StoreError::Failed(why)),
        }
    }
}

/// Bytes that a move takes in the table, with the longest name of a key, and in its index.
const MOVE_BYTES: u64 = 320;

/// The definition of a session, as exactly the JSON that is stored.
fn definition(session: &Session) -> Result<String> {
    let written = serde_json::to_string(&*session.definition);
    written.map_err(|error| StoreError::Failed(format!("a definition cannot be written: {error}")))
}

#[async_trait]
impl Store for PostgresStore {
    async fn ready(&self) -> Result<()> {
        let execute = async |statement| {
            let done = client_pool::try_once!(self.pool, READY, connection =>
                client_pool::execute(connection, statement, &[]));
            done.map(drop).map_err(Fault::into_store_error)
        };
        execute(sql::PING).await?;
        let probe = async {
            execute(sql::PROBE).await?;
            let done = client_pool::try_once!(self.pool, READY, connection => batch_tx::probe(connection));
            done.map_err(Fault::into_store_error)
        };
        self.probe.outcome(probe).await?;
        let stalled = self.writer.commits.stalled();
        if stalled < STALLED {
            return Ok(());
        }
        Err(StoreError::Unavailable(format!("changes wait, and none was committed for {} s", stalled.as_secs())))
    }

    async fn create(&self, session: Session, receipt: Option<Receipt>) -> Result<()> {
        let definition = definition(&session)?;
        self.writer.write(Change::Create(session, definition), receipt).await
    }

    async fn extent(&self, id: Uuid) -> Result<Extent> {
        match self.pool.row(sql::EXTENT, &[&id]).await? {
            Some(row) => {
                let mut columns = reader(&row);
                let extent = rows::extent(&mut columns)?;
                Ok(Extent { moved_at: Some(columns.time()?), ..extent })
            }
            None => Err(self.pool.missing(id).await),
        }
    }

    async fn usage(&self, tenant: &Tenant) -> Result<Usage> {
        let [each, step, reply] = [CONTACT_BYTES, MOVE_BYTES, RECEIPT_OVERHEAD].map(to_bigint);
        let row = self.pool.row(sql::USAGE, &[&tenant.name(), &each, &step, &reply]).await?;
        let usage = |row: Row| Usage { contacts: from_bigint(row.get(0)), bytes: from_bigint(row.get(1)) };
        Ok(row.map(usage).unwrap_or_default())
    }

    fn move_bytes(&self) -> u64 {
        MOVE_BYTES
    }

    async fn find(&self, id: Uuid) -> Result<Session> {
        match self.pool.row(sql::FIND, &[&id]).await? {
            Some(row) => rows::session(&mut reader(&row)),
            None => Err(self.pool.missing(id).await),
        }
    }

    async fn list(&self, tenant: Option<Tenant>, label: Option<String>, page: Page) -> Result<Vec<SessionSummary>> {
        // No session has the nil identifier, which is the lowest, or the highest.
        let after = page.after.unwrap_or(match page.order {
            ContactOrder::Oldest => Uuid::nil(),
            ContactOrder::Newest => Uuid::max(),
        });
        let sql = sql::list(tenant.is_some(), label.is_some(), page.order);
        let (limit, name) = (to_bigint(page.limit as u64), tenant.as_ref().map_or("", Tenant::name));
        let which: [client_pool::Parameter<'_>; 4] = [&after, &limit, &label, &name];
        let found =
            if label.is_some() { self.pool.search(&sql, &which).await? } else { self.pool.rows(&sql, &which).await? };
        found.iter().map(|row| rows::summary(&mut reader(row))).collect()
    }

    async fn rename(&self, id: Uuid, label: LabelChange, expected: u64, receipt: Option<Receipt>) -> Result<()> {
        self.pool.rename(id, label, expected, receipt).await
    }

    async fn append_after(
        &self,
        id: Uuid,
        (expected, moved_at): (u64, Option<Timestamp>),
        records: Vec<Record>,
        receipt: Option<Receipt>,
    ) -> Result<()> {
        self.writer.write(Change::Append { id, expected, moved_at, records }, receipt).await
    }

    async fn now(&self) -> Result<Timestamp> {
        let row = self.pool.row(sql::NOW, &[]).await?;
        let now = row.map_or_else(|| Ok(Timestamp::now()), |row| Timestamp::try_from(row.get::<_, SystemTime>(0)));
        now.map_err(|error| StoreError::Failed(format!("the time of the database cannot be read: {error}")))
    }

    async fn history(&self, id: Uuid, after: u64, limit: usize) -> Result<Vec<Record>> {
        let found = self.pool.rows(sql::HISTORY, &[&id, &to_bigint(after), &to_bigint(limit as u64)]).await?;
        let Some(first) = found.first() else { return Err(self.pool.missing(id).await) };
        let last = from_bigint(first.get(0));
        // A contact without such moves has one row, without a move.
        let moves = found.iter().filter(|row| row.get::<_, Option<i64>>(1).is_some());
        let page = moves.map(|row| rows::record(&mut reader_from(row, 1))).collect::<Result<Vec<Record>>>()?;
        rows::check_page(id, after, &page, limit, last)?;
        Ok(page)
    }

    async fn count_moves(&self, id: Uuid, end: u64) -> Result<u64> {
        let row = self.pool.row(sql::COUNT_MOVES, &[&id, &to_bigint(end)]).await?;
        Ok(row.map_or(0, |row| from_bigint(row.get(0))))
    }

    async fn fork(&self, id: Uuid, copy: Session, receipt: Option<Receipt>) -> Result<()> {
        self.pool.fork(id, copy, receipt).await
    }

    async fn delete(&self, id: Uuid, expected: u64) -> Result<()> {
        self.pool.delete(id, expected).await?;
        self.changes.wake(id);
        Ok(())
    }

    async fn keep(&self, receipt: Receipt) -> Result<()> {
        self.pool.keep(&receipt).await
    }

    async fn receipt(&self, key: &str) -> Result<Option<Receipt>> {
        let row = self.pool.row(sql::RECEIPT, &[&key, &RECEIPT_LIFETIME.as_secs_f64()]).await?;
        row.map(|row| rows::receipt(key, &mut reader(&row))).transpose()
    }

    async fn snapshot(&self, id: Uuid) -> Result<Option<Snapshot>> {
        let found = self.pool.row(sql::SNAPSHOT, &[&id]).await?;
        if found.is_none() {
            self.extent(id).await?;
        }
        found.map(|row| rows::snapshot(&mut reader(&row))).transpose()
    }

    async fn save_snapshot(&self, id: Uuid, snapshot: Snapshot, unreadable: Option<u64>) -> Result<()> {
        self.pool.save_snapshot(id, snapshot, unreadable).await
    }

    async fn purge_expired(&self, idle_since: Option<Timestamp>) -> Result<u64> {
        self.pool.purge_jobs().await?;
        let expired = self.pool.purge_expired(idle_since).await?;
        expired.iter().for_each(|id| self.changes.wake(*id));
        Ok(expired.len() as u64)
    }

    fn changes(&self) -> &Changes {
        &self.changes
    }

    fn commits(&self) -> &Commits {
        &self.writer.commits
    }

    async fn check_integrity(&self) -> Result<Vec<String>> {
        let orphans = self.pool.rows(sql::ORPHANED_MOVES, &[]).await?;
        let line = |id: Uuid| format!("moves of contact {id} are stored, but the contact is not");
        let jobs = self.pool.rows(sql::jobs::JOB_FAULTS, &[]).await?;
        let receipts = self.pool.rows(sql::RECEIPT_FAULTS, &[]).await?;
        let texts = jobs.iter().chain(&receipts).map(|row| row.get(0));
        Ok(orphans.iter().map(|row| line(row.get(0))).chain(texts).collect())
    }
}
