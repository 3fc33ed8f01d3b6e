//! `/contacts/{id}/move`, `/contacts/{id}/path` and `/contacts/{id}/relax`: sessions move on.

use axum::response::Response;
use uuid::Uuid;

use crate::simulation::cost;
use stickslip_wire::session::Advance;
use stickslip_wire::{Document, MoveReply, MoveRequest, PathReply, PathRequest, RelaxReply, RelaxRequest};

use crate::api::App;
use crate::api::extract::{Command, ContactId, Expected};
use crate::api::openapi::{ContactPath, IdempotencyKey, IfMatch};
use crate::api::problem::Problem;
use crate::api::reply;
use crate::api::state::TenantApp;

/// Move a contact
///
/// Makes one move. Moves of one contact are applied one at a time, in the order of their arrival.
#[utoipa::path(
    post, path = "/contacts/{id}/move", tag = "contacts", params(ContactPath, IfMatch, IdempotencyKey),
    request_body(content = MoveRequest, examples(
        ("sideways" = (summary = "To a tangential displacement", value = json!({"displacement": 1e-7}))),
        ("by force" = (summary = "To a tangential force", value = json!({"force": 1.5}))),
        ("oblique" = (summary = "Deeper and sideways at once, then the stresses",
            value = json!({"displacement": 1e-7, "indentation": 1.2e-6, "stress": {"points": 50}}))),
        ("back a little" = (summary = "By an increment", value = json!({"displacement": -2e-8, "relative": true}))),
        ("lift off" = (summary = "Out of contact, where nothing is remembered", value = json!({"indentation": -1e-6})))
    )),
    responses((status = 200, description = "The state after the move", body = MoveReply,
        headers(("ETag" = String, description = "The new sequence in quotes"))))
)]
pub async fn apply(
    TenantApp(app): TenantApp,
    ContactId(id): ContactId,
    Expected(expected): Expected,
    command: Command<MoveRequest>,
) -> Result<Response, Problem> {
    advance(&app, id, expected, command).await
}

/// Take a contact along a path
///
/// All of it or nothing: if a move of it cannot be made, none is.
#[utoipa::path(
    post, path = "/contacts/{id}/path", tag = "contacts", params(ContactPath, IfMatch, IdempotencyKey),
    request_body(content = PathRequest, examples(
        ("displacements" = (summary = "To and fro", value = json!({"path": {"displacement": [1e-7, -1e-7, 0.0]}}))),
        ("falling amplitude" = (summary = "Until almost no force is left, the last state alone",
            value = json!({"path": {"falling_amplitude": {"reversals": 20, "amplitude": 2e-7}}, "steps": "last"}))),
        ("moves" = (summary = "Lift off and touch again",
            value = json!({"path": {"moves": [{"indentation": -1e-7}, {"indentation": 1e-6}, {"displacement": 1e-7}]}})))
    )),
    responses((status = 200, description = "The states along the path", body = PathReply,
        headers(("ETag" = String, description = "The new sequence in quotes"))))
)]
pub async fn path(
    TenantApp(app): TenantApp,
    ContactId(id): ContactId,
    Expected(expected): Expected,
    command: Command<PathRequest>,
) -> Result<Response, Problem> {
    advance(&app, id, expected, command).await
}

/// Relax a contact
///
/// Finds the path that leaves least shear stress from the present state, whatever its history, and applies all of it or
/// nothing. A dry run shows the same and changes nothing.
#[utoipa::path(
    post, path = "/contacts/{id}/relax", tag = "contacts", params(ContactPath, IfMatch, IdempotencyKey),
    request_body(content = RelaxRequest, examples(
        ("show" = (summary = "What 20 reversals would leave", value = json!({"reversals": 20, "dry_run": true}))),
        ("relax" = (summary = "As few as leave a fifth, with the states along the path",
            value = json!({"target": 0.2, "steps": "all"})))
    )),
    responses((status = 200, description = "The path, and what remains", body = RelaxReply,
        headers(("ETag" = String, description = "The sequence in quotes: the new one, but of a dry run"))))
)]
pub async fn relax(
    TenantApp(app): TenantApp,
    ContactId(id): ContactId,
    Expected(expected): Expected,
    command: Command<RelaxRequest>,
) -> Result<Response, Problem> {
    let Command { body, key, mut held } = command;
    if body.dry_run {
        let (sequence, body, memory) = app.sessions.dry_run_relax(id, body, expected).await?;
        return Ok(reply::holding(reply::at_sequence(sequence, body), memory));
    }
    let advance = Advance::from(body);
    held.resize(&app.pool, cost::bytes_of_advance(&advance)).await?;
    Ok(held.on(reply::of_change(app.sessions.apply_moves(id, advance, expected, key).await?)))
}

async fn advance<T: Document<Checked = Advance>>(
    app: &App,
    id: Uuid,
    expected: Option<u64>,
    Command { body, key, mut held }: Command<T>,
) -> Result<Response, Problem> {
    held.resize(&app.pool, cost::bytes_of_advance(&body)).await?;
    Ok(held.on(reply::of_change(app.sessions.apply_moves(id, body, expected, key).await?)))
}
