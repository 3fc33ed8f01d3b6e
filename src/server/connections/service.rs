//! Serves one request of a connection: acquires a permit, calls the router, and returns a reply that releases it.

use std::net::IpAddr;
use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use axum::body::{Body, Bytes, HttpBody as _};
use axum::http::{HeaderValue, Method, Request, Response, StatusCode, Version, header};
use hyper::body::Incoming;
use ipnet::IpNet;
use parking_lot::Mutex;
use tokio::sync::watch;
use tower_service::Service as _;

use super::bodies::{RequestInProgress, SharedBody, TrackedBody, discard};
use super::proxies;
use super::{ConnectionActivity, OwnHosts};
use crate::admission::{Client, Pool, PoolError, Quota, Reservation};

/// Paths that are answered even if the server is busy.
const ALWAYS_ANSWERED: [&str; 3] = ["/healthz", "/readyz", "/metrics"];

/// From whom a request comes.
#[derive(Clone, Copy, Debug)]
pub struct RequestClient {
    /// The address of the client.
    pub address: IpAddr,
    /// How long the body may take to arrive.
    pub body_time: Duration,
}

/// Why a request is refused before it reaches a handler.
#[derive(Clone, Copy, Debug)]
pub enum Refusal {
    /// The server has no capacity for it.
    Full(PoolError),
    /// Its head can be read in more than one way.
    Ambiguous(&'static str),
    /// The server stops before there is capacity for it.
    Stopping,
    /// It comes by a foreign name, or from a page of another site.
    Foreign(&'static str),
}

/// What serves the requests of all connections.
pub struct Service {
    /// All routes, which answer a request with a [`Refusal`] in place of its handler.
    pub router: Router,
    /// Where requests get their places.
    pub pool: Pool,
    /// Whether clients are distinguished by their addresses: where there are no keys.
    pub by_address: bool,
    /// How long a body may take to arrive.
    pub body_time: Duration,
    /// By which names it may be called; any if none.
    pub hosts: Option<OwnHosts>,
    /// The proxies that are believed who their client is.
    pub proxies: Arc<[IpNet]>,
    /// True once requests that are not done are refused: the server has no more time.
    pub stopping: watch::Sender<bool>,
}

impl Service {
    /// Serves a request; on a spare connection only those for the health of the server.
    ///
    /// # Errors
    /// If the request arrived while its connection was being closed to make room.
    pub async fn serve(
        self: Arc<Self>,
        activity: Arc<ConnectionActivity>,
        spare: bool,
        peer: IpAddr,
        request: Request<Incoming>,
    ) -> Result<Response<TrackedBody>, &'static str> {
        if !activity.begin_request() {
            return Err("closed to make room");
        }
        let in_progress = RequestInProgress(activity);
        let (head, body) = request.into_parts();
        let body = SharedBody(Arc::new(Mutex::new(body)));
        let mut request = Request::from_parts(head, Body::new(body.clone()));
        let address = proxies::client(peer, request.headers(), &self.proxies);
        request.extensions_mut().insert(RequestClient { address, body_time: self.body_time });
        let client = Client::of_address(address);
        let fault = in_progress.0.head_fault().or_else(|| ambiguity(&request));
        // A proxy may see the end of the chunks elsewhere, and what follows them has not been inspected.
        let mut last = fault.is_some() || request.headers().contains_key(header::TRANSFER_ENCODING);
        // Of a head that can be read in two ways nobody knows where the body ends. A client that is not asked for its
        // body sends none.
        let readable = fault.is_none() && !spare && !request.headers().contains_key(header::EXPECT);
        let always = ALWAYS_ANSWERED.contains(&request.uri().path());
        let share = || client.within(|| self.pool.share_of(Quota::Requests));
        let share = (self.by_address && !always).then(share).transpose();
        let permit = if let Some(fault) = fault {
            Err(Refusal::Ambiguous(fault))
        } else if let Some(why) = self.hosts.as_ref().and_then(|hosts| hosts.refuse(&request)) {
            Err(Refusal::Foreign(why))
        } else if always {
            Ok(None)
        } else if let Err(exceeded) = share {
            Err(Refusal::Full(exceeded))
        } else if spare {
            Err(Refusal::Full(PoolError::Busy))
        } else if request.method() == Method::POST {
            // It acquires its permit once its body has arrived.
            Ok(None)
        } else {
            let mut stopping = self.stopping.subscribe();
            tokio::select! {
                biased;
                permit = self.pool.admit_request() => permit.map(Some).map_err(Refusal::Full),
                _ = stopping.wait_for(|stopping| *stopping) => Err(Refusal::Stopping),
            }
        };
        let permit = permit.unwrap_or_else(|refusal| {
            request.extensions_mut().insert(refusal);
            None
        });
        let Ok(mut reply) = client.clone().serve(self.router.clone().call(request)).await;
        // A body that took too long is not waited for again.
        let readable = readable && reply.status() != StatusCode::REQUEST_TIMEOUT;
        // The next request of the connection begins after the body.
        if !body.is_end_stream() {
            last |= !readable || !discard(body).await;
        }
        if last {
            reply.headers_mut().insert(header::CONNECTION, HeaderValue::from_static("close"));
        }
        // That of the key, if there is one.
        let client = reply.extensions_mut().remove::<Client>().unwrap_or(client);
        let memory = reply.extensions_mut().remove::<Arc<Reservation>>();
        // An endless stream has a limit of its own and occupies no solver. A compressed reply ends, but has no length.
        let ends = reply.body().size_hint().exact().is_some() || reply.headers().contains_key(header::CONTENT_ENCODING);
        let held = (in_progress, permit.filter(|_| ends), memory);
        Ok(reply.map(|body| TrackedBody { body, client, rest: Bytes::new(), _held: held }))
    }
}

/// What can be understood in more than one way in a head that can be read in one, if anything.
fn ambiguity<B>(request: &Request<B>) -> Option<&'static str> {
    if request.version() == Version::HTTP_11 && !request.headers().contains_key(header::HOST) {
        return Some("the head names no host");
    }
    let faults = [
        ("host", "the head names more than one host"),
        ("content-type", "the head has more than one Content-Type"),
        ("idempotency-key", "the head has more than one Idempotency-Key"),
        ("origin", "the head has more than one Origin"),
    ];
    let is_repeated = |name: &str| request.headers().get_all(name).iter().nth(1).is_some();
    faults.into_iter().find(|(name, _)| is_repeated(name)).map(|(_, fault)| fault)
}
