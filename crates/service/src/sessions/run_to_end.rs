//! A change on its way to the store, and its consequences in this process: both are completed even if the client hangs
//! up between the commit and its reply.

use std::pin::Pin;
use std::task::{Context, Poll};

use futures::FutureExt as _;
use futures::future::BoxFuture;
use tokio::runtime::Handle;
use tracing::Instrument as _;

use super::prelude::*;

/// A change that continues in a task of its own if the request that waits for it is dropped.
pub(super) struct RunToEnd<T: 'static>(Option<BoxFuture<'static, T>>);

/// Sends a change to the store, and completes its consequences.
pub(super) fn run_to_end<T>(change: impl Future<Output = T> + Send + 'static) -> RunToEnd<T> {
    RunToEnd(Some(Box::pin(change.instrument(otlp::part!("store")))))
}

impl<T> Future for RunToEnd<T> {
    type Output = T;

    fn poll(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<T> {
        // Taken out while it is polled: one that panics does not go on.
        let Some(mut change) = self.0.take() else { return Poll::Pending };
        let outcome = change.as_mut().poll(context);
        if outcome.is_pending() {
            self.0 = Some(change);
        }
        outcome
    }
}

impl<T> Drop for RunToEnd<T> {
    fn drop(&mut self) {
        if let (Some(change), Ok(runtime)) = (self.0.take(), Handle::try_current()) {
            runtime.spawn(change.map(drop));
        }
    }
}
