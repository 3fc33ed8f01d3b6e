//! The version of the tables in a database, which one replica at a time brings up to date at start.

use tokio_postgres::{Client, Error};

use crate::store::schema::{self, SchemaError};

/// The migrations, oldest first: each leads from one version of the tables to the next.
pub const MIGRATIONS: &[&str] = &[
    include_str!("schema_1.sql"),
    include_str!("schema_2.sql"),
    include_str!("schema_3.sql"),
    include_str!("schema_4.sql"),
    include_str!("schema_5.sql"),
    include_str!("schema_6.sql"),
    include_str!("schema_7.sql"),
];

/// Held while tables are migrated, so that of several replicas that start together one does it: "stickslip" in ASCII,
/// shortened to eight letters.
const ADVISORY_LOCK: &str = "SELECT pg_advisory_xact_lock(8319390287385554025)";

const CREATE_VERSIONS: &str = "
CREATE TABLE IF NOT EXISTS stickslip_schema (
    version integer PRIMARY KEY,
    applied_at timestamptz NOT NULL DEFAULT now()
)";
const VERSION: &str = "SELECT coalesce(max(version), 0) FROM stickslip_schema";
const RECORD_VERSION: &str = "INSERT INTO stickslip_schema (version) VALUES ($1)";

/// Applies the migrations that a database has not seen, all of them or none.
///
/// # Errors
/// [`SchemaError`]; nothing has changed then.
pub async fn migrate(client: &mut Client, migrations: &[&str]) -> Result<(), SchemaError<Error>> {
    let transaction = client.transaction().await?;
    transaction.batch_execute(ADVISORY_LOCK).await?;
    transaction.batch_execute(CREATE_VERSIONS).await?;
    let found = transaction.query_one(VERSION, &[]).await?.get(0);
    if found == 0 {
        tracing::warn!("there was no store in the database: an empty one is made");
    }
    for (version, script) in schema::pending(found, migrations).map_err(SchemaError::Version)? {
        transaction.batch_execute(script).await?;
        transaction.execute(RECORD_VERSION, &[&version]).await?;
        tracing::info!(version, "the database schema has been migrated");
    }
    Ok(transaction.commit().await?)
}

/// Whether the tables have the version that this program works with.
pub(super) async fn check(client: &Client) -> Result<(), SchemaError<Error>> {
    schema::check(client.query_one(VERSION, &[]).await?.get(0), MIGRATIONS).map_err(SchemaError::Version)
}
