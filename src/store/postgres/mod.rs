//! PostgreSQL, shared by many processes: all of them read what one has acknowledged.
//!
//! Moves and new sessions queue at a writer, which sends what has gathered as one transaction in one round trip. The
//! sequence of a contact decides which of several processes that move it at once wins; the primary key of the moves is
//! a second barrier. Everything else goes through a pool of connections. A lost connection is replaced, and what is
//! safe to repeat is repeated for a while; then the callers get an error.
//!
//! `docs/postgres.md` describes the tables and what the database must support.

mod batch_tx;
mod client_pool;
mod columns;
mod connect;
mod fault;
mod jobs;
mod listen;
mod outcome;
mod request;
pub mod schema;
mod sql;
mod transactions;
mod writer;

use std::sync::Arc;
use std::time::{Duration, Instant};

use async_trait::async_trait;
use jiff::Timestamp;
use tokio::task::AbortHandle;
use tokio::time::timeout;
use uuid::Uuid;

use stickslip_wire::SessionSummary;

use super::rows;
use super::schema::SchemaError;
use super::{
    Changes, Commits, RECEIPT_LIFETIME, Receipt, Record, Result, Session, Snapshot, Store, StoreError, Tenant,
};

use client_pool::ClientPool;
use columns::{from_bigint, reader, to_bigint};
use connect::ConnectTarget;
use fault::{Backoff, Fault};
use request::Change;
use writer::Writer;

/// How long a start waits for the database.
const START: Duration = Duration::from_secs(15);
/// How long the check whether the database is reachable may take.
const READY: Duration = Duration::from_secs(2);

/// Sessions in a PostgreSQL database.
pub struct PostgresStore {
    pool: Arc<ClientPool>,
    writer: Writer,
    changes: Arc<Changes>,
    listener: Option<AbortHandle>,
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
        let announces = prepare(&target).await.map_err(|error| match error {
            StoreError::Unavailable(text) => StoreError::Unavailable(format!("{address}: {text}")),
            StoreError::Failed(text) => StoreError::Failed(format!("{address}: {text}")),
            other => other,
        })?;
        if !announces {
            tracing::warn!("the database has no pg_notify: listeners read changes by other processes once a second");
        }
        let mut store = PostgresStore::start(target, announces)?;
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
        PostgresStore::start(target, false)
    }

    /// A store that does not listen yet.
    fn start(target: ConnectTarget, announces: bool) -> Result<PostgresStore> {
        let (pool, changes) = (Arc::new(ClientPool::new(target, announces)?), Arc::default());
        let writer = Writer::start(Arc::clone(&pool), Arc::clone(&changes));
        Ok(PostgresStore { pool, writer, changes, listener: None })
    }

    /// Which database it is, without the password.
    #[must_use]
    pub fn address(&self) -> String {
        self.pool.target.address()
    }
}

impl Drop for PostgresStore {
    fn drop(&mut self) {
        self.listener.iter().for_each(AbortHandle::abort);
    }
}

/// Migrates the tables, and returns whether the database has notifications.
async fn prepare(target: &ConnectTarget) -> Result<bool> {
    let (begin, mut backoff) = (Instant::now(), Backoff::default());
    loop {
        let fault = match target.open().await.map_err(SchemaError::from) {
            Ok(mut client) => match schema::migrate(&mut client, schema::MIGRATIONS).await {
                Ok(()) => return Ok(client.batch_execute(sql::PROBE_NOTIFY).await.is_ok()),
                Err(error) => error.into(),
            },
            Err(error) => Fault::from(error),
        };
        match fault {
            Fault::Lost(_) | Fault::Conflict(_) if begin.elapsed() < START => backoff.pause().await,
            fault => return Err(fault.into_store_error()),
        }
    }
}

impl From<SchemaError<tokio_postgres::Error>> for Fault {
    fn from(error: SchemaError<tokio_postgres::Error>) -> Fault {
        match error {
            SchemaError::Database(error) => error.into(),
            SchemaError::Version(error) => Fault::Refused(StoreError::Failed(error.to_string())),
        }
    }
}

/// The definition of a session as it is stored: exactly the JSON that it was.
fn definition(session: &Session) -> Result<String> {
    let written = serde_json::to_string(&*session.definition);
    written.map_err(|error| StoreError::Failed(format!("a definition cannot be written: {error}")))
}

#[async_trait]
impl Store for PostgresStore {
    async fn ready(&self) -> Result<()> {
        let asked = async {
            client_pool::try_once!(self.pool, READY, connection => client_pool::rows(connection, sql::READY, &[]))
        };
        match timeout(READY, asked).await.unwrap_or_else(|_| Err(Fault::no_answer())) {
            Ok(rows) if rows.iter().all(|row| row.get::<_, &str>(0) == "off") => Ok(()),
            Ok(_) => Err(StoreError::Unavailable("the database accepts no changes".to_owned())),
            Err(fault) => Err(fault.into_store_error()),
        }
    }

    async fn create(&self, session: Session, receipt: Option<Receipt>) -> Result<()> {
        let definition = definition(&session)?;
        self.writer.write(Change::Create(session, definition), receipt).await
    }

    async fn find(&self, id: Uuid) -> Result<Session> {
        match self.pool.row(sql::FIND, &[&id]).await? {
            Some(row) => rows::session(&mut reader(&row)),
            None => Err(self.pool.missing(id).await),
        }
    }

    async fn sequence(&self, id: Uuid) -> Result<u64> {
        match self.pool.row(sql::SEQUENCE, &[&id]).await? {
            Some(row) => Ok(from_bigint(row.get(0))),
            None => Err(self.pool.missing(id).await),
        }
    }

    async fn list(&self, tenant: Option<Tenant>, after: Option<Uuid>, limit: usize) -> Result<Vec<SessionSummary>> {
        // No session has the nil identifier, which is the lowest.
        let (after, limit) = (after.unwrap_or_default(), to_bigint(limit as u64));
        let found = match tenant {
            None => self.pool.rows(sql::LIST, &[&after, &limit]).await?,
            Some(tenant) => self.pool.rows(sql::LIST_OF_TENANT, &[&after, &limit, &tenant.name()]).await?,
        };
        found.iter().map(|row| rows::summary(&mut reader(row))).collect()
    }

    async fn append(&self, id: Uuid, expected: u64, records: Vec<Record>, receipt: Option<Receipt>) -> Result<()> {
        self.writer.write(Change::Append { id, expected, records }, receipt).await
    }

    async fn history(&self, id: Uuid, after: u64, limit: usize) -> Result<Vec<Record>> {
        let found = self.pool.rows(sql::HISTORY, &[&id, &to_bigint(after), &to_bigint(limit as u64)]).await?;
        if found.is_empty() {
            self.sequence(id).await?;
        }
        found.iter().map(|row| rows::record(&mut reader(row))).collect()
    }

    async fn fork(&self, id: Uuid, copy: Session, receipt: Option<Receipt>) -> Result<()> {
        self.pool.fork(id, copy, receipt).await
    }

    async fn delete(&self, id: Uuid, expected: u64) -> Result<()> {
        self.pool.delete(id, expected).await?;
        self.changes.wake(id);
        Ok(())
    }

    async fn receipt(&self, key: &str) -> Result<Option<Receipt>> {
        self.pool.receipt(key).await
    }

    async fn snapshot(&self, id: Uuid) -> Result<Option<Snapshot>> {
        let found = self.pool.row(sql::SNAPSHOT, &[&id]).await?;
        if found.is_none() {
            self.sequence(id).await?;
        }
        found.map(|row| rows::snapshot(&mut reader(&row))).transpose()
    }

    async fn save_snapshot(&self, id: Uuid, snapshot: Snapshot) -> Result<()> {
        self.pool.save_snapshot(id, snapshot).await
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

    fn commits(&self) -> Option<&Commits> {
        Some(&self.writer.commits)
    }

    async fn check_integrity(&self) -> Result<Vec<String>> {
        let orphans = self.pool.rows(sql::ORPHANED_MOVES, &[]).await?;
        let line = |id: Uuid| format!("the moves of contact {id} are there, and the contact is not");
        Ok(orphans.iter().map(|row| line(row.get(0))).collect())
    }
}

impl ClientPool {
    /// [`Store::receipt`]
    async fn receipt(&self, key: &str) -> Result<Option<Receipt>> {
        let row = self.row(sql::RECEIPT, &[&key, &RECEIPT_LIFETIME.as_secs_f64()]).await?;
        row.map(|row| rows::receipt(key, &mut reader(&row))).transpose()
    }
}
