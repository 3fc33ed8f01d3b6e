//! `/contacts/{id}/loop`: the tangential force over the displacement along the moves of a contact.

use axum::http::HeaderMap;
use axum::response::Response;
use utoipa::IntoParams;

use crate::sessions::Sessions;
use stickslip_wire::{JsonPath, LoopPage, limits};

use super::history::{ITEM_BYTES, version, with_next};
use crate::api::formats::{Format, plots, tables};
use crate::api::params::ContactPath;
use crate::api::problem::Problem;
use crate::api::query::{COUNT, CheckedQuery, QueryParams, QueryReader, SEQUENCE};
use crate::api::reply;
use crate::api::state::TenantApp;

/// Which part of a loop to trace.
#[derive(IntoParams)]
#[into_params(parameter_in = Query)]
pub struct LoopQuery {
    /// The `next` of the previous page.
    #[param(value_type = Option<u64>, nullable = false)]
    after: u64,
    /// How many moves at most.
    #[param(value_type = Option<usize>, nullable = false)]
    limit: usize,
    /// Points for each move, evenly spaced in the quantity that the move prescribes. With 1 they are the recorded
    /// states; with more, the moves are repeated in small steps on a copy of the contact.
    #[param(value_type = Option<usize>, nullable = false, default = 1)]
    points_per_move: usize,
    /// `columns` (this document), `rows` (a JSON array of flat objects), `csv`, `ndjson`, `arrow` (an Arrow IPC
    /// stream), or a plot as `svg` or `png`. If it is left out, `Accept` decides.
    #[param(value_type = Option<String>, nullable = false, default = "columns")]
    format: Option<Format>,
}

impl QueryParams for LoopQuery {
    fn take(query: &mut QueryReader, _: &HeaderMap) -> Option<LoopQuery> {
        let (after, limit) = query.page(SEQUENCE);
        let points_per_move = query.number("points_per_move", COUNT).unwrap_or(1);
        query.faults.count(JsonPath::Root.member("points_per_move"), points_per_move, &limits::LOOP_POINTS);
        Some(LoopQuery { after: after.unwrap_or(0), limit, points_per_move, format: query.format(&Format::ALL) })
    }
}

/// Get the hysteresis loop of a contact
///
/// Tangential force and displacement along a page of its moves, oldest first.
#[utoipa::path(
    get, path = "/contacts/{id}/loop", tag = "contacts", params(ContactPath, LoopQuery),
    responses((status = 200, description = "A page of the loop", body = LoopPage,
        headers(("ETag" = String, description = "The version of this page, in quotes"))))
)]
pub async fn get_loop(
    TenantApp(app): TenantApp,
    ContactPath { id }: ContactPath,
    headers: HeaderMap,
    CheckedQuery(query): CheckedQuery<LoopQuery>,
) -> Result<Response, Problem> {
    let LoopQuery { after, limit, points_per_move: points, format } = query;
    let format = Format::chosen(format, &headers, &Format::ALL)?;
    let bytes = limit * ITEM_BYTES + Sessions::bytes_of_trace(limit * points) + format.bytes(0, 0);
    let memory = app.pool.reserve(bytes).await?;
    let past = app.sessions.history(id, after, limit).await?;
    let tag = format.tag(&version(&past, after));
    if reply::is_current(&headers, &tag) {
        return Ok(reply::not_modified(&tag));
    }
    let next = past.next;
    let page = LoopPage { next, ..app.sessions.trace(id, after, &past.items, points).await? };
    let write = move || format.write(&page, || plots::hysteresis_loop(id, &page), || tables::hysteresis_loop(&page));
    let response = reply::tagged(format.reply(app.pool.run(format.cost(), write).await??), &tag);
    let next = next.map(|next| {
        let query = format!("after={next}&limit={limit}&points_per_move={points}&format={}", format.name());
        format!("/contacts/{id}/loop?{query}")
    });
    Ok(reply::holding(with_next(response, next), memory))
}
