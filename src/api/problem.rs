//! Errors as clients see them: every refusal is a problem document (RFC 9457). The table of [`Code`] says when to use
//! which code.
//!
//! The errors of the lower layers have no status codes; only the `From` implementations here assign them.

use std::time::Duration;

use axum::http::{HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};

use crate::admission::PoolError;
use crate::jobs::JobError;
use crate::sessions::SessionError;
use crate::store::StoreError;
use stickslip_compute::Refusal;
use stickslip_compute::formats::Unwritable;
use stickslip_compute::simulation::Failure;
use stickslip_measured::import::ImportError;
use stickslip_wire::{Fault, ProblemDocument, Rejection};

use crate::api::request_limits;

pub use stickslip_wire::Code;

/// The media type of a problem document.
pub const MEDIA_TYPE: &str = "application/problem+json";

/// A refusal on its way to the client.
#[derive(Clone, Debug)]
pub struct Problem {
    refusal: Refusal,
    /// When to try again, if that may help.
    retry_after: Duration,
    /// Whether a change may have been stored nevertheless.
    in_doubt: bool,
}

impl Problem {
    /// A problem of this code, with what happened this time.
    pub fn new(code: Code, detail: impl Into<String>) -> Problem {
        Refusal::new(code, detail).into()
    }

    /// A problem after which a change may have been stored; the document says so of a request that changes something.
    pub fn in_doubt(code: Code, detail: impl Into<String>) -> Problem {
        Problem { in_doubt: true, ..Problem::new(code, detail) }
    }

    /// A problem with one place in the request.
    pub fn at(code: Code, pointer: impl Into<String>, detail: impl Into<String>) -> Problem {
        Refusal::at(code, pointer, detail).into()
    }

    /// A fault of this program; the cause is for the log.
    pub fn internal(cause: impl Into<String>) -> Problem {
        Refusal::internal(cause).into()
    }

    /// The same problem, with a cause for the log.
    #[must_use]
    pub fn because(mut self, cause: String) -> Problem {
        self.refusal.cause = Some(cause);
        self
    }

    /// The cause for the log, which the client does not see.
    pub fn cause(&self) -> Option<&str> {
        self.refusal.cause.as_deref()
    }

    /// The code.
    pub fn code(&self) -> Code {
        self.refusal.code
    }

    /// The document that the client gets for a request that changes something, or only reads.
    pub fn document(mut self, request_id: &str, changes: bool) -> ProblemDocument {
        self.refusal.detail += match (self.in_doubt, changes) {
            (false, _) => "",
            (true, true) => ": the change may have been stored; repeat it with the same Idempotency-Key, or read first",
            (true, false) => ": nothing has changed, try again",
        };
        self.refusal.document(request_id)
    }
}

impl IntoResponse for Problem {
    /// The status alone: `request_log` writes the document from the extensions, with the identifier of the request.
    fn into_response(self) -> Response {
        let status = StatusCode::from_u16(self.code().status()).unwrap_or(StatusCode::INTERNAL_SERVER_ERROR);
        let mut response = status.into_response();
        if matches!(
            self.code(),
            Code::Overloaded | Code::Stopping | Code::StorageUnavailable | Code::TooManyJobs | Code::QuotaExceeded
        ) {
            response.headers_mut().insert(header::RETRY_AFTER, HeaderValue::from(self.retry_after.as_secs()));
        }
        if matches!(self.code(), Code::Unauthorized) {
            response.headers_mut().insert(header::WWW_AUTHENTICATE, HeaderValue::from_static("Bearer"));
        }
        response.extensions_mut().insert(self);
        response
    }
}

impl From<Problem> for Refusal {
    fn from(problem: Problem) -> Refusal {
        problem.refusal
    }
}

/// What is refused for the same reason without a server.
macro_rules! refused {
    ($($error:ty),+) => {
        $(impl From<$error> for Problem {
            fn from(error: $error) -> Self {
                Problem { refusal: error.into(), retry_after: request_limits::RETRY_AFTER, in_doubt: false }
            }
        })+
    };
}
refused!(Refusal, Rejection, Fault, ImportError, Unwritable, Failure);

impl From<PoolError> for Problem {
    fn from(error: PoolError) -> Self {
        match error {
            PoolError::Busy | PoolError::QueueFull => Problem::new(Code::Overloaded, error.to_string()),
            PoolError::Quota(_) => Problem::new(Code::QuotaExceeded, error.to_string()),
            PoolError::Panicked => Problem::internal(error.to_string()),
        }
    }
}

impl From<JobError> for Problem {
    fn from(error: JobError) -> Self {
        let detail = error.to_string();
        match error {
            JobError::NotFound(_) => Problem::new(Code::JobNotFound, detail),
            JobError::Unfinished { .. } => Problem::new(Code::JobNotDone, detail),
            JobError::Failed(_) => Problem::new(Code::JobFailed, detail),
            JobError::LongPoint { .. } => Problem::at(Code::TooMuchWork, "/base", detail),
            JobError::TooMuch { .. } => Problem::at(Code::TooMuchWork, "/axes", detail),
            JobError::TooManyStreams => Problem::new(Code::Overloaded, detail),
            JobError::Failure(failure) => failure.into(),
            JobError::Pool(error) => error.into(),
            JobError::TooMany { retry_after, .. } => Problem { retry_after, ..Problem::new(Code::TooManyJobs, detail) },
            JobError::Store(error) => SessionError::Store(error).into(),
            JobError::Broken(_) => Problem::internal(detail),
        }
    }
}

impl From<SessionError> for Problem {
    fn from(error: SessionError) -> Self {
        let detail = error.to_string();
        match error {
            SessionError::NotFound(_) => Problem::new(Code::ContactNotFound, detail),
            SessionError::OtherDefinition(_) => Problem::at(Code::InvalidInput, "/contact", detail),
            SessionError::Stale { .. } | SessionError::Relabelled { .. } => Problem::new(Code::StaleSequence, detail),
            SessionError::Overtaken { .. } => Problem::new(Code::Conflict, detail),
            SessionError::NoSuchMove { .. } => Problem::at(Code::InvalidInput, "/sequence", detail),
            SessionError::Ahead { .. } => Problem::at(Code::InvalidInput, "/Last-Event-ID", detail),
            SessionError::TooManyStreams => Problem::new(Code::Overloaded, detail),
            SessionError::Store(StoreError::KeyReused) => Problem::new(Code::IdempotencyKeyReused, detail),
            SessionError::Loading { .. } => Problem::new(Code::TooMuchWork, detail),
            SessionError::Failure(failure) => failure.into(),
            SessionError::Rejected(rejection) => rejection.into(),
            SessionError::Pool(error) => error.into(),
            SessionError::Expired(_) => Problem::new(Code::ContactExpired, detail),
            SessionError::Store(StoreError::Full(_)) => {
                Problem::new(Code::StorageFull, "nothing has changed; try again when there is room").because(detail)
            }
            SessionError::Store(StoreError::Damaged { contact, .. }) => {
                let advice = format!(
                    "the stored contact {contact} is damaged: the operator finds the cause in the log under the \
                     request_id"
                );
                Problem::new(Code::DamagedContact, advice).because(detail)
            }
            SessionError::Store(StoreError::Locked(_)) => {
                let advice = "another transaction of the database holds a lock: nothing has changed, try again";
                Problem::new(Code::StorageUnavailable, advice).because(detail)
            }
            SessionError::Store(StoreError::Unavailable(_)) => {
                Problem::in_doubt(Code::StorageUnavailable, "the storage cannot be reached").because(detail)
            }
            SessionError::Store(_) | SessionError::Unwritable(_) | SessionError::Broken(_) => Problem::internal(detail),
        }
    }
}
