//! Serving until told to stop.

use std::future::Future;
use std::io;

use axum::serve::ListenerExt as _;
use tokio::net::TcpListener;
use tokio::sync::oneshot;
use tokio::time::sleep;

use super::limits::GRACE;
use super::{App, router};

/// Serves on `listener` until `stop` is done. Then events end, and other requests under way may finish within [`GRACE`]; what
/// is still open after that is closed, and its work stopped.
///
/// # Errors
/// What the operating system has against accepting connections.
pub async fn serve(listener: TcpListener, app: App, stop: impl Future<Output = ()> + Send + 'static) -> io::Result<()> {
    // Replies are short and whole: waiting to fill a packet would only delay them.
    let listener = listener.tap_io(|stream| {
        if let Err(error) = stream.set_nodelay(true) {
            tracing::debug!(%error, "TCP_NODELAY was refused");
        }
    });
    let (announce, announced) = oneshot::channel();
    let sessions = app.sessions.clone();
    let graceful = axum::serve(listener, router(app)).with_graceful_shutdown(async move {
        stop.await;
        tracing::info!(grace_ms = GRACE.as_millis() as u64, "stopping");
        // A client that follows a contact would never be done.
        sessions.end_events();
        // Nobody listens only if serving has ended already.
        let _ = announce.send(());
    });
    let overdue = async {
        if announced.await.is_ok() {
            sleep(GRACE).await;
        } else {
            std::future::pending().await
        }
    };
    tokio::select! {
        served = graceful => served,
        () = overdue => {
            tracing::warn!("connections were still open and have been closed");
            Ok(())
        }
    }
}
