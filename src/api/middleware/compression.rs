//! Compression of replies by gzip or zstd, as `Accept-Encoding` says: what may be compressed, and the tag that it has then.

use std::sync::Arc;

use axum::body::HttpBody as _;
use axum::extract::{Request, State};
use axum::http::{Extensions, HeaderMap, HeaderName, HeaderValue, StatusCode, Version, header};
use axum::middleware::Next;
use axum::response::Response;

use crate::admission::{Pool, Reservation};
use crate::api::formats::Format;
use crate::api::problem;

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
/// Bytes that an encoder takes until its reply is sent: zstd at its fastest has a window of 512 KiB, held twice, and tables.
const ENCODER: usize = 2 * 1024 * 1024;
/// The codings, each with the suffix that it adds to an entity tag: a tag identifies bytes.
const CODINGS: [(&str, &str); 2] = [("gzip", "+gzip\""), ("zstd", "+zstd\"")];
/// The headers in which clients send tags.
const CONDITIONS: [HeaderName; 2] = [header::IF_MATCH, header::IF_NONE_MATCH];

/// A reply to a client that accepts codings, as it was before compression.
#[derive(Clone, Copy)]
struct Offer {
    compress: bool,
    status: StatusCode,
}

/// Decides which replies are compressed, if there is memory for it. It is inside the layer that compresses.
pub async fn offer(State(pool): State<Pool>, request: Request, next: Next) -> Response {
    let accepts = request.headers().contains_key(header::ACCEPT_ENCODING);
    let mut response = next.run(request).await;
    let worthwhile = is_worthwhile(&response);
    if worthwhile {
        response.headers_mut().append(header::VARY, HeaderValue::from_static("accept-encoding"));
    }
    if accepts {
        let room = if worthwhile { pool.try_reserve(ENCODER) } else { None };
        let offer = Offer { compress: room.is_some(), status: response.status() };
        let extensions = response.extensions_mut();
        if let Some(room) = room {
            // This is still the only handle.
            let held = extensions.remove::<Arc<Reservation>>().and_then(Arc::into_inner).unwrap_or_default();
            extensions.insert(Arc::new(held.with(room)));
        }
        extensions.insert(offer);
    }
    response
}

fn is_worthwhile(response: &Response) -> bool {
    let kind = response.headers().get(header::CONTENT_TYPE).map(HeaderValue::as_bytes);
    kind.is_some_and(|kind| COMPRESSED.iter().any(|known| known.as_bytes() == kind))
        && !response.headers().contains_key(header::CONTENT_ENCODING)
        && response.body().size_hint().exact().is_some_and(|size| size >= SMALLEST)
}

/// Whether a reply has been offered for compression.
pub fn is_offered(_: StatusCode, _: Version, _: &HeaderMap, extensions: &Extensions) -> bool {
    extensions.get::<Offer>().is_some_and(|offer| offer.compress)
}

/// Gives compressed replies tags of their own, and maps those tags back in requests. It is outside the layer that
/// compresses.
pub async fn tag(mut request: Request, next: Next) -> Response {
    let given = request.headers().get(header::IF_NONE_MATCH).cloned();
    for name in CONDITIONS {
        if let Some(plain) = request.headers().get(&name).and_then(without_coding) {
            request.headers_mut().insert(name, plain);
        }
    }
    let mut response = next.run(request).await;
    let offer = response.extensions_mut().remove::<Offer>();
    if let Some(offer) = offer {
        // The layer refuses a client that accepts no available coding, but the work is done: send the reply uncompressed.
        *response.status_mut() = offer.status;
    }
    let Some(plain) = response.headers().get(header::ETAG).and_then(|tag| tag.to_str().ok()) else {
        return response;
    };
    let coded = |suffix: &str| Some(format!("{}{suffix}", plain.strip_suffix('"')?));
    let tag = if response.status() == StatusCode::NOT_MODIFIED {
        // The tag that the client sent, not that of a representation which it does not have.
        let given = given.as_ref().and_then(|given| given.to_str().ok()).unwrap_or_default();
        CODINGS.iter().filter_map(|(_, suffix)| coded(suffix)).find(|tag| given.contains(tag.as_str()))
    } else if offer.is_some_and(|offer| offer.compress) {
        let coding = response.headers().get(header::CONTENT_ENCODING);
        let suffix = CODINGS.iter().find(|(name, _)| coding.is_some_and(|coding| coding == name));
        suffix.and_then(|(_, suffix)| coded(suffix))
    } else {
        None
    };
    if let Some(tag) = tag.and_then(|tag| HeaderValue::try_from(tag).ok()) {
        if response.status() == StatusCode::NOT_MODIFIED {
            response.headers_mut().append(header::VARY, HeaderValue::from_static("accept-encoding"));
        }
        response.headers_mut().insert(header::ETAG, tag);
    }
    response
}

/// A list of tags without the suffixes of codings; none if no tag has one.
fn without_coding(value: &HeaderValue) -> Option<HeaderValue> {
    let tags = value.to_str().ok().filter(|tags| CODINGS.iter().any(|(_, suffix)| tags.contains(suffix)))?;
    let plain = CODINGS.iter().fold(tags.to_owned(), |tags, (_, suffix)| tags.replace(suffix, "\""));
    HeaderValue::try_from(plain).ok()
}
