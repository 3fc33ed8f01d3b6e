//! What a request gets of [`stickslip_compute::formats`]: the choice by the query or by `Accept`, and the reply.

use axum::body::Body;
use axum::http::{HeaderMap, HeaderValue, header};
use axum::response::{IntoResponse as _, Response};

pub use stickslip_compute::formats::{Format, TableStream};

use super::accept::{admission, list_members};
use super::problem::{Code, Problem};

/// The format that the query names, or the one out of `formats` that `Accept` prefers.
///
/// # Errors
/// [`Code::NotAcceptable`] if `Accept` admits none of them.
pub fn chosen(named: Option<Format>, headers: &HeaderMap, formats: &[Format]) -> Result<Format, Problem> {
    if let Some(named) = named {
        return Ok(named);
    }
    if list_members(headers, "accept").all(|range| range.trim().is_empty()) {
        return Ok(Format::Columns);
    }
    let weighed = formats.iter().map(|format| {
        let essence = format.media_type().split(';').next().unwrap_or_default();
        (admission(headers, "accept", essence).map_or(0.0, |admission| admission.quality), *format)
    });
    // Of equals the first.
    let best = weighed.reduce(|best, next| if next.0 > best.0 { next } else { best });
    best.filter(|(quality, _)| *quality > 0.0).map(|(_, format)| format).ok_or_else(|| {
        let known: Vec<String> =
            formats.iter().map(|format| format!("{} (`?format={}`)", format.media_type(), format.name())).collect();
        Problem::new(Code::NotAcceptable, format!("Accept must admit one of {}", known.join(", ")))
    })
}

/// The tag of a reply in this format; that of columns is the version alone.
pub fn tag(format: Format, version: &str) -> String {
    match format {
        Format::Columns => format!("\"{version}\""),
        other => format!("\"{version}-{}\"", other.name()),
    }
}

/// 200 with a body in this format.
pub fn reply(format: Format, body: impl Into<Body>) -> Response {
    let headers = [
        (header::CONTENT_TYPE, HeaderValue::from_static(format.media_type())),
        (header::VARY, HeaderValue::from_static("accept")),
    ];
    (headers, body.into()).into_response()
}
