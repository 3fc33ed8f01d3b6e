//! Errors of jobs and sweeps.

use std::time::Duration;

use uuid::Uuid;

use crate::admission::PoolError;
use crate::store::StoreError;
use stickslip_compute::simulation::Failure;

/// Why a sweep or a job has no result.
#[derive(Debug, thiserror::Error)]
pub enum JobError {
    /// The job was not found, or has been deleted.
    #[error("the job {0} was not found")]
    NotFound(Uuid),
    /// It has not ended.
    #[error("{done} of {points} points are done")]
    Unfinished {
        /// Points that are done.
        done: u64,
        /// Points in all.
        points: u64,
    },
    /// It has failed.
    #[error("the job has failed: {0}")]
    Failed(String),
    /// A point takes longer than a request may.
    #[error("a point is estimated at {wanted} s of work: allowed are {allowed} s")]
    LongPoint {
        /// The estimated work, s.
        wanted: u64,
        /// The allowed work, s.
        allowed: u64,
    },
    /// The work exceeds the limit of one job.
    #[error("the sweep needs about {wanted} s of work of one core, {each} s a point: allowed are {allowed} s")]
    TooMuch {
        /// The estimated work, s.
        wanted: u64,
        /// That of a point, s.
        each: f64,
        /// The allowed work, s.
        allowed: u64,
    },
    /// The limit of clients that follow jobs is reached.
    #[error("{} clients follow jobs, which is the limit", super::STREAMS)]
    TooManyStreams,
    /// The tenant has as many jobs as it may have.
    #[error("{why}: GET /jobs lists them; delete some, or wait until they end")]
    TooMany {
        /// Which limit is reached.
        why: String,
        /// When there may be room.
        retry_after: Duration,
    },
    /// It was stopped, or took too long.
    #[error(transparent)]
    Failure(#[from] Failure),
    /// No memory or no thread became free.
    #[error(transparent)]
    Pool(#[from] PoolError),
    /// The storage refused or failed.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// Stored data cannot be read: a fault of this program.
    #[error("{0}")]
    Broken(String),
}
