//! The context of a request: made once, when its head has been read, and passed on to whatever serves it.

use std::net::IpAddr;
use std::sync::Arc;
use std::time::Duration;

use axum::extract::{FromRequestParts, Request};
use axum::http::request::Parts;
use axum::http::{HeaderMap, HeaderName, HeaderValue, Method};
use tokio::sync::watch;
use tower_http::cors::CorsLayer;
use uuid::Uuid;

use super::facts::Route;
use super::middleware::access_control;
use super::problem::Problem;
use super::request_limits::REQUEST_ID_LENGTH;
use super::request_metrics::{EndpointMeters, RequestMetrics};
use super::state::App;
use crate::access::{Holder, Keys};
use crate::admission::{Admission, Client, Deadline, Pool, PoolError, Quota, UnderWay};
use crate::api;
use crate::server::connections::{Arrival, Refusal};
use stickslip_compute::Nanoseconds;

/// The header with the identifier of a request, both ways.
pub const REQUEST_ID: HeaderName = HeaderName::from_static("x-request-id");

/// Paths that are answered even if the server is busy.
const ALWAYS_ANSWERED: [&str; 3] = ["/healthz", "/readyz", "/metrics"];

/// What all contexts are made of.
pub struct Reception {
    /// The keys in force; if there are none, everybody has access and clients are their addresses.
    pub keys: Option<watch::Receiver<Arc<Keys>>>,
    /// The meters of all endpoints.
    pub metrics: Arc<RequestMetrics>,
    /// Whether requests that are not done are refused.
    pub stops: watch::Receiver<bool>,
    /// What answers pages of other origins, if any may call.
    pub cross_origin: Option<CorsLayer>,
    /// What handlers share.
    pub app: Arc<App>,
}

/// Who asks, what was admitted, and what counts it.
pub struct RequestContext {
    /// Its identifier, for the log and the client.
    pub id: HeaderValue,
    /// The address of the client.
    pub address: IpAddr,
    /// The holder of its key, if it presented one that allows this.
    pub holder: Option<Arc<Holder>>,
    /// The meters of its route.
    pub meters: Arc<EndpointMeters>,
    /// The meters of all routes, for the page that shows them.
    pub metrics: Arc<RequestMetrics>,
    /// How long its body may take to arrive.
    pub body_time: Duration,
    /// What it holds, and its deadline.
    pub admission: Arc<Admission>,
    /// Why it is not served, if so.
    pub refusal: Option<Problem>,
    /// Whether it needs a permit before its handler: one with a body gets it once that has arrived.
    pub waits_at_door: bool,
    pool: Pool,
}

impl RequestContext {
    /// The context of a request to a route, with what tells the work for it to end.
    pub fn of(
        reception: &Reception,
        arrival: Arrival,
        request: &Request,
        route: Option<&Route>,
    ) -> (Arc<RequestContext>, UnderWay) {
        let (method, headers) = (request.method(), request.headers());
        let Arrival { address, body_time, refusal, spare } = arrival;
        let always = ALWAYS_ANSWERED.contains(&request.uri().path());
        let known = match &reception.keys {
            Some(keys) => access_control::identify(&keys.borrow(), headers, api::need(method, route)),
            None => Ok(None),
        };
        let (holder, unknown) = match known {
            Ok(holder) => (holder, None),
            Err(problem) => (None, Some(problem)),
        };
        let client = match &holder {
            Some(holder) => Client::Tenant(holder.tenant.clone()),
            None => Client::of_address(address),
        };
        let mut refusal = refusal.map(Problem::from);
        if spare && !always {
            refusal = refusal.or_else(|| Some(Refusal::Full(PoolError::Busy).into()));
        }
        refusal = refusal.or(unknown);
        let counts = refusal.is_none() && !always && (reception.keys.is_none() || holder.is_some());
        let share = counts.then(|| reception.app.pool.share_for(Quota::Requests, client.clone())).transpose();
        let share = share.unwrap_or_else(|exceeded| {
            refusal = Some(exceeded.into());
            None
        });
        let under_way = Admission::begin(&reception.app.pool, client, share);
        let context = RequestContext {
            id: request_id(headers),
            address,
            holder,
            meters: reception.metrics.of_request(route.map(|route| &*route.path), method),
            metrics: Arc::clone(&reception.metrics),
            body_time,
            admission: Arc::clone(under_way.admission()),
            refusal,
            waits_at_door: !always && !matches!(*method, Method::POST | Method::PATCH | Method::PUT),
            pool: reception.app.pool.clone(),
        };
        (Arc::new(context), under_way)
    }

    /// The limit of all work for this request.
    pub fn deadline(&self) -> &Deadline {
        &self.admission.deadline
    }

    /// Takes the memory for what comes next, in place of what it has.
    ///
    /// # Errors
    /// A [`Problem`] if this much is not available.
    pub async fn reserve(&self, bytes: usize) -> Result<(), Problem> {
        let Admission { client, memory, .. } = &*self.admission;
        Ok(self.pool.resize_for(client, &mut memory.clone(), bytes).await?)
    }

    /// Runs work of this cost, which asks the deadline of the request whether to go on.
    ///
    /// # Errors
    /// A [`Problem`] if no thread became free in time, or if the work panicked.
    pub async fn run<T: Send + 'static>(
        &self,
        cost: Nanoseconds,
        work: impl FnOnce(&Deadline) -> T + Send + 'static,
    ) -> Result<T, Problem> {
        let stop = self.deadline().clone();
        Ok(self.pool.run(cost, move || work(&stop)).await?)
    }
}

/// The context of the request, as a handler takes it.
pub struct Context(pub Arc<RequestContext>);

impl FromRequestParts<Arc<App>> for Context {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, _: &Arc<App>) -> Result<Context, Problem> {
        let context = parts.extensions.get::<Arc<RequestContext>>().cloned();
        context.map(Context).ok_or_else(|| Problem::internal("a request came without its context"))
    }
}

/// The identifier of the request with these headers: its own if that is printable and not too long, else a new one.
fn request_id(headers: &HeaderMap) -> HeaderValue {
    let sound = |id: &&HeaderValue| {
        (1..=REQUEST_ID_LENGTH).contains(&id.len()) && id.as_bytes().iter().all(u8::is_ascii_graphic)
    };
    headers.get(REQUEST_ID).filter(sound).cloned().unwrap_or_else(|| {
        let mut text = Uuid::encode_buffer();
        HeaderValue::from_str(Uuid::now_v7().hyphenated().encode_lower(&mut text))
            .unwrap_or(HeaderValue::from_static("-"))
    })
}
