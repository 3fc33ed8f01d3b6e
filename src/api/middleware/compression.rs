//! Compression of replies by gzip or zstd, as `Accept-Encoding` says. A reply has the same version in every coding.

use axum::body::{Body, HttpBody as _};
use axum::http::{HeaderMap, HeaderValue, header};
use axum::response::{IntoResponse as _, Response};
use tower::{ServiceExt as _, service_fn};
use tower_http::CompressionLevel;
use tower_http::compression::Compression;
use tower_http::compression::predicate::SizeAbove;

use crate::admission::{Admission, Pool};
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
/// The lines of `Accept-Encoding` of a request.
pub fn accepted(headers: &HeaderMap) -> Vec<HeaderValue> {
    headers.get_all(header::ACCEPT_ENCODING).iter().cloned().collect()
}

/// Compresses a reply as its client accepts it, if that is worth its time and there is memory for it.
pub async fn compress(
    mut response: Response,
    accepted: Vec<HeaderValue>,
    pool: &Pool,
    admission: &Admission,
) -> Response {
    if !is_worthwhile(&response) {
        return response;
    }
    response.headers_mut().append(header::VARY, HeaderValue::from_static("accept-encoding"));
    if accepted.is_empty() {
        return response;
    }
    let Some(room) = pool.try_reserve_encoder() else { return response };
    admission.keep_encoder(room);
    encode(response, accepted).await
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
    response
}

fn is_worthwhile(response: &Response) -> bool {
    let kind = response.headers().get(header::CONTENT_TYPE).map(HeaderValue::as_bytes);
    // A stream has no length, and is long.
    response.body().size_hint().exact().is_none_or(|size| size >= SMALLEST)
        && kind.is_some_and(|kind| COMPRESSED.iter().any(|known| known.as_bytes() == kind))
        && !response.headers().contains_key(header::CONTENT_ENCODING)
}
