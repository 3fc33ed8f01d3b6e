//! Replies of `/jobs`: work that continues after its request has been answered.

use super::event::EndReason;
use crate::prelude::*;

replies! {
/// A sweep that the server computes in the background.
pub struct JobReply omits Option {
    /// Its identifier.
    pub id: Uuid,
    /// Its state.
    pub state: JobState,
    /// Its progress.
    pub progress: JobProgress,
    /// Estimated time of the solver for one point, on one thread, s.
    #[schema(example = 0.012)]
    pub point_time: f64,
    /// When it was created (ISO 8601, UTC).
    pub created_at: Timestamp,
    /// When it ended (ISO 8601, UTC).
    pub finished_at: Option<Timestamp>,
    /// When it is deleted, with its result (ISO 8601, UTC).
    pub expires_at: Timestamp,
    /// Why it failed.
    pub detail: Option<String>,
    /// The path of its result, available once the state is `done`.
    #[schema(example = "/jobs/0199…/result")]
    pub result: String,
}

/// Jobs of a tenant.
pub struct JobList {
    /// The jobs, oldest first.
    pub items: Vec<JobReply>,
}
}

words! {
/// The state of a job.
pub enum JobState {
    /// It is queued, or being computed.
    Running = "running",
    /// Its result is available.
    Done = "done",
    /// It ended with an error.
    Failed = "failed",
}
}

replies! {
/// The progress of a job.
pub struct JobProgress: Copy, Eq {
    /// Number of points in all.
    pub points: u64,
    /// Number of points that are computed and stored.
    pub done: u64,
    /// Number of computed points without a result.
    pub failed: u64,
}

/// The data of the event `end`, which ends the stream before the job has ended.
pub struct JobEndEvent: Copy, Eq {
    /// Why there are no more events.
    pub reason: EndReason,
}
}
