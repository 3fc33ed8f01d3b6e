//! Opening the store that a URL names.

use std::path::Path;
use std::sync::Arc;

use super::{MemoryStore, PostgresStore, SqliteStore, Store};

/// Why a store cannot be used, in one line.
#[derive(Debug, thiserror::Error)]
#[error("cannot open the store {store}: {why}")]
pub struct OpenError {
    /// Which one; never with a password.
    pub store: String,
    /// What is wrong with it.
    pub why: String,
}

/// Opens a store: `memory:`, `sqlite:` and the path of a file, which is made if it is missing, or the URL of a PostgreSQL
/// database, `postgres://…`.
///
/// # Errors
/// [`OpenError`] if the URL names no store, or one that cannot be used.
pub async fn open(url: &str) -> Result<Arc<dyn Store>, OpenError> {
    let failed = |why: &str| OpenError { store: url.to_owned(), why: why.to_owned() };
    if url == "memory:" {
        tracing::warn!("contacts are kept in memory: all of them are gone when this process ends");
        return Ok(Arc::new(MemoryStore::new()));
    }
    if let Some(path) = url.strip_prefix("sqlite:") {
        // As URLs go: two slashes stand before a host, and there is none.
        let path = path.strip_prefix("//").unwrap_or(path);
        if path.is_empty() || path == ":memory:" {
            return Err(failed("expected the path of a file after sqlite:"));
        }
        let store = SqliteStore::open(Path::new(path)).map_err(|why| failed(&why))?;
        tracing::info!(path, "contacts are kept in a file");
        return Ok(Arc::new(store));
    }
    // From here on the URL may hold a password, or be meant to.
    let (kind, rest) = url.split_once(':').unwrap_or((url, ""));
    let failed = |why: String| OpenError { store: format!("{kind}:"), why };
    if matches!(kind, "postgres" | "postgresql") && rest.starts_with("//") {
        let store = PostgresStore::open(url).await.map_err(|error| failed(error.to_string()))?;
        return Ok(Arc::new(store));
    }
    Err(failed("unknown kind of store, expected sqlite:PATH, postgres://… or memory:".to_owned()))
}
