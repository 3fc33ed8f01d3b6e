//! What a connection does with a request: a place for it, the router, and a reply that gives the place back.

use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use axum::body::Body;
use axum::http::{Method, Request, Response};
use hyper::body::Incoming;
use tower_service::Service as _;

use super::Activity;
use super::bodies::{Busy, Timed, Watched};
use crate::simulation::{Pool, PoolError, Reservation};

/// Paths that are answered however busy the server is.
const ALWAYS: [&str; 3] = ["/healthz", "/readyz", "/metrics"];

/// The request came when the connection was being closed to make room.
#[derive(Debug, thiserror::Error)]
#[error("closed to make room")]
pub struct Closed;

/// What serves the requests of all connections.
#[derive(Clone)]
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
        mut self,
        activity: Arc<Activity>,
        spare: bool,
        request: Request<Incoming>,
    ) -> Result<Response<Watched>, Closed> {
        if !activity.begin() {
            return Err(Closed);
        }
        let busy = Busy(activity);
        let mut request = request.map(|body| Body::new(Timed::new(body, self.body_time)));
        let always = ALWAYS.contains(&request.uri().path());
        let place = if always {
            Ok(None)
        } else if spare {
            Err(PoolError::Busy)
        } else if request.method() == Method::POST {
            // It takes its place when its body is there.
            Ok(None)
        } else {
            self.pool.enter().await.map(Some)
        };
        let (reply, place) = match place {
            Ok(place) => (self.router.call(request).await, place),
            Err(refusal) => {
                request.extensions_mut().insert(refusal);
                (self.refusals.call(request).await, None)
            }
        };
        let Ok(mut reply) = reply;
        let memory = reply.extensions_mut().remove::<Arc<Reservation>>();
        Ok(reply.map(|body| Watched::new(body, busy, place, memory)))
    }
}
