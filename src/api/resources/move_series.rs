//! What is shown of the moves of a contact: a page of them, or all of them as one table, which is read page by page
//! while it is sent.

use std::io;
use std::sync::Arc;

use axum::body::Body;
use futures::{StreamExt as _, stream};
use serde::Serialize;
use serde_json::json;
use stickslip_plot::{Axis, Colour, Curve, Drawing, Panel, Plot};
use stickslip_wire::{HistoryPage, JsonPath};

use super::prelude::*;
use crate::admission::{Deadline, Reservation};
use crate::api::formats::TableStream;
use crate::api::query_parameters::{QueryParams, QueryReader, move_number};
use crate::api::request_context::RequestContext;
use stickslip_compute::Stop as _;
use stickslip_compute::formats::{CAPACITY, Table};
use stickslip_compute::simulation::Failure;
use stickslip_compute::simulation::bytes::OBJECT;

/// Moves that are read at once.
const BLOCK: usize = 500;
/// Bytes of an item of a history: the move and the state after it.
pub(super) const ITEM_BYTES: usize = 2 * OBJECT;

parameters! {
    /// Which moves of a contact a reply is of, as the query has it.
    pub struct MovesQuery {
        /// The `next` of the previous page.
        after: u64 = move_number();
        /// Largest number of moves. Without `after`, `limit` and `last`, `csv`, `ndjson` and `arrow` have all moves.
        limit: usize = count(&PAGE).with_default(json!(DEFAULT_PAGE));
        /// Number of newest moves, in place of `after` and `limit`. A plot shows the newest unless `after` is given.
        last: usize = count(&PAGE);
    }
}

/// Which moves, and what else.
impl<T: QueryParams> QueryParams for (MovesQuery, T) {
    fn take(query: &mut QueryReader<'_>) -> Option<(MovesQuery, T)> {
        let moves = MovesQuery::take(query)?;
        if moves.last.is_some() && (moves.after.is_some() || moves.limit.is_some()) {
            query.faults.add(JsonPath::Root.member("last"), "conflicts with `after` and `limit`: leave them out");
        }
        Some((moves, T::take(query)?))
    }
}

pub(super) trait MoveSeries: Clone + Send + Sync + 'static {
    type Page: Serialize + Send + 'static;

    /// The last part of the path.
    const NAME: &'static str;

    /// Bytes that so many moves take.
    fn bytes(&self, moves: usize) -> usize;

    /// Its own part of the query of the next page, and of its version; nothing for what is shown by default.
    fn parameters(&self) -> String;

    /// The document of these moves, which come after another one, for a reply in this format. The memory of the request
    /// is more while it is made.
    fn page(
        &self,
        app: &App,
        id: Uuid,
        after: u64,
        moves: HistoryPage,
        format: Format,
        memory: &mut Reservation,
    ) -> impl Future<Output = Result<Self::Page, Problem>> + Send;

    fn plot(page: &Self::Page) -> Plot;

    fn table<'a>(&self, page: &'a Self::Page) -> Table<'a>;
}

/// The reply with the moves that the query asks for. If it does not say, a plot shows the newest moves, and a table
/// that programs read row by row has all of them.
pub(super) async fn reply<T: MoveSeries>(
    app: Arc<App>,
    context: Arc<RequestContext>,
    id: Uuid,
    headers: &HeaderMap,
    moves: MovesQuery,
    format: Format,
    shown: T,
) -> Result<Response, Problem> {
    let MovesQuery { after, limit, last } = moves;
    if (after, limit, last) == (None, None, None) && format.is_stream() {
        return all(app, context, id, headers, format, shown).await;
    }
    let limit = last.or(limit).unwrap_or(DEFAULT_PAGE);
    let newest = last.is_some() || after.is_none() && format.is_plot();
    let after = if newest { app.sessions.sequence(id).await?.saturating_sub(limit as u64) } else { after.unwrap_or(0) };
    context.reserve(shown.bytes(limit) + format.bytes(0, 0)).await?;
    let moves = app.sessions.history(id, after, limit).await?;
    let tag = formats::tag(format, &(version(&moves, after) + &shown.parameters()));
    if reply::is_current(headers, &tag) {
        return Ok(reply::not_modified(&tag));
    }
    let next = moves.next.and_then(|next| {
        let query = format!("after={next}&limit={limit}{}&format={}", shown.parameters(), format.name());
        HeaderValue::from_str(&format!("</contacts/{id}/{}?{query}>; rel=\"next\"", T::NAME)).ok()
    });
    let page = shown.page(&app, id, after, moves, format, &mut context.admission.memory.clone()).await?;
    let write = move |stop: &Deadline| {
        let (plot, table) = (|| Some(Drawing::Plot(T::plot(&page))), || Some(shown.table(&page)));
        let written = format.write(CAPACITY, &page, &plot, &table, &|| stop.check().is_ok());
        if written.is_err() {
            stop.check().map_err(Failure::from)?;
        }
        Ok::<_, Problem>(written?)
    };
    let mut response = reply::tagged(formats::reply(format, context.run(format.cost(), write).await??), &tag);
    response.headers_mut().extend(next.map(|next| (header::LINK, next)));
    Ok(response)
}

/// The version of a page. Moves never change, so that the last one and whether more follow determine a page.
fn version(page: &HistoryPage, after: u64) -> String {
    let last = page.items.last().map_or(after, |item| item.sequence);
    let more = if page.next.is_some() { "-more" } else { "" };
    format!("{last}{more}")
}

/// The reply with all moves of a contact as one table.
async fn all<T: MoveSeries>(
    app: Arc<App>,
    context: Arc<RequestContext>,
    id: Uuid,
    headers: &HeaderMap,
    format: Format,
    shown: T,
) -> Result<Response, Problem> {
    let end = app.sessions.sequence(id).await?;
    let tag = formats::tag(format, &format!("{end}-all{}", shown.parameters()));
    if reply::is_current(headers, &tag) {
        return Ok(reply::not_modified(&tag));
    }
    app.sessions.check_complete(id, end).await?;
    context.reserve(shown.bytes(BLOCK)).await?;
    let memory = context.admission.memory.clone();
    let stream = TableStream::new(format);
    let mut table = WholeTable { app, id, shown, format, stream, end, after: 0, is_done: false, memory };
    // Before the reply begins, which cannot be taken back.
    let first = table.next().await?;
    let rest = stream::try_unfold(table, async |mut table| {
        if table.is_done {
            return Ok::<_, io::Error>(None);
        }
        let block = table.next().await.map_err(broken_off)?;
        Ok(Some((block, table)))
    });
    let body = Body::from_stream(stream::iter([Ok(first)]).chain(rest));
    Ok(reply::tagged(formats::reply(format, body), &tag))
}

/// The table of the moves 1 to `end`, while it is written.
struct WholeTable<T> {
    app: Arc<App>,
    id: Uuid,
    shown: T,
    format: Format,
    stream: TableStream,
    end: u64,
    /// The last move that has been written.
    after: u64,
    is_done: bool,
    memory: Reservation,
}

impl<T: MoveSeries> WholeTable<T> {
    async fn next(&mut self) -> Result<Vec<u8>, Problem> {
        let limit = BLOCK.min(usize::try_from(self.end - self.after).unwrap_or(BLOCK));
        let moves = self.app.sessions.history(self.id, self.after, limit).await?;
        let memory = &mut self.memory;
        let page = self.shown.page(&self.app, self.id, self.after, moves, self.format, memory).await?;
        let mut block = self.stream.push(&self.shown.table(&page))?;
        self.after += limit as u64;
        self.is_done = self.after >= self.end;
        if self.is_done {
            block.extend(self.stream.finish());
        }
        Ok(block)
    }
}

/// The reply has begun, and can only be cut off: without its last chunk the client knows that something is missing.
fn broken_off(problem: Problem) -> io::Error {
    tracing::warn!(code = problem.code().as_str(), cause = problem.cause(), "a history is cut off while it is sent");
    io::Error::other("a history cannot be read on")
}

/// A panel with one curve.
pub(super) fn curve(
    name: &'static str,
    unit: &'static str,
    colour: Colour,
    points: impl Iterator<Item = (f64, f64)>,
) -> Panel {
    Panel { y: Axis::of(name, unit), curves: vec![Curve::line("", colour, points)] }
}

/// Which moves a plot shows, for its title.
pub(super) fn shown(mut moves: impl DoubleEndedIterator<Item = u64>) -> String {
    let Some(last) = moves.next_back() else { return String::new() };
    match moves.next() {
        Some(first) if first < last => format!(", moves {first} to {last}"),
        _ => format!(", move {last}"),
    }
}
