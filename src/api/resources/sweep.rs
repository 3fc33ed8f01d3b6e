//! `/sweep`: many simulations in one call, answered at once or by a job.

use std::sync::Arc;

use axum::body::Body;
use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::response::{IntoResponse as _, Response};
use futures::StreamExt as _;
use utoipa::IntoParams;
use uuid::Uuid;

use crate::jobs::AT_ONCE;
use crate::simulation::Sweep;
use stickslip_wire::{JobReply, SweepReply, SweepRequest};

use crate::api::extract::Command;
use crate::api::formats::Format;
use crate::api::formats::sheet::Table;
use crate::api::openapi::IdempotencyKey;
use crate::api::problem::Problem;
use crate::api::query::Params;
use crate::api::reply;
use crate::api::resources::jobs;
use crate::api::state::TenantApp;

/// Bytes of a number of a table, computed and put together.
const NUMBER_BYTES: usize = 16;

/// How the table is to be given.
#[derive(IntoParams)]
#[into_params(parameter_in = Query)]
#[expect(dead_code, reason = "described here, read by `Params`")]
pub struct TableQuery {
    /// `columns` (this document), `rows` (a JSON array of flat objects), `csv` or `ndjson`; left out, what `Accept` prefers.
    #[param(nullable = false, default = "columns")]
    format: Option<String>,
}

/// How the answer is to come.
#[derive(IntoParams)]
#[into_params(parameter_in = Header)]
#[expect(dead_code, reason = "described here, read by the handler")]
pub struct Preference {
    /// `respond-async` makes a job of the sweep, however small it is (RFC 7240).
    #[param(rename = "Prefer", nullable = false)]
    prefer: Option<String>,
}

/// Sweep over simulations
///
/// Runs `POST /simulate` for each combination of the values of up to three axes, and gives a table of what is asked for. A
/// point without an answer is a row of `null`, and stands among the failures. A small sweep is answered at once. A large one
/// becomes a job: 202 with the job's place in `Location`, or, with `Accept: text/event-stream`, its events.
#[utoipa::path(
    post, path = "/sweep", tag = "simulation", params(TableQuery, Preference, IdempotencyKey), request_body = SweepRequest,
    responses(
        (status = 200, description = "The table", body = SweepReply),
        (status = 202, description = "The job that computes the table", body = JobReply, headers(
            ("Location" = String, description = "The path of the job"),
            ("Preference-Applied" = String, description = "`respond-async`, if that was asked for")))
    )
)]
pub async fn sweep(
    TenantApp(app): TenantApp,
    headers: HeaderMap,
    params: Params,
    command: Command<SweepRequest>,
) -> Result<Response, Problem> {
    let (named, events) = (params.table()?, wants_events(&headers));
    let format = if events { Format::Columns } else { Format::chosen_of(named, &headers, &Format::TABLES)? };
    let Command { body: draft, key, mut held } = command;
    let wanted = draft.request.job;
    let preferred = prefers_job(&headers);
    let sweep = app.pool.run(crate::admission::INLINE, move || Sweep::plan(draft)).await??;
    if events || wanted || preferred || sweep.cost() > AT_ONCE {
        let made = app.jobs.start(&sweep, key).await?;
        let id = made.created.unwrap_or(Uuid::nil());
        if events {
            return jobs::stream(&app, id).await;
        }
        let mut response = (StatusCode::ACCEPTED, reply::json(made.body)).into_response();
        if let Ok(place) = HeaderValue::from_str(&format!("/jobs/{id}")) {
            response.headers_mut().insert(header::LOCATION, place);
        }
        if preferred {
            response.headers_mut().insert("preference-applied", HeaderValue::from_static("respond-async"));
        }
        return Ok(response);
    }
    let (stop, _guard) = app.pool.deadline();
    let table_bytes = NUMBER_BYTES * sweep.numbers(sweep.points());
    held.resize(&app.pool, sweep.bytes(app.pool.capacity().threads) + table_bytes).await?;
    let sweep = Arc::new(sweep);
    let rows = app.jobs.at_once(&sweep, &stop).await?;
    held.resize(&app.pool, table_bytes).await?;
    Ok(held.on(table(Table::new(sweep.draft(), rows), format)))
}

/// A table as a reply.
pub fn table(table: Table, format: Format) -> Response {
    let pieces = futures::stream::iter(table.pieces(format)).map(Ok::<_, std::convert::Infallible>);
    let mut response = ([(header::CONTENT_TYPE, format.media_type())], Body::from_stream(pieces)).into_response();
    response.headers_mut().insert(header::VARY, HeaderValue::from_static("accept"));
    response
}

/// The parts of a header that may be given several times.
fn parts<'h>(headers: &'h HeaderMap, name: &str) -> impl Iterator<Item = &'h str> {
    let lines = headers.get_all(name).iter().filter_map(|line| line.to_str().ok()).collect::<Vec<_>>();
    lines.into_iter().flat_map(|line| line.split(','))
}

fn wants_events(headers: &HeaderMap) -> bool {
    let essence = |range: &str| range.split(';').next().unwrap_or_default().trim().to_ascii_lowercase();
    parts(headers, "accept").any(|range| essence(range) == "text/event-stream")
}

fn prefers_job(headers: &HeaderMap) -> bool {
    parts(headers, "prefer")
        .any(|preference| preference.split(';').next().unwrap_or_default().trim().eq_ignore_ascii_case("respond-async"))
}
