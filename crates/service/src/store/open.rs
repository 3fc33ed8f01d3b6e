//! Opening the store that a URL names.

use std::path::Path;
use std::sync::Arc;

#[cfg(feature = "postgres")]
use super::PostgresStore;
use super::{SqliteStore, Store, sqlite};

/// Why a store cannot be used, in one line.
#[derive(Debug, thiserror::Error)]
#[error("cannot open the store {store}: {why}")]
pub struct OpenError {
    /// Which one; never with a password.
    pub store: String,
    /// The reason.
    pub why: String,
}

/// What a URL names.
enum Kind<'a> {
    Memory,
    Sqlite(&'a Path),
    #[cfg(feature = "postgres")]
    Postgres,
}

impl OpenError {
    fn new(store: impl Into<String>, why: impl Into<String>) -> OpenError {
        OpenError { store: store.into(), why: why.into() }
    }

    /// An error about a URL that may hold a password, which is therefore not shown.
    fn of(url: &str, why: impl Into<String>) -> OpenError {
        // What has no colon has no password.
        let kind = url.split_once(':').map_or(url, |(kind, _)| kind);
        OpenError::new(kind, why)
    }
}

fn kind(url: &str) -> Result<Kind<'_>, OpenError> {
    if url == "memory:" {
        return Ok(Kind::Memory);
    }
    if let Some(path) = url.strip_prefix("sqlite:") {
        // In a URL two slashes come before a host, and a file has none.
        let path = path.strip_prefix("//").unwrap_or(path);
        if path.is_empty() || path == ":memory:" {
            return Err(OpenError::new(url, "expected the path of a file after sqlite:"));
        }
        return Ok(Kind::Sqlite(Path::new(path)));
    }
    if url.starts_with("postgres://") || url.starts_with("postgresql://") {
        #[cfg(feature = "postgres")]
        return Ok(Kind::Postgres);
        #[cfg(not(feature = "postgres"))]
        return Err(OpenError::of(url, "this program is built without PostgreSQL (the feature `postgres`)"));
    }
    Err(OpenError::of(url, "unknown kind of store, expected sqlite:PATH, postgres://… or memory:"))
}

/// Opens a store: `memory:`, `sqlite:` and the path of a file, which is made if it is missing, or the URL of a
/// PostgreSQL database, `postgres://…`.
///
/// # Errors
/// [`OpenError`] if the URL names no store, or one that cannot be used.
pub async fn open(url: &str) -> Result<Arc<dyn Store>, OpenError> {
    match kind(url)? {
        Kind::Memory => {
            tracing::warn!("contacts are kept in memory: they are lost when this process ends");
            Ok(Arc::new(SqliteStore::in_memory().map_err(|why| OpenError::new(url, why))?))
        }
        Kind::Sqlite(path) => {
            let store = SqliteStore::open(path).map_err(|why| OpenError::new(url, why))?;
            tracing::info!(path = %path.display(), "contacts are kept in a file");
            Ok(Arc::new(store))
        }
        #[cfg(feature = "postgres")]
        Kind::Postgres => {
            let store = PostgresStore::open(url).await.map_err(|error| OpenError::of(url, error.to_string()))?;
            tracing::info!(address = store.address(), "contacts are kept in a database");
            Ok(Arc::new(store))
        }
    }
}

/// Opens a store for reading, while other processes may use it. Nothing is created or migrated.
///
/// # Errors
/// [`OpenError`] if the URL names no store, or one that cannot be read.
pub async fn open_to_read(url: &str) -> Result<Arc<dyn Store>, OpenError> {
    match kind(url)? {
        Kind::Memory => Err(OpenError::new(url, "a `memory:` store exists only in the process that serves it")),
        Kind::Sqlite(path) => Ok(Arc::new(SqliteStore::open_to_read(path).map_err(|why| OpenError::new(url, why))?)),
        #[cfg(feature = "postgres")]
        Kind::Postgres => {
            let store = PostgresStore::open_to_read(url).await;
            Ok(Arc::new(store.map_err(|error| OpenError::of(url, error.to_string()))?))
        }
    }
}

/// Copies a store to a file that is not there yet, while it is in use or not; returns its bytes. Meanwhile `progress`
/// is called now and then with the bytes of the copy so far and of the store, which may have free pages that are not
/// copied.
///
/// # Errors
/// [`OpenError`] if the store is not kept in a file, or why there is no copy.
pub fn backup(url: &str, copy: &Path, progress: impl FnMut(u64, u64) + Send) -> Result<u64, OpenError> {
    match kind(url)? {
        Kind::Memory => Err(OpenError::new(url, "a `memory:` store exists only in the process that serves it")),
        Kind::Sqlite(path) => sqlite::backup::backup(path, copy, progress).map_err(|why| OpenError::new(url, why)),
        #[cfg(feature = "postgres")]
        Kind::Postgres => {
            Err(OpenError::of(url, "a database is backed up by its own means: pg_dump --format=custom --file=FILE URL"))
        }
    }
}
