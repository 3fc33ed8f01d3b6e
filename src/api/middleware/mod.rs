//! The middleware around every handler, one layer per file.

pub mod access_control;
pub mod compression;
pub mod request_id;
pub mod request_log;
pub mod security_headers;

use std::sync::Arc;

use axum::extract::{Request, State};
use axum::middleware::Next;
use axum::response::Response;
use tokio::sync::watch;

use crate::admission::Pool;
use crate::api::request_metrics::RequestMetrics;

/// What all requests share: their metrics, the pool, and whether those that are not done are refused.
pub type Observed = (Arc<RequestMetrics>, Pool, watch::Receiver<bool>);

/// Logs a request and compresses its reply: one layer, because each such layer puts the request and its answer into a
/// box.
pub async fn observe(State((metrics, pool, stops)): State<Observed>, request: Request, next: Next) -> Response {
    let client = compression::Client::of(request.headers());
    let response = request_log::log_request(&metrics, stops, request, next).await;
    compression::compress(response, client, &pool).await
}
