//! A pool of connections for all that does not go through the writer, with retries where a connection is lost.

use std::time::{Duration, Instant};

use deadpool_postgres::{
    GenericClient, Hook, HookError, Manager, ManagerConfig, Object, Pool, RecyclingMethod, Runtime,
};
use tokio::sync::Semaphore;
use tokio::time::timeout;
use tokio_postgres::Row;
use tokio_postgres::types::ToSql;
use tokio_postgres_rustls::MakeRustlsConnect;

use crate::store::{Result, StoreError};

use super::connect::ConnectTarget;
use super::fault::{Backoff, Fault, LOCK_WAIT, Outage};
use super::sql;

/// Connections of the pool. Reads are short; more would only make the database switch between them.
const CONNECTIONS: usize = 8;
/// Searches among them at a time.
const SEARCHES: usize = 2;
/// How long a call waits for a free connection, or for a new one.
const PATIENCE_FOR_CONNECTION: Duration = Duration::from_secs(5);
/// How long an answer may take: longer than the database itself allows a statement, so that the database gives up first
/// unless it cannot be reached.
pub(super) const ANSWER: Duration = Duration::from_secs(15);
/// The same for statements that copy or delete all moves of a contact.
pub(super) const LONG_ANSWER: Duration = Duration::from_secs(90);
/// How often work is tried in all, and how often because two transactions conflicted.
const TRIES: usize = 12;
const COLLISIONS: usize = 8;

/// Attempts something until it is done or no further attempt is worthwhile. (A macro, because the bounds of a closure's
/// future cannot be expressed for a function.)
macro_rules! retried {
    ($pool:expr, $attempt:expr) => {{
        let mut tries = $crate::store::postgres::client_pool::Tries::default();
        loop {
            let fault = match $attempt {
                Ok(done) => {
                    $pool.outage.end();
                    break Ok(done);
                }
                Err(fault) => fault,
            };
            if let Err(error) = tries.retry_or_fail(&$pool.outage, fault).await {
                break Err(error);
            }
        }
    }};
}

/// The same with work on a connection of the pool that may be done again on another.
macro_rules! with_retries {
    ($pool:expr, $limit:expr, $connection:ident => $work:expr) => {
        $crate::store::postgres::client_pool::retried!(
            $pool,
            $crate::store::postgres::client_pool::try_once!($pool, $limit, $connection => $work)
        )
    };
}

/// Does work on a connection of the pool. A connection that failed or did not answer in time is not given back.
macro_rules! try_once {
    ($pool:expr, $limit:expr, $connection:ident => $work:expr) => {
        match $pool.connection().await {
            Err(fault) => Err(fault),
            Ok(mut object) => {
                let $connection = &mut object;
                let done = $pool.answer($limit, $work).await;
                if matches!(done, Err(Fault::Lost(_))) {
                    drop(deadpool_postgres::Object::take(object));
                }
                done
            }
        }
    };
}

pub(super) use {retried, try_once, with_retries};

pub(super) type Parameter<'a> = &'a (dyn ToSql + Sync);

pub(super) struct ClientPool {
    pub(super) target: ConnectTarget,
    pub(super) outage: Outage,
    pool: Pool,
    /// For searches, so that other reads never wait behind them.
    searches: Semaphore,
}

/// A statement that is ended when this is dropped. Its connection is closed then: the end may come later.
struct Search {
    connection: Option<Object>,
    tls: MakeRustlsConnect,
}

impl Drop for Search {
    fn drop(&mut self) {
        if let Some(connection) = self.connection.take() {
            let (client, tls) = (Object::take(connection), self.tls.clone());
            tokio::spawn(async move {
                if let Err(error) = client.cancel_token().cancel_query(tls).await {
                    tracing::debug!(%error, "a search was not ended");
                }
            });
        }
    }
}

impl ClientPool {
    /// A pool that connects when it is first used.
    pub(super) fn new(target: ConnectTarget) -> Result<ClientPool> {
        let config = ManagerConfig { recycling_method: RecyclingMethod::Fast };
        let manager = Manager::from_config(target.config.clone(), target.tls.clone(), config);
        let prepare = Hook::async_fn(|client, _| {
            Box::pin(async move { client.batch_execute(sql::PREPARE_CONNECTION).await.map_err(HookError::Backend) })
        });
        let pool = Pool::builder(manager)
            .max_size(CONNECTIONS)
            .runtime(Runtime::Tokio1)
            .wait_timeout(Some(PATIENCE_FOR_CONNECTION))
            .create_timeout(Some(PATIENCE_FOR_CONNECTION))
            .recycle_timeout(Some(PATIENCE_FOR_CONNECTION))
            .post_create(prepare)
            .build();
        let pool = pool.map_err(|error| StoreError::Failed(format!("no pool of connections: {error}")))?;
        let searches = Semaphore::new(SEARCHES);
        Ok(ClientPool { target, outage: Outage::default(), pool, searches })
    }

    pub(super) async fn connection(&self) -> Result<Object, Fault> {
        self.answer(PATIENCE_FOR_CONNECTION, async { Ok(self.pool.get().await?) }).await
    }

    /// The outcome of work on a connection, unless it takes longer than `limit`.
    pub(super) async fn answer<T>(
        &self,
        limit: Duration,
        work: impl Future<Output = Result<T, Fault>>,
    ) -> Result<T, Fault> {
        let begin = Instant::now();
        timeout(limit, work).await.unwrap_or_else(|_| {
            self.outage.begin(begin);
            Err(Fault::no_answer())
        })
    }

    /// The rows of a statement that only reads, or that may be repeated.
    pub(super) async fn rows(&self, statement: &str, parameters: &[Parameter<'_>]) -> Result<Vec<Row>> {
        with_retries!(self, ANSWER, connection => rows(connection, statement, parameters))
    }

    /// The same for a statement that may read much: few run at a time, and the database ends one whose client has
    /// left.
    pub(super) async fn search(&self, statement: &str, parameters: &[Parameter<'_>]) -> Result<Vec<Row>> {
        retried!(self, {
            let _permit = self.searches.acquire().await;
            self.search_once(statement, parameters).await
        })
    }

    async fn search_once(&self, statement: &str, parameters: &[Parameter<'_>]) -> Result<Vec<Row>, Fault> {
        let mut search = Search { connection: Some(self.connection().await?), tls: self.target.tls.clone() };
        let Some(connection) = &search.connection else { return Ok(Vec::new()) };
        let found = self.answer(ANSWER, rows(connection, statement, parameters)).await;
        if !matches!(found, Err(Fault::Lost(_))) {
            // It goes back to the others.
            search.connection = None;
        }
        found
    }

    /// The first of these rows.
    pub(super) async fn row(&self, statement: &str, parameters: &[Parameter<'_>]) -> Result<Option<Row>> {
        Ok(self.rows(statement, parameters).await?.into_iter().next())
    }
}

/// How often work has been tried.
#[derive(Default)]
pub(super) struct Tries {
    backoff: Backoff,
    lock: Option<(Instant, Backoff)>,
    collisions: usize,
    count: usize,
}

impl Tries {
    /// Waits before another attempt, or returns the error if there is none.
    pub(super) async fn retry_or_fail(&mut self, outage: &Outage, fault: Fault) -> Result<()> {
        self.count += 1;
        match &fault {
            Fault::Lost(text) if outage.worth_waiting(text) && self.count < TRIES => {}
            Fault::Conflict(_) if self.collisions < COLLISIONS => self.collisions += 1,
            Fault::Locked(_) => {
                let (begin, backoff) = self.lock.get_or_insert_with(|| (Instant::now(), Backoff::for_lock()));
                if begin.elapsed() >= LOCK_WAIT {
                    return Err(fault.into_store_error());
                }
                backoff.pause().await;
                return Ok(());
            }
            _ => return Err(fault.into_store_error()),
        }
        self.backoff.pause().await;
        Ok(())
    }
}

/// The rows of a statement, on a connection or in a transaction; it is prepared once on each connection.
pub(super) async fn rows(
    client: &impl GenericClient,
    statement: &str,
    parameters: &[Parameter<'_>],
) -> Result<Vec<Row>, Fault> {
    let statement = client.prepare_cached(statement).await?;
    Ok(client.query(&statement, parameters).await?)
}

/// The same for a statement that may take long. It is sent at once with the settings around it, so that no transaction
/// waits for this process.
pub(super) async fn long_rows(
    client: &Object,
    statement: &str,
    parameters: &[Parameter<'_>],
) -> Result<Vec<Row>, Fault> {
    let statement = client.prepare_cached(statement).await?;
    // Polled in this order, and sent as they are polled.
    let (begun, rows, ended) = futures::join!(
        client.batch_execute(sql::ALLOW_LONG),
        client.query(&statement, parameters),
        client.batch_execute(sql::ALLOW_SHORT),
    );
    begun?;
    let rows = rows?;
    ended?;
    Ok(rows)
}

/// Whether the row of a statement exists. The first returned column says whether no other transaction held it.
pub(super) fn existed(rows: &[Row]) -> Result<bool, Fault> {
    match rows.first().map(|row| row.get(0)) {
        Some(false) => Err(Fault::locked()),
        found => Ok(found.is_some()),
    }
}

/// The number of rows that a statement has changed.
pub(super) async fn execute(
    client: &impl GenericClient,
    statement: &str,
    parameters: &[Parameter<'_>],
) -> Result<u64, Fault> {
    let statement = client.prepare_cached(statement).await?;
    Ok(client.execute(&statement, parameters).await?)
}
