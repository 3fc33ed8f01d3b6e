//! The formats of tables and plots.

mod accept;
mod fretting_map;
pub mod plots;
mod table;
pub mod tables;

use std::fmt::Display;

use axum::body::Body;
use axum::http::{HeaderValue, header};
use axum::response::{IntoResponse as _, Response};
use serde::Serialize;

use crate::admission::{INLINE, Nanoseconds};
use crate::otlp;
use stickslip_report::plot::Picture;

use super::problem::Problem;
use super::reply;

pub use table::{Table, TableStream};

/// Bytes of a row of stresses in the longest of the formats.
pub const STRESS_ROW: usize = 256;
/// Bytes of a row of stresses below the surface, likewise.
pub const SUBSURFACE_ROW: usize = 640;
/// Bytes that a plot takes while it is drawn.
const PLOT: usize = 16 * 1024 * 1024;

/// How a table is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// The JSON document of the endpoint.
    Columns,
    /// A JSON array of flat objects.
    Rows,
    /// Comma-separated values under a line of names; a missing value is an empty cell.
    Csv,
    /// One flat JSON object a line.
    Ndjson,
    /// A stream of Arrow's record batches: typed columns, read without parsing.
    Arrow,
    /// A vector plot.
    Svg,
    /// A bitmap plot.
    Png,
}

impl Format {
    /// All formats; the first is the default.
    pub const ALL: [Format; 7] =
        [Format::Columns, Format::Rows, Format::Csv, Format::Ndjson, Format::Arrow, Format::Svg, Format::Png];

    /// The formats of a table that has no plot.
    pub const TABLES: [Format; 5] = [Format::Columns, Format::Rows, Format::Csv, Format::Ndjson, Format::Arrow];

    /// Its name in a query, and its media type.
    const fn names(self) -> (&'static str, &'static str) {
        match self {
            Format::Columns => ("columns", "application/json"),
            Format::Rows => ("rows", "application/vnd.stickslip.rows+json"),
            Format::Csv => ("csv", "text/csv; charset=utf-8"),
            Format::Ndjson => ("ndjson", "application/x-ndjson"),
            Format::Arrow => ("arrow", "application/vnd.apache.arrow.stream"),
            Format::Svg => ("svg", "image/svg+xml"),
            Format::Png => ("png", "image/png"),
        }
    }

    /// Its name in a query.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.names().0
    }

    /// The one of `formats` with this name.
    #[must_use]
    pub fn named(name: &str, formats: &[Format]) -> Option<Format> {
        formats.iter().copied().find(|format| format.name() == name)
    }

    /// Its media type.
    #[must_use]
    pub const fn media_type(self) -> &'static str {
        self.names().1
    }

    /// Whether it is a plot.
    #[must_use]
    pub fn is_plot(self) -> bool {
        matches!(self, Format::Svg | Format::Png)
    }

    /// Whether it is a table that is read row by row, and can be sent piece by piece.
    #[must_use]
    pub fn is_stream(self) -> bool {
        matches!(self, Format::Csv | Format::Ndjson | Format::Arrow)
    }

    /// Bytes that writing takes beyond the columns, for `rows` rows of `row` bytes each.
    #[must_use]
    pub fn bytes(self, rows: usize, row: usize) -> usize {
        match self {
            Format::Columns => 0,
            Format::Svg | Format::Png => PLOT + rows * row,
            Format::Rows | Format::Csv | Format::Ndjson | Format::Arrow => rows * row,
        }
    }

    /// The tag of a reply in this format; that of columns is the version alone.
    #[must_use]
    pub fn tag(self, version: &str) -> String {
        match self {
            Format::Columns => format!("\"{version}\""),
            other => format!("\"{version}-{}\"", other.name()),
        }
    }

    /// The cost of writing it, beyond the numbers: a plot needs a solver thread.
    #[must_use]
    pub fn cost(self) -> Nanoseconds {
        if self.is_plot() { INLINE } else { 0 }
    }

    /// A page in this format; only the plot or table that it needs is made.
    ///
    /// # Errors
    /// [`Problem::internal`] if it cannot be written, which is a fault of the service.
    pub fn write<'p, P: Picture>(
        self,
        page: &impl Serialize,
        plot: impl FnOnce() -> P,
        table: impl FnOnce() -> Table<'p>,
    ) -> Result<Vec<u8>, Problem> {
        let write = || match self {
            Format::Columns => reply::written(page),
            Format::Svg => plot().svg().map_err(unwritable),
            Format::Png => plot().png().map_err(unwritable),
            Format::Rows | Format::Csv | Format::Ndjson | Format::Arrow => table().write(self).map_err(unwritable),
        };
        if self == Format::Columns { write() } else { otlp::part!("write").in_scope(write) }
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

/// The problem of a reply that cannot be written.
pub fn unwritable(error: impl Display) -> Problem {
    Problem::internal(format!("a reply cannot be written: {error}"))
}
