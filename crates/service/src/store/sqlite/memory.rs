//! A database in the memory of the process: nothing of it reaches a disk, and it is lost with the store.
//!
//! It has one connection. What is short is done at once by whoever asks for it, so that a move waits for no other
//! thread; what is long on the blocking pool, alone, in the order of arrival.

use std::sync::Arc;

use parking_lot::Mutex;
use rusqlite::Connection;
use tokio::sync::{RwLock, Semaphore};
use tokio::task::spawn_blocking;

use crate::store::schema::SchemaError;
use crate::store::{Changes, Clock, Commits, RECEIPT_OVERHEAD, Result, StoreError};

use super::change::{Change, Done, Transaction};
use super::columns::execute;
use super::fault::Fault;
use super::file;
use super::schema::{self, MIGRATIONS};
use super::writer::Writer;

/// Rows that a change writes without the blocking pool, in some 4 µs each.
const SHORT: usize = 250;
/// Bytes of replies kept for retries. Beyond that the oldest are deleted early, because memory is bounded.
const RECEIPT_BYTES: u64 = 256 * 1024 * 1024;
/// Expired sessions that are remembered. Beyond that the oldest are forgotten early.
const EXPIRED_MARKS: u64 = 100_000;

#[derive(Clone)]
pub(super) struct InMemory {
    // Locked for microseconds by those who share the gate, and for as long as it takes by one who has it alone.
    writer: Arc<Mutex<Writer>>,
    gate: Arc<RwLock<()>>,
    /// For long reads: all others wait for one of them at most.
    reads: Arc<Semaphore>,
}

impl InMemory {
    /// An empty database.
    pub(super) fn new(
        changes: Arc<Changes>,
        commits: Arc<Commits>,
        clock: Clock,
    ) -> Result<InMemory, SchemaError<rusqlite::Error>> {
        let mut database = Connection::open_in_memory()?;
        database.pragma_update(None, "temp_store", "MEMORY")?;
        file::prepare(&database)?;
        schema::migrate(&mut database, MIGRATIONS)?;
        let mut writer = Writer::new(database, Arc::default(), changes, commits, clock)?.gathering();
        // As every store, it begins by looking for moves without a contact.
        writer.background_step();
        Ok(InMemory { writer: Arc::new(Mutex::new(writer)), gate: Arc::default(), reads: Arc::new(Semaphore::new(1)) })
    }

    /// Asks a question that is answered in microseconds.
    pub(super) async fn look_up<T>(&self, question: impl FnOnce(&Connection) -> Result<T, Fault>) -> Result<T> {
        let _shared = self.gate.read().await;
        question(&self.writer.lock().database).map_err(Fault::into_store_error)
    }

    /// Asks any other question: a search among 100 000 contacts takes some 40 ms, also if its request is dropped.
    pub(super) async fn read<T: Send + 'static>(
        &self,
        question: impl FnOnce(&Connection) -> Result<T, Fault> + Send + 'static,
    ) -> Result<T> {
        let _permit = self.reads.acquire().await;
        self.alone(|writer| question(&writer.database).map_err(Fault::into_store_error)).await?
    }

    /// Makes a change and answers it. What it leaves to be done is done in steps, between which others have a turn.
    pub(super) async fn change(&self, request: Change) {
        let (is_short, database) = (request.weight <= SHORT, self.clone());
        let make = move |writer: &mut Writer| {
            let had_background = writer.has_background();
            writer.commit(vec![request]);
            if writer.has_background() && !had_background {
                tokio::spawn(async move { while let Ok(true) = database.alone(Writer::background_step).await {} });
            }
        };
        if is_short {
            let _shared = self.gate.read().await;
            make(&mut self.writer.lock());
        // In a box, so that a move is not as large as what waits for its turn.
        } else if let Err(error) = Box::pin(self.alone(make)).await {
            tracing::error!(%error, "a change failed");
        }
    }

    /// Does what is long, on the blocking pool.
    async fn alone<T: Send + 'static>(&self, work: impl FnOnce(&mut Writer) -> T + Send + 'static) -> Result<T> {
        let (gate, writer) = (Arc::clone(&self.gate).write_owned().await, Arc::clone(&self.writer));
        let done = spawn_blocking(move || {
            let _alone = gate;
            work(&mut writer.lock())
        });
        done.await.map_err(|_| StoreError::Failed("work on the database panicked".to_owned()))
    }
}

/// Forgets the oldest receipts and marks of expired sessions, as many as are too many.
pub(super) fn forget(transaction: &mut Transaction<'_>) -> Result<Done, Fault> {
    keep_newest(transaction.database, RECEIPT_BYTES, EXPIRED_MARKS)?;
    Ok(Done::Made(0))
}

fn keep_newest(database: &Connection, receipt_bytes: u64, marks: u64) -> rusqlite::Result<()> {
    let sql = format!(
        "DELETE FROM receipts WHERE number <= (
             SELECT max(number) FROM (
                 SELECT number, sum({RECEIPT_OVERHEAD} + octet_length(body) + 2 * octet_length(key))
                     OVER (ORDER BY number DESC) AS bytes
                 FROM receipts)
             WHERE bytes > {receipt_bytes})"
    );
    execute(database, &sql, [])?;
    let sql =
        format!("DELETE FROM expired WHERE at <= (SELECT at FROM expired ORDER BY at DESC LIMIT 1 OFFSET {marks})");
    execute(database, &sql, []).map(drop)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::store::rows::RowReader as _;
    use crate::store::sqlite::columns::all;
    use crate::store::sqlite::statements::insert_receipt;
    use crate::store::{Receipt, Reply, RequestKey};

    #[test]
    fn the_newest_receipts_and_marks_are_kept() {
        let mut database = Connection::open_in_memory().unwrap();
        schema::migrate(&mut database, MIGRATIONS).unwrap();
        for number in 0..10 {
            let request = RequestKey { key: number.to_string(), fingerprint: [0; 32] };
            let receipt = Receipt { request, reply: Reply { created: None, sequence: 1, body: vec![0; 1_000] } };
            insert_receipt(&database, Some(&receipt), Clock::starting_at(jiff::Timestamp::now())).unwrap();
            database.execute("INSERT INTO expired (id, at, tenant) VALUES (?1, ?1, '')", [number]).unwrap();
        }
        let kept = |sql| all(&database, sql, [], |row| row.next::<String>()).unwrap();
        let bytes = 3 * (RECEIPT_OVERHEAD + 1_002);
        for (bytes, marks, first) in [(u64::MAX, 100, 0), (bytes, 3, 7), (bytes, 3, 7), (bytes - 1, 2, 8), (0, 0, 10)] {
            keep_newest(&database, bytes.min(i64::MAX as u64), marks).unwrap();
            let newest: Vec<String> = (first..10).map(|number| number.to_string()).collect();
            assert_eq!(kept("SELECT key FROM receipts ORDER BY number"), newest);
            assert_eq!(kept("SELECT id FROM expired ORDER BY at"), newest);
        }
    }
}
