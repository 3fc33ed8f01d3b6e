//! `/contacts/{id}/history`: the moves that a contact has made.

use axum::http::{HeaderMap, HeaderValue, header};
use axum::response::Response;
use utoipa::IntoParams;

use stickslip_wire::HistoryPage;

use crate::api::formats::{Format, plots, tables};
use crate::api::params::ContactPath;
use crate::api::problem::Problem;
use crate::api::query::{CheckedQuery, QueryParams, QueryReader, SEQUENCE};
use crate::api::reply;
use crate::api::state::TenantApp;

/// Bytes of an item of a history.
pub(super) const ITEM_BYTES: usize = 1_792;

/// Which moves to list.
#[derive(IntoParams)]
#[into_params(parameter_in = Query)]
pub struct HistoryQuery {
    /// The `next` of the previous page.
    #[param(value_type = Option<u64>, nullable = false)]
    after: u64,
    /// How many moves at most.
    #[param(value_type = Option<usize>, nullable = false)]
    limit: usize,
    /// Whether to add the cycle that a move closed to it. This needs the moves before the page too, once: without it
    /// nothing but the page is read.
    #[param(value_type = Option<bool>, nullable = false, default = true)]
    cycles: bool,
    /// `columns` (this document), `rows` (a JSON array of flat objects), `csv`, `ndjson`, `arrow` (an Arrow IPC
    /// stream), or a plot as `svg` or `png`. If it is left out, `Accept` decides.
    #[param(value_type = Option<String>, nullable = false, default = "columns")]
    format: Option<Format>,
}

impl QueryParams for HistoryQuery {
    fn take(query: &mut QueryReader, _: &HeaderMap) -> Option<HistoryQuery> {
        let (after, limit) = query.page(SEQUENCE);
        let cycles = query.number("cycles", "true or false").unwrap_or(true);
        Some(HistoryQuery { after: after.unwrap_or(0), limit, cycles, format: query.format(&Format::ALL) })
    }
}

/// Get the history of a contact
///
/// A page of its moves with the states after them and the cycles that they closed, oldest first.
#[utoipa::path(
    get, path = "/contacts/{id}/history", tag = "contacts", params(ContactPath, HistoryQuery),
    responses((status = 200, description = "A page of moves", body = HistoryPage,
        headers(("ETag" = String, description = "The version of this page, in quotes"))))
)]
pub async fn get_history(
    TenantApp(app): TenantApp,
    ContactPath { id }: ContactPath,
    headers: HeaderMap,
    CheckedQuery(query): CheckedQuery<HistoryQuery>,
) -> Result<Response, Problem> {
    let HistoryQuery { after, limit, cycles, format } = query;
    let format = Format::chosen(format, &headers, &Format::ALL)?;
    let memory = app.pool.reserve(limit * ITEM_BYTES + format.bytes(0, 0)).await?;
    let mut page = app.sessions.history(id, after, limit).await?;
    let unmarked = if cycles { "" } else { "-unmarked" };
    let tag = format.tag(&(version(&page, after) + unmarked));
    if reply::is_current(&headers, &tag) {
        return Ok(reply::not_modified(&tag));
    }
    if cycles && !format.is_plot() {
        app.sessions.mark(id, &mut page).await?;
    }
    let next = page.next;
    let write = move || format.write(&page, || plots::history(id, &page), || tables::history(&page));
    let response = reply::tagged(format.reply(app.pool.run(format.cost(), write).await??), &tag);
    let choice = if cycles { "" } else { "&cycles=false" };
    let query = |next| format!("after={next}&limit={limit}{choice}&format={}", format.name());
    let next = next.map(|next| format!("/contacts/{id}/history?{}", query(next)));
    Ok(reply::holding(with_next(response, next), memory))
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
