//! Replies: JSON bodies and versions.

use axum::body::Body;
use axum::http::{HeaderMap, HeaderName, HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};

use crate::otlp;
use crate::store::Reply;
use stickslip_compute::formats;

use super::accept::list_members;
use super::problem::Problem;

/// Number of headers of a finished reply, so that the map need not grow step by step.
const HEADERS: usize = 12;

/// 200 with a JSON body.
pub fn json(body: Vec<u8>) -> Response {
    let mut response = Response::new(Body::from(body));
    let headers = response.headers_mut();
    headers.reserve(HEADERS);
    headers.insert(header::CONTENT_TYPE, HeaderValue::from_static("application/json"));
    response
}

/// 200 with a JSON body that belongs to a sequence of its contact.
pub fn at_sequence(sequence: u64, body: Vec<u8>) -> Response {
    tagged(json(body), &format!("\"{sequence}\""))
}

/// A reply with its version as `ETag`.
pub fn tagged(response: Response, tag: &str) -> Response {
    with_header(response, header::ETAG, tag)
}

/// A reply with one more header, if its value is one that headers can have.
pub fn with_header(mut response: Response, name: HeaderName, value: &str) -> Response {
    if let Ok(value) = HeaderValue::from_str(value) {
        response.headers_mut().insert(name, value);
    }
    response
}

/// Whether the client already has this version, according to `If-None-Match`.
pub fn is_current(headers: &HeaderMap, tag: &str) -> bool {
    let mut known = list_members(headers, "if-none-match").map(str::trim);
    // Weakly: the versions are the same, whatever the encodings.
    let tag = tag.trim_start_matches("W/");
    known.any(|known| known == "*" || known.trim_start_matches("W/") == tag)
}

/// 200 with a document as JSON and its version, or 304 if the client already has that.
///
/// # Errors
/// As [`written`].
pub fn versioned(headers: &HeaderMap, tag: &str, document: &impl serde::Serialize) -> Result<Response, Problem> {
    if is_current(headers, tag) {
        return Ok(not_modified(tag));
    }
    Ok(tagged(json(written(document)?), tag))
}

/// 304: the client already has this version.
pub fn not_modified(tag: &str) -> Response {
    let mut response = StatusCode::NOT_MODIFIED.into_response();
    response.headers_mut().insert(header::VARY, HeaderValue::from_static("accept"));
    tagged(response, tag)
}

/// The reply to a change: 201 with the path of the new resource, or 200.
pub fn of_change(reply: Reply) -> Response {
    let response = at_sequence(reply.sequence, reply.body);
    match reply.created {
        Some(id) => {
            (StatusCode::CREATED, with_header(response, header::LOCATION, &format!("/contacts/{id}"))).into_response()
        }
        None => response,
    }
}

/// A value as JSON.
///
/// # Errors
/// [`Problem::internal`] if it cannot be written, which is a fault of the service.
pub fn written(value: &impl serde::Serialize) -> Result<Vec<u8>, Problem> {
    Ok(otlp::part!("write").in_scope(|| formats::json(formats::CAPACITY, value))?)
}
