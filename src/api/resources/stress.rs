//! `/contacts/{id}/stress`: the stresses in the present state of a contact.

use std::ops::RangeInclusive;

use axum::http::{HeaderMap, header};
use axum::response::Response;
use utoipa::IntoParams;

use stickslip_mechanics::Contact;
use stickslip_wire::{Field, JsonPath, Sampling, StressReply, StressRequest};

use crate::api::formats::{Format, STRESS_ROW, plots, tables};
use crate::api::params::ContactPath;
use crate::api::problem::{Code, Problem};
use crate::api::query::{COUNT, CheckedQuery, QueryParams, QueryReader};
use crate::api::reply;
use crate::api::state::TenantApp;

/// Radii in a query: with all digits, they fit into the head of a request.
pub const QUERY_RADII: RangeInclusive<usize> = 1..=1_000;
/// Radii of a plot if the client does not say.
const PLOT_RADII: usize = 1_000;

/// Which stresses are wanted.
#[derive(IntoParams)]
#[into_params(parameter_in = Query)]
#[expect(dead_code, reason = "describes what `Wanted` is read from")]
pub struct StressQuery {
    /// Number of radii, evenly spaced from the centre to the edge, both included. Give this or `radii`, unless you ask
    /// for a plot.
    #[param(nullable = false, example = 100)]
    points: Option<usize>,
    /// Radii, m, separated by commas or given one by one.
    #[param(nullable = false)]
    radii: Option<String>,
    /// Which fields, separated by commas, out of `pressure`, `shear`, `slip` and `displacement`. If it is left out, the
    /// first two.
    #[param(nullable = false)]
    fields: Option<String>,
    /// Whether the extrema of the shear stress are wanted too.
    #[param(nullable = false, default = false)]
    residual: Option<bool>,
    /// `columns` (this document), `rows` (a JSON array of flat objects), `csv`, `ndjson`, `arrow` (an Arrow IPC
    /// stream), or a plot as `svg` or `png`. If it is left out, `Accept` decides.
    #[param(nullable = false, default = "columns")]
    format: Option<String>,
}

/// A [`StressQuery`] that has been checked.
pub struct Wanted {
    sampling: Sampling,
    residual: bool,
    format: Option<Format>,
}

impl QueryParams for Wanted {
    fn take(query: &mut QueryReader, headers: &HeaderMap) -> Option<Wanted> {
        let field = |name: &str| Field::ALL.into_iter().find(|field| field.name() == name);
        let mut points = query.number("points", COUNT);
        let radii = query.list("radii", "numbers with commas between them", |text| text.parse().ok());
        if let Some(radii) = &radii {
            query.faults.length(JsonPath::Root.member("radii"), radii.len(), &QUERY_RADII);
        }
        let fields = query.list(
            "fields",
            "a list of fields, with commas between them, out of `pressure`, `shear`, `slip`, `displacement`",
            field,
        );
        let residual = query.number("residual", "true or false").unwrap_or(false);
        let format = query.format(&Format::ALL);
        if Format::chosen(format, headers, &Format::ALL).is_ok_and(Format::is_plot) {
            if fields.is_some() {
                query
                    .faults
                    .add(JsonPath::Root.member("fields"), "a plot always shows pressure and shear: leave this out");
            }
            if radii.is_none() {
                points = points.or(Some(PLOT_RADII));
            }
        }
        if !query.faults.is_empty() {
            return None;
        }
        let sampling = StressRequest { points, radii, fields }.check(JsonPath::Root, &mut query.faults)?;
        Some(Wanted { sampling, residual, format })
    }
}

/// Get the stresses of a contact
///
/// Pressure, shear stress, slip and displacement over the radius, as they are now, and the residual stress on request.
#[utoipa::path(
    get, path = "/contacts/{id}/stress", tag = "contacts", params(ContactPath, StressQuery),
    responses((status = 200, description = "The stresses in its present state", body = StressReply,
        headers(("ETag" = String, description = "The sequence that they belong to, in quotes"))))
)]
pub async fn get_stress(
    TenantApp(app): TenantApp,
    ContactPath { id }: ContactPath,
    headers: HeaderMap,
    CheckedQuery(wanted): CheckedQuery<Wanted>,
) -> Result<Response, Problem> {
    let Wanted { sampling, residual, format } = wanted;
    let format = Format::chosen(format, &headers, &Format::ALL)?;
    if residual && format != Format::Columns {
        let detail = "the extrema are no column: ask for them with the format `columns`";
        return Err(Problem::at(Code::InvalidInput, "/residual", detail));
    }
    if headers.contains_key(header::IF_NONE_MATCH) {
        // Before anything is computed.
        let tag = format.tag(&app.sessions.get(id).await?.sequence.to_string());
        if reply::is_current(&headers, &tag) {
            return Ok(reply::not_modified(&tag));
        }
    }
    let extra = (format.bytes(sampling.length(), STRESS_ROW), format.cost());
    let write = move |stress: &StressReply, contact: &Contact, sequence: u64| {
        format.write(stress, || plots::stress(id, sequence, contact, stress), || tables::stress(stress))
    };
    let (sequence, body, memory) = app.sessions.stress(id, sampling, residual, extra, write).await?;
    let tag = format.tag(&sequence.to_string());
    Ok(reply::holding(reply::tagged(format.reply(body?), &tag), memory))
}
