//! HTTP. `router` is the table of contents; each resource has a file; [`problem`] says which error to use when.

pub mod access;
mod accuracy;
pub mod bound;
mod contacts;
mod describe;
pub mod descriptors;
pub mod door;
mod events;
mod extract;
pub mod format;
pub mod headers;
mod jobs;
pub mod limits;
mod meta;
mod metrics;
mod moves;
mod observe;
mod openapi;
mod page;
mod plots;
pub mod problem;
mod protocols;
mod query;
mod reads;
mod reply;
mod serve;
pub mod sheet;
mod simulate;
mod sweep;
mod table;
mod traffic;

use std::sync::Arc;

use axum::{Router, middleware};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;
use utoipa_swagger_ui::{Config, SwaggerUi};

use crate::admission::Pool;
use crate::jobs::Jobs;
use crate::sessions::Sessions;

pub use access::Access;
pub use door::{Connections, Door};
pub use openapi::document;
pub use problem::Problem;
pub use serve::{serve, serve_through};

/// What the handlers work with. Clones are handles on the same.
#[derive(Clone)]
pub struct App {
    /// The sessions.
    pub sessions: Sessions,
    /// The jobs.
    pub jobs: Jobs,
    /// Where long work is done.
    pub pool: Pool,
    /// Who may use it.
    pub access: Access,
}

/// What counts the requests of [`router`] and of [`refusals`].
fn traffic() -> Arc<traffic::Traffic> {
    // Our own document is sound; without it, endpoints would be shown from their first request on.
    Arc::new(traffic::Traffic::of(&serde_json::from_str(document()).unwrap_or_default()))
}

/// All routes.
fn router(app: App, traffic: Arc<traffic::Traffic>) -> Router {
    let (api, _) = described().split_for_parts();
    let docs = SwaggerUi::new("/docs").config(Config::from("/openapi.json").validator_url("none"));
    let access = app.access.clone();
    dressed(api.with_state(app).merge(docs).merge(page::routes()).fallback(meta::nothing_here), access, traffic)
}

/// The answer to requests that do not come as far as [`router`].
fn refusals(traffic: Arc<traffic::Traffic>) -> Router {
    dressed(Router::new().fallback(meta::refused), Access::default(), traffic)
}

/// What is common to all replies.
fn dressed(mut routes: Router, Access { keys, origins }: Access, traffic: Arc<traffic::Traffic>) -> Router {
    if let Some(keys) = keys {
        routes = routes.layer(middleware::from_fn_with_state(keys, access::admit));
    }
    if !origins.is_empty() {
        // Before keys are asked for: a browser asks whether it may send one.
        routes = routes.layer(headers::cross_origin(&origins));
    }
    routes.layer(middleware::from_fn_with_state(traffic, observe::observe))
}

/// The routes that the OpenAPI document describes.
fn described() -> OpenApiRouter<App> {
    OpenApiRouter::with_openapi(openapi::base())
        .routes(routes!(simulate::simulate))
        .routes(routes!(accuracy::accuracy))
        .routes(routes!(protocols::protocols))
        .routes(routes!(sweep::sweep))
        .routes(routes!(jobs::get, jobs::delete))
        .routes(routes!(jobs::result))
        .routes(routes!(jobs::events))
        .routes(routes!(contacts::create, contacts::list))
        .routes(routes!(contacts::get, contacts::delete))
        .routes(routes!(contacts::definition))
        .routes(routes!(contacts::fork))
        .routes(routes!(moves::apply))
        .routes(routes!(moves::path))
        .routes(routes!(moves::relax))
        .routes(routes!(reads::stress))
        .routes(routes!(reads::history))
        .routes(routes!(reads::hysteresis))
        .routes(routes!(events::events))
        .routes(routes!(meta::openapi))
        .routes(routes!(meta::problem))
        .routes(routes!(meta::healthz))
        .routes(routes!(meta::readyz))
        .routes(routes!(metrics::metrics))
}
