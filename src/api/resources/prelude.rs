//! What most handlers read and answer with.

pub(super) use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
pub(super) use axum::response::{IntoResponse as _, Response};
pub(super) use uuid::Uuid;

pub(super) use crate::api::checked_query::{CheckedQuery, DEFAULT_PAGE, PAGE};
pub(super) use crate::api::extract::CheckedBody;
pub(super) use crate::api::formats::{Format, Negotiated as _};
pub(super) use crate::api::path_and_headers::{ContactPath, IdempotencyKey, IfMatch};
pub(super) use crate::api::problem::{Code, Problem};
pub(super) use crate::api::query_parameters::{Number, QueryParams, QueryReader, count, formats, parameters};
pub(super) use crate::api::state::{App, TenantApp};
pub(super) use crate::api::{computations, reply};
