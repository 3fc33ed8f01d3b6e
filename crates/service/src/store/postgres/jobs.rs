//! Jobs in the database, whose chunks all replicas compute.
//!
//! A worker has a lease on the chunk that it computes, and renews it. The chunks of a replica that is gone are claimed
//! by others when its leases have run out.

use std::time::Duration;

use async_trait::async_trait;
use deadpool_postgres::Object;
use uuid::Uuid;

use crate::store::job_store::{ChunkResult, Claim, JOB_LIFETIME, JOB_TIME_LIMIT, Job, JobLimits, JobStore};
use crate::store::rows as read;
use crate::store::{Receipt, Result, StoreError, Tenant};

use super::PostgresStore;
use super::client_pool::{ANSWER, ClientPool, LONG_ANSWER, Parameter, existed, long_rows, rows, with_retries};
use super::columns::{Receipts, from_bigint, reader, split_time, to_bigint};
use super::fault::Fault;
use super::sql::jobs as sql;
use super::transactions::{InDoubt, begin};

/// Jobs that one statement deletes: their results are large.
const PURGED_AT_ONCE: i64 = 4;

impl ClientPool {
    async fn create_job(
        &self,
        connection: &mut Object,
        (job, request): (&Job, &str),
        limits: JobLimits,
        receipts: &Receipts,
        sent: &InDoubt,
    ) -> Result<(), Fault> {
        let transaction = begin(connection).await?;
        let tenant = job.tenant.name();
        // Tenants that share a number wait for each other, and no more.
        let lock = i64::from(crc32fast::hash(tenant.as_bytes()));
        existed(&rows(&transaction, sql::LOCK_TENANT, &[&lock]).await?)?;
        let statement = transaction.prepare_cached(sql::JOBS_OF_TENANT).await?;
        let found = transaction.query_one(&statement, &[&tenant]).await?;
        limits.check(from_bigint(found.get(0)), from_bigint(found.get(1)), from_bigint(found.get(2)), job)?;
        let (at, ns) = split_time(job.created_at);
        let (points, chunk) = (to_bigint(job.points), to_bigint(job.chunk));
        let (bytes, cost, chunks) = (to_bigint(job.bytes), to_bigint(job.cost), to_bigint(job.chunks()));
        let row: [Parameter<'_>; 10] = [&job.id, &tenant, &at, &ns, &points, &chunk, &bytes, &cost, &request, &chunks];
        let row: Vec<_> = row.into_iter().chain(receipts.parameters()).collect();
        rows(&transaction, sql::CREATE_JOB, &row).await?;
        sent.answered(async { Ok(transaction.commit().await?) }).await
    }

    pub(super) async fn purge_jobs(&self) -> Result<()> {
        let times = [JOB_LIFETIME, JOB_TIME_LIMIT].map(|time| time.as_secs_f64());
        let which: [Parameter<'_>; 3] = [&times[0], &times[1], &PURGED_AT_ONCE];
        let purge = async |connection: &Object| long_rows(connection, sql::PURGE_JOBS, &which).await;
        while to_bigint(with_retries!(self, LONG_ANSWER, connection => purge(connection))?.len() as u64)
            == PURGED_AT_ONCE
        {}
        Ok(())
    }
}

#[async_trait]
impl JobStore for PostgresStore {
    async fn create_job(&self, job: Job, request: String, limits: JobLimits, receipt: Option<Receipt>) -> Result<()> {
        let (pool, sent) = (&self.pool, InDoubt::default());
        let receipts = pool.free_key(job.id, receipt.as_ref()).await?;
        let made = with_retries!(pool, LONG_ANSWER, connection =>
            pool.create_job(connection, (&job, &request), limits, &receipts, &sent));
        let Err(error) = made else { return Ok(()) };
        // A lost connection may have hidden that an earlier attempt went well.
        if sent.get() && pool.row(sql::JOB, &[&job.id]).await?.is_some() {
            return Ok(());
        }
        Err(pool.key_taken_or(receipt.as_ref(), error).await?)
    }

    async fn job(&self, id: Uuid) -> Result<Job> {
        let row = self.pool.row(sql::JOB, &[&id]).await?.ok_or(StoreError::NotFound)?;
        read::job(&mut reader(&row))
    }

    async fn jobs(&self, tenant: Tenant) -> Result<Vec<Job>> {
        let found = self.pool.rows(sql::JOBS, &[&tenant.name()]).await?;
        found.iter().map(|row| read::job(&mut reader(row))).collect()
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
        let (chunk, points, failed) = (to_bigint(claim.chunk), to_bigint(result.points), to_bigint(result.failed));
        let parameters: [Parameter<'_>; 5] = [&claim.job, &chunk, &result.content, &points, &failed];
        let found = with_retries!(self.pool, ANSWER, connection => async {
            existed(&rows(connection, sql::SAVE_CHUNK, &parameters).await?)
        })?;
        self.changes.wake(claim.job);
        if found { Ok(()) } else { Err(StoreError::NotFound) }
    }

    async fn fail_job(&self, id: Uuid, error: String) -> Result<()> {
        with_retries!(self.pool, ANSWER, connection => async {
            existed(&rows(connection, sql::FAIL_JOB, &[&id, &error]).await?)
        })?;
        self.changes.wake(id);
        Ok(())
    }

    async fn chunks(&self, id: Uuid, first: u64, limit: usize) -> Result<Vec<Vec<u8>>> {
        let found = self.pool.rows(sql::CHUNKS, &[&id, &to_bigint(first), &to_bigint(limit as u64)]).await?;
        Ok(found.iter().map(|row| row.get(0)).collect())
    }

    async fn delete_job(&self, id: Uuid) -> Result<()> {
        let sent = InDoubt::default();
        let delete =
            async |connection: &Object| existed(&sent.answered(long_rows(connection, sql::DELETE_JOB, &[&id])).await?);
        let existed = with_retries!(self.pool, LONG_ANSWER, connection => delete(connection))?;
        self.changes.wake(id);
        if existed || sent.get() { Ok(()) } else { Err(StoreError::NotFound) }
    }
}
