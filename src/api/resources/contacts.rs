//! `/contacts`: contacts are created, listed, read, forked and deleted.

use super::prelude::*;
use crate::api::query_parameters::{closed, identifier, text};
use crate::sessions::label_checksum;
use crate::store::Page;
use stickslip_compute::simulation::bytes::OBJECT;
use stickslip_wire::session::LABEL;
use stickslip_wire::{
    ContactDefinition, ContactOrder, CreateRequest, ForkRequest, NewSession, RenameRequest, SessionPage, SessionReply,
};

/// Bytes of an item in a list of contacts, with a label of the longest kind.
const SUMMARY_BYTES: usize = 2 * OBJECT;

/// Create a contact
///
/// The contact is preloaded and has not been moved tangentially. It exists until it is deleted.
#[utoipa::path(
    post, path = "/contacts", tag = "contacts", params(IdempotencyKey), request_body = CreateRequest,
    responses((status = 201, description = "The new contact", body = NewSession, headers(
        ("Location" = String, description = "The path of the contact"), ("ETag" = String, description = "Its sequence \
            in quotes")
    )))
)]
pub async fn create_contact(
    TenantApp(app): TenantApp,
    request: CheckedBody<CreateRequest>,
) -> Result<Response, Problem> {
    Ok(reply::of_change(app.sessions.create(request.body, request.key).await?))
}

parameters! {
    pub struct ListQuery {
        /// Only contacts whose label contains this text. Upper and lower case are the same for the letters A to Z; the
        /// empty text finds all contacts with a label.
        label: String = text(&LABEL);
        /// The order: `oldest` or `newest` first.
        order: ContactOrder = closed(&ContactOrder::ALL, ContactOrder::name), or ContactOrder::Oldest;
        /// The `next` of the previous page, in the same order.
        after: Uuid = identifier();
        /// Largest number of contacts.
        limit: usize = count(&PAGE), or DEFAULT_PAGE;
    }
}

/// List contacts
///
/// A page of contacts, with the oldest or the newest first.
#[utoipa::path(
    get, path = "/contacts", tag = "contacts", params(ListQuery),
    responses((status = 200, description = "A page of contacts", body = SessionPage))
)]
pub async fn list_contacts(
    TenantApp(app): TenantApp,
    Context(context): Context,
    CheckedQuery(ListQuery { label, order, after, limit }): CheckedQuery<ListQuery>,
) -> Result<Response, Problem> {
    context.reserve(limit * SUMMARY_BYTES).await?;
    let page = app.sessions.list(label, Page { order, after, limit }).await?;
    Ok(reply::json(reply::written(&page)?))
}

/// Get a contact
///
/// The contact with its present state, without its moves.
#[utoipa::path(
    get, path = "/contacts/{id}", tag = "contacts", params(ContactPath),
    responses((status = 200, description = "The contact and its state", body = SessionReply,
        headers(("ETag" = String, description = "Its sequence, and a checksum of its label after a dot if it has one, \
            in quotes"))))
)]
pub async fn get_contact(
    ContactPath { app, id, .. }: ContactPath,
    headers: HeaderMap,
    _: CheckedQuery<()>,
) -> Result<Response, Problem> {
    let session = app.sessions.get(id).await?;
    reply::versioned(&headers, &tag(session.sequence, session.label.as_deref()), &session)
}

/// The version of a contact: its sequence, and a checksum of its label if it has one, which changes without a move.
fn tag(sequence: u64, label: Option<&str>) -> String {
    let checksum = label.map(|_| format!(".{:08x}", label_checksum(label)));
    formats::tag(Format::Columns, &format!("{sequence}{}", checksum.unwrap_or_default()))
}

/// Rename a contact
///
/// Gives the contact another label, or none. This is not a move: its sequence, its history and the time of its last
/// move do not change.
#[utoipa::path(
    patch, path = "/contacts/{id}", tag = "contacts", params(ContactPath, IfMatch, IdempotencyKey),
    request_body = RenameRequest,
    responses((status = 200, description = "The contact and its state", body = SessionReply,
        headers(("ETag" = String, description = "Its sequence, and a checksum of its label after a dot if it has one, \
            in quotes"))))
)]
pub async fn rename_contact(
    ContactPath { app, id, .. }: ContactPath,
    IfMatch { expected }: IfMatch,
    request: CheckedBody<RenameRequest>,
) -> Result<Response, Problem> {
    let label = request.body.label;
    let reply = app.sessions.rename(id, label.clone(), expected, request.key).await?;
    let tag = tag(reply.sequence, label.as_deref());
    Ok(reply::tagged(reply::of_change(reply), &tag))
}

/// Delete a contact
///
/// Deletes the contact with its history. Its forks remain.
#[utoipa::path(
    delete, path = "/contacts/{id}", tag = "contacts", params(ContactPath, IfMatch),
    responses((status = 204, description = "The contact is deleted"))
)]
pub async fn delete_contact(
    ContactPath { app, id, .. }: ContactPath,
    IfMatch { expected }: IfMatch,
) -> Result<StatusCode, Problem> {
    app.sessions.delete(id, expected).await?;
    Ok(StatusCode::NO_CONTENT)
}

/// Get the definition of a contact
///
/// The definition as it was sent: with another preload, or another path, it serves as the `contact` of a simulation. A
/// fork has the definition of its original.
#[utoipa::path(
    get, path = "/contacts/{id}/definition", tag = "contacts", params(ContactPath),
    responses((status = 200, description = "Profile, material, friction and preload", body = ContactDefinition))
)]
pub async fn get_definition(
    ContactPath { app, id, context }: ContactPath,
    _: CheckedQuery<()>,
) -> Result<Response, Problem> {
    let (body, memory) = app.sessions.definition(id).await?;
    // The reply holds it from now on.
    context.admission.memory.clone().take_over(&memory);
    Ok(reply::json(body))
}

/// Fork a contact
///
/// Creates a new contact with the same history, or with its first `sequence` moves, which then evolves independently.
/// This undoes moves, while the original keeps them. The body may be left out.
#[utoipa::path(
    post, path = "/contacts/{id}/fork", tag = "contacts", params(ContactPath, IdempotencyKey),
    request_body(content = ForkRequest, example = json!({"label": "what if"})),
    responses((status = 201, description = "The new contact", body = NewSession, headers(
        ("Location" = String, description = "The path of the contact"), ("ETag" = String, description = "Its sequence \
            in quotes")
    )))
)]
pub async fn fork_contact(
    ContactPath { app, id, .. }: ContactPath,
    request: CheckedBody<ForkRequest, true>,
) -> Result<Response, Problem> {
    Ok(reply::of_change(app.sessions.fork(id, request.body, request.key).await?))
}
