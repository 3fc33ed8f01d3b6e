//! Where contacts are stored: a file, or a database of the server that the tests of one binary share.

use std::path::PathBuf;
use std::sync::Arc;

use rusqlite::Connection;
use stickslip::store::Store;
use tempfile::{TempDir, tempdir};
use uuid::Uuid;

use super::postgres::{Cluster, connected};

/// A place that no store has used yet.
pub enum Place {
    /// The folder of a file.
    File(TempDir),
    /// The URL of a database.
    Database(String),
}

impl Place {
    pub fn file() -> Place {
        Place::File(tempdir().unwrap())
    }

    /// One of each kind.
    pub async fn both() -> [Place; 2] {
        [Place::file(), Place::Database(Cluster::shared().database().await)]
    }

    /// Where the file is, if it is one.
    pub fn path(&self) -> Option<PathBuf> {
        if let Place::File(folder) = self { Some(folder.path().join("contacts.db")) } else { None }
    }

    pub fn url(&self) -> String {
        match self {
            Place::File(_) => format!("sqlite:{}", self.path().unwrap().display()),
            Place::Database(url) => url.clone(),
        }
    }

    pub async fn open(&self) -> Arc<dyn Store> {
        stickslip::store::open(&self.url()).await.unwrap()
    }

    /// Another program at the file; rows that depend on others are not looked after, as by its default.
    pub fn connection(&self) -> Connection {
        let database = Connection::open(self.path().expect("a file")).unwrap();
        database.pragma_update(None, "foreign_keys", false).unwrap();
        database
    }

    /// Runs a statement of another program that changes something.
    pub async fn change(&self, statement: &str) {
        let changed = match self {
            Place::File(_) => self.connection().execute(statement, []).unwrap() as u64,
            Place::Database(url) => connected(url).await.execute(statement, &[]).await.unwrap(),
        };
        assert!(changed > 0, "{statement}");
    }

    /// The whole number that a query finds.
    pub async fn number(&self, query: &str) -> i64 {
        match self {
            Place::File(_) => self.connection().query_row(query, [], |row| row.get(0)).unwrap(),
            Place::Database(url) => connected(url).await.query_one(query, &[]).await.unwrap().get(0),
        }
    }

    /// Waits until a snapshot is stored, which a server does in the background.
    pub async fn has_snapshot(&self) {
        let there = async || (self.number("SELECT count(*) FROM snapshots").await > 0).then_some(());
        super::until("a snapshot is stored", there).await;
    }

    /// Lets so many hours go by for a time in a table.
    pub async fn age(&self, table: &str, column: &str, hours: i64, of: &str) {
        let earlier = match self {
            Place::File(_) => format!("{column} - {}", hours * 3_600_000_000_000),
            Place::Database(_) => format!("{column} - INTERVAL '{hours} hours'"),
        };
        self.change(&format!("UPDATE {table} SET {column} = {earlier} WHERE {of}")).await;
    }

    /// What rows that belong to a contact or a job of a table have for it, in statements.
    pub fn key(&self, table: &str, id: Uuid) -> String {
        match self {
            Place::File(_) => format!("(SELECT number FROM {table} WHERE id = '{id}')"),
            Place::Database(_) => format!("'{id}'"),
        }
    }

    /// A copy of a place that nobody uses any more.
    pub async fn copy(&self) -> Place {
        match self {
            Place::File(_) => {
                let copy = Place::file();
                std::fs::copy(self.path().unwrap(), copy.path().unwrap()).unwrap();
                copy
            }
            Place::Database(url) => Place::Database(Cluster::shared().copy(url).await),
        }
    }
}
