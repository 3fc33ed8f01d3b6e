//! `/contacts`: contacts are created, listed, read, forked and deleted.

use axum::http::{HeaderMap, StatusCode};
use axum::response::Response;
use utoipa::IntoParams;
use uuid::Uuid;

use crate::api::extract::{CheckedBody, OptionalBody};
use crate::api::formats::Format;
use crate::api::params::{ContactPath, IdempotencyKey, IfMatch};
use crate::api::problem::Problem;
use crate::api::query::{CheckedQuery, QueryParams, QueryReader};
use crate::api::reply;
use crate::api::state::TenantApp;
use stickslip_wire::{ContactDefinition, CreateRequest, ForkRequest, NewSession, SessionPage, SessionReply};

/// Bytes of an item in a list of contacts.
const SUMMARY_BYTES: usize = 2_048;

/// Create a contact
///
/// The contact is preloaded and has not been moved tangentially. It exists until it is deleted.
#[utoipa::path(
    post, path = "/contacts", tag = "contacts", params(IdempotencyKey), request_body = CreateRequest,
    responses((status = 201, description = "The new contact", body = NewSession, headers(
        ("Location" = String, description = "The path of the contact"), ("ETag" = String, description = "Its sequence in quotes")
    )))
)]
pub async fn create_contact(
    TenantApp(app): TenantApp,
    request: CheckedBody<CreateRequest>,
) -> Result<Response, Problem> {
    Ok(reply::of_change(app.sessions.create(request.body, request.key).await?))
}

/// Which contacts to list.
#[derive(IntoParams)]
#[into_params(parameter_in = Query)]
pub struct ListQuery {
    /// How many contacts at most.
    #[param(value_type = Option<usize>, nullable = false)]
    limit: usize,
    /// The `next` of the previous page.
    #[param(nullable = false)]
    after: Option<Uuid>,
}

impl QueryParams for ListQuery {
    fn take(query: &mut QueryReader, _: &HeaderMap) -> Option<ListQuery> {
        let (after, limit) = query.contacts();
        Some(ListQuery { limit, after })
    }
}

/// List contacts
///
/// A page of contacts, oldest first.
#[utoipa::path(
    get, path = "/contacts", tag = "contacts", params(ListQuery),
    responses((status = 200, description = "A page of contacts", body = SessionPage))
)]
pub async fn list_contacts(
    TenantApp(app): TenantApp,
    CheckedQuery(ListQuery { limit, after }): CheckedQuery<ListQuery>,
) -> Result<Response, Problem> {
    let memory = app.pool.reserve(limit * SUMMARY_BYTES).await?;
    Ok(reply::holding(reply::json(reply::written(&app.sessions.list(after, limit).await?)?), memory))
}

/// Get a contact
#[utoipa::path(
    get, path = "/contacts/{id}", tag = "contacts", params(ContactPath),
    responses((status = 200, description = "The contact and its state", body = SessionReply,
        headers(("ETag" = String, description = "Its sequence in quotes"))))
)]
pub async fn get_contact(
    TenantApp(app): TenantApp,
    ContactPath { id }: ContactPath,
    headers: HeaderMap,
    _: CheckedQuery<()>,
) -> Result<Response, Problem> {
    let session = app.sessions.get(id).await?;
    let tag = Format::Columns.tag(&session.sequence.to_string());
    if reply::is_current(&headers, &tag) {
        return Ok(reply::not_modified(&tag));
    }
    Ok(reply::at_sequence(session.sequence, reply::written(&session)?))
}

/// Delete a contact
///
/// Deletes the contact with its history. Its forks remain.
#[utoipa::path(
    delete, path = "/contacts/{id}", tag = "contacts", params(ContactPath, IfMatch),
    responses((status = 204, description = "The contact is deleted"))
)]
pub async fn delete_contact(
    TenantApp(app): TenantApp,
    ContactPath { id }: ContactPath,
    IfMatch { sequence }: IfMatch,
) -> Result<StatusCode, Problem> {
    app.sessions.delete(id, sequence).await?;
    Ok(StatusCode::NO_CONTENT)
}

/// Get the definition of a contact
///
/// As it was sent: with another preload, or another path, it serves as the `contact` of a simulation. A fork has the
/// definition of its original.
#[utoipa::path(
    get, path = "/contacts/{id}/definition", tag = "contacts", params(ContactPath),
    responses((status = 200, description = "Profile, material, friction and preload", body = ContactDefinition))
)]
pub async fn get_definition(
    TenantApp(app): TenantApp,
    ContactPath { id }: ContactPath,
    _: CheckedQuery<()>,
) -> Result<Response, Problem> {
    let (body, memory) = app.sessions.definition(id).await?;
    Ok(reply::holding(reply::json(body), memory))
}

/// Fork a contact
///
/// Creates a new contact with the same history, which then evolves independently. The body may be left out.
#[utoipa::path(
    post, path = "/contacts/{id}/fork", tag = "contacts", params(ContactPath, IdempotencyKey),
    request_body(content = ForkRequest, example = json!({"label": "what if"})),
    responses((status = 201, description = "The new contact", body = NewSession, headers(
        ("Location" = String, description = "The path of the contact"), ("ETag" = String, description = "Its sequence in quotes")
    )))
)]
pub async fn fork_contact(
    TenantApp(app): TenantApp,
    ContactPath { id }: ContactPath,
    request: OptionalBody<ForkRequest>,
) -> Result<Response, Problem> {
    Ok(reply::of_change(app.sessions.fork(id, request.body, request.key).await?))
}
