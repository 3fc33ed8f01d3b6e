//! `/sweep`: many simulations in one call, answered at once or by a job.

use std::sync::Arc;

use axum::body::Body;

use super::jobs::{self, TableQuery};
use super::prelude::*;
use crate::api::params::{Prefer, accepts_events};
use crate::jobs::AT_ONCE;
use crate::simulation::{Failure, Sweep};
use stickslip_wire::{JobReply, SweepReply, SweepRequest};

/// Bytes of a number of the table while it is computed.
const NUMBER_BYTES: usize = 16;

/// Run a sweep
///
/// Runs `POST /simulate` for each combination of the values of up to three axes, and returns a table of the outputs. A
/// point without an answer is a row of `null` and is listed among the failures. A small sweep is answered at once. A
/// large one becomes a job: 202 with the URL of the job in `Location` or, with `Accept: text/event-stream`, its events.
#[utoipa::path(
    post, path = "/sweep", tag = "simulation", params(TableQuery, Prefer, IdempotencyKey), request_body = SweepRequest,
    responses(
        (status = 200, description = "The table", body = SweepReply),
        (status = 202, description = "The job that computes the table", body = JobReply, headers(
            ("Location" = String, description = "The path of the job"),
            ("Preference-Applied" = String, description = "`respond-async`, if that was asked for")))
    )
)]
pub async fn run_sweep(
    TenantApp(app): TenantApp,
    headers: HeaderMap,
    Prefer { respond_async }: Prefer,
    query: Result<CheckedQuery<TableQuery>, Problem>,
    body: CheckedBody<SweepRequest>,
) -> Result<Response, Problem> {
    let (CheckedQuery(query), events) = (query?, accepts_events(&headers));
    let format = if events { Format::Columns } else { Format::chosen(query.format, &headers, &Format::TABLES)? };
    let CheckedBody { body: checked, key, mut held } = body;
    let wants_job = checked.request.job || respond_async || events;
    let (stop, _guard) = app.pool.deadline();
    let (cost, profiles) = (Sweep::planning_cost(&checked), app.sessions.profiles(&stop));
    let planned = app.pool.run(cost, move || Sweep::plan(checked, &profiles)).await?;
    if planned.is_err() {
        stop.check().map_err(|interrupted| Failure::interrupted(interrupted, "/base/contact/profile"))?;
    }
    let sweep = planned?;
    if wants_job || sweep.cost() > AT_ONCE {
        let made = app.jobs.start(&sweep, key).await?;
        let id = made.created.unwrap_or(Uuid::nil());
        if events {
            return jobs::stream(&app, id).await;
        }
        let mut response = (StatusCode::ACCEPTED, reply::json(made.body)).into_response();
        if let Ok(location) = HeaderValue::from_str(&format!("/jobs/{id}")) {
            response.headers_mut().insert(header::LOCATION, location);
        }
        if respond_async {
            response.headers_mut().insert("preference-applied", HeaderValue::from_static("respond-async"));
        }
        return Ok(response);
    }
    let (stop, _guard) = app.pool.deadline();
    let table_bytes = NUMBER_BYTES * sweep.numbers(sweep.points());
    held.resize(&app.pool, sweep.bytes(app.pool.capacity().threads) + table_bytes).await?;
    let sweep = Arc::new(sweep);
    let result = app.jobs.at_once(&sweep, &stop).await?;
    held.resize(&app.pool, table_bytes).await?;
    let table = Body::from_stream(futures::stream::iter(result.table(sweep.checked()).blocks(format)));
    Ok(held.on(format.reply(table)))
}
