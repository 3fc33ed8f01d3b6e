//! Jobs in the file. Which chunks are worked on is known to the process alone: its end is the end of all claims.

use std::collections::BTreeSet;
use std::time::Duration;

use futures::FutureExt as _;
use jiff::{SignedDuration, Timestamp};
use rusqlite::{Connection, OptionalExtension as _, Row, params};
use uuid::Uuid;

use crate::store::jobs::{Board, ChunkResult, Claim, JOB_LIFETIME, JOB_PATIENCE, Job, JobLimits, JobStore};
use crate::store::{Answer, Receipt, StoreError};

use super::SqliteStore;
use super::change::{Change, ChangeError, Done, free, keep};
use super::readers::ReadError;
use super::rows::{bound, identifier, integer, nanoseconds, natural, tenant, timestamp};

/// A change to the jobs.
pub(super) enum JobChange {
    Create(Box<NewJob>),
    Keep { claim: Claim, result: ChunkResult },
    Fail { id: Uuid, error: String },
    Delete { id: Uuid },
    Sweep,
}

/// A job to be stored.
pub(super) struct NewJob {
    job: Job,
    request: String,
    limits: JobLimits,
    receipt: Option<Receipt>,
}

impl JobChange {
    /// The job whose watchers are to be woken when the change is made.
    pub(super) fn touched(&self) -> &[Uuid] {
        match self {
            JobChange::Keep { claim, .. } => std::slice::from_ref(&claim.job),
            JobChange::Fail { id, .. } | JobChange::Delete { id } => std::slice::from_ref(id),
            JobChange::Create(_) | JobChange::Sweep => &[],
        }
    }

    /// Makes the change within the transaction under way.
    pub(super) fn make(&self, database: &Connection) -> Result<Done, ChangeError> {
        match self {
            JobChange::Create(new) => new.make(database)?,
            JobChange::Keep { claim, result } => keep_chunk(database, *claim, result)?,
            JobChange::Fail { id, error } => {
                let sql = "UPDATE jobs SET finished_at = ?2, error = ?3 WHERE id = ?1 AND finished_at IS NULL";
                let now = nanoseconds(Timestamp::now())?;
                database.prepare_cached(sql)?.execute(params![id.to_string(), now, error])?;
            }
            JobChange::Delete { id } => {
                if database.prepare_cached("DELETE FROM jobs WHERE id = ?1")?.execute([id.to_string()])? == 0 {
                    return Err(ChangeError::Refused(StoreError::NotFound));
                }
            }
            JobChange::Sweep => {
                let sql = "DELETE FROM jobs WHERE number =
                               (SELECT number FROM jobs WHERE finished_at < ?1 OR created_at < ?2 LIMIT 1)";
                let gone = database.prepare_cached(sql)?.execute([since(JOB_LIFETIME), since(JOB_PATIENCE)])?;
                return Ok(Done::Made(gone as u64));
            }
        }
        Ok(Done::Made(0))
    }
}

fn since(time: Duration) -> i64 {
    let time = SignedDuration::try_from(time).unwrap_or(SignedDuration::MAX);
    bound(Timestamp::now().checked_sub(time).unwrap_or(Timestamp::MIN))
}

impl NewJob {
    fn make(&self, database: &Connection) -> Result<(), ChangeError> {
        let NewJob { job, request, limits, receipt } = self;
        free(database, receipt.as_ref())?;
        let sql = "SELECT count(*), coalesce(sum(bytes), 0), coalesce(sum(iif(finished_at IS NULL, cost, 0)), 0)
                   FROM jobs WHERE tenant = ?1";
        let (jobs, bytes, cost) = database
            .prepare_cached(sql)?
            .query_row([job.tenant.name()], |row| Ok((natural(row, 0)?, natural(row, 1)?, natural(row, 2)?)))?;
        limits.admit(jobs, bytes, cost, job).map_err(ChangeError::Refused)?;
        let sql = "INSERT INTO jobs (id, tenant, created_at, points, chunk, done, failed, bytes, cost, request)
                   VALUES (?1, ?2, ?3, ?4, ?5, 0, 0, ?6, ?7, ?8)";
        database.prepare_cached(sql)?.execute(params![
            job.id.to_string(),
            job.tenant.name(),
            nanoseconds(job.created_at)?,
            integer(job.points)?,
            integer(job.chunk)?,
            integer(job.bytes)?,
            integer(job.cost)?,
            request,
        ])?;
        keep(database, receipt.as_ref())?;
        Ok(())
    }
}

fn keep_chunk(database: &Connection, claim: Claim, result: &ChunkResult) -> Result<(), ChangeError> {
    let sql = "SELECT number FROM jobs WHERE id = ?1 AND finished_at IS NULL";
    let number: Option<i64> =
        database.prepare_cached(sql)?.query_row([claim.job.to_string()], |row| row.get(0)).optional()?;
    let number = number.ok_or(ChangeError::Refused(StoreError::NotFound))?;
    let sql = "INSERT OR IGNORE INTO job_chunks (job, chunk, content) VALUES (?1, ?2, ?3)";
    let new = database.prepare_cached(sql)?.execute(params![number, integer(claim.chunk)?, result.content])?;
    if new > 0 {
        let sql =
            "UPDATE jobs SET done = done + ?2, failed = failed + ?3, finished_at = iif(done + ?2 = points, ?4, NULL)
                   WHERE number = ?1";
        let now = nanoseconds(Timestamp::now())?;
        database.prepare_cached(sql)?.execute(params![
            number,
            integer(result.points)?,
            integer(result.failed)?,
            now
        ])?;
    }
    Ok(())
}

/// Puts up the jobs that have not ended.
pub(super) fn unfinished(database: &Connection, board: &Board) -> rusqlite::Result<()> {
    let mut statement = database
        .prepare("SELECT id, (points + chunk - 1) / chunk, number FROM jobs WHERE finished_at IS NULL ORDER BY id")?;
    let mut chunks = database.prepare("SELECT chunk FROM job_chunks WHERE job = ?1")?;
    let mut rows = statement.query([])?;
    while let Some(row) = rows.next()? {
        let number: i64 = row.get(2)?;
        let done: BTreeSet<u64> = chunks.query_map([number], |row| natural(row, 0))?.collect::<Result<_, _>>()?;
        board.open(identifier(row, 0)?, (0..natural(row, 1)?).filter(|chunk| !done.contains(chunk)));
    }
    Ok(())
}

fn job(row: &Row<'_>) -> rusqlite::Result<Job> {
    let finished: Option<i64> = row.get(3)?;
    Ok(Job {
        id: identifier(row, 0)?,
        tenant: tenant(row, 1)?,
        created_at: timestamp(row, 2)?,
        finished_at: finished.map(|_| timestamp(row, 3)).transpose()?,
        error: row.get(4)?,
        points: natural(row, 5)?,
        chunk: natural(row, 6)?,
        done: natural(row, 7)?,
        failed: natural(row, 8)?,
        bytes: natural(row, 9)?,
        cost: natural(row, 10)?,
    })
}

fn find(database: &Connection, id: Uuid) -> Result<Job, ReadError> {
    let sql = "SELECT id, tenant, created_at, finished_at, error, points, chunk, done, failed, bytes, cost FROM jobs
               WHERE id = ?1";
    let found = database.prepare_cached(sql)?.query_row([id.to_string()], job).optional()?;
    found.ok_or(ReadError::Store(StoreError::NotFound))
}

fn request(database: &Connection, id: Uuid) -> Result<String, ReadError> {
    let mut statement = database.prepare_cached("SELECT request FROM jobs WHERE id = ?1")?;
    let found = statement.query_row([id.to_string()], |row| row.get(0)).optional()?;
    found.ok_or(ReadError::Store(StoreError::NotFound))
}

fn chunks(database: &Connection, id: Uuid, first: u64, limit: usize) -> Result<Vec<Vec<u8>>, ReadError> {
    let sql = "SELECT c.content FROM job_chunks AS c INNER JOIN jobs AS j ON j.number = c.job
               WHERE j.id = ?1 AND c.chunk >= ?2 ORDER BY c.chunk LIMIT ?3";
    let mut statement = database.prepare_cached(sql)?;
    let found =
        statement.query_map(params![id.to_string(), integer(first)?, integer(limit as u64)?], |row| row.get(0))?;
    Ok(found.collect::<Result<_, _>>()?)
}

impl SqliteStore {
    async fn change_jobs(&self, change: JobChange) -> Result<(), StoreError> {
        self.change(Change::Job(change)).await.map(drop)
    }

    /// Deletes the jobs whose time is over, one at a time: their results are large.
    pub(super) async fn sweep_jobs(&self) -> Result<(), StoreError> {
        while self.change(Change::Job(JobChange::Sweep)).await? > 0 {}
        Ok(())
    }
}

impl JobStore for SqliteStore {
    fn create_job(&self, job: Job, request: String, limits: JobLimits, receipt: Option<Receipt>) -> Answer<'_, ()> {
        async move {
            let (id, chunks) = (job.id, job.chunks());
            self.change_jobs(JobChange::Create(Box::new(NewJob { job, request, limits, receipt }))).await?;
            self.board.open(id, 0..chunks);
            Ok(())
        }
        .boxed()
    }

    fn job(&self, id: Uuid) -> Answer<'_, Job> {
        self.look(move |database| find(database, id))
    }

    fn job_request(&self, id: Uuid) -> Answer<'_, String> {
        self.look(move |database| request(database, id))
    }

    fn claim(&self, owner: Uuid, after: Option<Uuid>, _: Duration) -> Answer<'_, Option<Claim>> {
        std::future::ready(Ok(self.board.claim(owner, after))).boxed()
    }

    fn renew(&self, claim: Claim, _: Duration) -> Answer<'_, bool> {
        std::future::ready(Ok(self.board.holds(claim))).boxed()
    }

    fn release(&self, claim: Claim) -> Answer<'_, ()> {
        self.board.release(claim);
        std::future::ready(Ok(())).boxed()
    }

    fn keep_chunk(&self, claim: Claim, result: ChunkResult) -> Answer<'_, ()> {
        async move {
            let kept = self.change_jobs(JobChange::Keep { claim, result }).await;
            if matches!(kept, Ok(()) | Err(StoreError::NotFound)) {
                self.board.done(claim);
            }
            kept
        }
        .boxed()
    }

    fn fail_job(&self, id: Uuid, error: String) -> Answer<'_, ()> {
        async move {
            self.change_jobs(JobChange::Fail { id, error }).await?;
            self.board.close(id);
            Ok(())
        }
        .boxed()
    }

    fn chunks(&self, id: Uuid, first: u64, limit: usize) -> Answer<'_, Vec<Vec<u8>>> {
        self.look(move |database| chunks(database, id, first, limit))
    }

    fn delete_job(&self, id: Uuid) -> Answer<'_, ()> {
        async move {
            self.change_jobs(JobChange::Delete { id }).await?;
            self.board.close(id);
            // The writer has woken those who watch before the claims were gone.
            self.changes.wake(id);
            Ok(())
        }
        .boxed()
    }
}
