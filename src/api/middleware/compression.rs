//! Compression of replies by gzip or zstd, as `Accept-Encoding` says: what may be compressed, and the tag that it has
//! then.

use std::sync::Arc;

use axum::body::{Body, HttpBody as _};
use axum::extract::Request;
use axum::http::{HeaderName, HeaderValue, StatusCode, header};
use axum::response::{IntoResponse as _, Response};
use tower::{ServiceExt as _, service_fn};
use tower_http::CompressionLevel;
use tower_http::compression::Compression;
use tower_http::compression::predicate::SizeAbove;

use crate::admission::{Pool, Reservation};
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
/// The codings, each with the suffix that it adds to an entity tag: a tag identifies bytes.
const CODINGS: [(&str, &str); 2] = [("gzip", "+gzip\""), ("zstd", "+zstd\"")];
/// The headers in which clients send tags.
const CONDITIONS: [HeaderName; 2] = [header::IF_MATCH, header::IF_NONE_MATCH];

/// What the client of a request accepts and has.
pub struct Client {
    /// The lines of `Accept-Encoding`.
    accepted: Vec<HeaderValue>,
    /// The tags that it sent, if one is that of a compressed reply.
    tags: Option<HeaderValue>,
}

impl Client {
    /// The client of a request, in which the tags of compressed replies become those of the plain ones.
    pub fn of(request: &mut Request) -> Client {
        let accepted = request.headers().get_all(header::ACCEPT_ENCODING).iter().cloned().collect();
        let mut tags = None;
        for name in CONDITIONS {
            if let Some(plain) = request.headers().get(&name).and_then(without_coding) {
                tags = request.headers_mut().insert(name, plain);
            }
        }
        Client { accepted, tags }
    }
}

/// Compresses a reply as its client accepts it, if that is worth its time and there is memory for it. A compressed
/// reply gets a tag of its own.
pub async fn compress(mut response: Response, client: Client, pool: &Pool) -> Response {
    if let Some(tags) = client.tags.filter(|_| response.status() == StatusCode::NOT_MODIFIED) {
        // The tag that the client sent, not that of a representation which it does not have.
        let tags = tags.to_str().unwrap_or_default();
        vary(&mut response);
        add_suffix(&mut response, |tag| tags.contains(tag));
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
    let held = response.extensions_mut().remove::<Arc<Reservation>>().and_then(Arc::into_inner).unwrap_or_default();
    response.extensions_mut().insert(Arc::new(held.with(room)));
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
    if let Some(coding) = response.headers().get(header::CONTENT_ENCODING).cloned() {
        let suffix = CODINGS.iter().find(|(name, _)| coding == name).map(|(_, suffix)| *suffix);
        add_suffix(&mut response, |tag| suffix.is_some_and(|suffix| tag.ends_with(suffix)));
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
    response.headers_mut().append(header::VARY, HeaderValue::from_static("accept-encoding"));
}

/// Gives the tag of a reply the first suffix of a coding with which it is `right`.
fn add_suffix(response: &mut Response, right: impl Fn(&str) -> bool) {
    let plain = response.headers().get(header::ETAG).and_then(|tag| tag.to_str().ok()?.strip_suffix('"'));
    let mut coded = CODINGS.iter().filter_map(|(_, suffix)| Some(format!("{}{suffix}", plain?)));
    if let Some(tag) = coded.find(|tag| right(tag)).and_then(|tag| HeaderValue::try_from(tag).ok()) {
        response.headers_mut().insert(header::ETAG, tag);
    }
}

/// A list of tags without the suffixes of codings; none if no tag has one.
fn without_coding(value: &HeaderValue) -> Option<HeaderValue> {
    let tags = value.to_str().ok().filter(|tags| CODINGS.iter().any(|(_, suffix)| tags.contains(suffix)))?;
    let plain = CODINGS.iter().fold(tags.to_owned(), |tags, (_, suffix)| tags.replace(suffix, "\""));
    HeaderValue::try_from(plain).ok()
}
