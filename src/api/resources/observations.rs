//! `/contacts/{id}/observations` and `/contacts/{id}/friction`: a contact follows a bench.

use stickslip_wire::{FrictionReply, ObservationsReply, ObservationsRequest};

use super::moves::advance;
use super::prelude::*;

/// Follow a bench
///
/// Moves the contact to each measured displacement, and stores the measured force with the force that the contact
/// predicts: all of the observations or none.
#[utoipa::path(
    post, path = "/contacts/{id}/observations", tag = "contacts", params(ContactPath, IfMatch, IdempotencyKey),
    request_body(content = ObservationsRequest, examples(
        ("measured" = (summary = "Two measurements",
            value = json!({
                "observations": [{"displacement": 1e-7, "force": 1.21}, {"displacement": 2e-7, "force": 2.04}]
            }))),
        ("with its time" = (summary = "With the instant of the measurement",
            value = json!({"observations": [{"displacement": 1e-7, "force": 1.21, "at": "2026-03-01T12:00:00.25Z"}]})))
    )),
    responses((status = 200, description = "The observations with the forces that the contact \
        predicts", body = ObservationsReply,
        headers(("ETag" = String, description = "The new sequence in quotes"))))
)]
pub async fn follow_bench(
    ContactPath { app, id, .. }: ContactPath,
    IfMatch { expected }: IfMatch,
    request: CheckedBody<ObservationsRequest>,
) -> Result<Response, Problem> {
    advance(&app, id, expected, request).await
}

/// Get the measured friction of a contact
///
/// The coefficient of friction from the last measured cycle of the contact, from its stored observations.
#[utoipa::path(
    get, path = "/contacts/{id}/friction", tag = "contacts", params(ContactPath),
    responses((status = 200, description = "The estimate, if the observations determine one", body = FrictionReply,
        headers(("ETag" = String, description = "The sequence in quotes"))))
)]
pub async fn get_friction(
    ContactPath { app, id, .. }: ContactPath,
    headers: HeaderMap,
    _: CheckedQuery<()>,
) -> Result<Response, Problem> {
    let friction = app.sessions.friction(id).await?;
    reply::versioned(&headers, &formats::tag(Format::Columns, &friction.sequence.to_string()), &friction)
}
