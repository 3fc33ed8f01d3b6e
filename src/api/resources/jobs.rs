//! `/jobs`: sweeps that continue after their request has been answered.

use axum::body::Body;
use axum::response::sse::{Event, KeepAlive, Sse};
use futures::StreamExt as _;

use super::prelude::*;
use crate::api::query_parameters::closed;
use crate::store::StreamEvent;
use stickslip_wire::{JobEndEvent, JobList, JobReply, JobState, SweepAnswer};

parameters! {
    pub struct TableQuery {
        ..formats(&Format::TABLES, "")
    }
}

parameters! {
    pub struct JobsQuery {
        /// Only jobs in this state.
        state: JobState = closed(&JobState::ALL, JobState::name);
    }
}

/// List jobs
///
/// The jobs of the tenant, oldest first.
#[utoipa::path(
    get, path = "/jobs", tag = "jobs", params(JobsQuery),
    responses((status = 200, description = "The jobs", body = JobList))
)]
pub async fn list_jobs(
    TenantApp(app): TenantApp,
    CheckedQuery(JobsQuery { state }): CheckedQuery<JobsQuery>,
) -> Result<Response, Problem> {
    Ok(reply::json(reply::written(&app.jobs.list(state).await?)?))
}

/// Get a job
///
/// The state and the progress of the job, and the path of its result once it is done.
#[utoipa::path(
    get, path = "/jobs/{id}", tag = "jobs", params(JobPath),
    responses((status = 200, description = "The state and the progress of the job", body = JobReply))
)]
pub async fn get_job(JobPath { app, id, .. }: JobPath, _: CheckedQuery<()>) -> Result<Response, Problem> {
    Ok(reply::json(reply::written(&app.jobs.get(id).await?)?))
}

/// Get the result of a job
///
/// The table, once the job is done. It is kept for a day.
#[utoipa::path(
    get, path = "/jobs/{id}/result", tag = "jobs", params(JobPath, TableQuery),
    responses((status = 200, description = "The table, or the document of uncertain inputs", body = SweepAnswer))
)]
pub async fn get_job_result(
    JobPath { app, id, context }: JobPath,
    CheckedQuery(query): CheckedQuery<TableQuery>,
) -> Result<Response, Problem> {
    let format = query.format?;
    context.reserve(app.jobs.size(id).await?).await?;
    let (sweep, result) = app.jobs.result(id).await?;
    let table = Body::from_stream(futures::stream::iter(result.blocks(&sweep, format)));
    Ok(formats::reply(format, table))
}

/// Cancel a job
///
/// Stops the job if it is running, and deletes it with its result.
#[utoipa::path(
    delete, path = "/jobs/{id}", tag = "jobs", params(JobPath),
    responses((status = 204, description = "The job is deleted"))
)]
pub async fn cancel_job(JobPath { app, id, .. }: JobPath) -> Result<StatusCode, Problem> {
    app.jobs.delete(id).await?;
    Ok(StatusCode::NO_CONTENT)
}

/// Watch a job
///
/// Server-sent events whose data are those of `GET /jobs/{id}`: `progress` at once and after each step of the job, and
/// `done` or `failed` at its end. If the job is deleted or the server stops before that, the last event is `end` (its
/// data a `JobEndEvent`). Comments keep an idle connection open.
#[utoipa::path(
    get, path = "/jobs/{id}/events", tag = "jobs", params(JobPath),
    responses((status = 200, description = "The events",
        content_type = "text/event-stream", body = JobReply))
)]
pub async fn watch_job(JobPath { app, id, .. }: JobPath, _: CheckedQuery<()>) -> Result<Response, Problem> {
    stream(&app, id).await
}

pub async fn stream(app: &App, id: Uuid) -> Result<Response, Problem> {
    let events = app.jobs.events(id).await?.map(|event| match event {
        StreamEvent::State(job) => {
            let name = if job.state == JobState::Running { "progress" } else { job.state.name() };
            Event::default().event(name).json_data(job)
        }
        StreamEvent::End(reason) => Event::default().event("end").json_data(JobEndEvent { reason }),
    });
    Ok(Sse::new(events).keep_alive(KeepAlive::default()).into_response())
}
