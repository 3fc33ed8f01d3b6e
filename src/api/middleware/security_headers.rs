//! Security headers for browsers: on every reply, and CORS headers for pages of the allowed origins.

use std::time::Duration;

use axum::http::{HeaderMap, HeaderName, HeaderValue, Method, Uri, header};
use tower_http::cors::CorsLayer;

use crate::api::request_context::REQUEST_ID;

/// How long a browser may cache a CORS preflight reply.
const REMEMBERED: Duration = Duration::from_secs(600);

/// A reply is data: nothing in it may be run or framed.
const POLICY: HeaderValue = HeaderValue::from_static("default-src 'none'; frame-ancestors 'none'");
/// The API documentation runs its own scripts, styles its own elements, and talks to the service alone.
const DOCS_POLICY: HeaderValue = HeaderValue::from_static(
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data:; font-src 'self'; \
     connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
);

/// Which pages may embed a reply.
const RESOURCE_POLICY: HeaderName = HeaderName::from_static("cross-origin-resource-policy");
/// The web page does the same, without inline styles. It saves a plot as an image from a `blob:` URL.
const PAGE_POLICY: HeaderValue = HeaderValue::from_static(
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; \
     connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
);

/// The headers of every reply.
const COMMON: [(HeaderName, HeaderValue); 4] = [
    (header::X_CONTENT_TYPE_OPTIONS, HeaderValue::from_static("nosniff")),
    (header::X_FRAME_OPTIONS, HeaderValue::from_static("DENY")),
    (header::REFERRER_POLICY, HeaderValue::from_static("no-referrer")),
    (RESOURCE_POLICY, HeaderValue::from_static("same-origin")),
];

/// What a reply belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Data, which may be a secret.
    Data,
    /// The API documentation page, which is public and may be cached.
    Docs,
    /// The web page, which is public and may be cached.
    Page,
}

/// Writes the headers of a reply to a request by `method`.
pub fn protect(headers: &mut HeaderMap, method: &Method, kind: Kind) {
    headers.reserve(COMMON.len() + 3);
    headers.extend(COMMON);
    let policy = match kind {
        Kind::Data => POLICY,
        Kind::Docs => DOCS_POLICY,
        Kind::Page => PAGE_POLICY,
    };
    headers.insert(header::CONTENT_SECURITY_POLICY, policy);
    if kind == Kind::Data {
        if headers.get(header::CONTENT_TYPE).is_some_and(|kind| kind.as_bytes().starts_with(b"image/")) {
            // A dashboard elsewhere may show a plot. Its scripts see nothing of it but its size.
            headers.insert(RESOURCE_POLICY, HeaderValue::from_static("cross-origin"));
        }
        // What has a version may be kept by the browser that got it, and be shown again once the server has said that
        // it is the present one.
        let versioned = matches!(*method, Method::GET | Method::HEAD) && headers.contains_key(header::ETAG);
        let keeping = if versioned { "private, no-cache" } else { "no-store" };
        headers.insert(header::CACHE_CONTROL, HeaderValue::from_static(keeping));
    }
}

/// Answers CORS requests of pages from these origins.
pub fn cross_origin(origins: &[HeaderValue]) -> CorsLayer {
    let sent = ["idempotency-key", "last-event-id"].map(HeaderName::from_static);
    let sent = sent.into_iter().chain([
        header::AUTHORIZATION,
        header::CONTENT_TYPE,
        header::IF_MATCH,
        header::IF_NONE_MATCH,
        REQUEST_ID,
    ]);
    CorsLayer::new()
        .allow_origin(origins.to_vec())
        .allow_methods([Method::GET, Method::POST, Method::PATCH, Method::DELETE])
        .allow_headers(sent.collect::<Vec<_>>())
        .expose_headers([header::ETAG, header::LINK, header::LOCATION, header::RETRY_AFTER, REQUEST_ID])
        .max_age(REMEMBERED)
}

/// An origin that pages may come from.
///
/// # Errors
/// What is expected, if the text is not an origin.
pub fn origin(text: &str) -> Result<HeaderValue, String> {
    let refused = || "expected an origin as browsers write it, such as https://lab.example:8443".to_owned();
    let uri: Uri = text.parse().map_err(|_| refused())?;
    let (Some(scheme @ ("http" | "https")), Some(authority)) = (uri.scheme_str(), uri.authority()) else {
        return Err(refused());
    };
    // Compared byte by byte with what a browser sends.
    let plain = format!("{scheme}://{authority}").to_ascii_lowercase();
    if plain != text || text.contains(['@', '*']) {
        return Err(refused());
    }
    HeaderValue::from_str(text).map_err(|_| refused())
}

#[cfg(test)]
mod tests {
    use super::origin;

    #[test]
    fn an_origin_is_what_a_browser_sends() {
        for valid in ["https://lab.example", "http://localhost:3000", "http://[::1]:80"] {
            assert_eq!(origin(valid).unwrap(), valid);
        }
        for bad in [
            "",
            "*",
            "null",
            "lab.example",
            "https://lab.example/",
            "https://Lab.example",
            "https://*.example",
            "ftp://lab.example",
            "https://me@lab.example",
            "https://lab.example/a",
            "https://",
        ] {
            assert!(origin(bad).is_err(), "{bad}");
        }
    }
}
