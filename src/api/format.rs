//! The formats that tables are given in, and how a client asks for one: by `?format=`, or else by `Accept`.

use std::fmt::Write as _;

use axum::http::{HeaderMap, HeaderValue, header};
use axum::response::{IntoResponse as _, Response};
use serde_json::{Value, json};

use crate::wire::{Field, HistoryPage, StressReply};

use super::problem::{Kind, Problem};
use super::reply::tagged;

/// The media type of rows: a JSON array of flat objects.
pub const ROWS: &str = "application/vnd.stickslip.rows+json";
/// The media type of comma-separated values.
pub const CSV: &str = "text/csv; charset=utf-8";
/// The media type of one flat object a line.
pub const NDJSON: &str = "application/x-ndjson";
/// Bytes of a row of stresses in the longest of the formats.
pub const STRESS_ROW: usize = 256;

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
}

impl Format {
    /// All formats; where a client has no preference, the first.
    pub const ALL: [Format; 4] = [Format::Columns, Format::Rows, Format::Csv, Format::Ndjson];

    /// Its name in a query.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Format::Columns => "columns",
            Format::Rows => "rows",
            Format::Csv => "csv",
            Format::Ndjson => "ndjson",
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
        }
    }

    /// The format that the query names, or that `Accept` likes best.
    ///
    /// # Errors
    /// [`Kind::NotAcceptable`] if `Accept` admits none.
    pub fn chosen(named: Option<Format>, headers: &HeaderMap) -> Result<Format, Problem> {
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
        for format in Format::ALL {
            let quality = quality(&accepted, format.media_type());
            if quality > best.0 {
                best = (quality, Some(format));
            }
        }
        best.1.ok_or_else(|| {
            let known: Vec<String> = Format::ALL
                .iter()
                .map(|format| format!("{} (`?format={}`)", format.media_type(), format.name()))
                .collect();
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

/// Stresses as a flat table.
#[must_use]
pub fn stress(format: Format, reply: &StressReply) -> Vec<u8> {
    let columns: Vec<(&str, &Vec<Option<f64>>)> = Field::ALL
        .into_iter()
        .filter_map(|field| {
            let column = match field {
                Field::Pressure => &reply.pressure,
                Field::Shear => &reply.shear,
                Field::Slip => &reply.slip,
                Field::Displacement => &reply.displacement,
            };
            column.as_ref().map(|column| (field.name(), column))
        })
        .collect();
    let names: Vec<&str> = std::iter::once("radius").chain(columns.iter().map(|(name, _)| *name)).collect();
    let rows = reply.radius.iter().enumerate().map(|(index, radius)| {
        let values = columns.iter().map(|(_, column)| json!(column.get(index).copied().flatten()));
        std::iter::once(json!(radius)).chain(values).collect()
    });
    table(format, &names, rows)
}

/// A page of a history as a flat table: the states with their numbers and times.
#[must_use]
pub fn history(format: Format, page: &HistoryPage) -> Vec<u8> {
    const NAMES: [&str; 12] = [
        "sequence",
        "at",
        "displacement",
        "force",
        "indentation",
        "normal_force",
        "contact_radius",
        "stick_radius",
        "regime",
        "dissipated_energy",
        "elastic_energy",
        "memory_depth",
    ];
    let rows = page.items.iter().map(|item| {
        let state = &item.state;
        vec![
            json!(item.sequence),
            json!(item.at),
            json!(state.displacement),
            json!(state.force),
            json!(state.indentation),
            json!(state.normal_force),
            json!(state.contact_radius),
            json!(state.stick_radius),
            json!(state.regime),
            json!(state.dissipated_energy),
            json!(state.elastic_energy),
            json!(state.memory_depth),
        ]
    });
    table(format, &NAMES, rows)
}

/// Rows under names. No name and no text in a table has a comma or a quote in it.
fn table(format: Format, names: &[&str], rows: impl Iterator<Item = Vec<Value>>) -> Vec<u8> {
    let mut text = match format {
        Format::Csv => names.join(",") + "\n",
        Format::Rows => "[".to_owned(),
        Format::Columns | Format::Ndjson => String::new(),
    };
    let separator = if format == Format::Rows { "," } else { "\n" };
    for (index, row) in rows.enumerate() {
        if index > 0 {
            text.push_str(separator);
        }
        for (column, (name, value)) in names.iter().zip(&row).enumerate() {
            let comma = if column > 0 { "," } else { "" };
            // Writing to a string cannot fail.
            let _ = match (format, value) {
                (Format::Csv, Value::Null) => write!(text, "{comma}"),
                (Format::Csv, Value::String(value)) => write!(text, "{comma}{value}"),
                (Format::Csv, value) => write!(text, "{comma}{value}"),
                (_, value) if column == 0 => write!(text, "{{\"{name}\":{value}"),
                (_, value) => write!(text, ",\"{name}\":{value}"),
            };
        }
        if format != Format::Csv {
            text.push('}');
        }
    }
    if format == Format::Rows {
        text.push(']');
    } else if !text.is_empty() && !text.ends_with('\n') {
        text.push('\n');
    }
    text.into_bytes()
}
