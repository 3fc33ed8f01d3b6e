//! Hearing of changes that other processes make.

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

/// How often those who wait are sent to look where the engine knows no announcements.
const LOOK: Duration = Duration::from_secs(1);

/// Wakes those who wait for changes, for ever.
pub(super) async fn listen(pool: Arc<ClientPool>, changes: Arc<Changes>) {
    if !pool.announces {
        loop {
            tokio::time::sleep(LOOK).await;
            changes.wake_all();
        }
    }
    let mut backoff = Backoff::default();
    loop {
        let mut heard = false;
        if let Err(fault) = hear(&pool, &changes, &mut heard).await {
            tracing::debug!(?fault, "no announcements are heard for now");
        }
        if heard {
            backoff = Backoff::default();
        }
        backoff.pause().await;
    }
}

/// Listens on one connection until it is lost; `heard` tells whether it came about.
async fn hear(pool: &ClientPool, changes: &Changes, heard: &mut bool) -> Result<(), Fault> {
    let (client, mut driver) = pool.target.connect().await?;
    let mut messages = stream::poll_fn(move |context| driver.poll_message(context));
    let mut listen = std::pin::pin!(client.batch_execute(sql::LISTEN));
    loop {
        tokio::select! {
            listening = &mut listen, if !*heard => {
                listening?;
                *heard = true;
                // Whatever happened before is not announced to this connection.
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
