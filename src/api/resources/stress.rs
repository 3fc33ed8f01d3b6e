//! `/contacts/{id}/stress`: the stresses in the present state of a contact.

use std::ops::RangeInclusive;

use stickslip_mechanics::range;
use stickslip_wire::limits::{self, Array};
use stickslip_wire::{Field, JsonPath, StressReply, StressRequest};

use super::prelude::*;
use crate::api::query_parameters::{FLAG, Fields, List};
use stickslip_compute::computations::StressTask;

/// Radii in a query: with all digits, they fit into the head of a request.
pub const QUERY_RADII: RangeInclusive<usize> = 1..=1_000;
/// Radii of a plot if the client does not say.
const PLOT_RADII: usize = 1_000;

parameters! {
    pub struct StressQuery {
        /// Number of radii, evenly spaced from the centre to the edge, both included. Give this or `radii`, unless you
        /// ask for a plot.
        points: Option<usize> = Number { is_checked: false, example: Some(100), ..count(&limits::STRESS_POINTS) };
        /// Radii, m, separated by commas or given one by one.
        radii: Option<Vec<f64>> = List(Array(QUERY_RADII, range::CONTACT_RADIUS));
        /// Places along x of a line contact, m, in place of `radii`.
        x: Option<Vec<f64>> = List(Array(QUERY_RADII, range::PLACE));
        /// Which fields, separated by commas, out of `pressure`, `shear`, `slip` and `displacement`. If it is left out,
        /// the first two.
        fields: Option<Vec<Field>> = Fields;
        /// Whether the extrema of the shear stress are returned too.
        residual: bool = FLAG, or false;
        /// `columns` (this document), `rows` (a JSON array of flat objects), `csv`, `ndjson`, `arrow` (an Arrow IPC
        /// stream), or a plot as `svg` or `png`. If it is left out, `Accept` decides.
        format: Option<Format> = formats(&Format::ALL);
    }
}

pub struct CheckedStress {
    sampling: StressRequest,
    residual: bool,
    format: Option<Format>,
}

impl QueryParams for CheckedStress {
    fn take(query: &mut QueryReader, headers: &HeaderMap) -> Option<CheckedStress> {
        let StressQuery { mut points, radii, x, fields, residual, format } = StressQuery::take(query, headers)?;
        if Format::chosen(format, headers, &Format::ALL).is_ok_and(Format::is_plot) {
            if fields.is_some() {
                let detail = "a plot always shows pressure and shear: leave this out";
                query.faults.add(JsonPath::Root.member("fields"), detail);
            }
            if radii.is_none() && x.is_none() {
                points = points.or(Some(PLOT_RADII));
            }
        }
        if !query.faults.is_empty() {
            return None;
        }
        let sampling = StressRequest { points, radii, x, fields }.check(JsonPath::Root, &mut query.faults)?;
        Some(CheckedStress { sampling, residual, format })
    }
}

/// Get the stresses of a contact
///
/// Pressure, shear stress, slip and displacement over the radius in the present state, and the residual stress on
/// request.
#[utoipa::path(
    get, path = "/contacts/{id}/stress", tag = "contacts", params(ContactPath, StressQuery),
    responses((status = 200, description = "The stresses in the present state", body = StressReply,
        headers(("ETag" = String, description = "The sequence that they belong to, in quotes"))))
)]
pub async fn get_stress(
    TenantApp(app): TenantApp,
    ContactPath { id }: ContactPath,
    headers: HeaderMap,
    CheckedQuery(query): CheckedQuery<CheckedStress>,
) -> Result<Response, Problem> {
    let CheckedStress { sampling, residual, format } = query;
    if residual && Format::chosen(format, &headers, &Format::ALL)? != Format::Columns {
        let detail =
            "a table does not have the extrema: ask for them with the format `columns`, or at /contacts/{id}/residual";
        return Err(Problem::at(Code::InvalidInput, "/residual", detail));
    }
    computations::get_of_contact(&app, id, &headers, format, StressTask { sampling, residual }).await
}
