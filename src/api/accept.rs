//! Headers that are lists: their members, and the weights of `Accept` and `Accept-Encoding`.

use axum::http::HeaderMap;

/// How a list admits a value.
#[derive(Clone, Copy)]
pub struct Admission {
    /// From 0, not at all, to 1.
    pub quality: f64,
    /// The higher, the closer the range is to the value: [`NAMED`] by its name.
    pub rank: u8,
}

/// The rank of a value that the list names.
pub const NAMED: u8 = 3;

/// How `Accept` admits a media type, or `Accept-Encoding` a coding: by the most specific range that it falls in (RFC
/// 9110, 12.5). Nothing if it falls in none.
pub fn admission(headers: &HeaderMap, list: &'static str, value: &str) -> Option<Admission> {
    let group = value.split('/').next().unwrap_or_default();
    let admissions = list_members(headers, list).filter_map(|range| {
        let mut parts = range.split(';').map(str::trim);
        let name = parts.next()?;
        let rank = if name.eq_ignore_ascii_case(value) {
            NAMED
        } else if name.strip_suffix("/*").is_some_and(|named| named.eq_ignore_ascii_case(group)) {
            2
        } else if name == "*/*" || name == "*" {
            1
        } else {
            return None;
        };
        let given = parts.find_map(|part| part.strip_prefix("q=").or_else(|| part.strip_prefix("Q=")));
        let quality =
            given.map_or(1.0, |text| text.trim().parse::<f64>().map_or(0.0, |quality| quality.clamp(0.0, 1.0)));
        Some(Admission { quality, rank })
    });
    admissions.reduce(|best, next| if next.rank > best.rank { next } else { best })
}

/// The members of a comma-separated header, which may itself occur several times.
pub fn list_members<'h>(headers: &'h HeaderMap, name: &'static str) -> impl Iterator<Item = &'h str> {
    headers.get_all(name).iter().filter_map(|line| line.to_str().ok()).flat_map(|line| line.split(','))
}
