//! `/contacts/{id}/loop`: the tangential force over the displacement along the moves of a contact.

use std::sync::Arc;

use axum::http::HeaderMap;
use axum::response::Response;
use uuid::Uuid;

use crate::sessions::{bytes_of_trace, trace};
use stickslip_wire::{LoopPage, limits};

use super::history::{ITEM_BYTES, newest, version, with_next};
use super::whole_history;
use crate::api::formats::{Format, TableStream, plots, tables};
use crate::api::parameters::{Formats, count, parameters};
use crate::api::params::ContactPath;
use crate::api::problem::Problem;
use crate::api::query::{CheckedQuery, Moves, MovesQuery};
use crate::api::reply;
use crate::api::state::{App, TenantApp};
use crate::formats::Unwritable;

parameters! {
    /// How a loop is traced.
    pub struct LoopQuery {
        /// Points for each move, evenly spaced in the quantity that the move prescribes. With 1 they are the recorded
        /// states; with more, the moves are repeated in small steps on a copy of the contact.
        points_per_move: usize = count(&limits::LOOP_POINTS), or 1;
        /// `columns` (this document), `rows` (a JSON array of flat objects), `csv`, `ndjson`, `arrow` (an Arrow IPC
        /// stream), or a plot as `svg` or `png`. If it is left out, `Accept` decides.
        format: Option<Format> = Formats(&Format::ALL);
    }
}

/// Get the hysteresis loop of a contact
///
/// Tangential force and displacement along moves, oldest first: a page, the newest, or all of them.
#[utoipa::path(
    get, path = "/contacts/{id}/loop", tag = "contacts", params(ContactPath, MovesQuery, LoopQuery),
    responses((status = 200, description = "A page of the loop", body = LoopPage,
        headers(("ETag" = String, description = "The version of this page, in quotes"))))
)]
pub async fn get_loop(
    TenantApp(app): TenantApp,
    ContactPath { id }: ContactPath,
    headers: HeaderMap,
    CheckedQuery((moves, query)): CheckedQuery<(MovesQuery, LoopQuery)>,
) -> Result<Response, Problem> {
    let LoopQuery { points_per_move: points, format } = query;
    let format = Format::chosen(format, &headers, &Format::ALL)?;
    let bytes = |moves: usize| moves * ITEM_BYTES + bytes_of_trace(moves * points) + format.bytes(0, 0);
    let (after, limit) = match moves.of(format) {
        Moves::Page(after, limit) => (after, limit),
        Moves::Newest(limit) => (newest(&app, id, limit).await?, limit),
        Moves::All => {
            let owned = Arc::clone(&app);
            let write = move |table, after, limit| write_page(Arc::clone(&owned), id, (after, limit), points, table);
            return whole_history::reply(&app, id, &headers, (format, ""), bytes(whole_history::PAGE), write).await;
        }
    };
    let memory = app.pool.reserve(bytes(limit)).await?;
    let past = app.sessions.history().page(id, after, limit).await?;
    let tag = format.tag(&version(&past, after));
    if reply::is_current(&headers, &tag) {
        return Ok(reply::not_modified(&tag));
    }
    let next = past.next;
    let page = LoopPage { next, ..trace(&app.sessions.history(), id, after, &past.items, points).await? };
    let write = move || format.write(&page, || plots::hysteresis_loop(id, &page), || tables::hysteresis_loop(&page));
    let response = reply::tagged(format.reply(app.pool.run(format.cost(), write).await??), &tag);
    let next = next.map(|next| {
        let query = format!("after={next}&limit={limit}&points_per_move={points}&format={}", format.name());
        format!("/contacts/{id}/loop?{query}")
    });
    Ok(reply::holding(with_next(response, next), memory))
}

async fn write_page(
    app: Arc<App>,
    id: Uuid,
    (after, limit): (u64, usize),
    points: usize,
    mut table: TableStream,
) -> Result<(TableStream, Vec<u8>), Problem> {
    let past = app.sessions.history().page(id, after, limit).await?;
    let page = trace(&app.sessions.history(), id, after, &past.items, points).await?;
    let block = table.push(&tables::hysteresis_loop(&page)).map_err(Unwritable::new)?;
    Ok((table, block))
}
