//! All moves of a contact as one table, read page by page while it is sent.

use std::io;

use axum::body::Body;
use axum::http::HeaderMap;
use axum::response::Response;
use futures::future::{Either, ready};
use futures::stream;
use uuid::Uuid;

use crate::api::formats::{Format, TableStream};
use crate::api::problem::Problem;
use crate::api::reply;
use crate::api::state::App;

/// Moves that are read at once.
pub(super) const PAGE: usize = 500;

/// The reply with all moves of a contact, for which `bytes` are reserved. `marking` distinguishes tables of one format.
/// `write` appends so many moves after another one to the table.
pub(super) async fn reply<F>(
    app: &App,
    id: Uuid,
    headers: &HeaderMap,
    (format, marking): (Format, &str),
    bytes: usize,
    write: impl Fn(TableStream, u64, usize) -> F + Send + 'static,
) -> Result<Response, Problem>
where
    F: Future<Output = Result<(TableStream, Vec<u8>), Problem>> + Send + 'static,
{
    let end = app.sessions.history().sequence(id).await?;
    let tag = format.tag(&format!("{end}-all{marking}"));
    if reply::is_current(headers, &tag) {
        return Ok(reply::not_modified(&tag));
    }
    app.sessions.history().check_complete(id, end).await?;
    let memory = app.pool.reserve(bytes).await?;
    // Before the reply begins, which cannot be taken back.
    let first = write(TableStream::new(format), 0, length_of_page(0, end)).await?;
    Ok(reply::holding(reply::tagged(format.reply(table(first, end, write)), &tag), memory))
}

/// Moves of the page after a move.
fn length_of_page(after: u64, end: u64) -> usize {
    PAGE.min(usize::try_from(end - after).unwrap_or(PAGE))
}

/// The table of the moves 1 to `end`, of which the first page is written.
fn table<F>(
    first: (TableStream, Vec<u8>),
    end: u64,
    write: impl Fn(TableStream, u64, usize) -> F + Send + 'static,
) -> Body
where
    F: Future<Output = Result<(TableStream, Vec<u8>), Problem>> + Send + 'static,
{
    let first = (length_of_page(0, end) as u64, Either::Left(ready(Ok(first))));
    let blocks = stream::try_unfold((Some(first), None), move |(first, state)| {
        let next = state.map(|(table, after)| {
            let limit = length_of_page(after, end);
            (after + limit as u64, Either::Right(write(table, after, limit)))
        });
        let page = first.or(next);
        async move {
            let Some((reached, page)) = page else { return Ok::<_, io::Error>(None) };
            let (mut table, mut block) = page.await.map_err(broken_off)?;
            if reached < end {
                return Ok(Some((block, (None, Some((table, reached))))));
            }
            block.extend(table.finish().map_err(|error| broken_off(Problem::internal(error.to_string())))?);
            Ok(Some((block, (None, None))))
        }
    });
    Body::from_stream(blocks)
}

/// The reply has begun, and can only be cut off: without its last chunk the client knows that something is missing.
fn broken_off(problem: Problem) -> io::Error {
    tracing::warn!(code = problem.code().as_str(), cause = problem.cause(), "a history is cut off while it is sent");
    io::Error::other("a history cannot be read on")
}
