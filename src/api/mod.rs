//! HTTP: `router` is the table of contents; each resource has a file; [`problem`] says which error to use when.

mod accept;
mod computations;
mod extract;
mod facts;
pub mod formats;
pub mod middleware;
mod openapi;
mod path_and_headers;
pub mod problem;
mod query_parameters;
mod reply;
mod request_context;
pub mod request_limits;
mod request_metrics;
mod resources;
mod state;

use std::future::Future;
use std::sync::{Arc, LazyLock};

use axum::Router;
use axum::extract::Request;
use axum::middleware::from_fn_with_state;
use axum::response::Response;
use futures::future::BoxFuture;
use tokio::net::TcpListener;
use tokio::sync::watch;
use tower::ServiceBuilder;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::access::Role;
use crate::admission::UnderWay;
use crate::server::connections::{Answer, Arrival};
use crate::server::tls::Tls;
use crate::server::{self, ConnectionLimiter, ConnectionLimits, Service};
use stickslip_compute::computations::entries;

use facts::{Facts, Routes};
use middleware::{request_log, security_headers};
use request_context::Reception;
use request_metrics::RequestMetrics;
use resources::{
    contacts, cycle, cycles, events, files, history, hysteresis_loop, jobs, materials, meta, metrics, moves,
    observations, page, residual, stress, subsurface, sweep,
};

pub use problem::Problem;
pub(crate) use query_parameters::{QueryParams, QueryReader};
pub(crate) use resources::files::{LoopFileQuery, ScanFileQuery};
pub use state::{Access, App};

/// Serves the API on `listener` within the usual limits of connections, until `stop` is done.
pub async fn serve(listener: TcpListener, app: App, stop: impl Future<Output = ()> + Send + 'static) {
    let limiter = ConnectionLimiter::new(ConnectionLimits::default(), Arc::default());
    serve_within(limiter, listener, None, app, stop).await
}

/// Serves the API on `listener`, by TLS if it is given, for the connections that `limiter` admits, until `stop` is
/// done.
pub async fn serve_within(
    limiter: ConnectionLimiter,
    listener: TcpListener,
    tls: Option<Tls>,
    app: App,
    stop: impl Future<Output = ()> + Send + 'static,
) {
    let (sessions, jobs) = (app.sessions.clone(), app.jobs.clone());
    // The document always parses; without it, metrics of endpoints would appear with their first request.
    let metrics = Arc::new(RequestMetrics::of(&serde_json::from_str(document()).unwrap_or_default()));
    let (stopping, stops) = watch::channel(false);
    let reception = Reception {
        keys: app.access.keys.clone(),
        metrics,
        pool: app.pool.clone(),
        stops,
        crosses_origins: !app.access.origins.is_empty(),
    };
    let (hosts, reception) = (app.access.hosts.clone(), Arc::new(reception));
    let service = Service {
        hosts,
        api: Box::new(Api { router: router(app, &reception), reception }),
        body_time: limiter.limits.body,
        proxies: Arc::clone(&limiter.proxies),
        stopping,
    };
    server::serve(limiter, listener, tls, service, stop, || {
        // The event streams would never end by themselves.
        sessions.end_events();
        jobs.end();
    })
    .await;
}

/// All routes, and what is around them.
struct Api {
    router: Router,
    reception: Arc<Reception>,
}

impl Answer for Api {
    fn answer(&self, arrival: Arrival, request: Request) -> BoxFuture<'_, (Response, UnderWay)> {
        Box::pin(request_log::serve(&self.reception, &self.router, arrival, request))
    }
}

/// All routes.
fn router(app: App, reception: &Arc<Reception>) -> Router {
    let (api, _) = described().router.split_for_parts();
    let origins = Arc::clone(&app.access.origins);
    let all = api.with_state(Arc::new(app)).merge(page::routes()).fallback(meta::not_found);
    if origins.is_empty() {
        return all;
    }
    let layers = ServiceBuilder::new()
        // Before keys are asked for: a browser asks whether it may send one.
        .layer(security_headers::cross_origin(&origins))
        .layer(from_fn_with_state(Arc::clone(reception), request_log::serve_across));
    all.layer(layers)
}

/// The OpenAPI document, as `/openapi.json` serves it and `stickslip openapi` prints it.
pub fn document() -> &'static str {
    static DOCUMENT: LazyLock<String> = LazyLock::new(|| openapi::text(described()));
    &DOCUMENT
}

/// What is known of the routes.
static FACTS: LazyLock<Vec<(&str, String, Facts)>> = LazyLock::new(|| described().facts);

/// The route of a path, by the rules of the router.
pub fn route_of(path: &str) -> Option<&'static str> {
    static ROUTES: LazyLock<matchit::Router<&str>> = LazyLock::new(|| {
        let mut routes = matchit::Router::new();
        for route in FACTS.iter().map(|(_, route, _)| route.as_str()).chain(page::ROUTES) {
            // A route stands there once for each of its methods.
            let _ = routes.insert(route, route);
        }
        routes
    });
    ROUTES.at(path).ok().map(|found| *found.value)
}

/// The role that a method on a route needs, if it needs a key: the highest one, where nothing is known of it.
pub fn need(method: &str, route: &str) -> Option<Role> {
    let method = if method == "HEAD" { "GET" } else { method };
    if method == "GET" && page::ROUTES.contains(&route) {
        return None;
    }
    let known = FACTS.iter().find(|(known, path, _)| *known == method && path == route);
    known.map_or(Some(Role::Write), |(.., facts)| facts.role)
}

/// The routes that the OpenAPI document describes, with their facts.
fn described() -> Routes {
    let mut routes = Routes { router: OpenApiRouter::with_openapi(openapi::base()), facts: Vec::new() };
    entries().into_iter().for_each(|entry| routes.add_computation(entry));
    routes
        .with(Facts::WRITES, routes!(sweep::run_sweep))
        .with(Facts::READS, routes!(files::read_scan_file))
        .with(Facts::READS, routes!(files::read_loop_file))
        .with(Facts::READS, routes!(jobs::list_jobs))
        .with(Facts::READS, routes!(jobs::get_job))
        .with(Facts::WRITES, routes!(jobs::cancel_job))
        .with(Facts::READS_RESULT, routes!(jobs::get_job_result))
        .with(Facts { events: &["JobReply", "JobEndEvent"], ..Facts::READS }, routes!(jobs::watch_job))
        .with(Facts::WRITES, routes!(contacts::create_contact))
        .with(Facts::READS, routes!(contacts::list_contacts))
        .with(Facts::READS, routes!(contacts::get_contact))
        .with(Facts::WRITES, routes!(contacts::rename_contact))
        .with(Facts::WRITES, routes!(contacts::delete_contact))
        .with(Facts::READS, routes!(contacts::get_definition))
        .with(Facts { optional_body: true, ..Facts::WRITES }, routes!(contacts::fork_contact))
        .with(Facts::WRITES, routes!(moves::move_contact))
        .with(Facts::WRITES, routes!(moves::follow_path))
        .with(Facts::WRITES, routes!(moves::relax_contact))
        .with(Facts::WRITES, routes!(observations::follow_bench))
        .with(Facts::READS, routes!(observations::get_friction))
        .with(Facts::READS, routes!(stress::get_stress))
        .with(Facts::READS, routes!(residual::get_residual))
        .with(Facts::READS, routes!(subsurface::compute_subsurface_stress))
        .with(Facts::READS, routes!(cycle::get_steady_cycle))
        .with(Facts::READS, routes!(history::get_history))
        .with(Facts::READS, routes!(hysteresis_loop::get_loop))
        .with(Facts::READS, routes!(cycles::get_cycles))
        .with(Facts { events: &["StateEvent", "EndEvent"], ..Facts::READS }, routes!(events::watch_contact))
        .with(Facts::OPEN, routes!(meta::get_openapi))
        .with(Facts::OPEN, routes!(meta::get_problem))
        .with(Facts::OPEN, routes!(materials::get_materials))
        .with(Facts::OPEN, routes!(meta::check_health))
        .with(Facts::READY, routes!(meta::check_readiness))
        .with(Facts::METRICS, routes!(metrics::metrics))
}
