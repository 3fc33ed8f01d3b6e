//! `/`: the web page. Its files are part of the program, compressed when it was built.

use axum::Router;
use axum::extract::Path;
use axum::http::{HeaderMap, HeaderValue, StatusCode, Uri, header};
use axum::response::{IntoResponse as _, Response};
use axum::routing::get;

use super::meta;
use crate::api::accept::admission;
use crate::api::reply;

/// The path of the page, and that of its files.
pub const PAGE: &str = "/";
pub const FILES: &str = "/page/{name}";

struct Asset {
    name: &'static str,
    /// Changes with its content.
    tag: &'static str,
    plain: &'static [u8],
    packed: &'static [u8],
}

/// All files, as the build script found them.
const ASSETS: &[Asset] = &include!(concat!(env!("OUT_DIR"), "/page.in"));

pub fn routes() -> Router {
    Router::new().route(PAGE, get(index)).route(FILES, get(file))
}

async fn index(headers: HeaderMap, uri: Uri) -> Response {
    file(Path("index.html".to_owned()), headers, uri).await
}

async fn file(Path(name): Path<String>, headers: HeaderMap, uri: Uri) -> Response {
    match ASSETS.iter().find(|asset| asset.name == name) {
        Some(asset) => asset.answer(&headers),
        None => meta::not_found(uri).await.into_response(),
    }
}

impl Asset {
    /// The file, or 304 if the client has the current version.
    fn answer(&self, asked: &HeaderMap) -> Response {
        let gzip = admission(asked, "accept-encoding", "gzip").is_some_and(|gzip| gzip.quality > 0.0);
        let body = if gzip { self.packed } else { self.plain };
        let current = reply::is_current(asked, self.tag);
        let response = if current { StatusCode::NOT_MODIFIED.into_response() } else { body.into_response() };
        let mut response = reply::tagged(response, self.tag);
        let headers = response.headers_mut();
        headers.insert(header::VARY, HeaderValue::from_static("accept-encoding"));
        // Revalidated each time: after an update no old file is used with a new one.
        headers.insert(header::CACHE_CONTROL, HeaderValue::from_static("no-cache"));
        if !current {
            headers.insert(header::CONTENT_TYPE, HeaderValue::from_static(self.media_type()));
            if gzip {
                headers.insert(header::CONTENT_ENCODING, HeaderValue::from_static("gzip"));
            }
        }
        response
    }

    fn media_type(&self) -> &'static str {
        match self.name.rsplit('.').next() {
            Some("html") => "text/html; charset=utf-8",
            Some("css") => "text/css; charset=utf-8",
            Some("svg") => "image/svg+xml",
            _ => "text/javascript; charset=utf-8",
        }
    }
}
