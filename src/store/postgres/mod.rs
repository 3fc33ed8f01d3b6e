//! PostgreSQL, shared by many processes: what one has acknowledged all the others find.
//!
//! Moves and new sessions queue at a writer, which sends what has gathered as one transaction in one round trip. The
//! sequence of a session decides who wins where several processes move it at once; the primary key of the moves would catch
//! whatever got past it. Everything else goes through a pool of connections. A lost connection is replaced, and what is
//! safe to repeat is repeated for a while; then the callers are told that the storage is out of reach.
//!
//! `docs/postgres.md` describes the tables and what the engine has to know.

mod batch_tx;
mod client_pool;
mod connect;
mod fault;
mod jobs;
mod listen;
mod outcome;
mod request;
mod rows;
mod schema;
mod sql;
mod transactions;
mod writer;

use std::sync::Arc;
use std::time::{Duration, Instant};

use futures::FutureExt as _;
use jiff::Timestamp;
use tokio::task::AbortHandle;
use uuid::Uuid;

use stickslip_wire::SessionSummary;

use super::{
    Answer, Changes, Commits, RECEIPT_LIFETIME, Receipt, Record, Session, Snapshot, Store, StoreError, Tenant,
};

use client_pool::ClientPool;
use connect::ConnectTarget;
use fault::{Backoff, Fault};
use request::{Change, WriteRequest};
use rows::{from_bigint, to_bigint};
use schema::SchemaError;
use writer::Writer;

/// How long a start waits for the database.
const START: Duration = Duration::from_secs(15);
/// How long the question whether the database is there may take.
const READY: Duration = Duration::from_secs(2);

/// Sessions in a PostgreSQL database.
pub struct PostgresStore {
    pool: Arc<ClientPool>,
    writer: Writer,
    changes: Arc<Changes>,
    listener: AbortHandle,
}

impl PostgresStore {
    /// Connects to the database of a URL (`postgres://…` or `postgresql://…`), and makes or updates its tables. A
    /// database that does not answer is waited for a little, as it may be starting too.
    ///
    /// # Errors
    /// [`StoreError::Unavailable`] if it cannot be reached, [`StoreError::Failed`] if it or its tables cannot be used.
    pub async fn open(url: &str) -> Result<PostgresStore, StoreError> {
        let target = ConnectTarget::parse(url).map_err(StoreError::Failed)?;
        let place = target.place();
        let announces = prepared(&target).await.map_err(|error| match error {
            StoreError::Unavailable(text) => StoreError::Unavailable(format!("{place}: {text}")),
            StoreError::Failed(text) => StoreError::Failed(format!("{place}: {text}")),
            other => other,
        })?;
        if !announces {
            tracing::warn!("the database knows no pg_notify: changes by other processes are looked for once a second");
        }
        let pool = Arc::new(ClientPool::new(target, announces)?);
        let changes = Arc::new(Changes::default());
        let writer = Writer::start(Arc::clone(&pool), Arc::clone(&changes));
        let listener = tokio::spawn(listen::listen(Arc::clone(&pool), Arc::clone(&changes))).abort_handle();
        Ok(PostgresStore { pool, writer, changes, listener })
    }

    /// Connects to a database to look at, beside the processes that work with it. Its tables must be there already.
    ///
    /// # Errors
    /// [`StoreError::Unavailable`] if it cannot be reached, [`StoreError::Failed`] if its tables cannot be used.
    pub async fn open_to_read(url: &str) -> Result<PostgresStore, StoreError> {
        let target = ConnectTarget::parse(url).map_err(StoreError::Failed)?;
        let place = target.place();
        let checked = async { schema::check(&target.open().await?).await };
        checked.await.map_err(|error: SchemaError| {
            StoreError::Failed(format!("{place}: {}", Fault::from(error).into_store_error()))
        })?;
        let pool = Arc::new(ClientPool::new(target, false)?);
        let changes = Arc::new(Changes::default());
        let writer = Writer::start(Arc::clone(&pool), Arc::clone(&changes));
        let listener = tokio::spawn(std::future::pending::<()>()).abort_handle();
        Ok(PostgresStore { pool, writer, changes, listener })
    }

    /// Which database it is, without the password.
    #[must_use]
    pub fn place(&self) -> String {
        self.pool.target.place()
    }
}

impl Drop for PostgresStore {
    fn drop(&mut self) {
        self.listener.abort();
    }
}

/// Brings the tables up to date, and tells whether the engine knows announcements.
async fn prepared(target: &ConnectTarget) -> Result<bool, StoreError> {
    let (begin, mut backoff) = (Instant::now(), Backoff::default());
    loop {
        let fault = match target.open().await.map_err(SchemaError::from) {
            Ok(mut client) => match schema::migrate(&mut client).await {
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

impl From<SchemaError> for Fault {
    fn from(error: SchemaError) -> Fault {
        match error {
            SchemaError::Database(error) => error.into(),
            newer => Fault::Refused(StoreError::Failed(newer.to_string())),
        }
    }
}

/// The definition of a session as it is stored: exactly the JSON that it was.
fn definition(session: &Session) -> Result<String, StoreError> {
    let written = serde_json::to_string(&*session.definition);
    written.map_err(|error| StoreError::Failed(format!("a definition cannot be written: {error}")))
}

impl Store for PostgresStore {
    fn ready(&self) -> Answer<'_, ()> {
        async {
            let asked = async {
                client_pool::try_once!(self.pool, READY, connection => client_pool::rows(connection, sql::READY, &[]))
            };
            let asked = tokio::time::timeout(READY, asked).await;
            match asked.unwrap_or_else(|_| Err(Fault::Lost("no answer in time".to_owned()))) {
                Ok(rows) if rows.iter().all(|row| row.get::<_, &str>(0) == "off") => Ok(()),
                Ok(_) => Err(StoreError::Unavailable("the database takes no changes".to_owned())),
                Err(fault) => Err(fault.into_store_error()),
            }
        }
        .boxed()
    }

    fn create(&self, session: Session, receipt: Option<Receipt>) -> Answer<'_, ()> {
        async {
            let definition = definition(&session)?;
            let change = Change::Create(session, definition);
            self.writer.write(|answer| WriteRequest { change, receipt, stamp: request::stamp(), answer }).await
        }
        .boxed()
    }

    fn find(&self, id: Uuid) -> Answer<'_, Session> {
        async move {
            match self.pool.row(sql::FIND, &[&id]).await? {
                Some(row) => rows::session(&row),
                None => Err(self.pool.missing(id).await),
            }
        }
        .boxed()
    }

    fn list(&self, of: Option<Tenant>, after: Option<Uuid>, limit: usize) -> Answer<'_, Vec<SessionSummary>> {
        async move {
            // Nothing lies before the nil identifier, and no session has it.
            let after = after.unwrap_or(Uuid::nil());
            let limit = to_bigint(limit as u64);
            let found = match of {
                None => self.pool.rows(sql::LIST, &[&after, &limit]).await?,
                Some(tenant) => self.pool.rows(sql::LIST_OF_TENANT, &[&after, &limit, &tenant.name()]).await?,
            };
            found.iter().map(rows::summary).collect()
        }
        .boxed()
    }

    fn append(&self, id: Uuid, expected: u64, records: Vec<Record>, receipt: Option<Receipt>) -> Answer<'_, ()> {
        let change = Change::Append { id, expected, records };
        self.writer.write(move |answer| WriteRequest { change, receipt, stamp: request::stamp(), answer }).boxed()
    }

    fn history(&self, id: Uuid, after: u64, limit: usize) -> Answer<'_, Vec<Record>> {
        async move {
            let found = self.pool.rows(sql::HISTORY, &[&id, &to_bigint(after), &to_bigint(limit as u64)]).await?;
            if found.is_empty() && self.pool.row(sql::SEQUENCE, &[&id]).await?.is_none() {
                return Err(self.pool.missing(id).await);
            }
            found.iter().map(rows::record).collect()
        }
        .boxed()
    }

    fn fork(&self, id: Uuid, copy: Session, receipt: Option<Receipt>) -> Answer<'_, ()> {
        self.pool.fork(id, copy, receipt).boxed()
    }

    fn delete(&self, id: Uuid, expected: u64) -> Answer<'_, ()> {
        async move {
            self.pool.delete(id, expected).await?;
            self.changes.wake(id);
            Ok(())
        }
        .boxed()
    }

    fn receipt<'a>(&'a self, key: &'a str) -> Answer<'a, Option<Receipt>> {
        self.pool.receipt(key).boxed()
    }

    fn snapshot(&self, id: Uuid) -> Answer<'_, Option<Snapshot>> {
        async move {
            let kept = self.pool.row(sql::SNAPSHOT, &[&id]).await?;
            if kept.is_none() && self.pool.row(sql::SEQUENCE, &[&id]).await?.is_none() {
                return Err(self.pool.missing(id).await);
            }
            Ok(kept.as_ref().map(rows::snapshot))
        }
        .boxed()
    }

    fn keep_snapshot(&self, id: Uuid, snapshot: Snapshot) -> Answer<'_, ()> {
        self.pool.keep_snapshot(id, snapshot).boxed()
    }

    fn sweep(&self, idle_since: Option<Timestamp>) -> Answer<'_, u64> {
        async move {
            self.pool.sweep_jobs().await?;
            let gone = self.pool.sweep(idle_since).await?;
            gone.iter().for_each(|id| self.changes.wake(*id));
            Ok(gone.len() as u64)
        }
        .boxed()
    }

    fn changes(&self) -> &Changes {
        &self.changes
    }

    fn examine(&self) -> Answer<'_, Vec<String>> {
        async {
            let strays = self.pool.rows(sql::ORPHANED_MOVES, &[]).await?;
            let line = |id: Uuid| format!("the moves of contact {id} are there, and the contact is not");
            Ok(strays.iter().map(|row| line(row.get(0))).collect())
        }
        .boxed()
    }

    fn commits(&self) -> Option<&Commits> {
        Some(&self.writer.commits)
    }

    fn sequence(&self, id: Uuid) -> Answer<'_, u64> {
        async move {
            match self.pool.row(sql::SEQUENCE, &[&id]).await? {
                Some(row) => Ok(from_bigint(row.get(0))),
                None => Err(self.pool.missing(id).await),
            }
        }
        .boxed()
    }
}

impl ClientPool {
    /// [`Store::receipt`]
    async fn receipt(&self, key: &str) -> Result<Option<Receipt>, StoreError> {
        let row = self.row(sql::RECEIPT, &[&key, &RECEIPT_LIFETIME.as_secs_f64()]).await?;
        row.map(|row| rows::receipt(key, &row)).transpose()
    }
}
