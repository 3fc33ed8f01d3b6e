//! Serves one request of a connection: acquires a place, calls the router, and returns a reply that releases the place.

use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use axum::body::{Body, HttpBody as _};
use axum::http::{HeaderValue, Method, Request, Response, header};
use hyper::body::Incoming;
use tower_service::Service as _;

use super::ConnectionActivity;
use super::bodies::{DeadlineBody, RequestInProgress, TrackedBody};
use crate::admission::{Pool, PoolError, Reservation};

/// Paths that are answered even if the server is busy.
const ALWAYS_ANSWERED: [&str; 3] = ["/healthz", "/readyz", "/metrics"];

/// The request arrived while its connection was being closed to make room.
#[derive(Debug, thiserror::Error)]
#[error("closed to make room")]
pub struct Closed;

/// Why a request is refused before it reaches a handler.
#[derive(Clone, Copy, Debug)]
pub enum Refusal {
    /// The server has no capacity for it.
    Full(PoolError),
    /// Its head can be read in more than one way.
    Ambiguous(&'static str),
}

/// What serves the requests of all connections.
pub struct Service {
    /// All routes.
    pub router: Router,
    /// Answers refused requests.
    pub refusals: Router,
    /// Where requests get their places.
    pub pool: Pool,
    /// How long a body may take to arrive.
    pub body_time: Duration,
}

impl Service {
    /// Serves a request; on a spare connection only those for the health of the server.
    pub async fn serve(
        self: Arc<Self>,
        activity: Arc<ConnectionActivity>,
        spare: bool,
        request: Request<Incoming>,
    ) -> Result<Response<TrackedBody>, Closed> {
        if !activity.begin_request() {
            return Err(Closed);
        }
        let in_progress = RequestInProgress(activity);
        let mut request = request.map(|body| Body::new(DeadlineBody::new(body, self.body_time)));
        let fault = in_progress.0.head_fault();
        let place = if let Some(fault) = fault {
            Err(Refusal::Ambiguous(fault))
        } else if ALWAYS_ANSWERED.contains(&request.uri().path()) {
            Ok(None)
        } else if spare {
            Err(Refusal::Full(PoolError::Busy))
        } else if request.method() == Method::POST {
            // It acquires its place once its body has arrived.
            Ok(None)
        } else {
            self.pool.enter().await.map(Some).map_err(Refusal::Full)
        };
        let (reply, place) = match place {
            Ok(place) => (self.router.clone().call(request).await, place),
            Err(refusal) => {
                request.extensions_mut().insert(refusal);
                (self.refusals.clone().call(request).await, None)
            }
        };
        let Ok(mut reply) = reply;
        if fault.is_some() {
            reply.headers_mut().insert(header::CONNECTION, HeaderValue::from_static("close"));
        }
        let memory = reply.extensions_mut().remove::<Arc<Reservation>>();
        // An endless stream has a limit of its own and occupies no solver. A compressed reply ends, but has no length.
        let ends = reply.body().size_hint().exact().is_some() || reply.headers().contains_key(header::CONTENT_ENCODING);
        let place = place.filter(|_| ends);
        Ok(reply.map(|body| TrackedBody::new(body, in_progress, place, memory)))
    }
}
