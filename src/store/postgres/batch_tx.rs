//! One batch of requests: a transaction of one round trip however many requests it has, and of one statement unless it both moves
//! and makes sessions.

use std::collections::HashMap;

use futures::future::try_join;
use tokio_postgres::{Client, Statement};
use uuid::Uuid;

use super::client_pool::{ANSWER, ClientPool, Parameter};
use super::columns::{Moves, Receipts, Requests, Sessions, from_bigint};
use super::fault::Fault;
use super::request::{Change, WriteRequest};
use super::sql;

/// Identifiers in one announcement: its payload must stay below 8000 bytes.
const ANNOUNCED: usize = 200;

/// The writer's connection.
pub(super) struct WriterConnection {
    client: Client,
    append: Statement,
    create: Statement,
    announces: bool,
}

/// A batch as columns.
#[derive(Default)]
struct Columns {
    requests: Requests,
    moves: Moves,
    receipts: Receipts,
    sessions: Sessions,
    first_receipts: Receipts,
    announcements: Vec<String>,
}

impl WriterConnection {
    /// Connects, and prepares the statements of batches.
    pub(super) async fn open(pool: &ClientPool) -> Result<WriterConnection, Fault> {
        let open = async {
            let client = pool.target.open().await?;
            client.batch_execute(sql::PREPARE_WRITER).await?;
            let append = sql::append(pool.announces);
            let (append, create) = try_join(client.prepare(&append), client.prepare(sql::CREATE)).await?;
            Ok(WriterConnection { client, append, create, announces: pool.announces })
        };
        pool.answer(ANSWER, open).await
    }

    /// Whether it can still be used, as far as is known.
    pub(super) fn is_open(&self) -> bool {
        !self.client.is_closed()
    }

    /// Makes all changes whose sessions are at the expected sequence, in one transaction. Returns the sequence at which
    /// each session to append to was found; sessions that do not exist are missing.
    pub(super) async fn commit_batch(
        &self,
        pool: &ClientPool,
        requests: &[WriteRequest],
    ) -> Result<HashMap<Uuid, u64>, Fault> {
        let columns = Columns::of(requests);
        let appended = columns.requests.parameters().into_iter().chain(columns.moves.parameters());
        let mut appended: Vec<_> = appended.chain(columns.receipts.parameters()).collect();
        if self.announces {
            appended.extend([&sql::CHANNEL as Parameter<'_>, &columns.announcements]);
        }
        let created = created(&columns.sessions, &columns.first_receipts);
        let (appends, creates) = (!columns.requests.id.is_empty(), !columns.sessions.id.is_empty());

        // The driver returns once the database is ready again, and so after the commit of a statement without `BEGIN`.
        let transaction = async {
            Ok(match (appends, creates) {
                (true, false) => self.client.query(&self.append, &appended).await?,
                (false, _) => self.client.execute(&self.create, &created).await.map(|_| Vec::new())?,
                // Polled in this order, and sent as they are polled.
                (true, true) => {
                    let (begun, found, created, committed) = futures::join!(
                        self.client.batch_execute(sql::BEGIN),
                        self.client.query(&self.append, &appended),
                        self.client.execute(&self.create, &created),
                        self.client.batch_execute(sql::COMMIT),
                    );
                    // The first failure is the cause of the others, and of a commit that did nothing.
                    begun?;
                    let found = found?;
                    created?;
                    committed?;
                    found
                }
            })
        };
        let found = pool.answer(ANSWER, transaction).await?;
        Ok(found.iter().map(|row| (row.get(0), from_bigint(row.get(1)))).collect())
    }
}

impl Columns {
    fn of(requests: &[WriteRequest]) -> Columns {
        let mut columns = Columns::default();
        for request in requests {
            let receipts = match &request.change {
                Change::Create(session, definition) => {
                    columns.sessions.push((session, definition.clone()));
                    &mut columns.first_receipts
                }
                Change::Append { id, expected, records } => {
                    let last = records.last();
                    let sequence = last.map_or(*expected, |record| record.sequence);
                    columns.requests.push((*id, *expected, sequence, last.map(|record| record.at)));
                    for record in records {
                        columns.moves.push((*id, request.stamp, record));
                    }
                    &mut columns.receipts
                }
            };
            if let Some(receipt) = &request.receipt {
                receipts.push((request.id(), receipt));
            }
        }
        columns.announcements = announcements(&columns.requests.id);
        columns
    }
}

/// The parameters of [`sql::CREATE`].
pub(super) fn created<'a>(sessions: &'a Sessions, receipts: &'a Receipts) -> Vec<Parameter<'a>> {
    // The first column of a receipt names the session whose change must succeed for it; that of a new one always does.
    sessions.parameters().into_iter().chain(receipts.parameters().into_iter().skip(1)).collect()
}

/// Payloads that name these sessions.
pub(super) fn announcements(ids: &[Uuid]) -> Vec<String> {
    let payload = |ids: &[Uuid]| ids.iter().map(|id| id.simple().to_string()).collect::<Vec<_>>().join(",");
    ids.chunks(ANNOUNCED).map(payload).collect()
}
