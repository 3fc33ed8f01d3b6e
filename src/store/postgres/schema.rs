//! The tables, versioned: a database is brought up to date at start, by one replica at a time.

use std::cmp::Ordering;

use tokio_postgres::{Client, Error};

/// The migrations, oldest first. A published one is never edited: the version of a database is how many it has seen.
const MIGRATIONS: [&str; 3] = [TABLES, TENANTS, JOBS];

const TABLES: &str = "
CREATE TABLE contacts (
    id uuid PRIMARY KEY,
    label text,
    definition text NOT NULL,
    sequence bigint NOT NULL,
    created_at timestamptz NOT NULL,
    created_ns smallint NOT NULL,
    updated_at timestamptz NOT NULL,
    updated_ns smallint NOT NULL
);
CREATE TABLE moves (
    contact uuid NOT NULL,
    sequence bigint NOT NULL,
    target_displacement double precision,
    target_force double precision,
    target_indentation double precision,
    target_normal_force double precision,
    relative boolean NOT NULL,
    tolerance double precision NOT NULL,
    displacement double precision NOT NULL,
    force double precision NOT NULL,
    indentation double precision NOT NULL,
    normal_force double precision NOT NULL,
    contact_radius double precision NOT NULL,
    stick_radius double precision NOT NULL,
    regime text NOT NULL,
    dissipated_energy double precision NOT NULL,
    elastic_energy double precision NOT NULL,
    memory_depth bigint NOT NULL,
    at timestamptz NOT NULL,
    at_ns smallint NOT NULL,
    stamp bigint NOT NULL,
    PRIMARY KEY (contact, sequence)
);
CREATE TABLE receipts (
    key text PRIMARY KEY,
    fingerprint bytea NOT NULL,
    created uuid,
    sequence bigint NOT NULL,
    body bytea NOT NULL,
    created_at timestamptz NOT NULL DEFAULT now()
);
CREATE INDEX receipts_created_at ON receipts (created_at);
CREATE TABLE snapshots (
    contact uuid PRIMARY KEY REFERENCES contacts (id) ON DELETE CASCADE,
    sequence bigint NOT NULL,
    state bytea NOT NULL
);
CREATE TABLE expired (
    id uuid PRIMARY KEY,
    at timestamptz NOT NULL DEFAULT now()
);
";

/// What was there before belongs to the tenant without a name, as does what replicas of the earlier version still make.
const TENANTS: &str = "
ALTER TABLE contacts ADD COLUMN tenant text NOT NULL DEFAULT '';
ALTER TABLE expired ADD COLUMN tenant text NOT NULL DEFAULT '';
CREATE INDEX contacts_by_tenant ON contacts (tenant, id);
";

/// Jobs, and the chunks that they are done in.
const JOBS: &str = "
CREATE TABLE jobs (
    id uuid PRIMARY KEY,
    tenant text NOT NULL,
    created_at timestamptz NOT NULL,
    created_ns smallint NOT NULL,
    finished_at timestamptz,
    error text,
    points bigint NOT NULL,
    chunk bigint NOT NULL,
    done bigint NOT NULL,
    failed bigint NOT NULL,
    bytes bigint NOT NULL,
    cost bigint NOT NULL,
    request text NOT NULL
);
CREATE INDEX jobs_by_tenant ON jobs (tenant);
CREATE TABLE job_chunks (
    job uuid NOT NULL REFERENCES jobs (id) ON DELETE CASCADE,
    chunk bigint NOT NULL,
    owner uuid,
    leased_until timestamptz,
    content bytea,
    PRIMARY KEY (job, chunk)
);
CREATE INDEX job_chunks_open ON job_chunks (job, chunk) WHERE content IS NULL;
";

/// Held while the tables are made, so that of several replicas that start together one makes them: "stickslip" in ASCII,
/// shortened to eight letters.
const ADVISORY_LOCK: &str = "SELECT pg_advisory_xact_lock(8319390287385554025)";

const VERSIONS: &str = "
CREATE TABLE IF NOT EXISTS stickslip_schema (
    version integer PRIMARY KEY,
    applied_at timestamptz NOT NULL DEFAULT now()
)";
const CURRENT: &str = "SELECT coalesce(max(version), 0) FROM stickslip_schema";
const RECORD_VERSION: &str = "INSERT INTO stickslip_schema (version) VALUES ($1)";

/// Why the tables cannot be used.
#[derive(Debug, thiserror::Error)]
pub(super) enum SchemaError {
    /// A later version of this program has been here.
    #[error("the database has schema version {found}, this program knows up to {known}: start the newer program")]
    Newer { found: i32, known: i32 },
    /// An earlier version has been here, and this program may not change anything.
    #[error("the database has schema version {found}: `stickslip serve` brings it to version {known}")]
    Older { found: i32, known: i32 },
    /// The database refused or was lost.
    #[error(transparent)]
    Database(#[from] Error),
}

/// Brings the tables up to date.
pub(super) async fn migrate(client: &mut Client) -> Result<(), SchemaError> {
    let transaction = client.transaction().await?;
    transaction.batch_execute(ADVISORY_LOCK).await?;
    transaction.batch_execute(VERSIONS).await?;
    let found: i32 = transaction.query_one(CURRENT, &[]).await?.get(0);
    let mut known = 0;
    for migration in MIGRATIONS {
        known += 1;
        if known > found {
            transaction.batch_execute(migration).await?;
            transaction.execute(RECORD_VERSION, &[&known]).await?;
            tracing::info!(version = known, "the database schema has been brought up to date");
        }
    }
    if found > known {
        return Err(SchemaError::Newer { found, known });
    }
    Ok(transaction.commit().await?)
}

/// Looks whether the tables are as this program knows them, and changes nothing.
pub(super) async fn check(client: &Client) -> Result<(), SchemaError> {
    let (found, known): (i32, _) = (client.query_one(CURRENT, &[]).await?.get(0), MIGRATIONS.len() as i32);
    match found.cmp(&known) {
        Ordering::Less => Err(SchemaError::Older { found, known }),
        Ordering::Equal => Ok(()),
        Ordering::Greater => Err(SchemaError::Newer { found, known }),
    }
}
