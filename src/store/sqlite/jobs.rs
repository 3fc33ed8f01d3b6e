//! Jobs in the file. Claims are kept in the process alone, and end with it.

use std::collections::BTreeSet;
use std::time::Duration;

use async_trait::async_trait;
use jiff::{SignedDuration, Timestamp};
use rusqlite::{Connection, OptionalExtension as _, params};
use uuid::Uuid;

use crate::store::jobs::{ChunkQueue, ChunkResult, Claim, JOB_LIFETIME, JOB_TIME_LIMIT, Job, JobLimits, JobStore};
use crate::store::rows::{self, RowReader as _};
use crate::store::{Receipt, Result, StoreError, Tenant};

use super::SqliteStore;
use super::change::{Done, Transaction};
use super::columns::{clamped_nanoseconds, reader, to_integer, to_nanoseconds};
use super::fault::Fault;
use super::statements::{check_key, insert_receipt};

impl Transaction<'_> {
    fn create_job(
        &self,
        job: &Job,
        request: &str,
        limits: JobLimits,
        receipt: Option<&Receipt>,
    ) -> Result<Done, Fault> {
        let database = self.database;
        check_key(database, receipt)?;
        let sql = "SELECT count(*), coalesce(sum(bytes), 0), coalesce(sum(iif(finished_at IS NULL, cost, 0)), 0)
                   FROM jobs WHERE tenant = ?1";
        let (jobs, bytes, cost) = database.prepare_cached(sql)?.query_row([job.tenant.name()], |row| {
            let mut row = reader(row);
            Ok((row.count()?, row.count()?, row.count()?))
        })?;
        limits.check(jobs, bytes, cost, job)?;
        let sql = "INSERT INTO jobs (id, tenant, created_at, points, chunk, done, failed, bytes, cost, request)
                   VALUES (?1, ?2, ?3, ?4, ?5, 0, 0, ?6, ?7, ?8)";
        database.prepare_cached(sql)?.execute(params![
            job.id.to_string(),
            job.tenant.name(),
            to_nanoseconds(job.created_at)?,
            to_integer(job.points)?,
            to_integer(job.chunk)?,
            to_integer(job.bytes)?,
            to_integer(job.cost)?,
            request,
        ])?;
        insert_receipt(database, receipt)?;
        Ok(Done::Made(0))
    }

    fn save_chunk(&self, claim: Claim, result: &ChunkResult) -> Result<Done, Fault> {
        let sql = "SELECT number FROM jobs WHERE id = ?1 AND finished_at IS NULL";
        let mut statement = self.database.prepare_cached(sql)?;
        let number: Option<i64> = statement.query_row([claim.job.to_string()], |row| row.get(0)).optional()?;
        let number = number.ok_or(StoreError::NotFound)?;
        let sql = "INSERT OR IGNORE INTO job_chunks (job, chunk, content) VALUES (?1, ?2, ?3)";
        let chunk = params![number, to_integer(claim.chunk)?, result.content];
        if self.database.prepare_cached(sql)?.execute(chunk)? > 0 {
            let sql = "UPDATE jobs SET done = done + ?2, failed = failed + ?3,
                           finished_at = iif(done + ?2 = points, ?4, NULL)
                       WHERE number = ?1";
            let (points, failed) = (to_integer(result.points)?, to_integer(result.failed)?);
            let now = to_nanoseconds(Timestamp::now())?;
            self.database.prepare_cached(sql)?.execute(params![number, points, failed, now])?;
        }
        Ok(Done::Made(0))
    }

    fn fail_job(&self, id: Uuid, error: &str) -> Result<Done, Fault> {
        let sql = "UPDATE jobs SET finished_at = ?2, error = ?3 WHERE id = ?1 AND finished_at IS NULL";
        let now = to_nanoseconds(Timestamp::now())?;
        self.database.prepare_cached(sql)?.execute(params![id.to_string(), now, error])?;
        Ok(Done::Made(0))
    }

    fn delete_job(&self, id: Uuid) -> Result<Done, Fault> {
        match self.database.prepare_cached("DELETE FROM jobs WHERE id = ?1")?.execute([id.to_string()])? {
            0 => Err(StoreError::NotFound.into()),
            _ => Ok(Done::Made(0)),
        }
    }

    /// Deletes an expired job, if there is one; returns their number. One at a time: their results are large.
    fn purge_job(&self) -> Result<Done, Fault> {
        let before = |time| {
            let time = SignedDuration::try_from(time).unwrap_or(SignedDuration::MAX);
            clamped_nanoseconds(Timestamp::now().checked_sub(time).unwrap_or(Timestamp::MIN))
        };
        let sql = "DELETE FROM jobs WHERE number =
                       (SELECT number FROM jobs WHERE finished_at < ?1 OR created_at < ?2 LIMIT 1)";
        let deleted = self.database.prepare_cached(sql)?.execute([before(JOB_LIFETIME), before(JOB_TIME_LIMIT)])?;
        Ok(Done::Made(deleted as u64))
    }
}

/// Queues the chunks that are still to be done of the jobs that have not ended.
pub(super) fn restore_queue(database: &Connection, queue: &ChunkQueue) -> rusqlite::Result<()> {
    let mut statement = database
        .prepare("SELECT id, (points + chunk - 1) / chunk, number FROM jobs WHERE finished_at IS NULL ORDER BY id")?;
    let mut chunks = database.prepare("SELECT chunk FROM job_chunks WHERE job = ?1")?;
    let mut rows = statement.query([])?;
    while let Some(row) = rows.next()? {
        let mut row = reader(row);
        let (id, count, number): (_, _, i64) = (row.uuid()?, row.count()?, row.next()?);
        let done = chunks.query_map([number], |row| reader(row).count())?.collect::<Result<BTreeSet<u64>, _>>()?;
        queue.add_job(id, (0..count).filter(|chunk| !done.contains(chunk)));
    }
    Ok(())
}

/// The columns of a job, in the order in which it is read.
const COLUMNS: &str = "id, tenant, created_at, finished_at, error, points, chunk, done, failed, bytes, cost";

fn list(database: &Connection, tenant: &Tenant) -> Result<Vec<Job>, Fault> {
    let sql = format!("SELECT {COLUMNS} FROM jobs WHERE tenant = ?1 ORDER BY id");
    let mut statement = database.prepare_cached(&sql)?;
    let found = statement.query_map([tenant.name()], |row| rows::job(&mut reader(row)))?;
    Ok(found.collect::<Result<_, _>>()?)
}

fn find(database: &Connection, id: Uuid) -> Result<Job, Fault> {
    let sql = format!("SELECT {COLUMNS} FROM jobs WHERE id = ?1");
    let found =
        database.prepare_cached(&sql)?.query_row([id.to_string()], |row| rows::job(&mut reader(row))).optional()?;
    Ok(found.ok_or(StoreError::NotFound)?)
}

fn request(database: &Connection, id: Uuid) -> Result<String, Fault> {
    let mut statement = database.prepare_cached("SELECT request FROM jobs WHERE id = ?1")?;
    let found = statement.query_row([id.to_string()], |row| row.get(0)).optional()?;
    Ok(found.ok_or(StoreError::NotFound)?)
}

fn chunks(database: &Connection, id: Uuid, first: u64, limit: usize) -> Result<Vec<Vec<u8>>, Fault> {
    let sql = "SELECT c.content FROM job_chunks AS c INNER JOIN jobs AS j ON j.number = c.job
               WHERE j.id = ?1 AND c.chunk >= ?2 ORDER BY c.chunk LIMIT ?3";
    let mut statement = database.prepare_cached(sql)?;
    let found = statement
        .query_map(params![id.to_string(), to_integer(first)?, to_integer(limit as u64)?], |row| row.get(0))?;
    Ok(found.collect::<Result<_, _>>()?)
}

impl SqliteStore {
    /// Deletes the expired jobs.
    pub(super) async fn purge_jobs(&self) -> Result<()> {
        while self.change(1, [], |transaction| transaction.purge_job()).await? > 0 {}
        Ok(())
    }
}

#[async_trait]
impl JobStore for SqliteStore {
    async fn create_job(&self, job: Job, request: String, limits: JobLimits, receipt: Option<Receipt>) -> Result<()> {
        let (id, chunks) = (job.id, job.chunks());
        self.change(1, [], move |transaction| transaction.create_job(&job, &request, limits, receipt.as_ref())).await?;
        self.queue.add_job(id, 0..chunks);
        Ok(())
    }

    async fn job(&self, id: Uuid) -> Result<Job> {
        self.readers.read(move |database| find(database, id)).await
    }

    async fn jobs(&self, tenant: Tenant) -> Result<Vec<Job>> {
        self.readers.read(move |database| list(database, &tenant)).await
    }

    async fn job_request(&self, id: Uuid) -> Result<String> {
        self.readers.read(move |database| request(database, id)).await
    }

    async fn claim(&self, owner: Uuid, after: Option<Uuid>, _: Duration) -> Result<Option<Claim>> {
        Ok(self.queue.claim(owner, after))
    }

    async fn renew(&self, claim: Claim, _: Duration) -> Result<bool> {
        Ok(self.queue.is_claimed(claim))
    }

    async fn release(&self, claim: Claim) -> Result<()> {
        self.queue.release(claim);
        Ok(())
    }

    async fn save_chunk(&self, claim: Claim, result: ChunkResult) -> Result<()> {
        let saved =
            self.change(1, [claim.job], move |transaction| transaction.save_chunk(claim, &result)).await.map(drop);
        if matches!(saved, Ok(()) | Err(StoreError::NotFound)) {
            self.queue.finish(claim);
        }
        saved
    }

    async fn fail_job(&self, id: Uuid, error: String) -> Result<()> {
        self.change(1, [id], move |transaction| transaction.fail_job(id, &error)).await?;
        self.queue.remove_job(id);
        Ok(())
    }

    async fn chunks(&self, id: Uuid, first: u64, limit: usize) -> Result<Vec<Vec<u8>>> {
        self.readers.read(move |database| chunks(database, id, first, limit)).await
    }

    async fn delete_job(&self, id: Uuid) -> Result<()> {
        self.change(1, [id], move |transaction| transaction.delete_job(id)).await?;
        self.queue.remove_job(id);
        // The writer has woken the listeners before the claims were removed.
        self.changes.wake(id);
        Ok(())
    }
}
