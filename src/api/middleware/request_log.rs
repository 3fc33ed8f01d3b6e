//! Around every request: one line in the log, one count, one span, and the document of a problem. The line of a change
//! says who made it.

use std::net::IpAddr;
use std::sync::Arc;
use std::time::Instant;

use axum::body::Body;
use axum::extract::{MatchedPath, Request, State};
use axum::http::{HeaderMap, HeaderName, HeaderValue, Method, StatusCode, header};
use axum::middleware::Next;
use axum::response::{IntoResponse as _, Response};
use stickslip_wire::ProblemDocument;
use tokio::sync::watch;
use tracing::field::{Empty, display};
use tracing::{Instrument as _, Span, info_span};
use tracing_opentelemetry::OpenTelemetrySpanExt as _;
use uuid::Uuid;

use crate::access::Role;
use crate::admission::Pool;
use crate::api;
use crate::api::middleware::access_control::Caller;
use crate::api::middleware::{compression, security_headers};
use crate::api::problem::{Code, MEDIA_TYPE, Problem};
use crate::api::request_limits;
use crate::api::request_metrics::{ABANDONED, Endpoint, NONE, RequestMetrics};
use crate::api::resources::page;
use crate::metrics::Counted;
use crate::otlp;
use crate::server::RequestClient;
use crate::server::connections::Refusal;

/// The header with the identifier of a request, both ways.
pub const REQUEST_ID: HeaderName = HeaderName::from_static("x-request-id");

/// A request under way. If it is dropped before it is answered, its client has left.
struct RequestGuard<'a> {
    start: Instant,
    id: &'a str,
    /// What the client says that the request is a part of, for traces.
    traceparent: Option<&'a str>,
    method: &'a Method,
    route: Option<&'a str>,
    client: Option<IpAddr>,
    caller: Caller,
    /// The contact that it would change.
    contact: Option<Uuid>,
    metrics: &'a RequestMetrics,
    endpoint: Endpoint<'a>,
    span: Span,
    outcome: Outcome,
}

/// How a request has ended.
struct Outcome {
    status: u16,
    code: Option<&'static str>,
    /// Of a fault, which the client does not see.
    cause: Option<String>,
}

/// What all requests share: their metrics, the pool, and whether those that are not done are refused.
pub type Observed = (Arc<RequestMetrics>, Pool, watch::Receiver<bool>);

/// Logs a request and compresses its reply: one layer, because each such layer puts the request and its answer into a
/// box.
pub async fn observe(State((metrics, pool, stops)): State<Observed>, request: Request, next: Next) -> Response {
    let client = compression::Client::of(request.headers());
    let response = log_request(&metrics, stops, request, next).await;
    compression::compress(response, client, &pool).await
}

/// Serves a request, and adds what is common to every reply.
async fn log_request(
    metrics: &Arc<RequestMetrics>,
    mut stops: watch::Receiver<bool>,
    mut request: Request,
    next: Next,
) -> Response {
    let start = Instant::now();
    let request_id = request_id(request.headers());
    let id = request_id.to_str().unwrap_or_default();
    let method = request.method().clone();
    let part_of = request.headers().get("traceparent");
    let traceparent = part_of.filter(|value| value.len() <= request_limits::REQUEST_ID_LENGTH).cloned();
    // The route rather than the path: it holds no identifier, and cannot be made up by clients.
    let route = request.extensions().get::<MatchedPath>().cloned();
    let route = route.as_ref().map(MatchedPath::as_str);
    if route == Some("/metrics") {
        request.extensions_mut().insert(Arc::clone(metrics));
    }
    let endpoint = metrics.endpoint(route, &method);
    let in_flight = metrics.in_flight(endpoint);
    let _in_flight = Counted::by(&in_flight);
    let changes = !matches!(method, Method::GET | Method::HEAD | Method::OPTIONS);
    let mut guard = RequestGuard {
        start,
        id,
        traceparent: traceparent.as_ref().and_then(|value| value.to_str().ok()),
        method: &method,
        route,
        client: request.extensions().get::<RequestClient>().map(|client| client.address),
        caller: Caller::default(),
        contact: contact_in(request.uri().path()).filter(|_| changes),
        metrics,
        endpoint,
        span: span(&request, route.unwrap_or(NONE), id),
        outcome: Outcome { status: ABANDONED, code: None, cause: None },
    };
    request.extensions_mut().insert(Caller::clone(&guard.caller));
    let span = guard.span.clone();
    let answer = async {
        match request.extensions_mut().remove::<Refusal>() {
            Some(refusal) => Problem::from(refusal).into_response(),
            None => next.run(request).instrument(span).await,
        }
    };
    let mut response = tokio::select! {
        biased;
        response = answer => response,
        // Otherwise the service has been stopped.
        Ok(_) = stops.wait_for(|stops| *stops) => {
            Problem::in_doubt(Code::Stopping, "the server stops before this request is done").into_response()
        }
    };
    let made = response.headers().get(header::LOCATION).and_then(|location| location.to_str().ok());
    guard.contact = made.and_then(contact_in).or(guard.contact);

    let problem = response.extensions_mut().remove::<Problem>().or_else(|| foreign(&response));
    let mut outcome = Outcome { status: response.status().as_u16(), code: None, cause: None };
    if let Some(problem) = problem {
        (outcome.code, outcome.cause) = (Some(problem.code().as_str()), problem.cause().map(str::to_owned));
        let changes = api::need(method.as_str(), route.unwrap_or_default()) == Some(Role::Write);
        let document = problem.document(id, changes);
        outcome.status = document.status;
        response = with_document(response, document);
    }
    let kind = match route {
        Some(page::PAGE | page::FILES) => security_headers::Kind::Page,
        Some(route) if route.starts_with("/docs") => security_headers::Kind::Docs,
        _ => security_headers::Kind::Data,
    };
    security_headers::protect(response.headers_mut(), &method, kind);
    guard.outcome = outcome;
    drop(guard);
    response.headers_mut().insert(REQUEST_ID, request_id);
    response
}

/// The identifier of the request with these headers: its own if that is printable and not too long, else a new one.
fn request_id(headers: &HeaderMap) -> HeaderValue {
    let sound = |id: &&HeaderValue| {
        (1..=request_limits::REQUEST_ID_LENGTH).contains(&id.len()) && id.as_bytes().iter().all(u8::is_ascii_graphic)
    };
    headers.get(REQUEST_ID).filter(sound).cloned().unwrap_or_else(|| {
        let mut text = Uuid::encode_buffer();
        HeaderValue::from_str(Uuid::now_v7().hyphenated().encode_lower(&mut text))
            .unwrap_or(HeaderValue::from_static("-"))
    })
}

fn contact_in(path: &str) -> Option<Uuid> {
    path.strip_prefix("/contacts/")?.split('/').next()?.parse().ok()
}

/// The span of a request, below that of its caller; its fields have the names that OpenTelemetry gives them.
fn span(request: &Request, route: &str, id: &str) -> Span {
    let method = request.method();
    let span = info_span!(
        target: otlp::SPANS,
        otlp::REQUEST,
        "otel.name" = format!("{method} {route}"),
        "otel.kind" = "server",
        "otel.status_code" = Empty,
        "otel.status_description" = Empty,
        "http.request.method" = %method,
        "http.route" = route,
        "http.response.status_code" = Empty,
        "error.type" = Empty,
        "stickslip.request_id" = id,
    );
    if !span.is_disabled()
        && let Some(parent) = otlp::parent(request.headers())
    {
        // It fails where there is no trace.
        let _ = span.set_parent(parent);
    }
    span
}

impl Drop for RequestGuard<'_> {
    fn drop(&mut self) {
        let RequestGuard { id: request_id, traceparent, method, client, contact, .. } = *self;
        let Outcome { status, code, ref cause } = self.outcome;
        let (time, cause) = (self.start.elapsed(), cause.as_deref());
        self.metrics.answered(self.endpoint, status, time);
        self.span.record("http.response.status_code", status);
        self.span.record("error.type", code);
        if status >= 500 {
            self.span.record("otel.status_code", "ERROR");
            self.span.record("otel.status_description", cause);
        }
        let (route, duration_ms) = (self.route.unwrap_or(NONE), time.as_secs_f64() * 1e3);
        let (client, contact) = (client.map(display), contact.map(display));
        let (key, tenant) = self.caller.get().map(|holder| (&*holder.name, holder.tenant.name())).unzip();
        /// The fields that all lines have, and more.
        macro_rules! line {
            ($level:ident, $($more:ident,)* $message:literal) => {
                tracing::$level!(
                    request_id, %method, route, status, duration_ms, client, key, tenant, contact, $($more,)*
                    traceparent, $message
                )
            };
        }
        match status {
            ABANDONED => line!(info, "the client disconnected"),
            500 => line!(error, code, cause, "request failed"),
            // An external fault, which may last and affect every request.
            501.. => line!(warn, code, cause, "request failed"),
            _ => line!(info, code, "request"),
        }
    }
}

/// The problem behind a refusal that does not come from our handlers but from the framework.
fn foreign(response: &Response) -> Option<Problem> {
    let status = response.status();
    let kind = match status {
        StatusCode::METHOD_NOT_ALLOWED => Code::MethodNotAllowed,
        StatusCode::NOT_FOUND => Code::NotFound,
        StatusCode::PAYLOAD_TOO_LARGE => Code::TooLarge,
        StatusCode::UNSUPPORTED_MEDIA_TYPE => Code::UnsupportedMediaType,
        _ if status.is_server_error() => return Some(Problem::internal(format!("the framework answered {status}"))),
        _ if status.is_client_error() => Code::InvalidInput,
        _ => return None,
    };
    Some(Problem::new(kind, kind.title()))
}

/// The response with the document as its body; other headers, such as `Allow`, stay.
fn with_document(response: Response, document: ProblemDocument) -> Response {
    let (mut parts, _) = response.into_parts();
    parts.headers.remove(header::CONTENT_LENGTH);
    parts.headers.insert(header::CONTENT_TYPE, HeaderValue::from_static(MEDIA_TYPE));
    parts.status = StatusCode::from_u16(document.status).unwrap_or(parts.status);
    Response::from_parts(parts, Body::from(serde_json::to_vec(&document).unwrap_or_default()))
}
