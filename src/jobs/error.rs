//! Why a job, or a sweep at once, did not do what it was asked for.

use uuid::Uuid;

use crate::admission::PoolError;
use crate::simulation::SweepError;
use crate::store::{RetryError, StoreError};

/// Why nothing came of a sweep or a job.
#[derive(Debug, thiserror::Error)]
pub enum JobError {
    /// There is no such job, or it has gone.
    #[error("there is no job {0}")]
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
    /// The work is more than a server takes on.
    #[error("this is about {wanted} s of work for one core: allowed are {allowed} s")]
    TooMuch {
        /// What it is, s.
        wanted: u64,
        /// What is allowed, s.
        allowed: u64,
    },
    /// The idempotency key belongs to another request.
    #[error("the idempotency key has been used for another request")]
    KeyReused,
    /// As many clients follow jobs as may.
    #[error("{} clients follow jobs, and no more may", super::STREAMS)]
    TooManyStreams,
    /// It was stopped, or took too long.
    #[error(transparent)]
    Sweep(#[from] SweepError),
    /// No memory or no thread became free.
    #[error(transparent)]
    Pool(#[from] PoolError),
    /// The storage refused or failed.
    #[error(transparent)]
    Store(StoreError),
    /// What is stored cannot be read: a fault of this program.
    #[error("{0}")]
    Broken(String),
}

impl From<RetryError> for JobError {
    fn from(error: RetryError) -> JobError {
        match error {
            RetryError::KeyReused => JobError::KeyReused,
            RetryError::Store(error) => JobError::Store(error),
        }
    }
}
