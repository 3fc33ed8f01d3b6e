//! The one thread that writes. Requests that wait share a transaction, and so the wait for the disk; no request is
//! answered before it is durable.
//!
//! Each request is checked before it writes, so that a refusal does not affect the other requests. When SQLite itself
//! fails, the transaction is rolled back and its requests are tried one by one.

use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Instant;

use rusqlite::Connection;
use rusqlite::config::DbConfig;
use tokio::sync::mpsc;
use tokio::sync::mpsc::error::TryRecvError;

use crate::store::{Changes, Clock, Commits, Result, StoreError, batch};

use super::change::{Change, Done, Reply, SequenceCache, Transaction};
use super::fault::{Fault, Stage, is_locked, store_error, worth_splitting};
use super::fork::{self, Copying, Fork};
use super::open_files::OpenFiles;
use super::schema::{self, APPLICATION};
use super::statements::{check_key, insert_receipt};
use super::{BUSY, STILL_BUSY};

/// Contacts in the cache of sequences, of some 64 bytes each.
const CACHED: usize = 131_072;
/// Moves that share a transaction in memory.
const GATHERED: usize = 64;

const BEGIN: &str = "BEGIN IMMEDIATE";
const COMMIT: &str = "COMMIT";

pub(super) struct Writer {
    pub(super) database: Connection,
    /// The files that it writes to.
    files: Arc<OpenFiles>,
    changes: Arc<Changes>,
    cache: SequenceCache,
    /// How many moves share the transaction that is open between changes; none does in a file.
    gathered: Option<usize>,
    commits: Arc<Commits>,
    clock: Clock,
    /// A number that no session has had.
    next_number: i64,
    /// Forks under way; the first of them is being copied.
    forks: VecDeque<(Arc<Fork>, Copying, Change)>,
    /// Whether there may be moves without a contact.
    unowned: bool,
    /// Whether the last transaction succeeded: if not, background work rests.
    healthy: bool,
    /// Whether another program had locked the file then.
    locked: bool,
}

/// A transaction that failed and was rolled back.
struct Failure {
    error: rusqlite::Error,
    stage: Stage,
}

impl Writer {
    pub(super) fn new(
        database: Connection,
        files: Arc<OpenFiles>,
        changes: Arc<Changes>,
        commits: Arc<Commits>,
        clock: Clock,
    ) -> rusqlite::Result<Writer> {
        // Forks that a crash has left incomplete are abandoned.
        database.execute("UPDATE unowned SET forming = 0 WHERE forming = 1", [])?;
        let sql = "SELECT max(coalesce((SELECT max(number) FROM contacts), 0),
                              coalesce((SELECT max(contact) FROM moves), 0),
                              coalesce((SELECT max(contact) FROM unowned), 0))";
        let highest: i64 = database.query_row(sql, [], |row| row.get(0))?;
        Ok(Writer {
            database,
            files,
            changes,
            cache: SequenceCache::new(CACHED),
            gathered: None,
            commits,
            clock,
            next_number: highest + 1,
            forks: VecDeque::new(),
            unowned: true,
            healthy: true,
            locked: false,
        })
    }

    /// Serves until the store is dropped, then merges the log into the file.
    pub(super) fn run(mut self, mut requests: mpsc::Receiver<Change>) {
        loop {
            let first = if self.has_background() {
                match requests.try_recv() {
                    Ok(request) => Some(request),
                    Err(TryRecvError::Empty) => None,
                    Err(TryRecvError::Disconnected) => break,
                }
            } else {
                match requests.blocking_recv() {
                    Some(request) => Some(request),
                    None => break,
                }
            };
            if let Some(first) = first {
                self.commit(batch::collect(first, &mut requests, |request| request.weight));
            }
            self.background_step();
        }
        for (_, _, request) in self.forks.drain(..) {
            answer(request.reply, Err(StoreError::Unavailable("the store is closing".to_owned())));
        }
        if let Err(error) = self.close() {
            tracing::warn!(%error, "the write-ahead log could not be merged; the next start does it");
        }
    }

    /// Whether there is work besides the changes.
    pub(super) fn has_background(&self) -> bool {
        !self.forks.is_empty() || (self.healthy && self.unowned)
    }

    /// Marks the file as closed, and merges the log into it: with the log, the mark reaches the file. Where the mark
    /// cannot be written, as on a full disk, the log stays: without it, a file that is marked as in use is refused. It
    /// stays too beside a file that another has taken the place of, whose log it may be.
    fn close(&self) -> rusqlite::Result<()> {
        let marked = self.files.check().and_then(|()| schema::mark(&self.database, APPLICATION));
        if marked.is_err() {
            self.database.set_db_config(DbConfig::SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, true)?;
            return marked;
        }
        self.database.query_row("PRAGMA wal_checkpoint(TRUNCATE)", [], |_| Ok(()))
    }

    /// Makes changes durable together, then answers; or, where that fails, each alone.
    pub(super) fn commit(&mut self, batch: Vec<Change>) {
        match self.attempt(&batch) {
            Ok(outcomes) => {
                for (request, outcome) in batch.into_iter().zip(outcomes) {
                    self.finish(request, outcome);
                }
            }
            Err(failure) if batch.len() > 1 && worth_splitting(&failure.error) => {
                for request in batch {
                    self.commit(vec![request]);
                }
            }
            Err(Failure { error, stage }) => {
                for request in batch {
                    answer(request.reply, Err(store_error(&error, stage)));
                }
            }
        }
    }

    fn attempt(&mut self, batch: &[Change]) -> Result<Vec<Result<Done>>, Failure> {
        let (mut number, begin, clock) = (self.next_number, Instant::now(), self.clock);
        let changes = Arc::clone(&self.changes);
        let touched = || batch.iter().flat_map(|request| &request.touched);
        touched().for_each(|id| changes.begin(*id));
        let is_one_statement = matches!(batch, [only] if only.is_one_statement());
        let outcomes = self.transaction(is_one_statement, |database, cache| {
            let mut outcomes = Vec::with_capacity(batch.len());
            for request in batch {
                outcomes.push(match request.make(&mut Transaction { database, cache, number, clock }) {
                    Ok(done) => Ok(done),
                    Err(Fault::Refused(error)) => Err(error),
                    Err(Fault::Sqlite(error)) => return Err(error),
                });
                number += 1;
            }
            Ok(outcomes)
        });
        touched().for_each(|id| changes.end(*id));
        let outcomes = outcomes?;
        self.next_number = number;
        self.commits.committed(batch.len(), begin.elapsed());
        Ok(outcomes)
    }

    fn finish(&mut self, request: Change, outcome: Result<Done>) {
        let count = match outcome {
            Err(error) => return answer(request.reply, Err(error)),
            Ok(Done::Made(count)) => count,
            Ok(Done::Removed(count)) => {
                self.unowned = true;
                count
            }
            Ok(Done::Copying(fork, copying)) => return self.forks.push_back((fork, copying, request)),
        };
        answer(request.reply, Ok(count));
    }

    /// Does a part of that work, if there is any; returns whether there is more.
    pub(super) fn background_step(&mut self) -> bool {
        if let Some((fork, copying, request)) = self.forks.pop_front() {
            let (mut proceeded, receipt, clock) = (copying, request.receipt.as_ref(), self.clock);
            let proceed = |database: &Connection, proceeded: &mut Copying| {
                check_key(database, receipt, clock)?;
                let complete = fork.proceed(database, proceeded)?;
                if complete {
                    insert_receipt(database, receipt, clock)?;
                }
                Ok(complete)
            };
            // A refusal has written a part of the copy and nothing else, and that part is removed later.
            let step = self.transaction(false, |database, _| match proceed(database, &mut proceeded) {
                Ok(complete) => Ok(Ok(complete)),
                Err(Fault::Refused(error)) => copying.abandon(database).map(|()| Err(error)),
                Err(Fault::Sqlite(error)) => Err(error),
            });
            match step {
                Ok(Ok(false)) => self.forks.push_front((fork, proceeded, request)),
                Ok(Ok(true)) => answer(request.reply, Ok(0)),
                Ok(Err(error)) => {
                    self.unowned = true;
                    answer(request.reply, Err(error));
                }
                Err(Failure { error, stage }) => {
                    self.unowned |= self.transaction(false, |database, _| copying.abandon(database)).is_ok();
                    answer(request.reply, Err(store_error(&error, stage)));
                }
            }
        } else if self.unowned && self.healthy {
            match self.transaction(false, |database, _| fork::remove_unowned(database)) {
                Ok(more) => self.unowned = more,
                Err(Failure { error, .. }) => tracing::warn!(%error, "deleted moves could not be removed for now"),
            }
        }
        self.has_background()
    }

    /// Has moves share transactions: where nothing waits for a disk, what a rollback needs of a page is kept once for
    /// many of them.
    pub(super) fn gathering(self) -> Writer {
        Writer { gathered: Some(0), ..self }
    }

    /// Begins a transaction, or joins that of the moves before.
    fn begin(&mut self, is_one_statement: bool) -> rusqlite::Result<()> {
        self.files.check()?;
        let Some(gathered) = &mut self.gathered else {
            // One statement that writes is a transaction of its own.
            return if is_one_statement { Ok(()) } else { run_statement(&self.database, BEGIN) };
        };
        *gathered = if is_one_statement { (*gathered + 1) % GATHERED } else { 0 };
        if *gathered == 0 && !self.database.is_autocommit() {
            run_statement(&self.database, COMMIT)?;
        }
        if self.database.is_autocommit() { run_statement(&self.database, BEGIN) } else { Ok(()) }
    }

    /// Runs a transaction to its durable commit, or rolls it back.
    fn transaction<T>(
        &mut self,
        is_one_statement: bool,
        work: impl FnOnce(&Connection, &mut SequenceCache) -> rusqlite::Result<T>,
    ) -> Result<T, Failure> {
        let done = self.begin(is_one_statement).and_then(|()| work(&self.database, &mut self.cache));
        let commit = || if is_one_statement { Ok(()) } else { run_statement(&self.database, COMMIT) };
        let outcome = match done {
            // Before it is acknowledged: a file that has been overwritten since is read by the next start.
            Ok(value) => commit()
                .and_then(|()| self.files.check_content())
                .map(|()| value)
                .map_err(|error| Failure { error, stage: Stage::Commit }),
            // Its commit is a part of the statement.
            Err(error) => Err(Failure { error, stage: if is_one_statement { Stage::Commit } else { Stage::Before } }),
        };
        self.record_health(outcome.as_ref().err().map(|failure| &failure.error));
        outcome.inspect_err(|_| {
            self.cache.clear();
            // Some failures end the transaction by themselves; a statement that fails has changed nothing.
            let is_ended = self.database.is_autocommit();
            if is_one_statement && is_ended && self.gathered.is_some_and(|gathered| gathered > 0) {
                // Only for want of memory, which ends the process everywhere else too: acknowledged moves are gone.
                tracing::error!("the store in memory has lost moves");
                std::process::abort();
            }
            if !is_one_statement
                && !is_ended
                && let Err(error) = run_statement(&self.database, "ROLLBACK")
            {
                tracing::error!(%error, "a transaction could not be rolled back");
            }
        })
    }

    /// Notes how a transaction ended, and logs it where the one before ended otherwise.
    fn record_health(&mut self, failure: Option<&rusqlite::Error>) {
        match failure {
            Some(error) => {
                self.commits.failed.inc();
                if self.healthy {
                    tracing::error!(%error, "the database accepts no changes; requests fail until it does");
                }
            }
            None if !self.healthy => tracing::info!("the database accepts changes again"),
            None => {}
        }
        self.healthy = failure.is_none();
        let locked = failure.is_some_and(is_locked);
        if locked != self.locked {
            self.locked = locked;
            if let Err(error) = self.database.busy_timeout(if locked { STILL_BUSY } else { BUSY }) {
                tracing::warn!(%error, "the time to wait for locks could not be set");
            }
        }
    }
}

fn run_statement(database: &Connection, sql: &str) -> rusqlite::Result<()> {
    database.prepare_cached(sql)?.execute([]).map(drop)
}

fn answer(reply: Reply, outcome: Result<u64>) {
    // The client may have hung up.
    let _ = reply.send(outcome);
}
