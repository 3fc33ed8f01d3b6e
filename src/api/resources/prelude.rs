//! What most handlers read and answer with.

pub(super) use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
pub(super) use axum::response::{IntoResponse as _, Response};
pub(super) use uuid::Uuid;

pub(super) use crate::api::extract::CheckedBody;
pub(super) use crate::api::formats::{self, Format};
pub(super) use crate::api::path_and_headers::{ContactPath, IdempotencyKey, IfMatch, JobPath};
pub(super) use crate::api::problem::{Code, Problem};
pub(super) use crate::api::query_parameters::{CheckedQuery, count, parameters};
pub(super) use crate::api::request_context::Context;
pub(super) use crate::api::request_limits::{DEFAULT_PAGE, PAGE};
pub(super) use crate::api::state::{App, TenantApp};
pub(super) use crate::api::{computations, reply};
