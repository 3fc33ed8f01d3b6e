//! The document that every refusal comes as (RFC 9457).

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::check::Fault;

/// What went wrong, for programs (`code`, `errors`) and for people (`title`, `detail`).
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
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
    /// What happened this time.
    pub detail: String,
    /// The name of the kind, for programs.
    #[schema(example = "invalid_input")]
    pub code: String,
    /// Each fault of the request with its place.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub errors: Vec<Fault>,
    /// The identifier of the request, by which its operator finds it in the log; also in the header `x-request-id`.
    pub request_id: String,
}
