//! `/contacts`: sessions are made, listed, looked at, forked and deleted. What they have done is in [`crate::api::resources::reads`].

use axum::http::{HeaderMap, StatusCode};
use axum::response::Response;
use utoipa::IntoParams;
use uuid::Uuid;

use stickslip_wire::{ContactDefinition, CreateRequest, ForkRequest, NewSession, SessionPage, SessionReply};

use crate::api::extract::{Command, ContactId, Expected, OptionalCommand};
use crate::api::formats::Format;
use crate::api::limits;
use crate::api::openapi::{ContactPath, IdempotencyKey, IfMatch};
use crate::api::problem::Problem;
use crate::api::query::Params;
use crate::api::reply;
use crate::api::state::TenantApp;

/// Create a contact
///
/// The contact is preloaded, and has never moved sideways. It lives until it is deleted.
#[utoipa::path(
    post, path = "/contacts", tag = "contacts", params(IdempotencyKey), request_body = CreateRequest,
    responses((status = 201, description = "The new contact", body = NewSession, headers(
        ("Location" = String, description = "The path of the contact"), ("ETag" = String, description = "Its sequence in quotes")
    )))
)]
pub async fn create(TenantApp(app): TenantApp, command: Command<CreateRequest>) -> Result<Response, Problem> {
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
pub async fn list(TenantApp(app): TenantApp, params: Params) -> Result<Response, Problem> {
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
pub async fn get(
    TenantApp(app): TenantApp,
    ContactId(id): ContactId,
    headers: HeaderMap,
    params: Params,
) -> Result<Response, Problem> {
    params.none()?;
    let session = app.sessions.get(id).await?;
    let tag = Format::Columns.tag(&session.sequence.to_string());
    if reply::is_known(&headers, &tag) {
        return Ok(reply::not_modified(&tag));
    }
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
    TenantApp(app): TenantApp,
    ContactId(id): ContactId,
    Expected(expected): Expected,
) -> Result<StatusCode, Problem> {
    app.sessions.delete(id, expected).await?;
    Ok(StatusCode::NO_CONTENT)
}

/// Read the definition of a contact
///
/// As it came: with another preload, or another path, it serves as the `contact` of a simulation. A fork has that of its
/// original.
#[utoipa::path(
    get, path = "/contacts/{id}/definition", tag = "contacts", params(ContactPath),
    responses((status = 200, description = "Profile, material, friction and preload", body = ContactDefinition))
)]
pub async fn definition(
    TenantApp(app): TenantApp,
    ContactId(id): ContactId,
    params: Params,
) -> Result<Response, Problem> {
    params.none()?;
    let (body, held) = app.sessions.definition(id).await?;
    Ok(reply::holding(reply::json(body), held))
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
    TenantApp(app): TenantApp,
    ContactId(id): ContactId,
    OptionalCommand(command): OptionalCommand<ForkRequest>,
) -> Result<Response, Problem> {
    Ok(reply::of_change(app.sessions.fork(id, command.body, command.key).await?))
}
