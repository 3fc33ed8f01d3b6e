//! Listening to changes that other processes make.

use std::sync::Arc;
use std::time::Duration;

use futures::StreamExt as _;
use futures::stream;
use tokio_postgres::AsyncMessage;
use uuid::Uuid;

use crate::store::Changes;

use super::client_pool::ClientPool;
use super::fault::{Backoff, Fault};
use super::sql;

/// How often listeners are woken if the database has no notifications.
const LOOK: Duration = Duration::from_secs(1);

/// Wakes listeners when the database notifies of changes; never ends.
pub(super) async fn listen(pool: Arc<ClientPool>, changes: Arc<Changes>) {
    if !pool.announces {
        loop {
            tokio::time::sleep(LOOK).await;
            changes.wake_all();
        }
    }
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
    let (client, mut driver) = pool.target.connect().await?;
    let mut messages = stream::poll_fn(move |context| driver.poll_message(context));
    let mut listen = std::pin::pin!(client.batch_execute(sql::LISTEN));
    loop {
        tokio::select! {
            done = &mut listen, if !*listening => {
                done?;
                *listening = true;
                // Earlier changes are not notified to this connection.
                changes.wake_all();
            }
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
