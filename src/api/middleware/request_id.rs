//! The identifier of a request: the one that its client sent, or a generated one.

use axum::extract::Request;
use axum::http::{HeaderName, HeaderValue};
use tower_http::request_id::{MakeRequestId, RequestId};
use uuid::Uuid;

use crate::api::limits;

/// The header that carries it, both ways.
pub const REQUEST_ID: HeaderName = HeaderName::from_static("x-request-id");

/// Makes identifiers for requests that come without one.
#[derive(Clone, Copy)]
pub struct OwnId;

impl MakeRequestId for OwnId {
    fn make_request_id<B>(&mut self, _: &axum::http::Request<B>) -> Option<RequestId> {
        HeaderValue::try_from(Uuid::now_v7().to_string()).ok().map(RequestId::new)
    }
}

/// Removes from a request an identifier that is empty, too long, or not printable.
pub fn without_unsound(mut request: Request) -> Request {
    let sound = |id: &HeaderValue| {
        (1..=limits::REQUEST_ID_LENGTH).contains(&id.len()) && id.as_bytes().iter().all(u8::is_ascii_graphic)
    };
    if request.headers().get(REQUEST_ID).is_some_and(|id| !sound(id)) {
        request.headers_mut().remove(REQUEST_ID);
    }
    request
}
