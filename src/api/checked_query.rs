//! Query strings. Each operation reads its own into a struct; a parameter that the operation does not have is refused
//! by name.

use std::ops::RangeInclusive;
use std::sync::Arc;

use axum::extract::{FromRequestParts, Query};
use axum::http::HeaderMap;
use axum::http::request::Parts;

use stickslip_wire::{Fault, JsonPath, Rejection};

use super::formats::Format;
use super::problem::Problem;
use super::query_parameters::{MOVE_NUMBER, Number, QueryParams, QueryReader, count, parameters};
use super::state::App;

/// Items of a page.
pub const PAGE: RangeInclusive<usize> = 1..=1_000;
/// Items of a page if the client does not say.
pub const DEFAULT_PAGE: usize = 100;

parameters! {
    /// Which moves of a contact a reply is of, as the query has it.
    pub struct MovesQuery {
        /// The `next` of the previous page.
        after: Option<u64> = MOVE_NUMBER;
        /// Largest number of moves. Without `after`, `limit` and `last`, `csv`, `ndjson` and `arrow` have all moves.
        limit: Option<usize> = Number { suggestion: Some(DEFAULT_PAGE), ..count(&PAGE) };
        /// Number of newest moves, in place of `after` and `limit`. A plot shows the newest unless `after` is given.
        last: Option<usize> = count(&PAGE);
    }
}

/// Which moves of a contact a reply is of.
#[derive(Clone, Copy)]
pub enum Moves {
    /// At most so many after this one.
    Page(u64, usize),
    /// So many, up to the last one.
    Newest(usize),
    All,
}

impl MovesQuery {
    /// The moves for a reply in a format. If the query does not say, a plot shows the newest moves, and a table that
    /// programs read row by row has all of them.
    pub fn of(&self, format: Format) -> Moves {
        match *self {
            MovesQuery { last: Some(last), .. } => Moves::Newest(last),
            MovesQuery { after: None, limit, .. } if format.is_plot() => Moves::Newest(limit.unwrap_or(DEFAULT_PAGE)),
            MovesQuery { after: None, limit: None, .. } if format.is_stream() => Moves::All,
            MovesQuery { after, limit, .. } => Moves::Page(after.unwrap_or(0), limit.unwrap_or(DEFAULT_PAGE)),
        }
    }
}

/// Which moves, and what else.
impl<T: QueryParams> QueryParams for (MovesQuery, T) {
    fn take(query: &mut QueryReader, headers: &HeaderMap) -> Option<(MovesQuery, T)> {
        let moves = MovesQuery::take(query, headers)?;
        if moves.last.is_some() && (moves.after.is_some() || moves.limit.is_some()) {
            query.faults.add(JsonPath::Root.member("last"), "conflicts with `after` and `limit`: leave them out");
        }
        Some((moves, T::take(query, headers)?))
    }
}

/// The checked parameters of a request.
pub struct CheckedQuery<T>(pub T);

impl<T: QueryParams> FromRequestParts<Arc<App>> for CheckedQuery<T> {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, app: &Arc<App>) -> Result<Self, Problem> {
        let given = match Query::<Vec<(String, String)>>::from_request_parts(parts, app).await {
            Ok(Query(given)) => given,
            Err(error) => {
                let fault = Fault::new("", error.body_text());
                return Err(Rejection::Invalid(vec![fault]).into());
            }
        };
        let mut query = QueryReader::new(given);
        let value = T::take(&mut query, &parts.headers);
        query.finish(value).map(CheckedQuery)
    }
}
