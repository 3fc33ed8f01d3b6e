//! The choice of a format by `Accept`.

use axum::http::{HeaderMap, header};

use super::Format;
use crate::api::problem::{Code, Problem};

/// The format out of `formats` that `Accept` prefers.
pub(super) fn preferred(headers: &HeaderMap, formats: &[Format]) -> Result<Format, Problem> {
    let accepted: Vec<&str> = headers.get_all(header::ACCEPT).iter().filter_map(|line| line.to_str().ok()).collect();
    let accepted = accepted.join(",");
    if accepted.trim().is_empty() {
        return Ok(Format::Columns);
    }
    let weighed = formats.iter().map(|format| (quality(&accepted, format.media_type()), *format));
    // Of equals the first.
    let best = weighed.reduce(|best, next| if next.0 > best.0 { next } else { best });
    best.filter(|(quality, _)| *quality > 0.0).map(|(_, format)| format).ok_or_else(|| {
        let known: Vec<String> =
            formats.iter().map(|format| format!("{} (`?format={}`)", format.media_type(), format.name())).collect();
        Problem::new(Code::NotAcceptable, format!("Accept must admit one of {}", known.join(", ")))
    })
}

/// The weight that `Accept` gives a media type, 0 to 1: that of the most specific range that it falls in (RFC 9110,
/// 12.5.1).
fn quality(accepted: &str, media_type: &str) -> f64 {
    let essence = media_type.split(';').next().unwrap_or_default();
    let group = essence.split('/').next().unwrap_or_default();
    let mut best = (0, 0.0);
    for range in accepted.split(',') {
        let mut parts = range.split(';').map(str::trim);
        let name = parts.next().unwrap_or_default();
        let rank = if name.eq_ignore_ascii_case(essence) {
            3
        } else if name.strip_suffix("/*").is_some_and(|named| named.eq_ignore_ascii_case(group)) {
            2
        } else if name == "*/*" {
            1
        } else {
            continue;
        };
        let given = parts.find_map(|part| part.strip_prefix("q=").or_else(|| part.strip_prefix("Q=")));
        let quality =
            given.map_or(1.0, |text| text.trim().parse::<f64>().map_or(0.0, |quality| quality.clamp(0.0, 1.0)));
        if rank > best.0 {
            best = (rank, quality);
        }
    }
    best.1
}
