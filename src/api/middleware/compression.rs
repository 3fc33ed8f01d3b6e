//! Compression of replies by gzip or zstd, as `Accept-Encoding` says. The tag of a compressed reply is weak: it has the
//! version of the plain reply, and other bytes (RFC 9110, 8.8.1).

use std::sync::Arc;

use axum::body::{Body, HttpBody as _};
use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::response::{IntoResponse as _, Response};
use tower::{ServiceExt as _, service_fn};
use tower_http::CompressionLevel;
use tower_http::compression::Compression;
use tower_http::compression::predicate::SizeAbove;

use crate::admission::{Pool, Reservation};
use crate::api::accept::list_members;
use crate::api::formats::Format;
use crate::api::problem::{self, Problem};

/// What is compressed; event streams must not wait for more to come, and PNG is packed already.
const COMPRESSED: [&str; 7] = [
    problem::MEDIA_TYPE,
    Format::Columns.media_type(),
    Format::Rows.media_type(),
    Format::Csv.media_type(),
    Format::Ndjson.media_type(),
    Format::Arrow.media_type(),
    Format::Svg.media_type(),
];
/// Bytes below which compression is not worth its time.
const SMALLEST: u64 = 1024;
/// Bytes that an encoder takes until its reply is sent: zstd at its fastest has a window of 512 KiB, held twice, and
/// tables.
const ENCODER: usize = 2 * 1024 * 1024;

/// The beginning of a weak tag.
const WEAK: &str = "W/";

/// What the client of a request accepts and has.
pub struct Client {
    /// The lines of `Accept-Encoding`.
    accepted: Vec<HeaderValue>,
    /// Whether it has a reply with a weak tag.
    has_weak_tag: bool,
}

impl Client {
    /// The client of a request with these headers.
    pub fn of(headers: &HeaderMap) -> Client {
        let accepted = headers.get_all(header::ACCEPT_ENCODING).iter().cloned().collect();
        let has_weak_tag = list_members(headers, "if-none-match").any(|tag| tag.trim().starts_with(WEAK));
        Client { accepted, has_weak_tag }
    }
}

/// Compresses a reply as its client accepts it, if that is worth its time and there is memory for it. A compressed
/// reply gets a weak tag.
pub async fn compress(mut response: Response, client: Client, pool: &Pool) -> Response {
    if client.has_weak_tag && response.status() == StatusCode::NOT_MODIFIED {
        // A cache refreshes a reply with a weak tag by another weak one.
        vary(&mut response);
        weaken_tag(&mut response);
    }
    if !is_worthwhile(&response) {
        return response;
    }
    vary(&mut response);
    if client.accepted.is_empty() {
        return response;
    }
    let Some(room) = pool.try_reserve(ENCODER) else { return response };
    // This is still the only handle.
    let held = response.extensions_mut().remove::<Arc<Reservation>>().and_then(Arc::into_inner);
    let mut held = held.unwrap_or_default();
    held.add(room);
    response.extensions_mut().insert(Arc::new(held));
    encode(response, client.accepted).await
}

/// The reply in the coding that suits `accepted` best.
async fn encode(response: Response, accepted: Vec<HeaderValue>) -> Response {
    let status = response.status();
    let mut request = axum::http::Request::new(());
    request.headers_mut().extend(accepted.into_iter().map(|line| (header::ACCEPT_ENCODING, line)));
    let mut response = Some(response);
    let reply = service_fn(move |_| std::future::ready(response.take().ok_or(())));
    let coded = Compression::new(reply).quality(CompressionLevel::Fastest).compress_when(SizeAbove::new(0));
    let Ok(mut response) = coded.oneshot(request).await.map(|response| response.map(Body::new)) else {
        return Problem::internal("a reply was compressed twice").into_response();
    };
    // The library refuses a client that accepts no coding that there is, but the work is done: it gets the reply as it
    // is.
    *response.status_mut() = status;
    if response.headers().contains_key(header::CONTENT_ENCODING) {
        weaken_tag(&mut response);
    }
    response
}

fn is_worthwhile(response: &Response) -> bool {
    let kind = response.headers().get(header::CONTENT_TYPE).map(HeaderValue::as_bytes);
    response.body().size_hint().exact().is_some_and(|size| size >= SMALLEST)
        && kind.is_some_and(|kind| COMPRESSED.iter().any(|known| known.as_bytes() == kind))
        && !response.headers().contains_key(header::CONTENT_ENCODING)
}

fn vary(response: &mut Response) {
    let coding = HeaderValue::from_static("accept-encoding");
    if !response.headers().get_all(header::VARY).iter().any(|field| field == coding) {
        response.headers_mut().append(header::VARY, coding);
    }
}

fn weaken_tag(response: &mut Response) {
    let tag = response.headers().get(header::ETAG).and_then(|tag| tag.to_str().ok());
    let strong = tag.filter(|tag| !tag.starts_with(WEAK)).map(|tag| format!("{WEAK}{tag}"));
    if let Some(weak) = strong.and_then(|tag| HeaderValue::try_from(tag).ok()) {
        response.headers_mut().insert(header::ETAG, weak);
    }
}
