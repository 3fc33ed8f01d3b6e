//! What a connection does with a request: a place for it, the router, and a reply that gives the place back.

use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use axum::body::{Body, HttpBody as _};
use axum::http::{HeaderValue, Method, Request, Response, header};
use hyper::body::Incoming;
use tower_service::Service as _;

use super::ConnectionActivity;
use super::bodies::{Busy, DeadlineBody, TrackedBody};
use crate::admission::{Pool, PoolError, Reservation};

/// Paths that are answered however busy the server is.
const ALWAYS: [&str; 3] = ["/healthz", "/readyz", "/metrics"];

/// The request came when the connection was being closed to make room.
#[derive(Debug, thiserror::Error)]
#[error("closed to make room")]
pub struct Closed;

/// Why a request does not come as far as a handler.
#[derive(Clone, Copy, Debug)]
pub enum Refusal {
    /// There is no room for it.
    Full(PoolError),
    /// Its head can be read in more than one way.
    Ambiguous(&'static str),
}

/// What serves the requests of all connections.
pub struct Service {
    /// Everything.
    pub router: Router,
    /// The answer to what there is no room for.
    pub refusals: Router,
    /// Who gives places.
    pub pool: Pool,
    /// How long a body may take.
    pub body_time: Duration,
}

impl Service {
    /// Serves a request of a connection; of a spare one, only if it asks whether the server is well.
    pub async fn serve(
        self: Arc<Self>,
        activity: Arc<ConnectionActivity>,
        spare: bool,
        request: Request<Incoming>,
    ) -> Result<Response<TrackedBody>, Closed> {
        if !activity.begin() {
            return Err(Closed);
        }
        let busy = Busy(activity);
        let mut request = request.map(|body| Body::new(DeadlineBody::new(body, self.body_time)));
        let fault = busy.0.fault();
        let place = if let Some(fault) = fault {
            Err(Refusal::Ambiguous(fault))
        } else if ALWAYS.contains(&request.uri().path()) {
            Ok(None)
        } else if spare {
            Err(Refusal::Full(PoolError::Busy))
        } else if request.method() == Method::POST {
            // It takes its place when its body is there.
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
        // A stream without an end has a bound of its own, and works on nothing. What is compressed has an end, and no length.
        let ends = reply.body().size_hint().exact().is_some() || reply.headers().contains_key(header::CONTENT_ENCODING);
        let place = place.filter(|_| ends);
        Ok(reply.map(|body| TrackedBody::new(body, busy, place, memory)))
    }
}
