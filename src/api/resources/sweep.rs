//! `/sweep`: many simulations in one call, answered at once or by a job.

use std::sync::Arc;

use axum::body::Body;

use super::jobs::{self, TableQuery};
use super::prelude::*;
use crate::api::path_and_headers::{Prefer, accepts_events};
use crate::jobs::AT_ONCE;
use stickslip_compute::Stop as _;
use stickslip_compute::simulation::bytes::NUMBER;
use stickslip_compute::simulation::{Failure, Sweep, SweepResult};
use stickslip_wire::{JobReply, SweepAnswer, SweepRequest};

/// The most numbers of a table that is kept for a retry as a whole.
const KEPT_NUMBERS: usize = 65_536;

/// Run a sweep
///
/// Runs `POST /simulate` for each combination of the values of up to three axes, and returns a table of the outputs. A
/// point without a result is a row of `null` and is listed among the failures. A small sweep is answered at once. A
/// large one becomes a job: 202 with the URL of the job in `Location` or, with `Accept: text/event-stream`, its events.
/// A retry with the same `Idempotency-Key` gets the numbers of the first attempt, or its job. With a key, a table of
/// more than 65536 numbers is the result of a job.
#[utoipa::path(
    post, path = "/sweep", tag = "simulation", params(TableQuery, Prefer, IdempotencyKey), request_body = SweepRequest,
    responses(
        (status = 200, description = "The table", body = SweepAnswer),
        (status = 202, description = "The job that computes the table", body = JobReply, headers(
            ("Location" = String, description = "The path of the job"),
            ("Preference-Applied" = String, description = "`respond-async`, if that was asked for")))
    )
)]
pub async fn run_sweep(
    TenantApp(app): TenantApp,
    headers: HeaderMap,
    Prefer { respond_async }: Prefer,
    CheckedQuery(query): CheckedQuery<TableQuery>,
    body: CheckedBody<SweepRequest>,
) -> Result<Response, Problem> {
    let events = accepts_events(&headers);
    let format = if events { Format::Columns } else { query.format? };
    let CheckedBody { body: checked, key, context } = body;
    let earlier = match &key {
        Some(key) => app.sessions.earlier_reply(key.clone()).await?,
        None => None,
    };
    let wants_job = checked.request.job || respond_async || events;
    let (cost, profiles) = (Sweep::planning_cost(&checked), app.sessions.profiles(context.deadline()));
    let planned = context.run(cost, move |_| Sweep::plan(checked, &profiles)).await?;
    if planned.is_err() {
        context.deadline().check().map_err(|interrupted| Failure::interrupted(interrupted, "/base/contact/profile"))?;
    }
    let sweep = planned?;
    let numbers = sweep.numbers(sweep.points());
    let is_large = sweep.cost() > AT_ONCE || key.is_some() && numbers > KEPT_NUMBERS;
    let is_job = earlier.as_ref().map_or(wants_job || is_large, |reply| reply.created.is_some());
    if is_job {
        let made = app.jobs.start(&sweep, key).await?;
        let id = made.created.unwrap_or(Uuid::nil());
        if events {
            return jobs::stream(&app, id).await;
        }
        let mut response = (StatusCode::ACCEPTED, reply::json(made.body)).into_response();
        response = reply::with_header(response, header::LOCATION, &format!("/jobs/{id}"));
        if respond_async {
            response.headers_mut().insert("preference-applied", HeaderValue::from_static("respond-async"));
        }
        return Ok(response);
    }
    let table_bytes = NUMBER * numbers;
    context.reserve(sweep.bytes(app.pool.capacity().threads) + table_bytes).await?;
    let sweep = Arc::new(sweep);
    let result = match earlier.and_then(|reply| SweepResult::from_bytes(&reply.body, numbers)) {
        Some(earlier) => earlier,
        None => {
            let result = app.jobs.at_once(&sweep, context.deadline()).await?;
            match key {
                Some(key) => {
                    let kept = app.sessions.keep_reply(key, result.to_bytes()).await?;
                    SweepResult::from_bytes(&kept.body, numbers).unwrap_or(result)
                }
                None => result,
            }
        }
    };
    context.reserve(table_bytes).await?;
    let table = Body::from_stream(futures::stream::iter(result.blocks(sweep.checked(), format)));
    Ok(formats::reply(format, table))
}
