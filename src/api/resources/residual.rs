//! `/contacts/{id}/residual`: the extrema of the shear stress in the present state of a contact.

use stickslip_wire::{Faults, Field, JsonPath, Residual, StressRequest};

use super::prelude::*;
use super::stress::PLOT_RADII;
use stickslip_compute::computations::ResidualTask;

parameters! {
    pub struct ResidualQuery {
        ..formats(&Format::ALL, "A table has a row for each extremum with its radius, shear stress and kind (`maximum` \
            or `minimum`).")
    }
}

/// Get the residual stress of a contact
///
/// The extrema of the shear stress in the present state of the contact, with their positions to round-off.
#[utoipa::path(
    get, path = "/contacts/{id}/residual", tag = "contacts", params(ContactPath, ResidualQuery),
    responses((status = 200, description = "The extrema of the shear stress in the present state", body = Residual,
        headers(("ETag" = String, description = "The sequence that they belong to, in quotes"))))
)]
pub async fn get_residual(
    ContactPath { app, id, context }: ContactPath,
    headers: HeaderMap,
    CheckedQuery(query): CheckedQuery<ResidualQuery>,
) -> Result<Response, Problem> {
    let format = query.format?;
    let request = StressRequest { points: Some(PLOT_RADII), radii: None, x: None, fields: Some(vec![Field::Shear]) };
    let between = format.is_plot().then(|| request.check(JsonPath::Root, &mut Faults::default())).flatten();
    computations::get_of_contact(&app, id, &headers, format, Box::new(ResidualTask { between }), &context).await
}
