//! The choice of a format by `Accept`.

use axum::http::HeaderMap;

use super::Format;
use crate::api::accept::{admission, list_members};
use crate::api::problem::{Code, Problem};

/// The format out of `formats` that `Accept` prefers.
pub(super) fn preferred(headers: &HeaderMap, formats: &[Format]) -> Result<Format, Problem> {
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
