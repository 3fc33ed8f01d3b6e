//! `/contacts`: sessions are made, listed, looked at, forked and deleted.

use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::response::Response;
use utoipa::IntoParams;
use uuid::Uuid;

use crate::wire::{
    ContactDefinition, CreateRequest, ForkRequest, HistoryPage, NewSession, SessionPage, SessionReply, StressReply,
};

use super::access::Own;
use super::extract::{Command, ContactId, Expected, OptionalCommand};
use super::format::{self, Format};
use super::openapi::{ContactPath, IdempotencyKey, IfMatch};
use super::problem::{Kind, Problem};
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
pub async fn get(
    Own(app): Own,
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
    Own(app): Own,
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
pub async fn definition(Own(app): Own, ContactId(id): ContactId, params: Params) -> Result<Response, Problem> {
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
    /// `columns` (this document), `rows` (a JSON array of flat objects), `csv` or `ndjson`; left out, what `Accept` prefers.
    #[param(nullable = false, default = "columns")]
    format: Option<String>,
}

/// Read the stresses of a contact
#[utoipa::path(
    get, path = "/contacts/{id}/stress", tag = "contacts", params(ContactPath, StressQuery),
    responses((status = 200, description = "The stresses in its present state", body = StressReply,
        headers(("ETag" = String, description = "The sequence that they belong to, in quotes"))))
)]
pub async fn stress(
    Own(app): Own,
    ContactId(id): ContactId,
    headers: HeaderMap,
    params: Params,
) -> Result<Response, Problem> {
    let (sampling, residual, named) = params.stress()?;
    let format = Format::chosen(named, &headers)?;
    if residual && format != Format::Columns {
        let detail = "the extrema are no column: ask for them with the format `columns`";
        return Err(Problem::at(Kind::InvalidInput, "/residual", detail));
    }
    if headers.contains_key(header::IF_NONE_MATCH) {
        // Before anything is computed.
        let tag = format.tag(&app.sessions.get(id).await?.sequence.to_string());
        if reply::is_known(&headers, &tag) {
            return Ok(reply::not_modified(&tag));
        }
    }
    let more = if format == Format::Columns { 0 } else { format::STRESS_ROW };
    let write = move |found: &StressReply| (format != Format::Columns).then(|| format::stress(format, found));
    let (sequence, body, held) = app.sessions.stress(id, sampling, residual, more, write).await?;
    Ok(reply::holding(format.reply(body, &format.tag(&sequence.to_string())), held))
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
    /// `columns` (this document), `rows` (a JSON array of flat objects), `csv` or `ndjson`; left out, what `Accept` prefers.
    #[param(nullable = false, default = "columns")]
    format: Option<String>,
}

/// Read the past of a contact
///
/// A page of its moves with the states after them, oldest first.
#[utoipa::path(
    get, path = "/contacts/{id}/history", tag = "contacts", params(ContactPath, HistoryQuery),
    responses((status = 200, description = "A page of moves", body = HistoryPage,
        headers(("ETag" = String, description = "The version of this page, in quotes"))))
)]
pub async fn history(
    Own(app): Own,
    ContactId(id): ContactId,
    headers: HeaderMap,
    params: Params,
) -> Result<Response, Problem> {
    let (after, limit, named) = params.history()?;
    let format = Format::chosen(named, &headers)?;
    let held = app.pool.reserve(limit * limits::HISTORY_ITEM).await?;
    let page = app.sessions.history(id, after.unwrap_or(0), limit).await?;
    // Moves never change: a page is told by its last move, and by whether there are more.
    let last = page.items.last().map_or(after.unwrap_or(0), |item| item.sequence);
    let more = if page.next.is_some() { "-more" } else { "" };
    let tag = format.tag(&format!("{last}{more}"));
    if reply::is_known(&headers, &tag) {
        return Ok(reply::not_modified(&tag));
    }
    let body = match format {
        Format::Columns => reply::written(&page)?,
        flat => format::history(flat, &page),
    };
    let mut response = format.reply(body, &tag);
    if let Some(next) = page.next {
        let place =
            format!("</contacts/{id}/history?after={next}&limit={limit}&format={}>; rel=\"next\"", format.name());
        if let Ok(place) = HeaderValue::from_str(&place) {
            response.headers_mut().insert(header::LINK, place);
        }
    }
    Ok(reply::holding(response, held))
}
