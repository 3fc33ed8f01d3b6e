//! Serves one request of a connection: says what is known of it when its head is read, and calls the API.

use std::net::IpAddr;
use std::sync::Arc;
use std::time::Duration;

use axum::body::{Body, Bytes, HttpBody as _};
use axum::http::{HeaderValue, Method, Request, Response, StatusCode, Version, header};
use futures::future::BoxFuture;
use hyper::body::Incoming;
use ipnet::IpNet;
use parking_lot::Mutex;
use tokio::sync::watch;

use super::bodies::{RequestInProgress, SharedBody, TrackedBody, discard};
use super::proxies;
use super::{ConnectionActivity, OwnHosts};
use crate::admission::{PoolError, UnderWay};

/// A request whose head has been read. The API makes its context of it.
#[derive(Clone, Copy, Debug)]
pub struct Arrival {
    /// The address of the client.
    pub address: IpAddr,
    /// How long the body may take to arrive.
    pub body_time: Duration,
    /// Why it is refused before it reaches a handler, if so.
    pub refusal: Option<Refusal>,
    /// Whether it came by a spare connection, which is there for the health of the server.
    pub spare: bool,
}

/// Why a request is refused before it reaches a handler.
#[derive(Clone, Copy, Debug)]
pub enum Refusal {
    /// The server has no capacity for it.
    Full(PoolError),
    /// Its head can be read in more than one way.
    Ambiguous(&'static str),
    /// It comes by a foreign name, or from a page of another site.
    Foreign(&'static str),
}

/// What answers requests.
pub trait Answer: Send + Sync + 'static {
    /// The reply to a request, with what it holds until its last byte has been read.
    fn answer(&self, arrival: Arrival, request: Request<Body>) -> BoxFuture<'_, (Response<Body>, UnderWay)>;
}

/// What serves the requests of all connections.
pub struct Service {
    /// What answers them.
    pub api: Box<dyn Answer>,
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
        let request = Request::from_parts(head, Body::new(body.clone()));
        let fault = ambiguity(&request);
        // A proxy may see the end of the chunks elsewhere.
        let mut last = fault.is_some() || request.headers().contains_key(header::TRANSFER_ENCODING);
        // A client that is not asked for its body sends none.
        let mut readable = fault.is_none() && !spare && !request.headers().contains_key(header::EXPECT);
        let with_body = matches!(*request.method(), Method::POST | Method::PATCH | Method::PUT);
        if readable && !with_body && !body.is_end_stream() {
            // Before the request holds anything. A body that does not arrive in time is not waited for again.
            readable = discard(body.clone()).await;
        }
        let foreign = || self.hosts.as_ref().and_then(|hosts| hosts.refuse(&request)).map(Refusal::Foreign);
        let refusal = fault.map(Refusal::Ambiguous).or_else(foreign);
        let address = proxies::client(peer, request.headers(), &self.proxies);
        let arrival = Arrival { address, body_time: self.body_time, refusal, spare };
        let (mut reply, under_way) = self.api.answer(arrival, request).await;
        // The next request of the connection begins after the body.
        if !body.is_end_stream() {
            readable &= reply.status() != StatusCode::REQUEST_TIMEOUT && !*self.stopping.borrow();
            last |= !readable || !discard(body).await;
        }
        if last {
            reply.headers_mut().insert(header::CONNECTION, HeaderValue::from_static("close"));
        }
        if under_way.admission().memory.class().is_some() {
            in_progress.0.begin_large_reply();
        }
        Ok(reply.map(|body| TrackedBody { body, under_way, rest: Bytes::new(), _in_progress: in_progress }))
    }
}

/// What can be understood in more than one way in a head that can be read in one, if anything.
fn ambiguity<B>(request: &Request<B>) -> Option<&'static str> {
    let headers = request.headers();
    if request.version() == Version::HTTP_11 && !headers.contains_key(header::HOST) {
        return Some("the head names no host");
    }
    if headers.len() == headers.keys_len() {
        return None;
    }
    let faults = [
        ("host", "the head names more than one host"),
        ("content-type", "the head has more than one Content-Type"),
        ("idempotency-key", "the head has more than one Idempotency-Key"),
        ("if-match", "the head has more than one If-Match"),
        ("last-event-id", "the head has more than one Last-Event-ID"),
        ("origin", "the head has more than one Origin"),
    ];
    let is_repeated = |name: &str| headers.get_all(name).iter().nth(1).is_some();
    faults.into_iter().find(|(name, _)| is_repeated(name)).map(|(_, fault)| fault)
}
