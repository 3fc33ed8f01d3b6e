//! What a request gets of [`crate::formats`]: the choice by the query or by `Accept`, and the reply.

mod choice;

use axum::body::Body;
use axum::http::{HeaderValue, header};
use axum::response::{IntoResponse as _, Response};

pub use crate::formats::{Format, TableStream};

impl Format {
    /// The tag of a reply in this format; that of columns is the version alone.
    #[must_use]
    pub fn tag(self, version: &str) -> String {
        match self {
            Format::Columns => format!("\"{version}\""),
            other => format!("\"{version}-{}\"", other.name()),
        }
    }

    /// 200 with a body in this format.
    #[must_use]
    pub fn reply(self, body: impl Into<Body>) -> Response {
        let headers = [
            (header::CONTENT_TYPE, HeaderValue::from_static(self.media_type())),
            (header::VARY, HeaderValue::from_static("accept")),
        ];
        (headers, body.into()).into_response()
    }
}
