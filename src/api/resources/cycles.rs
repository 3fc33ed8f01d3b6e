//! `/contacts/{id}/cycles`: the closed cycles of a contact's past.

use axum::http::{HeaderMap, header};
use axum::response::Response;

use stickslip_wire::{CyclePage, limits};

use crate::api::formats::{Format, plots, tables};
use crate::api::parameters::{Formats, count, parameters};
use crate::api::params::ContactPath;
use crate::api::problem::Problem;
use crate::api::query::{CheckedQuery, DEFAULT_PAGE};
use crate::api::reply;
use crate::api::state::TenantApp;

/// Bytes of a cycle in the longest of the formats.
const CYCLE_BYTES: usize = 1_024;

parameters! {
    /// Which cycles to list.
    pub struct CyclesQuery {
        /// How many of the newest cycles at most.
        last: usize = count(&limits::CYCLES), or DEFAULT_PAGE;
        /// `columns` (this document), `rows` (a JSON array of flat objects), `csv`, `ndjson`, `arrow` (an Arrow IPC
        /// stream), or a plot as `svg` or `png`. If it is left out, `Accept` decides.
        format: Option<Format> = Formats(&Format::ALL);
    }
}

/// Get the cycles of a contact
///
/// The newest closed cycles of its displacement, oldest first.
#[utoipa::path(
    get, path = "/contacts/{id}/cycles", tag = "contacts", params(ContactPath, CyclesQuery),
    responses((status = 200, description = "The newest cycles", body = CyclePage,
        headers(("ETag" = String, description = "The sequence that they belong to, in quotes"))))
)]
pub async fn get_cycles(
    TenantApp(app): TenantApp,
    ContactPath { id }: ContactPath,
    headers: HeaderMap,
    CheckedQuery(query): CheckedQuery<CyclesQuery>,
) -> Result<Response, Problem> {
    let CyclesQuery { last, format } = query;
    let format = Format::chosen(format, &headers, &Format::ALL)?;
    if headers.contains_key(header::IF_NONE_MATCH) {
        // Before anything is read.
        let tag = format.tag(&app.sessions.get(id).await?.sequence.to_string());
        if reply::is_current(&headers, &tag) {
            return Ok(reply::not_modified(&tag));
        }
    }
    let memory = app.pool.reserve(last * CYCLE_BYTES + format.bytes(0, 0)).await?;
    let (sequence, page) = app.sessions.cycles().newest(id, last).await?;
    let write = move || format.write(&page, || plots::cycles(id, &page), || tables::cycles(&page));
    let body = app.pool.run(format.cost(), write).await??;
    let tag = format.tag(&sequence.to_string());
    Ok(reply::holding(reply::tagged(format.reply(body), &tag), memory))
}
