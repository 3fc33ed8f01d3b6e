//! `/contacts/{id}/stress`: the stresses in the present state of a contact.

use std::ops::RangeInclusive;

use serde_json::json;
use stickslip_mechanics::range;
use stickslip_wire::limits::{self, Array};
use stickslip_wire::{Faults, Field, JsonPath, StressReply, StressRequest};

use super::prelude::*;
use crate::api::query_parameters::{fields, flag, numbers};
use stickslip_compute::computations::StressTask;

/// Radii in a query: with all digits, they fit into the head of a request.
pub const QUERY_RADII: RangeInclusive<usize> = 1..=1_000;
/// Radii of a plot if the client does not say.
pub const PLOT_RADII: usize = 1_000;

parameters! {
    pub struct StressQuery {
        /// Number of radii, evenly spaced from the centre to the edge, both included. Give this or `radii`, unless you
        /// ask for a plot.
        points: usize = count(&limits::STRESS_POINTS).with_example(json!(100));
        /// Radii, m, separated by commas or given one by one.
        radii: Vec<f64> = numbers(&Array(QUERY_RADII, range::CONTACT_RADIUS));
        /// Places along x of a line contact, m, in place of `radii`.
        x: Vec<f64> = numbers(&Array(QUERY_RADII, range::PLACE));
        /// Which fields, separated by commas, out of `pressure`, `shear`, `slip`, `displacement` and, of a contact that
        /// is twisted, `hoop`. If it is left out, the first two.
        fields: Vec<Field> = fields();
        /// Whether the extrema of the shear stress are returned too.
        residual: bool = flag(), or false;
        ..formats(&Format::ALL, "")
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
    ContactPath { app, id, context }: ContactPath,
    headers: HeaderMap,
    CheckedQuery(query): CheckedQuery<StressQuery>,
) -> Result<Response, Problem> {
    let StressQuery { mut points, radii, x, fields, residual, format } = query;
    let mut faults = Faults::default();
    if format.as_ref().is_ok_and(|format| format.is_plot()) {
        if fields.is_some() {
            faults.add(JsonPath::Root.member("fields"), "a plot always shows pressure and shear: leave this out");
        }
        if radii.is_none() && x.is_none() {
            points = points.or(Some(PLOT_RADII));
        }
    }
    let sampling = StressRequest { points, radii, x, fields }.check(JsonPath::Root, &mut faults);
    let (sampling, format) = (faults.done(sampling)?, format?);
    if residual && format != Format::Columns {
        let detail =
            "a table does not have the extrema: ask for them with the format `columns`, or at /contacts/{id}/residual";
        return Err(Problem::at(Code::InvalidInput, "/residual", detail));
    }
    let task = Box::new(StressTask { sampling, residual });
    computations::get_of_contact(&app, id, &headers, format, task, &context).await
}
