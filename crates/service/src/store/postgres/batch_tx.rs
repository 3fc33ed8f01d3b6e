//! One batch of requests: one statement, which is a transaction of its own, and one round trip however many requests it
//! has.

use std::collections::HashMap;

use deadpool_postgres::Object;
use tokio_postgres::{Client, Row, Statement};
use uuid::Uuid;

use super::client_pool::{ANSWER, ClientPool, Parameter, rows};
use super::columns::{Moves, Pasts, Receipts, Requests, Sessions, from_bigint};
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

    /// Makes all changes whose sessions are as expected and free. Returns the sequence at which each session to append
    /// to was found, and whether it was as expected; none if another transaction holds it. Sessions that do not exist
    /// are missing.
    pub(super) async fn commit_batch(
        &self,
        pool: &ClientPool,
        requests: &[WriteRequest],
    ) -> Result<HashMap<Uuid, Option<Found>>, Fault> {
        let (mut appends, mut pasts, mut moves) = (Requests::default(), Pasts::default(), Moves::default());
        let (mut receipts, mut sessions) = (Receipts::default(), Sessions::default());
        for request in requests {
            match &request.change {
                Change::Create(session, definition) => sessions.push((session, definition.clone())),
                Change::Append { id, expected, moved_at, records } => {
                    pasts.push(*moved_at);
                    let last = records.last();
                    let sequence = last.map_or(*expected, |record| record.sequence);
                    appends.push((*id, *expected, sequence, last.map(|record| record.at)));
                    records.iter().for_each(|record| moves.push((*id, request.stamp, record)));
                }
            }
            request.receipt.iter().for_each(|receipt| receipts.push((request.id(), receipt)));
        }
        let parameters = parameters(&appends, &moves, &receipts, &sessions, &pasts);
        // The driver returns once the database is ready again, and so after the commit of a statement without `BEGIN`.
        let commit = async { Ok(self.client.query(&self.batch, &parameters).await?) };
        let found = pool.answer(ANSWER, commit).await?;
        let of = |row: &Row| {
            let sequence: Option<i64> = row.get(1);
            (row.get(0), sequence.map(|sequence| Found { sequence: from_bigint(sequence), as_expected: row.get(2) }))
        };
        Ok(found.iter().map(of).collect())
    }
}

/// A session to append to.
#[derive(Clone, Copy)]
pub(super) struct Found {
    pub(super) sequence: u64,
    /// Whether moves have been appended to it.
    pub(super) as_expected: bool,
}

/// Executes the statement of batches without a change: it needs all rights, tables and columns that a change needs.
pub(super) async fn probe(connection: &Object) -> Result<(), Fault> {
    let (appends, pasts, moves) = (Requests::default(), Pasts::default(), Moves::default());
    let (receipts, sessions) = (Receipts::default(), Sessions::default());
    let parameters = parameters(&appends, &moves, &receipts, &sessions, &pasts);
    rows(connection, sql::BATCH, &parameters).await.map(drop)
}

/// The parameters of the statement, in their order.
fn parameters<'a>(
    appends: &'a Requests,
    moves: &'a Moves,
    receipts: &'a Receipts,
    sessions: &'a Sessions,
    pasts: &'a Pasts,
) -> Vec<Parameter<'a>> {
    let columns = [appends.parameters(), moves.parameters(), receipts.parameters(), sessions.parameters()];
    [columns.concat(), pasts.parameters()].concat()
}
