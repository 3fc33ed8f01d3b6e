//! What is not about contacts: health, the specification, the kinds of problems, and the answers where nothing is.

use std::any::Any;

use axum::Extension;
use axum::extract::{Path, State};
use axum::http::Uri;
use axum::response::{IntoResponse, Response};
use serde_json::json;

use crate::admission::PoolError;

use crate::api::App;
use crate::api::problem::{Kind, Problem};
use crate::api::reply;
use crate::server::connections::Refusal;

/// Is the process alive?
#[utoipa::path(
    get, path = "/healthz", tag = "service",
    responses((status = 200, description = "It is", body = serde_json::Value, example = json!({"status": "ok"})))
)]
pub async fn healthz() -> Result<Response, Problem> {
    Ok(reply::json(reply::written(&json!({"status": "ok"}))?))
}

/// Can it serve?
#[utoipa::path(
    get, path = "/readyz", tag = "service",
    responses((status = 200, description = "It can", body = serde_json::Value, example = json!({"status": "ready"})))
)]
pub async fn readyz(State(app): State<App>) -> Result<Response, Problem> {
    match app.sessions.ready().await {
        Ok(()) => Ok(reply::json(reply::written(&json!({"status": "ready"}))?)),
        Err(error) => Err(Problem::new(Kind::Overloaded, "the store is not ready").because(error.to_string())),
    }
}

/// This document
#[utoipa::path(
    get, path = "/openapi.json", tag = "service",
    responses((status = 200, description = "The specification (OpenAPI 3.1)", body = serde_json::Value))
)]
pub async fn openapi() -> Response {
    reply::json(crate::api::document().as_bytes().to_vec())
}

/// What a kind of problem is
///
/// The `type` of every problem document leads here.
#[utoipa::path(
    get, path = "/problems/{code}", tag = "service",
    params(("code" = String, Path, description = "The code of the problem", example = "invalid_input")),
    responses((status = 200, description = "Its title and status", body = serde_json::Value,
        example = json!({"code": "invalid_input", "title": "The request is invalid", "status": 422})))
)]
pub async fn problem(Path(code): Path<String>, uri: Uri) -> Result<Response, Problem> {
    let Some(kind) = Kind::parse(&code) else {
        return Err(nothing(&uri));
    };
    Ok(reply::json(reply::written(&json!({"code": code, "title": kind.title(), "status": kind.status()}))?))
}

/// The answer to a path that does not exist.
pub async fn nothing_here(uri: Uri) -> Problem {
    nothing(&uri)
}

/// The answer to a request that does not come as far as a handler.
pub async fn refused(refusal: Option<Extension<Refusal>>) -> Problem {
    match refusal {
        Some(Extension(Refusal::Ambiguous(why))) => Problem::new(Kind::AmbiguousRequest, why),
        Some(Extension(Refusal::Full(error))) => error.into(),
        None => PoolError::Busy.into(),
    }
}

fn nothing(uri: &Uri) -> Problem {
    let path: String = uri.path().chars().take(100).collect();
    Problem::new(Kind::NotFound, format!("there is nothing at {path}; /docs shows what there is"))
}

/// The answer when a handler panicked.
pub fn panicked(panic: Box<dyn Any + Send + 'static>) -> Response {
    let text = panic.downcast_ref::<String>().map(String::as_str).or(panic.downcast_ref::<&str>().copied());
    Problem::internal(format!("panicked: {}", text.unwrap_or("without a message"))).into_response()
}
