//! One batch of requests: a whole transaction sent at once, which costs one round trip however many requests it has.

use std::collections::HashMap;

use futures::future::try_join_all;
use tokio_postgres::{Client, Error, Statement};
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
    lock: Statement,
    append: Statement,
    create: Statement,
    /// None where the database has no notifications.
    notify: Option<Statement>,
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
            let statements = [sql::LOCK, sql::APPEND, sql::CREATE].map(|statement| client.prepare(statement));
            let statements = try_join_all(statements).await?;
            let notify = if pool.announces { Some(client.prepare(sql::NOTIFY).await?) } else { None };
            let [lock, append, create] = <[Statement; 3]>::try_from(statements)
                .map_err(|_| Fault::Lost("a statement was not prepared".to_owned()))?;
            Ok(WriterConnection { client, lock, append, create, notify })
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
        let appended: Vec<_> = appended.chain(columns.receipts.parameters()).collect();
        let created = created(&columns.sessions, &columns.first_receipts);

        let locked: [Parameter<'_>; 1] = [&columns.requests.id];
        let announced: [Parameter<'_>; 2] = [&sql::CHANNEL, &columns.announcements];

        // Polled in this order, and sent as they are polled.
        let transaction = async {
            Ok(futures::join!(
                self.client.batch_execute(sql::BEGIN),
                self.client.query(&self.lock, &locked),
                self.execute(Some(&self.append).filter(|_| !columns.requests.id.is_empty()), &appended),
                self.execute(Some(&self.create).filter(|_| !columns.sessions.id.is_empty()), &created),
                self.execute(self.notify.as_ref(), &announced),
                self.client.batch_execute(sql::COMMIT),
            ))
        };
        let answers = pool.answer(ANSWER, transaction).await?;
        // The first failure is the cause of the others, and of a commit that did nothing.
        let (begun, found, appended, created, notified, committed) = answers;
        begun?;
        let found = found?;
        appended?;
        created?;
        notified?;
        committed?;
        Ok(found.iter().map(|row| (row.get(0), from_bigint(row.get(1)))).collect())
    }

    /// Executes a statement if there is one.
    async fn execute(&self, statement: Option<&Statement>, parameters: &[Parameter<'_>]) -> Result<u64, Error> {
        match statement {
            Some(statement) => self.client.execute(statement, parameters).await,
            None => Ok(0),
        }
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
