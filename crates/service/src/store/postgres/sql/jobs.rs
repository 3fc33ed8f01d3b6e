//! The statements of jobs.

/// Jobs whose columns contradict each other or their chunks. A job that has not failed has a row for every chunk.
pub const JOB_FAULTS: &str = "
WITH stored AS (
    SELECT j.id, count(c.chunk) AS chunks,
        coalesce(sum(CASE WHEN c.content IS NOT NULL
            THEN greatest(least(j.chunk, j.points - c.chunk * j.chunk), 0) END), 0) AS computed
    FROM jobs AS j LEFT JOIN job_chunks AS c ON c.job = j.id GROUP BY j.id
)
SELECT 'job ' || id || ': ' || done || ' points are counted as done, and ' || s.computed || ' are stored'
FROM jobs JOIN stored AS s USING (id) WHERE done <> s.computed
UNION ALL
SELECT 'job ' || id || ': it has ' || s.chunks || ' chunks for ' || points || ' points'
FROM jobs JOIN stored AS s USING (id) WHERE error IS NULL AND s.chunks <> (points + chunk - 1) / chunk
UNION ALL
SELECT 'job ' || id || ': it has ended at ' || done || ' of ' || points || ' points without an error'
FROM jobs WHERE finished_at IS NOT NULL AND error IS NULL AND done <> points
UNION ALL
SELECT 'job ' || id || ': all of its points are done, and it has not ended'
FROM jobs WHERE finished_at IS NULL AND done >= points
UNION ALL
SELECT 'job ' || id || ': of ' || done || ' points ' || failed || ' have no answer' FROM jobs
WHERE failed NOT BETWEEN 0 AND done";

/// Held while the jobs of a tenant are counted and another is made; false if another transaction holds it.
pub const LOCK_TENANT: &str = "SELECT pg_try_advisory_xact_lock($1)";

pub const JOBS_OF_TENANT: &str = "
SELECT count(*), coalesce(sum(bytes), 0)::bigint,
    coalesce(sum(CASE WHEN finished_at IS NULL THEN cost ELSE 0 END), 0)::bigint
FROM jobs WHERE tenant = $1";

/// Makes a job with its chunks, and keeps the receipt.
pub const CREATE_JOB: &str = announcing!(
    "found",
    "
WITH found AS (
    INSERT INTO jobs (id, tenant, created_at, created_ns, points, chunk, done, failed, bytes, cost, request)
    VALUES ($1, $2, $3, $4, $5, $6, 0, 0, $7, $8, $9) RETURNING id
), chunks AS (
    INSERT INTO job_chunks (job, chunk)
    SELECT found.id, number FROM found, generate_series(0::bigint, $10::bigint - 1) AS number
), kept AS (
    INSERT INTO receipts (key, fingerprint, created, sequence, body)
    SELECT receipt.key, receipt.fingerprint, receipt.created, receipt.sequence, receipt.body
    FROM unnest($11::uuid[], $12::text[], $13::bytea[], $14::uuid[], $15::bigint[], $16::bytea[])
        AS receipt (contact, key, fingerprint, created, sequence, body)
    JOIN found ON found.id = receipt.contact
)"
);

pub const JOB: &str = "
SELECT id, tenant, created_at, created_ns, finished_at, error, points, chunk, done, failed, bytes, cost
FROM jobs WHERE id = $1";

pub const JOBS: &str = "
SELECT id, tenant, created_at, created_ns, finished_at, error, points, chunk, done, failed, bytes, cost
FROM jobs WHERE tenant = $1 ORDER BY id";

pub const JOB_REQUEST: &str = "SELECT request FROM jobs WHERE id = $1";

/// Claims a chunk of a job after `$1` that is not claimed, or whose lease is over.
pub const CLAIM: &str = "
WITH next AS (
    SELECT job, chunk FROM job_chunks
    WHERE content IS NULL AND job > $1 AND (leased_until IS NULL OR leased_until < now())
    ORDER BY job, chunk LIMIT 1 FOR UPDATE SKIP LOCKED
)
UPDATE job_chunks SET owner = $2, leased_until = now() + $3::double precision * INTERVAL '1 second'
FROM next WHERE job_chunks.job = next.job AND job_chunks.chunk = next.chunk
RETURNING job_chunks.job, job_chunks.chunk";

pub const RENEW: &str = "
UPDATE job_chunks SET leased_until = now() + $4::double precision * INTERVAL '1 second'
WHERE job = $1 AND chunk = $2 AND owner = $3 AND content IS NULL
RETURNING chunk";

pub const RELEASE: &str = "
UPDATE job_chunks SET owner = NULL, leased_until = NULL
WHERE job = $1 AND chunk = $2 AND owner = $3 AND content IS NULL";

// A job that has not ended, locked unless another transaction holds it: before its chunks, as deleting it does. `found`
// says, if there is such a job, whether it was free.
macro_rules! held_job {
    () => {
        "
WITH held AS (
    SELECT id FROM jobs WHERE id = $1 AND finished_at IS NULL FOR NO KEY UPDATE SKIP LOCKED
), found AS (
    SELECT held.id IS NOT NULL AS held FROM jobs LEFT JOIN held ON held.id = jobs.id
    WHERE jobs.id = $1 AND jobs.finished_at IS NULL
)"
    };
}

/// Stores the result of a chunk that has none, and counts it.
pub const SAVE_CHUNK: &str = announcing!(
    "saved",
    held_job!(),
    ", saved AS (
    UPDATE job_chunks SET content = $3, owner = NULL, leased_until = NULL FROM held
    WHERE job_chunks.job = held.id AND job_chunks.chunk = $2 AND job_chunks.content IS NULL
    RETURNING job_chunks.job AS id
), counted AS (
    UPDATE jobs SET done = done + $4, failed = failed + $5,
        finished_at = CASE WHEN done + $4 = points THEN clock_timestamp() END
    FROM saved WHERE jobs.id = saved.id
)"
);

/// Ends a job with an error, and deletes the chunks that have no result.
pub const FAIL_JOB: &str = announcing!(
    "held",
    held_job!(),
    ", failed AS (
    UPDATE jobs SET finished_at = now(), error = $2 FROM held WHERE jobs.id = held.id
), dropped AS (
    DELETE FROM job_chunks USING held WHERE job_chunks.job = held.id AND job_chunks.content IS NULL
)"
);

pub const CHUNKS: &str = "
SELECT content FROM job_chunks WHERE job = $1 AND chunk >= $2 AND content IS NOT NULL ORDER BY chunk LIMIT $3";

/// Deletes a job with its chunks. Returns, if it exists, whether it was free.
pub const DELETE_JOB: &str = announcing!(
    "held",
    "
WITH held AS (
    SELECT id FROM jobs WHERE id = $1 FOR UPDATE SKIP LOCKED
), gone AS (
    DELETE FROM jobs USING held WHERE jobs.id = held.id
), found AS (
    SELECT held.id IS NOT NULL AS held FROM jobs LEFT JOIN held ON held.id = jobs.id WHERE jobs.id = $1
)"
);

/// Expired jobs, some at a time. What another replica is deleting is left to it.
pub const PURGE_JOBS: &str = "
DELETE FROM jobs WHERE id IN (
    SELECT id FROM jobs
    WHERE finished_at < now() - $1::double precision * INTERVAL '1 second'
        OR created_at < now() - $2::double precision * INTERVAL '1 second'
    LIMIT $3 FOR UPDATE SKIP LOCKED)
RETURNING id";
