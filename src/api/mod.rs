//! HTTP: `router` is the table of contents; each resource has a file; [`problem`] says which error to use when.

mod extract;
pub mod formats;
pub mod limits;
pub mod middleware;
mod openapi;
mod params;
pub mod problem;
mod query;
mod reply;
mod request_metrics;
mod resources;
mod routes;
mod state;

use std::future::Future;
use std::io;
use std::sync::{Arc, OnceLock};

use axum::http::header::AUTHORIZATION;
use axum::middleware::from_fn_with_state;
use axum::{Extension, Router};
use tokio::net::TcpListener;
use tokio::sync::watch;
use tower::ServiceBuilder;
use tower_http::catch_panic::CatchPanicLayer;
use tower_http::sensitive_headers::SetSensitiveRequestHeadersLayer;
use utoipa_axum::router::{OpenApiRouter, UtoipaMethodRouterExt as _};
use utoipa_axum::routes;
use utoipa_swagger_ui::{Config, SwaggerUi};

use crate::admission::Pool;
use crate::server::tls::Tls;
use crate::server::{self, ConnectionLimiter, ConnectionLimits, Service};

use middleware::{access_control, observe, security_headers};
use request_metrics::RequestMetrics;
use resources::meta::OpenApiText;
use resources::{
    accuracy, contacts, cycle, cycles, events, fit, fretting, history, hysteresis_loop, jobs, meta, metrics, moves,
    observations, page,
};
use resources::{profile_fit, protocols, simulate, stress, subsurface, sweep};

pub use problem::Problem;
pub use state::{Access, App};

/// Serves the API on `listener` within the usual limits of connections, until `stop` is done.
///
/// # Errors
/// As [`server::serve`].
pub async fn serve(listener: TcpListener, app: App, stop: impl Future<Output = ()> + Send + 'static) -> io::Result<()> {
    let limiter = ConnectionLimiter::new(ConnectionLimits::default(), Arc::default());
    serve_within(limiter, listener, None, app, stop).await
}

/// Serves the API on `listener`, by TLS if it is given, for the connections that `limiter` admits, until `stop` is done.
///
/// # Errors
/// As [`server::serve`].
pub async fn serve_within(
    limiter: ConnectionLimiter,
    listener: TcpListener,
    tls: Option<Tls>,
    app: App,
    stop: impl Future<Output = ()> + Send + 'static,
) -> io::Result<()> {
    let (sessions, jobs, pool) = (app.sessions.clone(), app.jobs.clone(), app.pool.clone());
    let by_address = app.access.keys.is_none();
    // The document always parses; without it, metrics of endpoints would appear with their first request.
    let metrics = Arc::new(RequestMetrics::of(&serde_json::from_str(document()).unwrap_or_default()));
    let hosts = app.access.hosts.clone();
    let (stopping, stops) = watch::channel(false);
    let (router, refusals) = (router(app, Arc::clone(&metrics), stops.clone()), refusals(metrics, pool.clone(), stops));
    let service = Service {
        router,
        refusals,
        pool,
        by_address,
        body_time: limiter.limits().body,
        hosts,
        proxies: Arc::clone(limiter.proxies()),
        stopping,
    };
    server::serve(limiter, listener, tls, service, stop, || {
        // The event streams would never end by themselves.
        sessions.end_events();
        jobs.end();
    })
    .await
}

/// All routes.
fn router(app: App, metrics: Arc<RequestMetrics>, stops: watch::Receiver<bool>) -> Router {
    let (api, _) = described(document()).split_for_parts();
    let docs = SwaggerUi::new("/docs").config(Config::from("/openapi.json").validator_url("none"));
    let access = app.access.clone();
    let pool = app.pool.clone();
    let routes = api.with_state(Arc::new(app)).merge(docs).merge(page::routes()).fallback(meta::not_found);
    with_middleware(routes, access, metrics, pool, stops)
}

/// The answer to requests that are not admitted to [`router`].
fn refusals(metrics: Arc<RequestMetrics>, pool: Pool, stops: watch::Receiver<bool>) -> Router {
    with_middleware(Router::new().fallback(meta::refused), Access::default(), metrics, pool, stops)
}

/// Adds the middleware, from the outermost layer to the innermost.
fn with_middleware(
    routes: Router,
    access: Access,
    metrics: Arc<RequestMetrics>,
    pool: Pool,
    stops: watch::Receiver<bool>,
) -> Router {
    let origins = (!access.origins.is_empty()).then(|| security_headers::cross_origin(&access.origins));
    let keys = access.keys.map(|keys| from_fn_with_state((keys, pool.clone()), access_control::admit));
    let layers = ServiceBuilder::new()
        .layer(SetSensitiveRequestHeadersLayer::new([AUTHORIZATION]))
        .layer(from_fn_with_state((metrics, pool, stops), observe))
        .layer(CatchPanicLayer::custom(meta::panicked))
        // Before keys are asked for: a browser asks whether it may send one.
        .option_layer(origins)
        .option_layer(keys);
    routes.layer(layers)
}

/// The OpenAPI document, as `/openapi.json` serves it and `stickslip openapi` prints it.
pub fn document() -> &'static str {
    static DOCUMENT: OnceLock<String> = OnceLock::new();
    DOCUMENT.get_or_init(|| openapi::complete(described("").get_openapi()))
}

/// The routes that the OpenAPI document describes. `document` is its text, which one of them serves.
fn described(document: &'static str) -> OpenApiRouter<Arc<App>> {
    OpenApiRouter::with_openapi(openapi::base())
        .routes(routes!(simulate::simulate_path))
        .routes(routes!(accuracy::compare_solvers))
        .routes(routes!(protocols::find_protocol))
        .routes(routes!(cycle::compute_steady_cycle))
        .routes(routes!(fretting::rate_fretting))
        .routes(routes!(profile_fit::fit_profile))
        .routes(routes!(fit::fit_loops))
        .routes(routes!(sweep::run_sweep))
        .routes(routes!(jobs::list_jobs))
        .routes(routes!(jobs::get_job, jobs::cancel_job))
        .routes(routes!(jobs::get_job_result))
        .routes(routes!(jobs::watch_job))
        .routes(routes!(contacts::create_contact, contacts::list_contacts))
        .routes(routes!(contacts::get_contact, contacts::rename_contact, contacts::delete_contact))
        .routes(routes!(contacts::get_definition))
        .routes(routes!(contacts::fork_contact))
        .routes(routes!(moves::move_contact))
        .routes(routes!(moves::follow_path))
        .routes(routes!(moves::relax_contact))
        .routes(routes!(observations::follow_bench))
        .routes(routes!(observations::get_friction))
        .routes(routes!(stress::get_stress))
        .routes(routes!(subsurface::compute_subsurface_stress))
        .routes(routes!(cycle::get_steady_cycle))
        .routes(routes!(history::get_history))
        .routes(routes!(hysteresis_loop::get_loop))
        .routes(routes!(cycles::get_cycles))
        .routes(routes!(events::watch_contact))
        .routes(routes!(meta::get_openapi).layer(Extension(OpenApiText(document))))
        .routes(routes!(meta::get_problem))
        .routes(routes!(meta::check_health))
        .routes(routes!(meta::check_readiness))
        .routes(routes!(metrics::metrics))
}
