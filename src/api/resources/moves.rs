//! `/contacts/{id}/move`, `/contacts/{id}/path` and `/contacts/{id}/relax`: contacts are moved.

use super::prelude::*;
use crate::sessions::{Expected, bytes_of_moves};
use stickslip_compute::documents::Parse;
use stickslip_wire::session::Advance;
use stickslip_wire::{MoveReply, MoveRequest, PathReply, PathRequest, RelaxReply, RelaxRequest};

/// Move a contact
///
/// Applies one move. Moves of one contact are applied one at a time, in the order of their arrival.
#[utoipa::path(
    post, path = "/contacts/{id}/move", tag = "contacts", params(ContactPath, IfMatch, IdempotencyKey),
    request_body(content = MoveRequest, examples(
        ("sideways" = (summary = "To a tangential displacement", value = json!({"displacement": 1e-7}))),
        ("by force" = (summary = "To a tangential force", value = json!({"force": 1.5}))),
        ("oblique" = (summary = "Deeper and sideways at once, then the stresses",
            value = json!({"displacement": 1e-7, "indentation": 1.2e-6, "stress": {"points": 50}}))),
        ("back a little" = (summary = "By an increment", value = json!({"displacement": -2e-8, "relative": true}))),
        ("lift off" = (summary = "Out of contact, which erases the memory", value = json!({"indentation": -1e-6})))
    )),
    responses((status = 200, description = "The state after the move", body = MoveReply,
        headers(("ETag" = String, description = "The new sequence in quotes"))))
)]
pub async fn move_contact(
    ContactPath { app, id, .. }: ContactPath,
    IfMatch { expected }: IfMatch,
    request: CheckedBody<MoveRequest>,
) -> Result<Response, Problem> {
    advance(&app, id, expected, request).await
}

/// Follow a path
///
/// Applies all moves of the path, or none if one of them is refused.
#[utoipa::path(
    post, path = "/contacts/{id}/path", tag = "contacts", params(ContactPath, IfMatch, IdempotencyKey),
    request_body(content = PathRequest, examples(
        ("displacements" = (summary = "Back and forth", value = json!({"path": {"displacement": [1e-7, -1e-7, 0.0]}}))),
        ("falling amplitude" = (summary = "Until almost no force is left, the last state alone",
            value = json!({"path": {"falling_amplitude": {"reversals": 20, "amplitude": 2e-7}}, "steps": "last"}))),
        ("moves" = (summary = "Lift off and touch again",
            value = json!({
                "path": {"moves": [{"indentation": -1e-7}, {"indentation": 1e-6}, {"displacement": 1e-7}]}
            })))
    )),
    responses((status = 200, description = "The states along the path", body = PathReply,
        headers(("ETag" = String, description = "The new sequence in quotes"))))
)]
pub async fn follow_path(
    ContactPath { app, id, .. }: ContactPath,
    IfMatch { expected }: IfMatch,
    request: CheckedBody<PathRequest>,
) -> Result<Response, Problem> {
    advance(&app, id, expected, request).await
}

/// Relax a contact
///
/// Finds the path from the present state that leaves the least shear stress, whatever the history, and applies all of
/// it or nothing. A dry run returns the same and changes nothing.
#[utoipa::path(
    post, path = "/contacts/{id}/relax", tag = "contacts", params(ContactPath, IfMatch, IdempotencyKey),
    request_body(content = RelaxRequest, examples(
        ("show" = (summary = "What 20 reversals would leave", value = json!({"reversals": 20, "dry_run": true}))),
        ("relax" = (summary = "As few as leave a fifth, with the states along the path",
            value = json!({"target": 0.2, "steps": "all"})))
    )),
    responses((status = 200, description = "The path, and the stress that remains", body = RelaxReply,
        headers(("ETag" = String, description = "The sequence in quotes: the new one, or the present one after a dry \
            run"))))
)]
pub async fn relax_contact(
    ContactPath { app, id, .. }: ContactPath,
    IfMatch { expected }: IfMatch,
    request: CheckedBody<RelaxRequest>,
) -> Result<Response, Problem> {
    let CheckedBody { body, key, context } = request;
    if body.dry_run {
        let memory = &mut context.admission.memory.clone();
        let (sequence, body) = app.sessions.dry_run_relax(id, body, expected, memory).await?;
        return Ok(reply::at_sequence(sequence, body));
    }
    let advance = Advance::from(body);
    context.reserve(bytes_of_moves(&advance)).await?;
    Ok(reply::of_change(app.sessions.apply(id, advance, expected, key).await?))
}

/// Moves a contact by a checked body.
pub(super) async fn advance<T: Parse<Checked = Advance>>(
    app: &App,
    id: Uuid,
    expected: Option<Expected>,
    CheckedBody { body, key, context }: CheckedBody<T>,
) -> Result<Response, Problem> {
    context.reserve(bytes_of_moves(&body)).await?;
    Ok(reply::of_change(app.sessions.apply(id, body, expected, key).await?))
}
