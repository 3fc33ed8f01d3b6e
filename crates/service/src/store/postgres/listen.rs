//! One connection that listens to changes that other processes make.

use std::sync::Arc;

use futures::StreamExt as _;
use futures::stream;
use tokio::time::timeout;
use tokio_postgres::AsyncMessage;
use uuid::Uuid;

use crate::store::Changes;

use super::client_pool::{ANSWER, ClientPool};
use super::fault::{Backoff, Fault};
use super::sql;

/// Wakes listeners when the database notifies of changes; never ends.
pub(super) async fn listen(pool: Arc<ClientPool>, changes: Arc<Changes>) {
    let mut backoff = Backoff::default();
    loop {
        let mut listening = false;
        if let Err(fault) = receive(&pool, &changes, &mut listening).await {
            tracing::debug!(?fault, "no notifications are received for now");
        }
        if listening {
            backoff = Backoff::default();
        }
        backoff.pause().await;
    }
}

/// Listens on one connection until it is lost; sets `listening` when it has begun.
async fn receive(pool: &ClientPool, changes: &Changes, listening: &mut bool) -> Result<(), Fault> {
    let connected = timeout(ANSWER, pool.target.connect()).await.map_err(|_| Fault::no_answer())?;
    let (client, mut driver) = connected?;
    let mut messages = stream::poll_fn(move |context| driver.poll_message(context));
    // Sent as the messages are driven.
    let begin = async {
        client.batch_execute(sql::LISTEN).await?;
        *listening = true;
        // Earlier changes are not notified to this connection.
        changes.wake_all();
        std::future::pending::<Result<(), Fault>>().await
    };
    let mut begin = std::pin::pin!(begin);
    loop {
        tokio::select! {
            failed = &mut begin => return failed,
            message = messages.next() => match message {
                Some(Ok(AsyncMessage::Notification(announcement))) => wake(changes, announcement.payload()),
                Some(Ok(_)) => {}
                Some(Err(error)) => return Err(error.into()),
                None => return Ok(()),
            },
        }
    }
}

fn wake(changes: &Changes, payload: &str) {
    for id in payload.split(',').filter_map(|id| Uuid::try_parse(id).ok()) {
        changes.wake(id);
    }
}
