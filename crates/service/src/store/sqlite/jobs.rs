//! Jobs in the file. Claims are kept in the process alone, and end with it.

use std::collections::HashSet;
use std::time::Duration;

use async_trait::async_trait;
use jiff::Timestamp;
use rusqlite::{Connection, params};
use uuid::Uuid;

use crate::store::job_store::{ChunkResult, Claim, JOB_LIFETIME, JOB_TIME_LIMIT, Job, JobLimits, JobStore};
use crate::store::rows::{self, RowReader as _};
use crate::store::{Receipt, Result, StoreError, Tenant};

use super::SqliteStore;
use super::change::{Done, Transaction};
use super::columns::{all, clamped_nanoseconds, execute, first, to_integer, to_nanoseconds};
use super::fault::Fault;

impl Transaction<'_> {
    fn create_job(&self, job: &Job, request: &str, limits: JobLimits) -> Result<Done, Fault> {
        let database = self.database;
        let sql = "SELECT count(*), coalesce(sum(bytes), 0), coalesce(sum(iif(finished_at IS NULL, cost, 0)), 0)
                   FROM jobs WHERE tenant = ?1";
        let found = first(database, sql, [job.tenant.name()], |row| Ok((row.count()?, row.count()?, row.count()?)))?;
        let (jobs, bytes, cost) = found.unwrap_or_default();
        limits.check(jobs, bytes, cost, job)?;
        let sql = "INSERT INTO jobs (id, tenant, created_at, points, chunk, done, failed, bytes, cost, request)
                   VALUES (?1, ?2, ?3, ?4, ?5, 0, 0, ?6, ?7, ?8)";
        let (id, tenant, created_at) = (job.id.to_string(), job.tenant.name(), to_nanoseconds(job.created_at)?);
        let (points, chunk) = (to_integer(job.points)?, to_integer(job.chunk)?);
        let (bytes, cost) = (to_integer(job.bytes)?, to_integer(job.cost)?);
        execute(database, sql, params![id, tenant, created_at, points, chunk, bytes, cost, request])?;
        Ok(Done::Made(1))
    }

    fn save_chunk(&self, claim: Claim, result: &ChunkResult) -> Result<Done, Fault> {
        let sql = "SELECT number FROM jobs WHERE id = ?1 AND finished_at IS NULL";
        let number = first(self.database, sql, [claim.job.to_string()], |row| row.next::<i64>())?;
        let number = number.ok_or(StoreError::NotFound)?;
        let sql = "INSERT OR IGNORE INTO job_chunks (job, chunk, content) VALUES (?1, ?2, ?3)";
        let chunk = params![number, to_integer(claim.chunk)?, result.content];
        if execute(self.database, sql, chunk)? > 0 {
            let sql = "UPDATE jobs SET done = done + ?2, failed = failed + ?3,
                           finished_at = iif(done + ?2 = points, ?4, NULL)
                       WHERE number = ?1";
            let (points, failed) = (to_integer(result.points)?, to_integer(result.failed)?);
            let now = to_nanoseconds(Timestamp::now())?;
            execute(self.database, sql, [number, points, failed, now])?;
        }
        Ok(Done::Made(1))
    }

    fn fail_job(&self, id: Uuid, error: &str) -> Result<Done, Fault> {
        let sql = "UPDATE jobs SET finished_at = ?2, error = ?3 WHERE id = ?1 AND finished_at IS NULL";
        let now = to_nanoseconds(Timestamp::now())?;
        execute(self.database, sql, params![id.to_string(), now, error])?;
        Ok(Done::Made(1))
    }

    fn delete_job(&self, id: Uuid) -> Result<Done, Fault> {
        match execute(self.database, "DELETE FROM jobs WHERE id = ?1", [id.to_string()])? {
            0 => Err(StoreError::NotFound.into()),
            _ => Ok(Done::Made(1)),
        }
    }

    /// Deletes an expired job, if there is one; returns their number. One at a time: their results are large.
    fn purge_job(&self) -> Result<Done, Fault> {
        let sql = "DELETE FROM jobs WHERE number =
                       (SELECT number FROM jobs WHERE finished_at < ?1 OR created_at < ?2 LIMIT 1)";
        let before = [JOB_LIFETIME, JOB_TIME_LIMIT].map(|time| clamped_nanoseconds(self.clock.ago(time)));
        let deleted = execute(self.database, sql, before)?;
        Ok(Done::Made(deleted as u64))
    }
}

/// The first chunk without a result that is not taken, of the jobs after one, and then of the others.
fn next_chunk(
    database: &Connection,
    after: Option<Uuid>,
    taken: &HashSet<(Uuid, u64)>,
) -> Result<Option<(Uuid, u64)>, Fault> {
    let sql = "SELECT id, (points + chunk - 1) / chunk, number FROM jobs WHERE finished_at IS NULL
               ORDER BY id <= ?1, id";
    let after = after.map(|id| id.to_string()).unwrap_or_default();
    for (id, count, number) in all(database, sql, [after], |row| Ok((row.uuid()?, row.count()?, row.next::<i64>()?)))? {
        let done = all(database, "SELECT chunk FROM job_chunks WHERE job = ?1", [number], |row| row.count())?;
        let done: HashSet<u64> = done.into_iter().collect();
        let free = (0..count).find(|chunk| !done.contains(chunk) && !taken.contains(&(id, *chunk)));
        if let Some(chunk) = free {
            return Ok(Some((id, chunk)));
        }
    }
    Ok(None)
}

/// The columns of a job, in the order in which it is read.
const COLUMNS: &str = "id, tenant, created_at, finished_at, error, points, chunk, done, failed, bytes, cost";

impl SqliteStore {
    pub(super) async fn purge_jobs(&self) -> Result<()> {
        while self.change(1, [], None, |transaction| transaction.purge_job()).await? > 0 {}
        Ok(())
    }
}

#[async_trait]
impl JobStore for SqliteStore {
    async fn create_job(&self, job: Job, request: String, limits: JobLimits, receipt: Option<Receipt>) -> Result<()> {
        self.change(1, [], receipt, move |transaction| transaction.create_job(&job, &request, limits)).await.map(drop)
    }

    async fn job(&self, id: Uuid) -> Result<Job> {
        let sql = format!("SELECT {COLUMNS} FROM jobs WHERE id = ?1");
        let read = move |database: &Connection| {
            Ok(first(database, &sql, [id.to_string()], |row| rows::job(row))?.ok_or(StoreError::NotFound)?)
        };
        self.read(read).await
    }

    async fn jobs(&self, tenant: Tenant) -> Result<Vec<Job>> {
        let sql = format!("SELECT {COLUMNS} FROM jobs WHERE tenant = ?1 ORDER BY id");
        let read = move |database: &Connection| Ok(all(database, &sql, [tenant.name()], |row| rows::job(row))?);
        self.read(read).await
    }

    async fn job_request(&self, id: Uuid) -> Result<String> {
        let sql = "SELECT request FROM jobs WHERE id = ?1";
        let read = move |database: &Connection| {
            Ok(first(database, sql, [id.to_string()], |row| row.next())?.ok_or(StoreError::NotFound)?)
        };
        self.read(read).await
    }

    async fn claim(&self, owner: Uuid, after: Option<Uuid>, _: Duration) -> Result<Option<Claim>> {
        loop {
            let taken = self.claims.lock().clone();
            let Some(next) = self.read(move |database| next_chunk(database, after, &taken)).await? else {
                return Ok(None);
            };
            if self.claims.lock().insert(next) {
                return Ok(Some(Claim { job: next.0, chunk: next.1, owner }));
            }
        }
    }

    async fn renew(&self, claim: Claim, _: Duration) -> Result<bool> {
        if !self.claims.lock().contains(&(claim.job, claim.chunk)) {
            return Ok(false);
        }
        let sql = "SELECT NOT EXISTS (SELECT 1 FROM job_chunks WHERE job = jobs.number AND chunk = ?2) FROM jobs
                   WHERE id = ?1 AND finished_at IS NULL";
        let read = move |database: &Connection| {
            let which = params![claim.job.to_string(), to_integer(claim.chunk)?];
            Ok(first(database, sql, which, |row| row.next())?.unwrap_or(false))
        };
        let holds = self.read(read).await?;
        if !holds {
            self.release(claim).await?;
        }
        Ok(holds)
    }

    async fn release(&self, claim: Claim) -> Result<()> {
        self.claims.lock().remove(&(claim.job, claim.chunk));
        Ok(())
    }

    async fn save_chunk(&self, claim: Claim, result: ChunkResult) -> Result<()> {
        let saved = self.change(1, [claim.job], None, move |transaction| transaction.save_chunk(claim, &result)).await;
        if matches!(saved, Ok(_) | Err(StoreError::NotFound)) {
            self.release(claim).await?;
        }
        saved.map(drop)
    }

    async fn fail_job(&self, id: Uuid, error: String) -> Result<()> {
        self.change(1, [id], None, move |transaction| transaction.fail_job(id, &error)).await.map(drop)
    }

    async fn chunks(&self, id: Uuid, first: u64, limit: usize) -> Result<Vec<Vec<u8>>> {
        let sql = "SELECT c.content FROM job_chunks AS c INNER JOIN jobs AS j ON j.number = c.job
                   WHERE j.id = ?1 AND c.chunk >= ?2 ORDER BY c.chunk LIMIT ?3";
        let read = move |database: &Connection| {
            let which = params![id.to_string(), to_integer(first)?, to_integer(limit as u64)?];
            Ok(all(database, sql, which, |row| row.next())?)
        };
        self.read(read).await
    }

    async fn delete_job(&self, id: Uuid) -> Result<()> {
        self.change(1, [id], None, move |transaction| transaction.delete_job(id)).await.map(drop)
    }
}
