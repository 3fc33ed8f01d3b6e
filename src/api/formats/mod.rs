//! The formats that tables are given in, and how a client asks for one: by `?format=`, or else by `Accept`.

pub mod plots;
pub mod sheet;
pub mod table;

use axum::http::{HeaderMap, HeaderValue, header};
use axum::response::{IntoResponse as _, Response};

use crate::api::problem::{Kind, Problem};
use crate::api::reply::tagged;

/// The media type of rows: a JSON array of flat objects.
pub const ROWS: &str = "application/vnd.stickslip.rows+json";
/// The media type of comma-separated values.
pub const CSV: &str = "text/csv; charset=utf-8";
/// The media type of one flat object a line.
pub const NDJSON: &str = "application/x-ndjson";
/// The media type of Arrow's stream of record batches.
pub const ARROW: &str = "application/vnd.apache.arrow.stream";
/// The media type of a plot to scale at will.
pub const SVG: &str = "image/svg+xml";
/// The media type of a plot in pixels.
pub const PNG: &str = "image/png";
/// Bytes of a row of stresses in the longest of the formats.
pub const STRESS_ROW: usize = 256;
/// Bytes that a plot takes while it is drawn.
pub const PLOT: usize = 16 * 1024 * 1024;

/// How a table is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// The JSON document of the endpoint.
    Columns,
    /// A JSON array of flat objects.
    Rows,
    /// Comma-separated values under a line of names; what has no value is left empty.
    Csv,
    /// One flat JSON object a line.
    Ndjson,
    /// A stream of Arrow's record batches: typed columns, read without parsing.
    Arrow,
    /// A plot to scale at will.
    Svg,
    /// A plot in pixels.
    Png,
}

impl Format {
    /// All formats; where a client has no preference, the first.
    pub const ALL: [Format; 7] =
        [Format::Columns, Format::Rows, Format::Csv, Format::Ndjson, Format::Arrow, Format::Svg, Format::Png];

    /// Those of a table that nobody draws.
    pub const TABLES: [Format; 5] = [Format::Columns, Format::Rows, Format::Csv, Format::Ndjson, Format::Arrow];

    /// Its name in a query.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Format::Columns => "columns",
            Format::Rows => "rows",
            Format::Csv => "csv",
            Format::Ndjson => "ndjson",
            Format::Arrow => "arrow",
            Format::Svg => "svg",
            Format::Png => "png",
        }
    }

    /// Its media type.
    #[must_use]
    pub fn media_type(self) -> &'static str {
        match self {
            Format::Columns => "application/json",
            Format::Rows => ROWS,
            Format::Csv => CSV,
            Format::Ndjson => NDJSON,
            Format::Arrow => ARROW,
            Format::Svg => SVG,
            Format::Png => PNG,
        }
    }

    /// Whether it is a picture.
    #[must_use]
    pub fn is_plot(self) -> bool {
        matches!(self, Format::Svg | Format::Png)
    }

    /// Bytes that it takes beyond the columns, for so many rows of so many bytes each.
    #[must_use]
    pub fn bytes(self, rows: usize, row: usize) -> usize {
        match self {
            Format::Columns => 0,
            Format::Svg | Format::Png => PLOT + rows * row,
            Format::Rows | Format::Csv | Format::Ndjson | Format::Arrow => rows * row,
        }
    }

    /// The format that the query names, or that `Accept` likes best.
    ///
    /// # Errors
    /// [`Kind::NotAcceptable`] if `Accept` admits none.
    pub fn chosen(named: Option<Format>, headers: &HeaderMap) -> Result<Format, Problem> {
        Format::chosen_of(named, headers, &Format::ALL)
    }

    /// The same out of some formats.
    ///
    /// # Errors
    /// [`Kind::NotAcceptable`] if `Accept` admits none of them.
    pub fn chosen_of(named: Option<Format>, headers: &HeaderMap, formats: &[Format]) -> Result<Format, Problem> {
        if let Some(format) = named {
            return Ok(format);
        }
        let accepted: Vec<&str> =
            headers.get_all(header::ACCEPT).iter().filter_map(|line| line.to_str().ok()).collect();
        let accepted = accepted.join(",");
        if accepted.trim().is_empty() {
            return Ok(Format::Columns);
        }
        let mut best = (0.0, None);
        for &format in formats {
            let quality = quality(&accepted, format.media_type());
            if quality > best.0 {
                best = (quality, Some(format));
            }
        }
        best.1.ok_or_else(|| {
            let known: Vec<String> =
                formats.iter().map(|format| format!("{} (`?format={}`)", format.media_type(), format.name())).collect();
            Problem::new(Kind::NotAcceptable, format!("Accept must admit one of {}", known.join(", ")))
        })
    }

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
    pub fn reply(self, body: Vec<u8>, tag: &str) -> Response {
        let mut response = ([(header::CONTENT_TYPE, self.media_type())], body).into_response();
        response.headers_mut().insert(header::VARY, HeaderValue::from_static("accept"));
        tagged(response, tag)
    }
}

/// How much a media type is liked, 0 to 1: the most specific range that it falls in says so (RFC 9110, 12.5.1).
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
