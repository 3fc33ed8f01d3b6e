//! `/contacts/{id}/history`: the moves that a contact has made.

use std::sync::Arc;

use axum::http::{HeaderMap, HeaderValue, header};
use axum::response::Response;
use uuid::Uuid;

use stickslip_wire::HistoryPage;

use super::whole_history;
use crate::api::formats::{Format, TableStream, plots, tables};
use crate::api::parameters::{FLAG, Formats, parameters};
use crate::api::params::ContactPath;
use crate::api::problem::Problem;
use crate::api::query::{CheckedQuery, Moves, MovesQuery};
use crate::api::reply;
use crate::api::state::{App, TenantApp};
use crate::formats::Unwritable;

/// Bytes of an item of a history.
pub(super) const ITEM_BYTES: usize = 2_048;

parameters! {
    /// What a history has of each move.
    pub struct HistoryQuery {
        /// Whether to add the cycle that a move closed to it. This needs the moves before the page too, once: without
        /// it nothing but the page is read.
        cycles: bool = FLAG, or true;
        /// `columns` (this document), `rows` (a JSON array of flat objects), `csv`, `ndjson`, `arrow` (an Arrow IPC
        /// stream), or a plot as `svg` or `png`. If it is left out, `Accept` decides.
        format: Option<Format> = Formats(&Format::ALL);
    }
}

/// Get the history of a contact
///
/// Moves with the states after them and the cycles that they closed, oldest first: a page, the newest, or all of them.
#[utoipa::path(
    get, path = "/contacts/{id}/history", tag = "contacts", params(ContactPath, MovesQuery, HistoryQuery),
    responses((status = 200, description = "A page of moves", body = HistoryPage,
        headers(("ETag" = String, description = "The version of this page, in quotes"))))
)]
pub async fn get_history(
    TenantApp(app): TenantApp,
    ContactPath { id }: ContactPath,
    headers: HeaderMap,
    CheckedQuery((moves, query)): CheckedQuery<(MovesQuery, HistoryQuery)>,
) -> Result<Response, Problem> {
    let HistoryQuery { cycles, format } = query;
    let format = Format::chosen(format, &headers, &Format::ALL)?;
    let unmarked = if cycles { "" } else { "-unmarked" };
    let (after, limit) = match moves.of(format) {
        Moves::Page(after, limit) => (after, limit),
        Moves::Newest(limit) => (newest(&app, id, limit).await?, limit),
        Moves::All => {
            let owned = Arc::clone(&app);
            let write = move |table, after, limit| write_page(Arc::clone(&owned), id, (after, limit), cycles, table);
            return whole_history::reply(
                &app,
                id,
                &headers,
                (format, unmarked),
                whole_history::PAGE * ITEM_BYTES,
                write,
            )
            .await;
        }
    };
    let memory = app.pool.reserve(limit * ITEM_BYTES + format.bytes(0, 0)).await?;
    let mut page = app.sessions.history().page(id, after, limit).await?;
    let tag = format.tag(&(version(&page, after) + unmarked));
    if reply::is_current(&headers, &tag) {
        return Ok(reply::not_modified(&tag));
    }
    if cycles && !format.is_plot() {
        app.sessions.cycles().mark(id, &mut page).await?;
    }
    let next = page.next;
    let names_makers = app.sessions.names_makers();
    let write = move || format.write(&page, || plots::history(id, &page), || tables::history(&page, names_makers));
    let response = reply::tagged(format.reply(app.pool.run(format.cost(), write).await??), &tag);
    let choice = if cycles { "" } else { "&cycles=false" };
    let query = |next| format!("after={next}&limit={limit}{choice}&format={}", format.name());
    let next = next.map(|next| format!("/contacts/{id}/history?{}", query(next)));
    Ok(reply::holding(with_next(response, next), memory))
}

/// The move after which the newest moves begin, so many of them.
pub(super) async fn newest(app: &App, id: Uuid, limit: usize) -> Result<u64, Problem> {
    Ok(app.sessions.history().sequence(id).await?.saturating_sub(limit as u64))
}

async fn write_page(
    app: Arc<App>,
    id: Uuid,
    (after, limit): (u64, usize),
    cycles: bool,
    mut table: TableStream,
) -> Result<(TableStream, Vec<u8>), Problem> {
    let mut page = app.sessions.history().page(id, after, limit).await?;
    if cycles {
        app.sessions.cycles().mark(id, &mut page).await?;
    }
    let block = table.push(&tables::history(&page, app.sessions.names_makers())).map_err(Unwritable::new)?;
    Ok((table, block))
}

/// The version of a page. Moves never change, so that the last one and whether more follow determine a page.
pub(super) fn version(page: &HistoryPage, after: u64) -> String {
    let last = page.items.last().map_or(after, |item| item.sequence);
    let more = if page.next.is_some() { "-more" } else { "" };
    format!("{last}{more}")
}

/// The reply with the URL of the next page, if there is one.
pub(super) fn with_next(mut response: Response, next: Option<String>) -> Response {
    let link = next.and_then(|next| HeaderValue::from_str(&format!("<{next}>; rel=\"next\"")).ok());
    response.headers_mut().extend(link.map(|link| (header::LINK, link)));
    response
}
