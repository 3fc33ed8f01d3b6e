//! What contacts have done: their stresses, their history and their hysteresis loop, in every format.

use axum::http::{HeaderMap, HeaderValue, header};
use axum::response::Response;
use utoipa::IntoParams;

use crate::admission::{INLINE, Nanoseconds};
use crate::otlp;
use crate::sessions::Sessions;
use stickslip_mechanics::Contact;
use stickslip_report::plot::Plot;
use stickslip_wire::{HistoryPage, LoopPage, StressReply};

use crate::api::App;
use crate::api::extract::ContactId;
use crate::api::formats::plots;
use crate::api::formats::table::Table;
use crate::api::formats::{self, Format};
use crate::api::limits;
use crate::api::openapi::ContactPath;
use crate::api::problem::{Kind, Problem};
use crate::api::query::Params;
use crate::api::reply;
use crate::api::state::TenantApp;

/// Where stresses are asked for.
#[derive(IntoParams)]
#[into_params(parameter_in = Query)]
#[expect(dead_code, reason = "described here, read by `Params`")]
pub struct StressQuery {
    /// Number of radii, evenly spaced from the centre to the edge, both included; this or `radii`, unless a plot is asked for.
    #[param(nullable = false, example = 100)]
    points: Option<usize>,
    /// Radii, m, with commas between them, or one by one.
    #[param(nullable = false)]
    radii: Option<String>,
    /// Which fields, with commas between them, out of `pressure`, `shear`, `slip` and `displacement`; left out, the first two.
    #[param(nullable = false)]
    fields: Option<String>,
    /// Whether the extrema of the shear stress are wanted too.
    #[param(nullable = false, default = false)]
    residual: Option<bool>,
    /// `columns` (this document), `rows` (a JSON array of flat objects), `csv`, `ndjson`, `arrow` (Arrow's IPC stream), or a
    /// plot as `svg` or `png`; left out, what `Accept` prefers.
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
    TenantApp(app): TenantApp,
    ContactId(id): ContactId,
    headers: HeaderMap,
    params: Params,
) -> Result<Response, Problem> {
    let (sampling, residual, named) = params.stress(&headers)?;
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
    let more = (format.bytes(sampling.length(), formats::STRESS_ROW), price(format));
    let write = move |found: &StressReply, contact: &Contact, sequence: u64| {
        written(format, found, || plots::of_stress(id, sequence, contact, found), || Table::of_stress(found))
    };
    let (sequence, body, held) = app.sessions.stress(id, sampling, residual, more, write).await?;
    Ok(reply::holding(format.reply(body?, &format.tag(&sequence.to_string())), held))
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
    /// `columns` (this document), `rows` (a JSON array of flat objects), `csv`, `ndjson`, `arrow` (Arrow's IPC stream), or a
    /// plot as `svg` or `png`; left out, what `Accept` prefers.
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
    TenantApp(app): TenantApp,
    ContactId(id): ContactId,
    headers: HeaderMap,
    params: Params,
) -> Result<Response, Problem> {
    let (after, limit, named) = params.history()?;
    let after = after.unwrap_or(0);
    let format = Format::chosen(named, &headers)?;
    let bytes = limit * limits::HISTORY_ITEM + format.bytes(0, 0);
    let held = app.pool.reserve(bytes).await?;
    let page = app.sessions.history(id, after, limit).await?;
    let tag = format.tag(&version(&page, after));
    if reply::is_known(&headers, &tag) {
        return Ok(reply::not_modified(&tag));
    }
    let next = page.next;
    let body = drawn(&app, format, move || {
        written(format, &page, || plots::of_history(id, &page), || Table::of_history(&page))
    });
    let response = format.reply(body.await?, &tag);
    let rest = next.map(|next| format!("/contacts/{id}/history?after={next}&limit={limit}&format={}", format.name()));
    Ok(reply::holding(linked(response, rest), held))
}

/// Which part of a loop to trace.
#[derive(IntoParams)]
#[into_params(parameter_in = Query)]
#[expect(dead_code, reason = "described here, read by `Params`")]
pub struct LoopQuery {
    /// The `next` of the page before.
    #[param(nullable = false)]
    after: Option<u64>,
    /// How many moves at most.
    #[param(nullable = false)]
    limit: Option<usize>,
    /// Points for each move, evenly spaced in what it names. With 1 they are the recorded states; with more, the moves are made
    /// again in small steps, beside the contact.
    #[param(nullable = false, default = 1)]
    points_per_move: Option<usize>,
    /// `columns` (this document), `rows` (a JSON array of flat objects), `csv`, `ndjson`, `arrow` (Arrow's IPC stream), or a
    /// plot as `svg` or `png`; left out, what `Accept` prefers.
    #[param(nullable = false, default = "columns")]
    format: Option<String>,
}

/// Read the hysteresis loop of a contact
///
/// Tangential force and displacement along a page of its moves, oldest first.
#[utoipa::path(
    get, path = "/contacts/{id}/loop", tag = "contacts", operation_id = "loop", params(ContactPath, LoopQuery),
    responses((status = 200, description = "A page of the loop", body = LoopPage,
        headers(("ETag" = String, description = "The version of this page, in quotes"))))
)]
pub async fn hysteresis(
    TenantApp(app): TenantApp,
    ContactId(id): ContactId,
    headers: HeaderMap,
    params: Params,
) -> Result<Response, Problem> {
    let (after, limit, points, named) = params.hysteresis()?;
    let after = after.unwrap_or(0);
    let format = Format::chosen(named, &headers)?;
    let bytes = limit * limits::HISTORY_ITEM + Sessions::bytes_of_trace(limit * points) + format.bytes(0, 0);
    let held = app.pool.reserve(bytes).await?;
    let past = app.sessions.history(id, after, limit).await?;
    let tag = format.tag(&version(&past, after));
    if reply::is_known(&headers, &tag) {
        return Ok(reply::not_modified(&tag));
    }
    let next = past.next;
    let page = LoopPage { next, ..app.sessions.trace(id, after, &past.items, points).await? };
    let body =
        drawn(&app, format, move || written(format, &page, || plots::of_loop(id, &page), || Table::of_loop(&page)));
    let response = format.reply(body.await?, &tag);
    let rest = next.map(|next| {
        let way = format!("after={next}&limit={limit}&points_per_move={points}&format={}", format.name());
        format!("/contacts/{id}/loop?{way}")
    });
    Ok(reply::holding(linked(response, rest), held))
}

/// Moves never change: a page is told by its last move, and by whether there are more.
fn version(page: &HistoryPage, after: u64) -> String {
    let last = page.items.last().map_or(after, |item| item.sequence);
    let more = if page.next.is_some() { "-more" } else { "" };
    format!("{last}{more}")
}

/// A body written where one stands, or on a thread of its own if it is a picture.
async fn drawn(
    app: &App,
    format: Format,
    write: impl FnOnce() -> Result<Vec<u8>, Problem> + Send + 'static,
) -> Result<Vec<u8>, Problem> {
    app.pool.run(price(format), write).await?
}

/// A page in a format, and what makes a plot or a table of it where one is wanted.
fn written(
    format: Format,
    page: &impl serde::Serialize,
    plot: impl FnOnce() -> Plot,
    table: impl FnOnce() -> Table,
) -> Result<Vec<u8>, Problem> {
    match format {
        Format::Columns => reply::written(page),
        Format::Svg | Format::Png => otlp::part!("write").in_scope(|| plots::written(format, &plot())),
        flat => otlp::part!("write").in_scope(|| table().written(flat)),
    }
}

/// What writing costs beyond the numbers: a picture takes a thread of its own.
fn price(format: Format) -> Nanoseconds {
    if format.is_plot() { INLINE } else { 0 }
}

/// The reply with the place of what comes next, if anything does.
fn linked(mut response: Response, next: Option<String>) -> Response {
    let place = next.and_then(|place| HeaderValue::from_str(&format!("<{place}>; rel=\"next\"")).ok());
    response.headers_mut().extend(place.map(|place| (header::LINK, place)));
    response
}
