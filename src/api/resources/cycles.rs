//! `/contacts/{id}/cycles`: the closed cycles of a contact's past.

use stickslip_wire::{CyclePage, limits};

use super::prelude::*;
use crate::api::formats::{plots, tables};

/// Bytes of a cycle in the longest of the formats.
const CYCLE_BYTES: usize = 1_024;

parameters! {
    /// Which cycles to list.
    pub struct CyclesQuery {
        /// How many of the newest cycles at most.
        last: usize = count(&limits::CYCLES), or DEFAULT_PAGE;
        /// `columns` (this document), `rows` (a JSON array of flat objects), `csv`, `ndjson`, `arrow` (an Arrow IPC
        /// stream), or a plot as `svg` or `png`. If it is left out, `Accept` decides.
        format: Option<Format> = formats(&Format::ALL);
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
    if let Some(unchanged) = computations::unchanged(&app, id, &headers, format).await? {
        return Ok(unchanged);
    }
    let memory = app.pool.reserve(last * CYCLE_BYTES + format.bytes(0, 0)).await?;
    let (sequence, page) = app.sessions.cycles().newest(id, last).await?;
    let write = move || format.write(&page, || plots::cycles(id, &page), || tables::cycles(&page));
    let body = app.pool.run(format.cost(), write).await??;
    let tag = format.tag(&sequence.to_string());
    Ok(reply::holding(reply::tagged(format.reply(body), &tag), memory))
}
