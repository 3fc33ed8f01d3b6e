//! One batch of requests: one statement, which is a transaction of its own, and one round trip however many requests it
//! has.

use std::collections::HashMap;

use tokio_postgres::{Client, Statement};
use uuid::Uuid;

use super::client_pool::{ANSWER, ClientPool};
use super::columns::{Moves, Receipts, Requests, Sessions, from_bigint};
use super::fault::Fault;
use super::request::{Change, WriteRequest};
use super::sql;

pub(super) struct WriterConnection {
    client: Client,
    batch: Statement,
}

impl WriterConnection {
    /// Connects, and prepares the statements of batches.
    pub(super) async fn open(pool: &ClientPool) -> Result<WriterConnection, Fault> {
        let open = async {
            let client = pool.target.open().await?;
            client.batch_execute(sql::PREPARE_WRITER).await?;
            let batch = client.prepare(sql::BATCH).await?;
            Ok(WriterConnection { client, batch })
        };
        pool.answer(ANSWER, open).await
    }

    /// Whether it can still be used, as far as is known.
    pub(super) fn is_open(&self) -> bool {
        !self.client.is_closed()
    }

    /// Makes all changes whose sessions are at the expected sequence and free. Returns the sequence at which each
    /// session to append to was found, and none if another transaction holds it; sessions that do not exist are
    /// missing.
    pub(super) async fn commit_batch(
        &self,
        pool: &ClientPool,
        requests: &[WriteRequest],
    ) -> Result<HashMap<Uuid, Option<u64>>, Fault> {
        let (mut appends, mut moves) = (Requests::default(), Moves::default());
        let (mut receipts, mut sessions) = (Receipts::default(), Sessions::default());
        for request in requests {
            match &request.change {
                Change::Create(session, definition) => sessions.push((session, definition.clone())),
                Change::Append { id, expected, records } => {
                    let last = records.last();
                    let sequence = last.map_or(*expected, |record| record.sequence);
                    appends.push((*id, *expected, sequence, last.map(|record| record.at)));
                    records.iter().for_each(|record| moves.push((*id, request.stamp, record)));
                }
            }
            request.receipt.iter().for_each(|receipt| receipts.push((request.id(), receipt)));
        }
        let columns = [appends.parameters(), moves.parameters(), receipts.parameters(), sessions.parameters()];
        let parameters = columns.concat();
        // The driver returns once the database is ready again, and so after the commit of a statement without `BEGIN`.
        let commit = async { Ok(self.client.query(&self.batch, &parameters).await?) };
        let found = pool.answer(ANSWER, commit).await?;
        Ok(found.iter().map(|row| (row.get(0), row.get::<_, Option<i64>>(1).map(from_bigint))).collect())
    }
}
