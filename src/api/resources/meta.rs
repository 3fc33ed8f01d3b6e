//! The service itself: health, the OpenAPI document, the kinds of problems, and the answers to requests without a
//! handler.

use std::any::Any;
use std::sync::Arc;

use axum::Json;
use axum::extract::State;
use axum::http::Uri;
use axum::response::IntoResponse;
use percent_encoding::percent_decode_str;
use serde_json::{Value, json};

use super::prelude::*;
use crate::api;
use crate::server::connections::Refusal;
use crate::sessions::SessionError;
use crate::store::StoreError;

/// Check that the process is alive
///
/// The reply does not depend on the store. Restart a process that does not reply.
#[utoipa::path(
    get, path = "/healthz", tag = "service",
    responses((status = 200, description = "Alive", body = serde_json::Value, example = json!({"status": "ok"})))
)]
pub async fn check_health() -> Json<Value> {
    Json(json!({"status": "ok"}))
}

/// Check that the service is ready
///
/// Checks that the store can be read and accepts changes. If not, the reply is 503, or 507 if the storage is full: send
/// requests elsewhere.
#[utoipa::path(
    get, path = "/readyz", tag = "service",
    responses((status = 200, description = "Ready", body = serde_json::Value, example = json!({"status": "ready"})))
)]
pub async fn check_readiness(State(app): State<Arc<App>>) -> Result<Json<Value>, Problem> {
    match app.sessions.ready().await {
        Ok(()) => Ok(Json(json!({"status": "ready"}))),
        Err(error @ SessionError::Store(StoreError::Full(_))) => Err(error.into()),
        Err(error @ SessionError::Pool(_)) => Err(error.into()),
        Err(error) => Err(Problem::new(Code::StorageUnavailable, "the store is not ready").because(error.to_string())),
    }
}

/// Get this document
///
/// The document that `/docs` shows and that clients are generated from.
#[utoipa::path(
    get, path = "/openapi.json", tag = "service",
    responses((status = 200, description = "The specification (OpenAPI 3.1)", body = serde_json::Value))
)]
pub async fn get_openapi() -> Response {
    reply::json(api::document().into())
}

/// Explain a kind of problem
///
/// The `type` of every problem document leads here.
#[utoipa::path(
    get, path = "/problems/{code}", tag = "service",
    params(("code" = String, Path, description = "The code of the problem", example = "invalid_input")),
    responses((status = 200, description = "The title and the status of the problem", body = serde_json::Value,
        example = json!({"code": "invalid_input", "title": "The request is invalid", "status": 422})))
)]
pub async fn get_problem(uri: Uri) -> Result<Json<Value>, Problem> {
    let code = percent_decode_str(uri.path().rsplit('/').next().unwrap_or_default()).decode_utf8_lossy();
    let kind = Code::parse(&code).ok_or_else(|| not_found(&uri))?;
    Ok(Json(json!({"code": code, "title": kind.title(), "status": kind.status()})))
}

pub fn not_found(uri: &Uri) -> Problem {
    let path: String = uri.path().chars().take(100).collect();
    Problem::new(Code::NotFound, format!("the path {path} was not found; /docs lists the paths"))
}

/// Why the server has not admitted a request.
impl From<Refusal> for Problem {
    fn from(refusal: Refusal) -> Problem {
        match refusal {
            Refusal::Ambiguous(why) => Problem::new(Code::AmbiguousRequest, why),
            Refusal::Foreign(why) => Problem::new(Code::ForeignOrigin, why),
            Refusal::Full(error) => error.into(),
        }
    }
}

pub fn panicked(panic: Box<dyn Any + Send + 'static>) -> Response {
    let text = panic.downcast_ref::<String>().map(String::as_str).or(panic.downcast_ref::<&str>().copied());
    Problem::internal(format!("panicked: {}", text.unwrap_or("without a message"))).into_response()
}
