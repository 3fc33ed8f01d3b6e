//! All moves of a contact as one table, read page by page while it is sent.

use std::io;

use axum::body::Body;
use axum::http::HeaderMap;
use axum::response::Response;
use futures::stream;
use uuid::Uuid;

use crate::api::formats::{Format, TableStream};
use crate::api::problem::Problem;
use crate::api::reply;
use crate::api::state::App;

/// Moves that are read at once.
pub(super) const PAGE: usize = 500;

/// The reply with all moves of a contact, for which `bytes` are reserved. `marking` distinguishes tables of one format. `write`
/// appends so many moves after another one to the table.
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
    let end = app.sessions.sequence(id).await?;
    let tag = format.tag(&format!("{end}-all{marking}"));
    if reply::is_current(headers, &tag) {
        return Ok(reply::not_modified(&tag));
    }
    let memory = app.pool.reserve(bytes).await?;
    Ok(reply::holding(reply::tagged(format.reply(table(format, end, write)), &tag), memory))
}

/// The table of the moves 1 to `end`.
fn table<F>(format: Format, end: u64, write: impl Fn(TableStream, u64, usize) -> F + Send + 'static) -> Body
where
    F: Future<Output = Result<(TableStream, Vec<u8>), Problem>> + Send + 'static,
{
    let blocks = stream::try_unfold(Some((TableStream::new(format), 0)), move |state| {
        let page = state.map(|(table, after)| {
            let limit = PAGE.min(usize::try_from(end - after).unwrap_or(PAGE));
            (after + limit as u64, write(table, after, limit))
        });
        async move {
            let Some((reached, page)) = page else { return Ok::<_, io::Error>(None) };
            let (mut table, mut block) = page.await.map_err(broken_off)?;
            if reached < end {
                return Ok(Some((block, Some((table, reached)))));
            }
            block.extend(table.finish().map_err(|error| broken_off(Problem::internal(error.to_string())))?);
            Ok(Some((block, None)))
        }
    });
    Body::from_stream(blocks)
}

/// The reply has begun, and can only be cut off: without its last chunk the client knows that something is missing.
fn broken_off(problem: Problem) -> io::Error {
    tracing::warn!(code = problem.code().as_str(), cause = problem.cause(), "a history is cut off while it is sent");
    io::Error::other("a history cannot be read on")
}
