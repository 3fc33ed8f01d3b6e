//! Around every request: one line in the log, one count, one span, and the document of a problem. The line of a change
//! says who made it.

use std::convert::Infallible;
use std::future::ready;
use std::panic::AssertUnwindSafe;
use std::sync::Arc;
use std::time::Instant;

use axum::body::{Body, BodyDataStream, Bytes};
use axum::extract::Request;
use axum::http::{HeaderName, HeaderValue, Method, StatusCode, header};
use axum::response::{IntoResponse as _, Response};
use futures::stream::{self, PollNext};
use futures::{FutureExt as _, Stream, StreamExt as _};
use http_body::Body as _;
use stickslip_wire::{EndEvent, EndReason, ProblemDocument};
use tower::{Layer as _, ServiceExt as _, service_fn};
use tracing::field::{Empty, display};
use tracing::{Instrument as _, Span, info_span};
use uuid::Uuid;

use crate::access::Role;
use crate::admission::UnderWay;
use crate::api;
use crate::api::middleware::access_control::revoked;
use crate::api::middleware::{compression, security_headers};
use crate::api::problem::{Code, MEDIA_TYPE, Problem};
use crate::api::request_context::{REQUEST_ID, Reception, RequestContext};
use crate::api::request_limits;
use crate::api::request_metrics::{ABANDONED, NONE};
use crate::api::resources::{meta, page};
use crate::metrics::Counted;
use crate::otlp;
use crate::server::connections::Arrival;

/// What a request is a part of, as its client says (W3C Trace Context).
const TRACEPARENT: HeaderName = HeaderName::from_static("traceparent");

/// What a stream of events consists of.
type EventBytes = Result<Bytes, axum::Error>;

/// A request under way. If it is dropped before it is answered, its client has left.
struct RequestGuard<'a> {
    start: Instant,
    context: &'a RequestContext,
    /// What the client says that the request is a part of, for traces.
    traceparent: Option<&'a str>,
    method: &'a Method,
    route: Option<&'a str>,
    /// The contact that it would change.
    contact: Option<Uuid>,
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

/// Serves a request, from its head to the head of its reply: makes its context, has it admitted and answered, and adds
/// what is common to every reply. A function around the handlers: a layer would put the request and its answer into
/// boxes.
pub async fn serve(reception: &Reception, arrival: Arrival, mut request: Request) -> (Response, UnderWay) {
    let start = Instant::now();
    let found = api::route_of(request.uri().path());
    // For the log: it holds no identifier, and cannot be made up by clients.
    let route = found.map(|route| &*route.path);
    let (context, under_way) = RequestContext::of(reception, arrival, &request, found);
    let _in_flight = Counted::by(&context.meters.in_flight);
    let method = request.method().clone();
    let part_of = request.headers().get(TRACEPARENT);
    let traceparent = part_of.filter(|value| value.len() <= request_limits::REQUEST_ID_LENGTH).cloned();
    let accepted = compression::accepted(request.headers());
    let changes = !matches!(method, Method::GET | Method::HEAD | Method::OPTIONS);
    let mut guard = RequestGuard {
        start,
        context: &context,
        traceparent: traceparent.as_ref().and_then(|value| value.to_str().ok()),
        method: &method,
        route,
        contact: contact_in(request.uri().path()).filter(|_| changes),
        span: span(&request, route.unwrap_or(NONE), context.id.to_str().unwrap_or_default()),
        outcome: Outcome { status: ABANDONED, code: None, cause: None },
    };
    request.extensions_mut().insert(Arc::clone(&context));
    let mut stops = reception.stops.clone();
    if method == Method::HEAD {
        // Its body is taken away at the end, when all headers say what it would be.
        *request.method_mut() = Method::GET;
    }
    let answer =
        |request: Request| admitted(reception, &context, api::handled(Arc::clone(&reception.app), found, request));
    let answer = async {
        let Some(origins) = &reception.cross_origin else { return answer(request).await };
        // A preflight request is answered before keys are asked for: a browser asks whether it may send one.
        let answer = origins.layer(service_fn(|request: Request| answer(request).map(Ok::<_, Infallible>)));
        let Ok(answered) = answer.oneshot(request).await;
        answered
    };
    let answer = AssertUnwindSafe(answer.instrument(guard.span.clone())).catch_unwind();
    let mut response = tokio::select! {
        biased;
        answered = answer => answered.unwrap_or_else(meta::panicked),
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
        let changes = api::need(&method, found) == Some(Role::Write);
        let document = problem.document(context.id.to_str().unwrap_or_default(), changes);
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
    response.headers_mut().insert(REQUEST_ID, context.id.clone());
    if context.admission.memory.class().is_some()
        && let Some(length) = response.body().size_hint().exact()
    {
        // What the reply was made of is gone. Its text may have grown by doubling.
        let kept = usize::try_from(length).unwrap_or(usize::MAX).saturating_mul(2);
        // Shrinking is never refused.
        let _ = context.reserve(kept).await;
    }
    response = compression::compress(response, accepted, &reception.app.pool, &context.admission).await;
    if method == Method::HEAD {
        if let Some(length) = response.body().size_hint().exact() {
            response.headers_mut().insert(header::CONTENT_LENGTH, length.into());
        }
        *response.body_mut() = Body::empty();
    }
    (response, under_way)
}

/// Serves a request that is not refused, once it has its permit; one with a body gets that when the body has arrived.
/// Events end with the key.
async fn admitted(reception: &Reception, context: &RequestContext, answer: impl Future<Output = Response>) -> Response {
    if let Some(problem) = &context.refusal {
        return problem.clone().into_response();
    }
    let admission = &context.admission;
    if context.waits_at_door
        && let Err(refused) = admission.admit(&reception.app.pool).await
    {
        return Problem::from(refused).into_response();
    }
    let response = Arc::clone(admission).serve(answer).await;
    let kind = response.headers().get(header::CONTENT_TYPE);
    if !kind.is_some_and(|kind| kind.as_bytes().starts_with(b"text/event-stream")) {
        return response;
    }
    admission.become_endless();
    let (Some(keys), Some(holder)) = (reception.keys.clone(), context.holder.clone()) else { return response };
    response.map(|body| Body::from_stream(until_revoked(body.into_data_stream(), revoked(keys, holder))))
}

/// Events, or their beginning and a last event `end` once the key of their client counts no longer.
fn until_revoked(events: BodyDataStream, revoked: impl Future<Output = ()>) -> impl Stream<Item = EventBytes> {
    let last = EndEvent { reason: EndReason::Revoked };
    let end = stream::once(async move {
        revoked.await;
        let data = serde_json::to_string(&last).map_err(axum::Error::new)?;
        Ok(Bytes::from(format!("event: end\ndata: {data}\n\n")))
    });
    let (events, end) = (events.map(Some).chain(stream::once(ready(None))), end.map(Some));
    // The end comes first, and nothing after it: both streams are over with their `None`.
    let both = stream::select_with_strategy(end.chain(stream::once(ready(None))), events, |()| PollNext::Left);
    both.take_while(|event| ready(event.is_some())).filter_map(ready)
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
    if !span.is_disabled() {
        otlp::set_parent(&span, request.headers());
    }
    span
}

impl Drop for RequestGuard<'_> {
    fn drop(&mut self) {
        let RequestGuard { context, traceparent, method, contact, .. } = *self;
        let Outcome { status, code, ref cause } = self.outcome;
        let (time, cause) = (self.start.elapsed(), cause.as_deref());
        context.meters.answered(status, time);
        self.span.record("http.response.status_code", status);
        self.span.record("error.type", code);
        if status >= 500 {
            self.span.record("otel.status_code", "ERROR");
            self.span.record("otel.status_description", cause);
        }
        let request_id = context.id.to_str().unwrap_or_default();
        let (route, duration_ms) = (self.route.unwrap_or(NONE), time.as_secs_f64() * 1e3);
        let (client, contact) = (display(context.address), contact.map(display));
        let (key, tenant) = context.holder.as_ref().map(|holder| (&*holder.name, holder.tenant.name())).unzip();
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
