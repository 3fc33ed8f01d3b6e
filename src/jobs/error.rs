//! Errors of jobs and sweeps.

use std::time::Duration;

use uuid::Uuid;

use crate::admission::PoolError;
use crate::simulation::SweepError;
use crate::store::StoreError;

/// Why a sweep or a job has no result.
#[expect(missing_docs, reason = "the messages say it")]
#[derive(Debug, thiserror::Error)]
pub enum JobError {
    #[error("there is no job {0}")]
    NotFound(Uuid),
    #[error("{done} of {points} points are done")]
    Unfinished { done: u64, points: u64 },
    #[error("the job has failed: {0}")]
    Failed(String),
    #[error("a point is estimated at {wanted} s of work: allowed are {allowed} s")]
    LongPoint {
        /// The estimated work, s.
        wanted: u64,
        /// The allowed work, s.
        allowed: u64,
    },
    #[error("the sweep needs about {wanted} s of work of one core, {each} s a point: allowed are {allowed} s")]
    TooMuch {
        /// The estimated work, s.
        wanted: u64,
        /// That of a point, s.
        each: f64,
        /// The allowed work, s.
        allowed: u64,
    },
    #[error("{} clients follow jobs, which is the limit", super::STREAMS)]
    TooManyStreams,
    #[error("{why}: GET /jobs lists them, delete some or wait until they are gone")]
    TooMany { why: String, retry_after: Duration },
    #[error(transparent)]
    Sweep(#[from] SweepError),
    #[error(transparent)]
    Pool(#[from] PoolError),
    #[error(transparent)]
    Store(#[from] StoreError),
    /// Stored data cannot be read: a fault of this program.
    #[error("{0}")]
    Broken(String),
}
