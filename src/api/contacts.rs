//! `/contacts`: sessions are made, listed, looked at, forked and deleted.

use axum::http::StatusCode;
use axum::response::Response;
use utoipa::IntoParams;
use uuid::Uuid;

use crate::wire::{CreateRequest, ForkRequest, HistoryPage, NewSession, SessionPage, SessionReply, StressReply};

use super::access::Own;
use super::extract::{Command, ContactId, Expected, OptionalCommand};
use super::openapi::{ContactPath, IdempotencyKey, IfMatch};
use super::problem::Problem;
use super::query::Params;
use super::{limits, reply};

/// Create a contact
///
/// The contact is preloaded, and has never moved sideways. It lives until it is deleted.
#[utoipa::path(
    post, path = "/contacts", tag = "contacts", params(IdempotencyKey), request_body = CreateRequest,
    responses((status = 201, description = "The new contact", body = NewSession, headers(
        ("Location" = String, description = "The path of the contact"), ("ETag" = String, description = "Its sequence in quotes")
    )))
)]
pub async fn create(Own(app): Own, command: Command<CreateRequest>) -> Result<Response, Problem> {
    Ok(reply::of_change(app.sessions.create(command.body, command.key).await?))
}

/// Which contacts to list.
#[derive(IntoParams)]
#[into_params(parameter_in = Query)]
#[expect(dead_code, reason = "described here, read by `Params`")]
pub struct ListQuery {
    /// How many at most.
    #[param(nullable = false)]
    limit: Option<usize>,
    /// The `next` of the page before.
    #[param(nullable = false)]
    after: Option<Uuid>,
}

/// List the contacts
///
/// A page of them, oldest first.
#[utoipa::path(
    get, path = "/contacts", tag = "contacts", params(ListQuery),
    responses((status = 200, description = "A page of contacts", body = SessionPage))
)]
pub async fn list(Own(app): Own, params: Params) -> Result<Response, Problem> {
    let (after, limit) = params.page("the identifier of a contact")?;
    let held = app.pool.reserve(limit * limits::SUMMARY).await?;
    Ok(reply::holding(reply::json(reply::written(&app.sessions.list(after, limit).await?)?), held))
}

/// Look at a contact
#[utoipa::path(
    get, path = "/contacts/{id}", tag = "contacts", params(ContactPath),
    responses((status = 200, description = "The contact and its state", body = SessionReply,
        headers(("ETag" = String, description = "Its sequence in quotes"))))
)]
pub async fn get(Own(app): Own, ContactId(id): ContactId, params: Params) -> Result<Response, Problem> {
    params.none()?;
    let session = app.sessions.get(id).await?;
    Ok(reply::at_sequence(session.sequence, reply::written(&session)?))
}

/// Delete a contact
///
/// With its past. Forks of it live on.
#[utoipa::path(
    delete, path = "/contacts/{id}", tag = "contacts", params(ContactPath, IfMatch),
    responses((status = 204, description = "It is gone"))
)]
pub async fn delete(
    Own(app): Own,
    ContactId(id): ContactId,
    Expected(expected): Expected,
) -> Result<StatusCode, Problem> {
    app.sessions.delete(id, expected).await?;
    Ok(StatusCode::NO_CONTENT)
}

/// Fork a contact
///
/// Makes a new contact with the same past, which then goes its own way. The body may be left out.
#[utoipa::path(
    post, path = "/contacts/{id}/fork", tag = "contacts", params(ContactPath, IdempotencyKey),
    request_body(content = ForkRequest, example = json!({"label": "what if"})),
    responses((status = 201, description = "The new contact", body = NewSession, headers(
        ("Location" = String, description = "The path of the contact"), ("ETag" = String, description = "Its sequence in quotes")
    )))
)]
pub async fn fork(
    Own(app): Own,
    ContactId(id): ContactId,
    OptionalCommand(command): OptionalCommand<ForkRequest>,
) -> Result<Response, Problem> {
    Ok(reply::of_change(app.sessions.fork(id, command.body, command.key).await?))
}

/// Where stresses are asked for.
#[derive(IntoParams)]
#[into_params(parameter_in = Query)]
#[expect(dead_code, reason = "described here, read by `Params`")]
pub struct StressQuery {
    /// Number of radii, evenly spaced from the centre to the edge, both included; this or `radii`.
    #[param(nullable = false, example = 100)]
    points: Option<usize>,
    /// Radii, m, with commas between them.
    #[param(nullable = false)]
    radii: Option<String>,
    /// Which fields, with commas between them, out of `pressure`, `shear`, `slip` and `displacement`; left out, the first two.
    #[param(nullable = false)]
    fields: Option<String>,
    /// Whether the extrema of the shear stress are wanted too.
    #[param(nullable = false, default = false)]
    residual: Option<bool>,
}

/// Read the stresses of a contact
#[utoipa::path(
    get, path = "/contacts/{id}/stress", tag = "contacts", params(ContactPath, StressQuery),
    responses((status = 200, description = "The stresses in its present state", body = StressReply,
        headers(("ETag" = String, description = "The sequence that they belong to, in quotes"))))
)]
pub async fn stress(Own(app): Own, ContactId(id): ContactId, params: Params) -> Result<Response, Problem> {
    let (sampling, residual) = params.stress()?;
    let (sequence, body, held) = app.sessions.stress(id, sampling, residual).await?;
    Ok(reply::holding(reply::at_sequence(sequence, body), held))
}

/// Which moves to list.
#[derive(IntoParams)]
#[into_params(parameter_in = Query)]
#[expect(dead_code, reason = "described here, read by `Params`")]
pub struct HistoryQuery {
    /// The `next` of the page before.
    #[param(nullable = false)]
    after: Option<u64>,
    /// How many at most.
    #[param(nullable = false)]
    limit: Option<usize>,
}

/// Read the past of a contact
///
/// A page of its moves with the states after them, oldest first.
#[utoipa::path(
    get, path = "/contacts/{id}/history", tag = "contacts", params(ContactPath, HistoryQuery),
    responses((status = 200, description = "A page of moves", body = HistoryPage))
)]
pub async fn history(Own(app): Own, ContactId(id): ContactId, params: Params) -> Result<Response, Problem> {
    let (after, limit) = params.page("the number of a move")?;
    let held = app.pool.reserve(limit * limits::HISTORY_ITEM).await?;
    let page = app.sessions.history(id, after.unwrap_or(0), limit).await?;
    Ok(reply::holding(reply::json(reply::written(&page)?), held))
}
