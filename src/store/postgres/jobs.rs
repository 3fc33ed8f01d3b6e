//! Jobs in the database, whose chunks all replicas compute.
//!
//! A worker has a lease on the chunk that it computes, and renews it. The chunks of a replica that is gone are claimed
//! by others when its leases have run out.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use async_trait::async_trait;
use deadpool_postgres::Object;
use uuid::Uuid;

use crate::store::jobs::{ChunkResult, Claim, JOB_LIFETIME, JOB_TIME_LIMIT, Job, JobLimits, JobStore};
use crate::store::rows;
use crate::store::{Receipt, Result, StoreError, Tenant};

use super::PostgresStore;
use super::client_pool::{self, ANSWER, ClientPool, LONG_ANSWER, Parameter, execute, try_once, with_retries};
use super::columns::{Receipts, Sessions, from_bigint, reader, split_time, to_bigint};
use super::fault::Fault;
use super::sql;
use super::transactions::{begin, create};

/// Jobs that one statement deletes: their results are large.
const PURGED_AT_ONCE: i64 = 4;

impl ClientPool {
    async fn create_job(
        &self,
        connection: &mut Object,
        (job, request): (&Job, &str),
        limits: JobLimits,
        receipt: Option<&Receipt>,
        commit_sent: &AtomicBool,
    ) -> Result<(), Fault> {
        let transaction = begin(connection).await?;
        let tenant = job.tenant.name();
        // Tenants that share a number wait for each other, and no more.
        execute(&transaction, sql::LOCK_TENANT, &[&i64::from(crc32fast::hash(tenant.as_bytes()))]).await?;
        let statement = transaction.prepare_cached(sql::JOBS_OF_TENANT).await?;
        let found = transaction.query_one(&statement, &[&tenant]).await?;
        limits.check(from_bigint(found.get(0)), from_bigint(found.get(1)), from_bigint(found.get(2)), job)?;
        let (at, ns) = split_time(job.created_at);
        let (points, chunk) = (to_bigint(job.points), to_bigint(job.chunk));
        let (bytes, cost) = (to_bigint(job.bytes), to_bigint(job.cost));
        let row: [Parameter<'_>; 9] = [&job.id, &tenant, &at, &ns, &points, &chunk, &bytes, &cost, &request];
        execute(&transaction, sql::CREATE_JOB, &row).await?;
        execute(&transaction, sql::CREATE_CHUNKS, &[&job.id, &to_bigint(job.chunks())]).await?;
        if let Some(receipt) = receipt {
            let mut receipts = Receipts::default();
            receipts.push((job.id, receipt));
            create(&transaction, &Sessions::default(), &receipts).await?;
        }
        self.announce(&transaction, &[job.id]).await?;
        commit_sent.store(true, Ordering::Relaxed);
        transaction.commit().await?;
        Ok(())
    }
    /// Whether there was such a job.
    async fn save_chunk(&self, connection: &mut Object, claim: Claim, result: &ChunkResult) -> Result<bool, Fault> {
        let transaction = begin(connection).await?;
        let Claim { job, chunk, .. } = claim;
        if client_pool::rows(&transaction, sql::LOCK_JOB, &[&job]).await?.is_empty() {
            return Ok(false);
        }
        if execute(&transaction, sql::SAVE_CHUNK, &[&job, &to_bigint(chunk), &result.content]).await? > 0 {
            let (points, failed) = (to_bigint(result.points), to_bigint(result.failed));
            execute(&transaction, sql::COUNT_CHUNK, &[&job, &points, &failed]).await?;
            self.announce(&transaction, &[job]).await?;
        }
        transaction.commit().await?;
        Ok(true)
    }

    async fn fail_job(&self, connection: &mut Object, id: Uuid, error: &str) -> Result<(), Fault> {
        let transaction = begin(connection).await?;
        if !client_pool::rows(&transaction, sql::LOCK_JOB, &[&id]).await?.is_empty() {
            execute(&transaction, sql::FAIL_JOB, &[&id, &error]).await?;
            execute(&transaction, sql::DROP_CHUNKS, &[&id]).await?;
            self.announce(&transaction, &[id]).await?;
            transaction.commit().await?;
        }
        Ok(())
    }

    async fn delete_job(&self, connection: &mut Object, id: Uuid, commit_sent: &AtomicBool) -> Result<bool, Fault> {
        let transaction = begin(connection).await?;
        if execute(&transaction, sql::DELETE_JOB, &[&id]).await? == 0 {
            return Ok(commit_sent.load(Ordering::Relaxed));
        }
        self.announce(&transaction, &[id]).await?;
        commit_sent.store(true, Ordering::Relaxed);
        transaction.commit().await?;
        Ok(true)
    }

    /// Deletes the expired jobs.
    pub(super) async fn purge_jobs(&self) -> Result<()> {
        while to_bigint(with_retries!(self, LONG_ANSWER, connection => purge(connection))?) == PURGED_AT_ONCE {}
        Ok(())
    }
}

async fn purge(connection: &mut Object) -> Result<u64, Fault> {
    let transaction = begin(connection).await?;
    let times = [JOB_LIFETIME, JOB_TIME_LIMIT].map(|time| time.as_secs_f64());
    let gone = execute(&transaction, sql::PURGE_JOBS, &[&times[0], &times[1], &PURGED_AT_ONCE]).await?;
    transaction.commit().await?;
    Ok(gone)
}

#[async_trait]
impl JobStore for PostgresStore {
    async fn create_job(&self, job: Job, request: String, limits: JobLimits, receipt: Option<Receipt>) -> Result<()> {
        let (pool, receipt, commit_sent) = (&self.pool, receipt.as_ref(), AtomicBool::new(false));
        let made = with_retries!(pool, LONG_ANSWER, connection =>
            pool.create_job(connection, (&job, &request), limits, receipt, &commit_sent));
        let Err(error) = made else { return Ok(()) };
        // A lost connection may have hidden that an earlier attempt went well.
        if commit_sent.into_inner() && pool.row(sql::JOB, &[&job.id]).await?.is_some() {
            return Ok(());
        }
        match receipt {
            Some(receipt) if pool.receipt(&receipt.request.key).await?.is_some() => Err(StoreError::KeyTaken),
            _ => Err(error),
        }
    }

    async fn job(&self, id: Uuid) -> Result<Job> {
        let row = self.pool.row(sql::JOB, &[&id]).await?.ok_or(StoreError::NotFound)?;
        rows::job(&mut reader(&row))
    }

    async fn jobs(&self, tenant: Tenant) -> Result<Vec<Job>> {
        let found = self.pool.rows(sql::JOBS, &[&tenant.name()]).await?;
        found.iter().map(|row| rows::job(&mut reader(row))).collect()
    }

    async fn job_request(&self, id: Uuid) -> Result<String> {
        let found = self.pool.row(sql::JOB_REQUEST, &[&id]).await?;
        found.map(|row| row.get(0)).ok_or(StoreError::NotFound)
    }

    async fn claim(&self, owner: Uuid, after: Option<Uuid>, lease: Duration) -> Result<Option<Claim>> {
        // First the jobs after the last one, then all of them.
        for from in after.into_iter().chain([Uuid::nil()]) {
            if let Some(row) = self.pool.row(sql::CLAIM, &[&from, &owner, &lease.as_secs_f64()]).await? {
                return Ok(Some(Claim { job: row.get(0), chunk: from_bigint(row.get(1)), owner }));
            }
        }
        Ok(None)
    }

    async fn renew(&self, Claim { job, chunk, owner }: Claim, lease: Duration) -> Result<bool> {
        let (chunk, lease) = (to_bigint(chunk), lease.as_secs_f64());
        Ok(self.pool.row(sql::RENEW, &[&job, &chunk, &owner, &lease]).await?.is_some())
    }

    async fn release(&self, Claim { job, chunk, owner }: Claim) -> Result<()> {
        self.pool.rows(sql::RELEASE, &[&job, &to_bigint(chunk), &owner]).await.map(drop)
    }

    async fn save_chunk(&self, claim: Claim, result: ChunkResult) -> Result<()> {
        let found = with_retries!(self.pool, ANSWER, connection => self.pool.save_chunk(connection, claim, &result))?;
        self.changes.wake(claim.job);
        if found { Ok(()) } else { Err(StoreError::NotFound) }
    }

    async fn fail_job(&self, id: Uuid, error: String) -> Result<()> {
        with_retries!(self.pool, ANSWER, connection => self.pool.fail_job(connection, id, &error))?;
        self.changes.wake(id);
        Ok(())
    }

    async fn chunks(&self, id: Uuid, first: u64, limit: usize) -> Result<Vec<Vec<u8>>> {
        let found = self.pool.rows(sql::CHUNKS, &[&id, &to_bigint(first), &to_bigint(limit as u64)]).await?;
        Ok(found.iter().map(|row| row.get(0)).collect())
    }

    async fn delete_job(&self, id: Uuid) -> Result<()> {
        let commit_sent = AtomicBool::new(false);
        let deleted =
            with_retries!(self.pool, LONG_ANSWER, connection => self.pool.delete_job(connection, id, &commit_sent))?;
        self.changes.wake(id);
        if deleted { Ok(()) } else { Err(StoreError::NotFound) }
    }
}
