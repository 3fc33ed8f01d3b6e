//! `/`: the web page; `/docs`: the documentation of the API, by Swagger UI. Their files are part of the program,
//! compressed when it was built.

use std::io::Read as _;
use std::sync::{LazyLock, OnceLock};

use axum::http::{HeaderMap, HeaderValue, StatusCode, Uri, header};
use axum::response::{IntoResponse as _, Redirect, Response};
use flate2::read::GzDecoder;
use percent_encoding::percent_decode_str;

use super::meta;
use crate::api::accept::admission;
use crate::api::reply;

/// The path of the page, and that of its files.
pub const PAGE: &str = "/";
pub const FILES: &str = "/page/{name}";

/// The paths of the documentation: with the slash that a folder may have, it is the page, and then its files.
const DOCS: [&str; 3] = ["/docs", "/docs/", "/docs/{*rest}"];

/// All of these routes.
pub const ROUTES: [&str; 5] = [PAGE, FILES, DOCS[0], DOCS[1], DOCS[2]];

struct Asset {
    name: &'static str,
    /// Changes with its content.
    tag: &'static str,
    packed: &'static [u8],
    /// For clients that do not take it compressed; made when the first of them asks.
    plain: OnceLock<Vec<u8>>,
}

/// All files of the page, as the build script found them.
static ASSETS: LazyLock<Vec<Asset>> = LazyLock::new(|| Vec::from(include!(concat!(env!("OUT_DIR"), "/page.in"))));
/// All files of the documentation.
static DOCUMENTATION: LazyLock<Vec<Asset>> =
    LazyLock::new(|| Vec::from(include!(concat!(env!("OUT_DIR"), "/docs.in"))));

/// The file that a path of these names.
pub async fn get(uri: Uri, headers: HeaderMap) -> Response {
    let path = uri.path();
    let (assets, name) = match (path.strip_prefix("/page/"), path.strip_prefix("/docs/")) {
        _ if path == DOCS[0] => return Redirect::to(DOCS[1]).into_response(),
        (Some(name), _) => (&ASSETS, name),
        (_, Some("")) => (&DOCUMENTATION, "index.html"),
        (_, Some(name)) => (&DOCUMENTATION, name),
        (None, None) => (&ASSETS, "index.html"),
    };
    let name = percent_decode_str(name).decode_utf8_lossy();
    match assets.iter().find(|asset| asset.name == name) {
        Some(asset) => asset.answer(&headers),
        None => meta::not_found(&uri).into_response(),
    }
}

impl Asset {
    fn new(name: &'static str, tag: &'static str, packed: &'static [u8]) -> Asset {
        Asset { name, tag, packed, plain: OnceLock::new() }
    }

    /// The file as it was before the build.
    fn plain(&'static self) -> &'static [u8] {
        self.plain.get_or_init(|| {
            let mut plain = Vec::new();
            let unpacked = GzDecoder::new(self.packed).read_to_end(&mut plain);
            unpacked.expect("the build script has compressed it");
            plain
        })
    }

    /// The file, or 304 if the client has the current version.
    fn answer(&'static self, asked: &HeaderMap) -> Response {
        let gzip = admission(asked, "accept-encoding", "gzip").is_some_and(|gzip| gzip.quality > 0.0);
        let body = if gzip { self.packed } else { self.plain() };
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
            Some("png") => "image/png",
            Some("svg") => "image/svg+xml",
            _ => "text/javascript; charset=utf-8",
        }
    }
}
