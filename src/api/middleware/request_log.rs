//! Around every request: an identifier, one line in the log, one count, and the document of a problem.

use std::panic::AssertUnwindSafe;
use std::sync::Arc;
use std::time::Instant;

use axum::body::Body;
use axum::extract::{MatchedPath, Request, State};
use axum::http::{HeaderName, HeaderValue, Method, StatusCode, header};
use axum::middleware::Next;
use axum::response::Response;
use futures::FutureExt as _;
use uuid::Uuid;

use crate::api::limits;
use crate::api::middleware::request_metrics::{ABANDONED, Endpoint, RequestMetrics};
use crate::api::middleware::security_headers;
use crate::api::problem::{Kind, MEDIA_TYPE, Problem};
use crate::api::resources::meta;
use crate::api::resources::metrics;
use crate::api::resources::page;

/// The header that carries a request's identifier, both ways.
pub const REQUEST_ID: HeaderName = HeaderName::from_static("x-request-id");

/// A request under way. If it is dropped before it is answered, its client has left.
struct RequestGuard<'a> {
    start: Instant,
    id: &'a str,
    /// What the client says that the request is a part of, for traces.
    traceparent: Option<&'a str>,
    method: &'a Method,
    route: Option<&'a str>,
    endpoint: &'a Endpoint,
    answered: bool,
}

/// Serves a request, and sees to all that is common to every reply.
pub async fn log_request(State(traffic): State<Arc<RequestMetrics>>, mut request: Request, next: Next) -> Response {
    let start = Instant::now();
    let id = request_id(&request);
    let method = request.method().clone();
    let traceparent =
        request.headers().get("traceparent").filter(|value| value.len() <= limits::REQUEST_ID_LENGTH).cloned();
    // The route rather than the path: it holds no identifier, and cannot be made up by clients.
    let route = request.extensions().get::<MatchedPath>().cloned();
    let route = route.as_ref().map(MatchedPath::as_str);
    if route == Some(metrics::ROUTE) {
        request.extensions_mut().insert(Arc::clone(&traffic));
    }
    let endpoint = traffic.endpoint(route, &method);
    let _in_flight = endpoint.in_flight.enter();
    let traceparent = traceparent.as_ref().and_then(|value| value.to_str().ok());
    let mut guard = RequestGuard { start, id: &id, traceparent, method: &method, route, endpoint, answered: false };
    let answer = AssertUnwindSafe(next.run(request)).catch_unwind().await;
    let mut response = answer.unwrap_or_else(meta::panicked);

    let problem = response.extensions_mut().remove::<Problem>().or_else(|| foreign(&response));
    let code = problem.as_ref().map(|problem| problem.code().as_str());
    let cause = problem.as_ref().and_then(Problem::cause).map(str::to_owned);
    if let Some(problem) = problem {
        response = dressed(response, problem, &id);
    }
    let kind = match route {
        Some("/" | page::FOLDER) => security_headers::Kind::Page,
        Some(route) if route.starts_with("/docs") => security_headers::Kind::Docs,
        _ => security_headers::Kind::Data,
    };
    security_headers::protect(response.headers_mut(), &method, kind);
    if let Ok(value) = HeaderValue::from_str(&id) {
        response.headers_mut().insert(REQUEST_ID, value);
    }
    guard.answer(response.status(), code, cause.as_deref());
    response
}

impl RequestGuard<'_> {
    fn answer(&mut self, status: StatusCode, code: Option<&str>, cause: Option<&str>) {
        self.answered = true;
        let time = self.start.elapsed();
        self.endpoint.answered(status.as_u16(), time);
        let RequestGuard { id: request_id, traceparent, method, .. } = *self;
        let (route, status, duration_ms) = (self.route.unwrap_or("none"), status.as_u16(), time.as_secs_f64() * 1e3);
        match status {
            500 => {
                tracing::error!(request_id, %method, route, status, duration_ms, code, cause, traceparent, "request failed")
            }
            // A fault of the surroundings, which may last, and come with every request.
            501.. => {
                tracing::warn!(request_id, %method, route, status, duration_ms, code, cause, traceparent, "request failed")
            }
            _ => tracing::info!(request_id, %method, route, status, duration_ms, code, traceparent, "request"),
        }
    }
}

impl Drop for RequestGuard<'_> {
    fn drop(&mut self) {
        if !self.answered {
            let RequestGuard { id: request_id, traceparent, method, .. } = *self;
            let time = self.start.elapsed();
            self.endpoint.answered(ABANDONED, time);
            let (route, duration_ms) = (self.route.unwrap_or("none"), time.as_secs_f64() * 1e3);
            tracing::info!(request_id, %method, route, status = ABANDONED, duration_ms, traceparent, "the client left");
        }
    }
}

/// The identifier that the client has given the request, or one of our own.
fn request_id(request: &Request) -> String {
    let given = request.headers().get(REQUEST_ID).and_then(|value| value.to_str().ok());
    let sound = |id: &&str| {
        (1..=limits::REQUEST_ID_LENGTH).contains(&id.len()) && id.bytes().all(|byte| byte.is_ascii_graphic())
    };
    given.filter(sound).map_or_else(|| Uuid::now_v7().to_string(), str::to_owned)
}

/// The problem behind a refusal that does not come from our handlers but from the framework.
fn foreign(response: &Response) -> Option<Problem> {
    let status = response.status();
    let kind = match status {
        StatusCode::METHOD_NOT_ALLOWED => Kind::MethodNotAllowed,
        StatusCode::NOT_FOUND => Kind::NotFound,
        StatusCode::PAYLOAD_TOO_LARGE => Kind::TooLarge,
        StatusCode::UNSUPPORTED_MEDIA_TYPE => Kind::UnsupportedMediaType,
        _ if status.is_server_error() => return Some(Problem::internal(format!("the framework answered {status}"))),
        _ if status.is_client_error() => Kind::InvalidInput,
        _ => return None,
    };
    Some(Problem::new(kind, kind.title()))
}

/// The response with the document as its body; other headers, such as `Allow`, stay.
fn dressed(response: Response, problem: Problem, id: &str) -> Response {
    let (mut parts, _) = response.into_parts();
    let document = problem.document(id);
    parts.headers.remove(header::CONTENT_LENGTH);
    parts.headers.insert(header::CONTENT_TYPE, HeaderValue::from_static(MEDIA_TYPE));
    parts.status = StatusCode::from_u16(document.status).unwrap_or(parts.status);
    Response::from_parts(parts, Body::from(serde_json::to_vec(&document).unwrap_or_default()))
}
