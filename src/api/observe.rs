//! Around every request: an identifier, one line in the log, and the document of a problem.

use std::time::Instant;

use axum::body::Body;
use axum::extract::{MatchedPath, Request};
use axum::http::{HeaderName, HeaderValue, StatusCode, header};
use axum::middleware::Next;
use axum::response::Response;
use uuid::Uuid;

use super::problem::{Kind, MEDIA_TYPE, Problem};
use super::{headers, limits};

/// The header that carries a request's identifier, both ways.
pub const REQUEST_ID: HeaderName = HeaderName::from_static("x-request-id");

/// Serves a request, and sees to all that is common to every reply.
pub async fn observe(request: Request, next: Next) -> Response {
    let start = Instant::now();
    let id = request_id(&request);
    let method = request.method().clone();
    // The route rather than the path: it holds no identifier, and cannot be made up by clients.
    let route = request.extensions().get::<MatchedPath>().cloned();
    let mut response = next.run(request).await;

    let status = response.status();
    let problem = response.extensions_mut().remove::<Problem>().or_else(|| foreign(&response));
    let code = problem.as_ref().map(Problem::code);
    let cause = problem.as_ref().and_then(Problem::cause).map(str::to_owned);
    if let Some(problem) = problem {
        response = dressed(response, problem, &id);
    }
    let page = route.as_ref().is_some_and(|route| route.as_str().starts_with("/docs"));
    headers::protect(response.headers_mut(), page);
    if let Ok(value) = HeaderValue::from_str(&id) {
        response.headers_mut().insert(REQUEST_ID, value);
    }

    let route = route.as_ref().map_or("none", MatchedPath::as_str);
    let (request_id, status) = (id.as_str(), status.as_u16());
    let duration_ms = start.elapsed().as_secs_f64() * 1e3;
    if status >= 500 {
        tracing::error!(request_id, %method, route, status, duration_ms, code, cause, "request failed");
    } else {
        tracing::info!(request_id, %method, route, status, duration_ms, code, "request");
    }
    response
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
    Some(Problem::new(kind, kind.parts().2))
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
