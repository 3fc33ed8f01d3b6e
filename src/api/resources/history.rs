//! `/contacts/{id}/history`: the moves that a contact has made.

use stickslip_report::plot::Plot;
use stickslip_wire::HistoryPage;

use super::move_series::{self, ITEM_BYTES, MoveSeries};
use super::prelude::*;
use crate::api::formats::{plots, tables};
use crate::api::parameters::FLAG;
use crate::api::query::MovesQuery;
use crate::formats::Table;

parameters! {
    /// What a history has of each move.
    pub struct HistoryQuery {
        /// Whether to add the cycle that a move closed to it. This needs the moves before the page too, once: without
        /// it nothing but the page is read.
        cycles: bool = FLAG, or true;
        /// `columns` (this document), `rows` (a JSON array of flat objects), `csv`, `ndjson`, `arrow` (an Arrow IPC
        /// stream), or a plot as `svg` or `png`. If it is left out, `Accept` decides.
        format: Option<Format> = formats(&Format::ALL);
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
    let shown = History { cycles, names_makers: app.sessions.names_makers() };
    move_series::reply(app, id, &headers, moves, format, shown).await
}

/// Moves with the states after them.
#[derive(Clone)]
struct History {
    /// Whether the cycles that they closed are marked.
    cycles: bool,
    names_makers: bool,
}

impl MoveSeries for History {
    type Page = HistoryPage;

    const NAME: &'static str = "history";

    fn bytes(&self, moves: usize) -> usize {
        moves * ITEM_BYTES
    }

    fn marking(&self) -> &'static str {
        if self.cycles { "" } else { "-unmarked" }
    }

    fn parameters(&self) -> String {
        if self.cycles { String::new() } else { "&cycles=false".to_owned() }
    }

    async fn page(
        &self,
        app: &App,
        id: Uuid,
        _: u64,
        mut moves: HistoryPage,
        format: Format,
    ) -> Result<HistoryPage, Problem> {
        if self.cycles && !format.is_plot() {
            app.sessions.cycles().mark(id, &mut moves).await?;
        }
        Ok(moves)
    }

    fn plot(id: Uuid, page: &HistoryPage) -> Plot {
        plots::history(id, page)
    }

    fn table<'a>(&self, page: &'a HistoryPage) -> Table<'a> {
        tables::history(page, self.names_makers)
    }
}
