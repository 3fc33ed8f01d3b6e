//! `/contacts/{id}/subsurface`: the stress below the surface in the present state of a contact.

use stickslip_wire::{SubsurfaceReply, SubsurfaceRequest};

use super::prelude::*;

parameters! {
    pub struct SubsurfaceFormat {
        ..formats(&Format::ALL, "A picture is of one field in a plane or on the surface.")
    }
}

/// Compute the stress below the surface
///
/// The stress tensor and its invariants in one of the two bodies, in the present state of the contact, whatever its
/// history. Nothing changes.
#[utoipa::path(
    post, path = "/contacts/{id}/subsurface", tag = "contacts", params(ContactPath, SubsurfaceFormat),
    request_body(content = SubsurfaceRequest, examples(
        ("section" = (summary = "Von Mises stress in the plane of the motion", value = json!({
            "body": "first", "plane": {"normal": "y", "offset": 0.0, "x": [-2e-4, 2e-4, 41], "z": [0.0, 2e-4, 21]},
            "fields": ["von_mises"]
        }))),
        ("points" = (summary = "The tensor at two points, with a bulk stress", value = json!({
            "body": "first", "points": [[0.0, 0.0, 5e-5], [1e-4, 0.0, 0.0]], "bulk": {"xx": 1e8}
        })))
    )),
    responses((status = 200, description = "The stresses in the present state", body = SubsurfaceReply,
        headers(("ETag" = String, description = "The sequence that they belong to, in quotes"))))
)]
pub async fn compute_subsurface_stress(
    ContactPath { app, id, .. }: ContactPath,
    CheckedQuery(query): CheckedQuery<SubsurfaceFormat>,
    request: CheckedBody<SubsurfaceRequest>,
) -> Result<Response, Problem> {
    let format = query.format?;
    let CheckedBody { body, context, .. } = request;
    let task = app.sessions.subsurface_task(id, body).await?;
    computations::of_contact(&app, id, format, Box::new(task), &context).await
}
