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
use stickslip_compute::computations::ComputeError;
use stickslip_compute::formats::Unwritable;
use stickslip_compute::simulation::{Cause, Failure};
use stickslip_measured::import::ImportError;
use stickslip_wire::{Fault, ProblemDocument, Rejection};

use crate::api::limits;

pub use stickslip_wire::Code;

/// The media type of a problem document.
pub const MEDIA_TYPE: &str = "application/problem+json";

/// A refusal on its way to the client.
#[derive(Clone, Debug)]
pub struct Problem {
    code: Code,
    detail: String,
    errors: Vec<Fault>,
    /// The cause for the log, which the client does not see.
    cause: Option<String>,
    /// When to try again, if that may help.
    retry_after: Duration,
    /// Whether a change may have been stored nevertheless.
    in_doubt: bool,
}

impl Problem {
    /// A problem of this code, with what happened this time.
    #[must_use]
    pub fn new(code: Code, detail: impl Into<String>) -> Problem {
        let (detail, retry_after) = (detail.into(), limits::RETRY_AFTER);
        Problem { code, detail, errors: Vec::new(), cause: None, retry_after, in_doubt: false }
    }

    /// A problem after which a change may have been stored; the document says so of a request that changes something.
    #[must_use]
    pub fn in_doubt(code: Code, detail: impl Into<String>) -> Problem {
        Problem { in_doubt: true, ..Problem::new(code, detail) }
    }

    /// A problem with one place in the request.
    #[must_use]
    pub fn at(code: Code, pointer: impl Into<String>, detail: impl Into<String>) -> Problem {
        let (pointer, detail) = (pointer.into(), detail.into());
        let errors = vec![Fault { pointer, detail: detail.clone() }];
        Problem { errors, ..Problem::new(code, detail) }
    }

    /// A fault of this program; the cause is for the log.
    #[must_use]
    pub fn internal(cause: impl Into<String>) -> Problem {
        let detail = "this is not your fault; the operator finds the cause in the log under the request_id";
        Problem { cause: Some(cause.into()), ..Problem::new(Code::Internal, detail) }
    }

    /// The same problem, with a cause for the log.
    #[must_use]
    pub fn because(self, cause: String) -> Problem {
        Problem { cause: Some(cause), ..self }
    }

    /// The cause for the log, which the client does not see.
    #[must_use]
    pub fn cause(&self) -> Option<&str> {
        self.cause.as_deref()
    }

    /// The code.
    #[must_use]
    pub fn code(&self) -> Code {
        self.code
    }

    /// The document that the client gets for a request that changes something, or only reads.
    #[must_use]
    pub fn document(self, request_id: &str, changes: bool) -> ProblemDocument {
        let advice = match (self.in_doubt, changes) {
            (false, _) => "",
            (true, true) => ": the change may have been stored; repeat it with the same Idempotency-Key, or read first",
            (true, false) => ": nothing has changed, try again",
        };
        ProblemDocument::new(self.code, self.detail + advice, self.errors, request_id)
    }
}

impl IntoResponse for Problem {
    /// The status alone: `request_log` writes the document from the extensions, with the identifier of the request.
    fn into_response(self) -> Response {
        let status = StatusCode::from_u16(self.code.status()).unwrap_or(StatusCode::INTERNAL_SERVER_ERROR);
        let mut response = status.into_response();
        if matches!(
            self.code,
            Code::Overloaded | Code::Stopping | Code::StorageUnavailable | Code::TooManyJobs | Code::QuotaExceeded
        ) {
            response.headers_mut().insert(header::RETRY_AFTER, HeaderValue::from(self.retry_after.as_secs()));
        }
        if matches!(self.code, Code::Unauthorized) {
            response.headers_mut().insert(header::WWW_AUTHENTICATE, HeaderValue::from_static("Bearer"));
        }
        response.extensions_mut().insert(self);
        response
    }
}

impl From<Rejection> for Problem {
    fn from(rejection: Rejection) -> Self {
        let detail = rejection.to_string();
        match rejection {
            Rejection::NotJson(_) => Problem::new(Code::NotJson, detail),
            Rejection::Invalid(errors) => Problem { errors, ..Problem::new(Code::InvalidInput, detail) },
            Rejection::Refused { pointer, error } => Failure::at(pointer, error).into(),
        }
    }
}

impl From<Fault> for Problem {
    fn from(Fault { pointer, detail }: Fault) -> Self {
        Problem::at(Code::InvalidInput, pointer, detail)
    }
}

impl From<ImportError> for Problem {
    /// At the line and column of the file, from 1 on.
    fn from(error: ImportError) -> Self {
        let place = |name: &str, number: Option<usize>| number.map_or_else(String::new, |at| format!("/{name}/{at}"));
        let pointer = place("line", error.line) + &place("column", error.column);
        let code = if error.unknown_unit.is_some() { Code::UnknownUnit } else { Code::InvalidInput };
        Problem::at(code, pointer, error.to_string())
    }
}

impl From<Unwritable> for Problem {
    fn from(error: Unwritable) -> Self {
        Problem::internal(error.to_string())
    }
}

impl From<ComputeError> for Problem {
    fn from(error: ComputeError) -> Self {
        match error {
            ComputeError::Unknown(_) => Problem::new(Code::NotFound, error.to_string()),
            ComputeError::Rejected(rejection) => rejection.into(),
            ComputeError::Failed(failure) => failure.into(),
            ComputeError::Unwritable(error) => error.into(),
        }
    }
}

impl From<Failure> for Problem {
    fn from(failure: Failure) -> Self {
        let (code, detail) = (failure.code(), failure.cause.to_string());
        match failure.cause {
            Cause::Stopped | Cause::Lifted => Problem::new(code, detail),
            _ => Problem::at(code, failure.pointer, detail),
        }
    }
}

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
                    "what is stored of contact {contact} is damaged: the operator finds the cause in the log under the \
                     request_id"
                );
                Problem::new(Code::DamagedContact, advice).because(detail)
            }
            SessionError::Store(StoreError::Locked(_)) => {
                let advice = "another transaction of the database holds it: nothing has changed, try again";
                Problem::new(Code::StorageUnavailable, advice).because(detail)
            }
            SessionError::Store(StoreError::Unavailable(_)) => {
                Problem::in_doubt(Code::StorageUnavailable, "the storage cannot be reached").because(detail)
            }
            SessionError::Store(_) | SessionError::Unwritable(_) | SessionError::Broken(_) => Problem::internal(detail),
        }
    }
}
