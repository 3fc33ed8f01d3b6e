//! Errors as clients see them: every refusal is a problem document (RFC 9457).
//!
//! Which to use when:
//!
//! - The body is not JSON: [`Kind::NotJson`]. It is JSON but wrong in itself, whatever the state of the server:
//!   [`Kind::InvalidInput`], with a pointer to each fault. It is sound, but the mechanics has no answer to it: the kind of
//!   that error. All but the first are 422, as the syntax is not to blame.
//! - No key, or one that is not known: [`Kind::Unauthorized`]. A key that does not allow it: [`Kind::Forbidden`]. What belongs
//!   to another tenant does not exist.
//! - A name that does not exist: [`Kind::NotFound`] for a path, [`Kind::ContactNotFound`] for a session, [`Kind::JobNotFound`]
//!   for a job.
//! - The result of a job that is not there: [`Kind::JobNotDone`] if it may come, [`Kind::JobFailed`] if it never will.
//! - A tenant with as many jobs as it may have: [`Kind::TooManyJobs`].
//! - No format that `Accept` admits: [`Kind::NotAcceptable`].
//! - A sound request that the present state forbids: [`Kind::StaleSequence`] if the client has said what state it expects,
//!   else [`Kind::Conflict`].
//! - A head that a proxy might read in another way than this server: [`Kind::AmbiguousRequest`].
//! - A body that takes too long to arrive: [`Kind::RequestTimeout`].
//! - Nothing wrong with the request, but no capacity: [`Kind::Overloaded`], with `Retry-After`.
//! - The storage has no room ([`Kind::StorageFull`]) or cannot be reached ([`Kind::StorageUnavailable`]): not the client's
//!   fault, and not this program's. Nothing has been acknowledged, and a retry is welcome.
//! - A fault of this program: [`Kind::Internal`]. Its cause goes to the log, and the client gets the request's identifier.
//!
//! The errors of the lower floors know no status codes; the `From` implementations here are the one place that gives them.

use axum::http::{HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};

use crate::admission::PoolError;
use crate::jobs::JobError;
use crate::sessions::SessionError;
use crate::simulation::{Failure, SweepError};
use crate::store::StoreError;
use stickslip_mechanics as mechanics;
use stickslip_wire::{Fault, ProblemDocument, Rejection};

use crate::api::limits;

/// The media type of a problem document.
pub const MEDIA_TYPE: &str = "application/problem+json";

/// The kinds of problems, each with its status and code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The head of the request can be read in more than one way.
    AmbiguousRequest,
    /// The body is not JSON.
    NotJson,
    /// There is no key with the request, or none that is known.
    Unauthorized,
    /// The key does not allow it.
    Forbidden,
    /// No such path.
    NotFound,
    /// No such session.
    ContactNotFound,
    /// No such job.
    JobNotFound,
    /// The job has not ended.
    JobNotDone,
    /// The job has no result, and never will.
    JobFailed,
    /// The tenant has as many jobs as it may.
    TooManyJobs,
    /// The session was idle for so long that it has been deleted.
    ContactExpired,
    /// The path has no such method.
    MethodNotAllowed,
    /// There is no format that the client takes.
    NotAcceptable,
    /// The state of the session forbids it.
    Conflict,
    /// The session is not at the sequence given in `If-Match`.
    StaleSequence,
    /// The body did not arrive in time.
    RequestTimeout,
    /// The body is too large.
    TooLarge,
    /// The body is not declared as JSON.
    UnsupportedMediaType,
    /// Something in the request is missing, unknown, of the wrong type, or out of range.
    InvalidInput,
    /// No state carries the tangential force asked for.
    ForceExceedsFriction,
    /// The contact outgrows the profile.
    BeyondProfile,
    /// The contact area would be a ring.
    ProfileNotConvexEnough,
    /// The solver cannot follow the move.
    UnsupportedMove,
    /// The request takes longer than a server computes for one.
    TooMuchWork,
    /// The idempotency key belongs to another request.
    IdempotencyKeyReused,
    /// No capacity at present.
    Overloaded,
    /// The storage has no room.
    StorageFull,
    /// The storage cannot be reached.
    StorageUnavailable,
    /// A fault of this program.
    Internal,
}

impl Kind {
    /// All kinds, for the documentation.
    pub const ALL: [Kind; 29] = [
        Kind::AmbiguousRequest,
        Kind::NotJson,
        Kind::Unauthorized,
        Kind::Forbidden,
        Kind::NotFound,
        Kind::ContactNotFound,
        Kind::JobNotFound,
        Kind::JobNotDone,
        Kind::JobFailed,
        Kind::TooManyJobs,
        Kind::ContactExpired,
        Kind::MethodNotAllowed,
        Kind::NotAcceptable,
        Kind::Conflict,
        Kind::StaleSequence,
        Kind::RequestTimeout,
        Kind::TooLarge,
        Kind::UnsupportedMediaType,
        Kind::InvalidInput,
        Kind::ForceExceedsFriction,
        Kind::BeyondProfile,
        Kind::ProfileNotConvexEnough,
        Kind::UnsupportedMove,
        Kind::TooMuchWork,
        Kind::IdempotencyKeyReused,
        Kind::Overloaded,
        Kind::StorageFull,
        Kind::StorageUnavailable,
        Kind::Internal,
    ];

    /// Status, code and title.
    #[must_use]
    pub fn parts(self) -> (StatusCode, &'static str, &'static str) {
        match self {
            Kind::AmbiguousRequest => {
                (StatusCode::BAD_REQUEST, "ambiguous_request", "The head of the request is ambiguous")
            }
            Kind::NotJson => (StatusCode::BAD_REQUEST, "not_json", "The body is not JSON"),
            Kind::Unauthorized => (StatusCode::UNAUTHORIZED, "unauthorized", "A key is needed"),
            Kind::Forbidden => (StatusCode::FORBIDDEN, "forbidden", "The key does not allow this"),
            Kind::NotFound => (StatusCode::NOT_FOUND, "not_found", "There is nothing at this path"),
            Kind::ContactNotFound => (StatusCode::NOT_FOUND, "contact_not_found", "There is no such contact"),
            Kind::JobNotFound => (StatusCode::NOT_FOUND, "job_not_found", "There is no such job"),
            Kind::JobNotDone => (StatusCode::CONFLICT, "job_not_done", "The job has not ended"),
            Kind::JobFailed => (StatusCode::CONFLICT, "job_failed", "The job has failed"),
            Kind::TooManyJobs => (StatusCode::TOO_MANY_REQUESTS, "too_many_jobs", "There are too many jobs"),
            Kind::ContactExpired => (StatusCode::GONE, "contact_expired", "The contact has expired"),
            Kind::MethodNotAllowed => {
                (StatusCode::METHOD_NOT_ALLOWED, "method_not_allowed", "This path has no such method")
            }
            Kind::NotAcceptable => (StatusCode::NOT_ACCEPTABLE, "not_acceptable", "There is no such format"),
            Kind::Conflict => (StatusCode::CONFLICT, "conflict", "The state of the contact forbids this"),
            Kind::StaleSequence => (StatusCode::PRECONDITION_FAILED, "stale_sequence", "The contact has moved on"),
            Kind::RequestTimeout => {
                (StatusCode::REQUEST_TIMEOUT, "request_timeout", "The request did not arrive in time")
            }
            Kind::TooLarge => (StatusCode::PAYLOAD_TOO_LARGE, "too_large", "The body is too large"),
            Kind::UnsupportedMediaType => {
                (StatusCode::UNSUPPORTED_MEDIA_TYPE, "unsupported_media_type", "The body must be application/json")
            }
            Kind::InvalidInput => (StatusCode::UNPROCESSABLE_ENTITY, "invalid_input", "The request is invalid"),
            Kind::ForceExceedsFriction => (
                StatusCode::UNPROCESSABLE_ENTITY,
                "force_exceeds_friction",
                "The tangential force is not below the friction limit",
            ),
            Kind::BeyondProfile => {
                (StatusCode::UNPROCESSABLE_ENTITY, "beyond_profile", "The contact outgrows the profile")
            }
            Kind::ProfileNotConvexEnough => (
                StatusCode::UNPROCESSABLE_ENTITY,
                "profile_not_convex_enough",
                "The contact area would not be a full circle",
            ),
            Kind::UnsupportedMove => {
                (StatusCode::UNPROCESSABLE_ENTITY, "unsupported_move", "The solver cannot follow this move")
            }
            Kind::TooMuchWork => (StatusCode::UNPROCESSABLE_ENTITY, "too_much_work", "The request takes too long"),
            Kind::IdempotencyKeyReused => (
                StatusCode::UNPROCESSABLE_ENTITY,
                "idempotency_key_reused",
                "The idempotency key belongs to another request",
            ),
            Kind::Overloaded => (StatusCode::SERVICE_UNAVAILABLE, "overloaded", "The server is busy"),
            Kind::StorageFull => (StatusCode::INSUFFICIENT_STORAGE, "storage_full", "The server has no room left"),
            Kind::StorageUnavailable => {
                (StatusCode::SERVICE_UNAVAILABLE, "storage_unavailable", "The storage cannot be reached")
            }
            Kind::Internal => (StatusCode::INTERNAL_SERVER_ERROR, "internal", "The server has failed"),
        }
    }
}

/// A refusal on its way to the client.
#[derive(Clone, Debug)]
pub struct Problem {
    kind: Kind,
    detail: String,
    errors: Vec<Fault>,
    /// What the log is told and the client is not.
    cause: Option<String>,
}

impl Problem {
    /// A problem of a kind, with what happened this time.
    #[must_use]
    pub fn new(kind: Kind, detail: impl Into<String>) -> Problem {
        Problem { kind, detail: detail.into(), errors: Vec::new(), cause: None }
    }

    /// A problem with one place in the request.
    #[must_use]
    pub fn at(kind: Kind, pointer: impl Into<String>, detail: impl Into<String>) -> Problem {
        let (pointer, detail) = (pointer.into(), detail.into());
        let errors = vec![Fault { pointer, detail: detail.clone() }];
        Problem { kind, detail, errors, cause: None }
    }

    /// A fault of this program; the cause is for the log.
    #[must_use]
    pub fn internal(cause: impl Into<String>) -> Problem {
        let detail = "this is not your fault; the operator finds the cause in the log under the request_id";
        Problem { cause: Some(cause.into()), ..Problem::new(Kind::Internal, detail) }
    }

    /// The same problem, with a cause for the log.
    #[must_use]
    pub fn because(self, cause: String) -> Problem {
        Problem { cause: Some(cause), ..self }
    }

    /// What the log is told and the client is not.
    #[must_use]
    pub fn cause(&self) -> Option<&str> {
        self.cause.as_deref()
    }

    /// The code.
    #[must_use]
    pub fn code(&self) -> &'static str {
        self.kind.parts().1
    }

    /// The document that the client gets.
    #[must_use]
    pub fn document(self, request_id: &str) -> ProblemDocument {
        let (status, code, title) = self.kind.parts();
        ProblemDocument {
            kind: format!("/problems/{code}"),
            title: title.to_owned(),
            status: status.as_u16(),
            detail: self.detail,
            code: code.to_owned(),
            errors: self.errors,
            request_id: request_id.to_owned(),
        }
    }
}

impl IntoResponse for Problem {
    /// The status alone: the document waits in the extensions for `observe`, which knows the request's identifier.
    fn into_response(self) -> Response {
        let mut response = self.kind.parts().0.into_response();
        if matches!(self.kind, Kind::Overloaded | Kind::StorageUnavailable | Kind::TooManyJobs) {
            response.headers_mut().insert(header::RETRY_AFTER, HeaderValue::from(limits::RETRY_AFTER.as_secs()));
        }
        if matches!(self.kind, Kind::Unauthorized) {
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
            Rejection::NotJson(_) => Problem::new(Kind::NotJson, detail),
            Rejection::Invalid(errors) => Problem { errors, ..Problem::new(Kind::InvalidInput, detail) },
            Rejection::Refused { pointer, error } => Failure::Refused { pointer, error }.into(),
        }
    }
}

impl From<Failure> for Problem {
    fn from(failure: Failure) -> Self {
        let detail = failure.to_string();
        match failure {
            Failure::Refused { pointer, error } => {
                let kind = match &error {
                    mechanics::Error::OutOfRange { .. } | mechanics::Error::Table { .. } => Kind::InvalidInput,
                    mechanics::Error::BeyondProfile { .. } => Kind::BeyondProfile,
                    mechanics::Error::NotConvexEnough { .. } => Kind::ProfileNotConvexEnough,
                    mechanics::Error::ForceExceedsFriction { .. } => Kind::ForceExceedsFriction,
                    mechanics::Error::Interrupted => Kind::TooMuchWork,
                    mechanics::Error::Unsupported { .. } => Kind::UnsupportedMove,
                };
                Problem::at(kind, pointer, error.to_string())
            }
            Failure::MemoryFull { pointer, .. } => Problem::at(Kind::Conflict, pointer, detail),
            Failure::TooLong { pointer, .. } => Problem::at(Kind::TooMuchWork, pointer, detail),
            Failure::Stopped => Problem::new(Kind::Overloaded, detail),
        }
    }
}

impl From<PoolError> for Problem {
    fn from(error: PoolError) -> Self {
        match error {
            PoolError::Busy | PoolError::QueueFull => Problem::new(Kind::Overloaded, error.to_string()),
            PoolError::Panicked => Problem::internal(error.to_string()),
        }
    }
}

impl From<JobError> for Problem {
    fn from(error: JobError) -> Self {
        let detail = error.to_string();
        match error {
            JobError::NotFound(_) => Problem::new(Kind::JobNotFound, detail),
            JobError::Unfinished { .. } => Problem::new(Kind::JobNotDone, detail),
            JobError::Failed(_) => Problem::new(Kind::JobFailed, detail),
            JobError::TooMuch { .. } => Problem::at(Kind::TooMuchWork, "/axes", detail),
            JobError::KeyReused => Problem::new(Kind::IdempotencyKeyReused, detail),
            JobError::TooManyStreams => Problem::new(Kind::Overloaded, detail),
            JobError::Sweep(SweepError::Failure(failure)) => failure.into(),
            JobError::Sweep(SweepError::Pool(error)) | JobError::Pool(error) => error.into(),
            JobError::Store(StoreError::TooManyJobs(_)) => {
                Problem::new(Kind::TooManyJobs, format!("{detail}: delete some, or wait until they are gone"))
            }
            JobError::Store(error) => SessionError::Store(error).into(),
            JobError::Broken(_) => Problem::internal(detail),
        }
    }
}

impl From<SessionError> for Problem {
    fn from(error: SessionError) -> Self {
        let detail = error.to_string();
        match error {
            SessionError::NotFound(_) => Problem::new(Kind::ContactNotFound, detail),
            SessionError::OtherDefinition(_) => Problem::at(Kind::InvalidInput, "/contact", detail),
            SessionError::Stale { .. } => Problem::new(Kind::StaleSequence, detail),
            SessionError::Overtaken { .. } => Problem::new(Kind::Conflict, detail),
            SessionError::Ahead { .. } => Problem::at(Kind::InvalidInput, "/Last-Event-ID", detail),
            SessionError::TooManyStreams => Problem::new(Kind::Overloaded, detail),
            SessionError::KeyReused => Problem::new(Kind::IdempotencyKeyReused, detail),
            SessionError::Failure(failure) => failure.into(),
            SessionError::Pool(error) => error.into(),
            SessionError::Expired(_) => Problem::new(Kind::ContactExpired, detail),
            SessionError::Store(StoreError::Full(_)) => {
                Problem::new(Kind::StorageFull, "nothing has changed; try again when there is room").because(detail)
            }
            SessionError::Store(StoreError::Unavailable(_)) => {
                let advice = "the change may or may not be stored; retry with the same Idempotency-Key, or look";
                Problem::new(Kind::StorageUnavailable, advice).because(detail)
            }
            SessionError::Store(_) | SessionError::Broken(_) => Problem::internal(detail),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Problem;
    use crate::simulation::Failure;
    use stickslip_mechanics::{self as mechanics, range};

    #[test]
    fn a_point_of_a_sweep_fails_by_the_code_that_it_is_refused_with_alone() {
        let errors = [
            range::FRICTION.check(-1.0).unwrap_err(),
            mechanics::Error::BeyondProfile { radius: 2.0, limit: 1.0 },
            mechanics::Error::NotConvexEnough { radius: 1.0 },
            mechanics::Error::Table { fault: mechanics::TableFault::RadiusNotRising, index: 1 },
            mechanics::Error::ForceExceedsFriction { target: 2.0, limit: 1.0, part: 0.5 },
            mechanics::Error::Interrupted,
            mechanics::Error::Unsupported(mechanics::UnsupportedMove::TangentialForceWithNormalTarget),
        ];
        let refused = errors.map(|error| Failure::Refused { pointer: String::new(), error });
        let others = [
            Failure::MemoryFull { pointer: String::new(), depth: 1 },
            Failure::TooLong { pointer: String::new(), allowed: std::time::Duration::ZERO },
            Failure::Stopped,
        ];
        for failure in refused.into_iter().chain(others) {
            assert_eq!(failure.code(), Problem::from(failure.clone()).code(), "{failure:?}");
        }
    }
}
