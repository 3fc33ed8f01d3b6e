//! The document that every refusal comes as (RFC 9457), and the table of its kinds.

use crate::files::FileCandidate;
use crate::prelude::*;

/// Declares [`Code`]: for each kind when to use it, its status, code and title, and what a client can do.
macro_rules! codes {
    ($($(#[doc = $when:literal])+ $kind:ident = $status:literal $code:literal: $title:literal, $advice:literal;)+) => {
        /// The kinds of refusals. Each says when it is the one to use.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Code {
            $($(#[doc = $when])+ $kind,)+
        }

        impl Code {
            /// All kinds, by status.
            pub const ALL: &[Code] = &[$(Code::$kind),+];

            /// The status code of a response that refuses so.
            pub fn status(self) -> u16 {
                match self {
                    $(Code::$kind => $status,)+
                }
            }

            /// The name for programs, which never changes.
            pub fn as_str(self) -> &'static str {
                match self {
                    $(Code::$kind => $code,)+
                }
            }

            /// The title of this kind of refusal.
            pub fn title(self) -> &'static str {
                match self {
                    $(Code::$kind => $title,)+
                }
            }

            /// What a client can do about it, in Markdown.
            pub fn advice(self) -> &'static str {
                match self {
                    $(Code::$kind => $advice,)+
                }
            }
        }
    };
}

codes! {
    /// The body is not JSON. A body that is JSON but not a valid request is [`Code::InvalidInput`].
    NotJson = 400 "not_json": "The body is not valid JSON", "`detail` says what was found, with line and column";
    /// A proxy might read the head of the request in another way than this server.
    AmbiguousRequest = 400 "ambiguous_request": "The head of the request is ambiguous",
        "the head can be read in two ways (two lengths, two keys, no host): correct the client or the proxy";
    /// The request has no key, or one that is not known.
    Unauthorized = 401 "unauthorized": "A key is needed", "send a key: `Authorization: Bearer KEY`";
    /// The key does not allow this. The contacts of other tenants are hidden: [`Code::ContactNotFound`].
    Forbidden = 403 "forbidden": "The key does not allow this", "the role of this key does not allow this";
    /// The service has no keys, and the request names a host that is not its own, or comes from a page of another site.
    ForeignOrigin = 403 "foreign_origin": "The request comes from another site",
        "call the service by an address or a name of its own, or have its operator add yours: \
            [browsers](access.md#browsers)";
    /// The path does not exist.
    NotFound = 404 "not_found": "The path was not found", "`/docs` lists the paths of the service";
    /// The contact does not exist.
    ContactNotFound = 404 "contact_not_found": "The contact was not found",
        "check the identifier; contacts of other tenants are hidden";
    /// The job does not exist.
    JobNotFound = 404 "job_not_found": "The job was not found",
        "check the identifier; jobs of other tenants are hidden, and jobs are deleted a day after their end";
    /// The path exists, but not with this method.
    MethodNotAllowed = 405 "method_not_allowed": "The path does not allow this method",
        "use a method that `Allow` lists";
    /// `Accept` admits no format that the path has.
    NotAcceptable = 406 "not_acceptable": "The format is not available",
        "let `Accept` admit one of the [formats](contacts.md#formats)";
    /// The body takes too long to arrive.
    RequestTimeout = 408 "request_timeout": "The request did not arrive in time",
        "send the body again, without long pauses";
    /// The request is sound, but the present state of the contact forbids it; [`Code::StaleSequence`] if the client has
    /// said which state it expects.
    Conflict = 409 "conflict": "The state of the contact forbids this",
        "`detail` gives the reason: the slip history of the contact is full, or other clients kept moving it";
    /// The result of a job that has not ended, and may yet have one.
    JobNotDone = 409 "job_not_done": "The job has not ended",
        "the job has not ended: wait for its events, or ask again";
    /// The result of a job that will never have one.
    JobFailed = 409 "job_failed": "The job has failed", "the document of the job gives the error that ended it";
    /// The contact was idle for so long that it has been deleted.
    ContactExpired = 410 "contact_expired": "The contact has expired",
        "the contact was idle for longer than `--expire-after`: create a new one";
    /// The contact is not at the sequence that `If-Match` names.
    StaleSequence = 412 "stale_sequence": "The contact has changed",
        "the contact has changed since: read it, then decide";
    /// The body is too large.
    TooLarge = 413 "too_large": "The body is too large", "bodies have at most 8 MiB, files of instruments 16 MiB";
    /// The body is not declared as JSON.
    UnsupportedMediaType = 415 "unsupported_media_type": "The body must be application/json",
        "send `Content-Type: application/json`, uncompressed; a file of an instrument as `application/octet-stream`";
    /// Something in the request is missing, unknown, of the wrong type or out of range, whatever the state of the
    /// server. Each fault comes with a pointer to its place.
    InvalidInput = 422 "invalid_input": "The request is invalid", "`errors` names each fault and what is allowed";
    /// A file names a unit that is not in the table of units, or a unit of another quantity than is needed there.
    UnknownUnit = 422 "unknown_unit": "A unit of the file is not known",
        "correct the header of the file, or name the unit in the query: [units](measured-surfaces.md#units)";
    /// A file may mean several things. `candidates` has each with the `mapping` that chooses it.
    AmbiguousFile = 422 "ambiguous_file": "The file may mean several things",
        "choose one of `candidates` by its `mapping`: [files](measured-loops.md#a-file-that-asks)";
    /// The request is valid, but no state carries the tangential force that it asks for.
    ForceExceedsFriction = 422 "force_exceeds_friction": "The tangential force is not below the friction limit",
        "the force must stay below μ F_N, which `detail` gives";
    /// The request is valid, but the contact would outgrow the profile.
    BeyondProfile = 422 "beyond_profile": "The contact outgrows the profile",
        "the contact outgrows the table or the sphere: reduce the load, or give a larger profile";
    /// The request is valid, but its bulk stress is too large for the contact, or the profile takes none.
    BulkTooLarge = 422 "bulk_too_large": "The bulk stress is too large for nested stick zones",
        "slip would begin on both sides in opposite directions; `detail` gives the largest stress: [line \
            contacts](line-contacts.md#bulk-stress)";
    /// The request is valid, but changes the load of a contact with a shear strength, or a twist, that carries shear.
    LoadMustBeConstant = 422 "load_must_be_constant": "The load must stay constant",
        "with a shear strength, change the load before the first tangential move, or define a contact under the other \
            load: [shear strength](shear-strength.md)";
    /// The request is valid, but twists a contact that has been moved along the surface, or the other way round.
    TwistWithShift = 422 "twist_with_shift": "Twist and tangential motion meet in one contact",
        "the direction of slip would depend on the angle: twist another contact, or lift it off in between: \
            [twist](twist.md)";
    /// The request is valid, but asks for a stress of a contact that is known by its load curve alone.
    NoStressField = 422 "no_stress_field": "The profile has no stress field",
        "forces and energies follow from a load curve, stresses do not: [rough contacts](rough-contacts.md)";
    /// The request is valid, but the contact area would be a ring.
    ProfileNotConvexEnough = 422 "profile_not_convex_enough": "The contact area would not be a full circle",
        "the contact area would be a ring, which the model does not treat: [limits](limits.md)";
    /// The request is valid, but the solver that it names cannot follow a move of it.
    UnsupportedMove = 422 "unsupported_move": "The solver cannot follow this move",
        "springs cannot follow this move: leave `solver` out";
    /// The request takes longer than a server computes for one.
    TooMuchWork = 422 "too_much_work": "The request takes too long",
        "ask for less at a time: fewer springs, moves or points. If `detail` says that the contact is being \
            [loaded](overload.md#work-that-ends), send the request again";
    /// The idempotency key belongs to another request.
    IdempotencyKeyReused = 422 "idempotency_key_reused": "The idempotency key belongs to another request",
        "choose a new key";
    /// The tenant has reached its limit of jobs.
    TooManyJobs = 429 "too_many_jobs": "The tenant has too many jobs",
        "wait for a job to end, or delete one; `Retry-After` says when to try again";
    /// A quota of the client is used up.
    QuotaExceeded = 429 "quota_exceeded": "A quota of the client is used up",
        "`detail` names the [quota](overload.md#quotas): end, close or delete something, or wait as long as \
            `Retry-After` says";
    /// A fault of this program. Its cause goes to the log; the client gets the identifier of the request.
    Internal = 500 "internal": "The server has failed",
        "a fault of the server: give its operator the `request_id`; a change may have been stored";
    /// The stored contact is damaged: moves are missing, or cannot be replayed.
    DamagedContact = 500 "damaged_contact": "The stored contact is damaged",
        "moves of the contact are missing in the store: the operator must restore it; other contacts are not affected";
    /// Nothing is wrong with the request, but there is no capacity at present.
    Overloaded = 503 "overloaded": "The server is busy", "wait as long as `Retry-After` says, and repeat";
    /// The server stops before the request is done.
    Stopping = 503 "stopping": "The server is stopping",
        "repeat elsewhere or later, with the same `Idempotency-Key`: a change may have been stored";
    /// The storage cannot be reached. Nothing has been acknowledged, and a retry is welcome.
    StorageUnavailable = 503 "storage_unavailable": "The storage cannot be reached",
        "repeat with the same `Idempotency-Key`: a change may have been stored, unless `detail` says that nothing has \
         changed";
    /// The storage has no room. Nothing has been acknowledged.
    StorageFull = 507 "storage_full": "The server has no room left", "the operator must make room; nothing has changed";
}

impl Code {
    /// The kind of this name.
    pub fn parse(code: &str) -> Option<Code> {
        Code::ALL.iter().copied().find(|known| known.as_str() == code)
    }
}

replies! {
/// What went wrong, for programs (`code`, `errors`) and for people (`title`, `detail`).
pub struct ProblemDocument {
    /// A reference that identifies the kind of problem: `/problems/` and the code.
    #[serde(rename = "type")]
    #[schema(example = "/problems/invalid_input")]
    pub kind: String,
    /// What this kind of problem is.
    #[schema(example = "The request is invalid")]
    pub title: String,
    /// The status code of the response.
    #[schema(example = 422)]
    pub status: u16,
    /// What happened in this request.
    pub detail: String,
    /// The name of the kind of problem, for programs.
    #[schema(example = "invalid_input")]
    pub code: String,
    /// Each fault of the request with its place.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub errors: Vec<Fault>,
    /// What a file may mean, if it may mean several things.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub candidates: Vec<FileCandidate>,
    /// The value of the parameter `mapping` with which the first of `candidates` is read.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    pub mapping: Option<String>,
    /// The identifier of the request, by which the operator of the server finds it in the log; also in the header
    /// `x-request-id`.
    pub request_id: String,
}
}

impl ProblemDocument {
    /// The document of a refusal.
    pub fn new(code: Code, detail: String, errors: Vec<Fault>, request_id: &str) -> ProblemDocument {
        ProblemDocument {
            kind: format!("/problems/{}", code.as_str()),
            title: code.title().to_owned(),
            status: code.status(),
            detail,
            code: code.as_str().to_owned(),
            errors,
            candidates: Vec::new(),
            mapping: None,
            request_id: request_id.to_owned(),
        }
    }
}
