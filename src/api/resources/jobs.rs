//! `/jobs`: work that goes on after its request has been answered.

use axum::http::{HeaderMap, StatusCode};
use axum::response::sse::{Event, KeepAlive, Sse};
use axum::response::{IntoResponse as _, Response};
use futures::StreamExt as _;
use utoipa::IntoParams;
use uuid::Uuid;

use crate::store::StreamEvent;
use stickslip_wire::{JobEndEvent, JobReply, JobState, SweepReply};

use crate::api::App;
use crate::api::extract::JobId;
use crate::api::formats::Format;
use crate::api::formats::sheet::Table;
use crate::api::limits::KEEP_ALIVE;
use crate::api::problem::Problem;
use crate::api::query::Params;
use crate::api::reply;
use crate::api::resources::sweep::{TableQuery, table};
use crate::api::state::TenantApp;

/// The job in the path.
#[derive(IntoParams)]
#[into_params(parameter_in = Path)]
#[expect(dead_code, reason = "described here, read by `JobId`")]
pub struct JobPath {
    /// The identifier of the job.
    id: Uuid,
}

/// Look at a job
#[utoipa::path(
    get, path = "/jobs/{id}", operation_id = "get_job", tag = "jobs", params(JobPath),
    responses((status = 200, description = "How it stands", body = JobReply))
)]
pub async fn get(TenantApp(app): TenantApp, JobId(id): JobId, params: Params) -> Result<Response, Problem> {
    params.none()?;
    Ok(reply::json(reply::written(&app.jobs.get(id).await?)?))
}

/// Get the result of a job
///
/// The table, once the job is done. It is kept for a day.
#[utoipa::path(
    get, path = "/jobs/{id}/result", operation_id = "job_result", tag = "jobs", params(JobPath, TableQuery),
    responses((status = 200, description = "The table", body = SweepReply))
)]
pub async fn result(
    TenantApp(app): TenantApp,
    JobId(id): JobId,
    headers: HeaderMap,
    params: Params,
) -> Result<Response, Problem> {
    let format = Format::chosen_of(params.table()?, &headers, &Format::TABLES)?;
    let held = app.pool.reserve(app.jobs.size(id).await?).await?;
    let (draft, rows) = app.jobs.result(id).await?;
    Ok(reply::holding(table(Table::new(&draft, rows), format), held))
}

/// Cancel a job
///
/// Ends it if it has not ended, and deletes it with its result.
#[utoipa::path(
    delete, path = "/jobs/{id}", operation_id = "cancel_job", tag = "jobs", params(JobPath),
    responses((status = 204, description = "It is gone"))
)]
pub async fn delete(TenantApp(app): TenantApp, JobId(id): JobId) -> Result<StatusCode, Problem> {
    app.jobs.delete(id).await?;
    Ok(StatusCode::NO_CONTENT)
}

/// Follow a job
///
/// Server-sent events whose data are those of `GET /jobs/{id}`: `progress` at once and whenever the job has come on, and
/// `done` or `failed` at its end. If there is nothing more to tell before that, because it has been deleted or the server
/// stops, the last event is `end` (its data a `JobEndEvent`); comments keep an idle connection open.
#[utoipa::path(
    get, path = "/jobs/{id}/events", operation_id = "job_events", tag = "jobs", params(JobPath),
    responses((status = 200, description = "The events; the schema is that of the data of all but `end`",
        content_type = "text/event-stream", body = JobReply))
)]
pub async fn events(TenantApp(app): TenantApp, JobId(id): JobId, params: Params) -> Result<Response, Problem> {
    params.none()?;
    stream(&app, id).await
}

/// The events of a job as a reply.
pub async fn stream(app: &App, id: Uuid) -> Result<Response, Problem> {
    let events = app.jobs.events(id).await?.map(|event| match event {
        StreamEvent::State(job) => {
            let name = match job.state {
                JobState::Running => "progress",
                JobState::Done => "done",
                JobState::Failed => "failed",
            };
            Event::default().event(name).json_data(job)
        }
        StreamEvent::End(reason) => Event::default().event("end").json_data(JobEndEvent { reason }),
    });
    Ok(Sse::new(events).keep_alive(KeepAlive::new().interval(KEEP_ALIVE)).into_response())
}
