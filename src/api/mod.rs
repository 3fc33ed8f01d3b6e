//! HTTP: `described` is the table of contents; each resource has a file; [`problem`] says which error to use when.

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

use axum::extract::Request;
use axum::http::{Method, StatusCode, header};
use axum::response::{IntoResponse as _, Response};
use futures::future::BoxFuture;
use tokio::net::TcpListener;
use tokio::sync::watch;
use utoipa_axum::router::OpenApiRouter;

use crate::access::Role;
use crate::admission::UnderWay;
use crate::server::connections::{Answer, Arrival};
use crate::server::tls::Tls;
use crate::server::{self, ConnectionLimiter, ConnectionLimits, Service};
use stickslip_compute::computations::entries;

use facts::{Facts, Route, Routes, handler, route};
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
        stops,
        cross_origin: (!app.access.origins.is_empty()).then(|| security_headers::cross_origin(&app.access.origins)),
        app: Arc::new(app),
    };
    let service = Service {
        hosts: reception.app.access.hosts.clone(),
        api: Box::new(reception),
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

impl Answer for Reception {
    fn answer(&self, arrival: Arrival, request: Request) -> BoxFuture<'_, (Response, UnderWay)> {
        Box::pin(request_log::serve(self, arrival, request))
    }
}

/// The OpenAPI document, as `/openapi.json` serves it and `stickslip openapi` prints it.
pub fn document() -> &'static str {
    static DOCUMENT: LazyLock<String> = LazyLock::new(|| openapi::text(described()));
    &DOCUMENT
}

/// The route of a path.
pub fn route_of(path: &str) -> Option<&'static Route> {
    static ROUTES: LazyLock<matchit::Router<Route>> = LazyLock::new(|| {
        let (mut routes, mut all) = (matchit::Router::new(), described());
        page::ROUTES.iter().for_each(|path| all.insert(path, ("GET", handler(page::get), Facts::OPEN)));
        for route in all.table {
            routes.insert(route.path.clone(), route).expect("the routes are constants that do not overlap");
        }
        routes
    });
    ROUTES.at(path).ok().map(|found| found.value)
}

/// The role that a method on a route needs, if it needs a key: the highest one, where nothing is known of it.
pub fn need(method: &Method, route: Option<&Route>) -> Option<Role> {
    let known = route.and_then(|route| route.operation(method.as_str()));
    known.map_or(Some(Role::Write), |(.., facts)| facts.role)
}

/// The reply of the handler of a request.
pub async fn handled(app: Arc<App>, route: Option<&Route>, request: Request) -> Response {
    let Some(route) = route else { return meta::not_found(request.uri()).into_response() };
    if let Some((_, handler, _)) = route.operation(request.method().as_str()) {
        return handler(request, app).await;
    }
    let methods: Vec<_> = route.operations.iter().map(|(method, ..)| *method).collect();
    let allowed = methods.join(",").replace("GET", "GET,HEAD");
    (StatusCode::METHOD_NOT_ALLOWED, [(header::ALLOW, allowed)]).into_response()
}

/// The routes that the OpenAPI document describes, with their facts.
fn described() -> Routes {
    let mut routes = Routes { document: OpenApiRouter::with_openapi(openapi::base()), table: Vec::new() };
    entries().into_iter().for_each(|entry| routes.add_computation(entry));
    routes
        .with(Facts::WRITES, route!(sweep::run_sweep))
        .with(Facts::READS, route!(files::read_scan_file))
        .with(Facts::READS, route!(files::read_loop_file))
        .with(Facts::READS, route!(jobs::list_jobs))
        .with(Facts::READS, route!(jobs::get_job))
        .with(Facts::WRITES, route!(jobs::cancel_job))
        .with(Facts::READS_RESULT, route!(jobs::get_job_result))
        .with(Facts { events: &["JobReply", "JobEndEvent"], ..Facts::READS }, route!(jobs::watch_job))
        .with(Facts::WRITES, route!(contacts::create_contact))
        .with(Facts::READS, route!(contacts::list_contacts))
        .with(Facts::READS, route!(contacts::get_contact))
        .with(Facts::WRITES, route!(contacts::rename_contact))
        .with(Facts::WRITES, route!(contacts::delete_contact))
        .with(Facts::READS, route!(contacts::get_definition))
        .with(Facts { optional_body: true, ..Facts::WRITES }, route!(contacts::fork_contact))
        .with(Facts::WRITES, route!(moves::move_contact))
        .with(Facts::WRITES, route!(moves::follow_path))
        .with(Facts::WRITES, route!(moves::relax_contact))
        .with(Facts::WRITES, route!(observations::follow_bench))
        .with(Facts::READS, route!(observations::get_friction))
        .with(Facts::READS, route!(stress::get_stress))
        .with(Facts::READS, route!(residual::get_residual))
        .with(Facts::READS, route!(subsurface::compute_subsurface_stress))
        .with(Facts::READS, route!(cycle::get_steady_cycle))
        .with(Facts::READS, route!(history::get_history))
        .with(Facts::READS, route!(hysteresis_loop::get_loop))
        .with(Facts::READS, route!(cycles::get_cycles))
        .with(Facts { events: &["StateEvent", "EndEvent"], ..Facts::READS }, route!(events::watch_contact))
        .with(Facts::OPEN, route!(meta::get_openapi))
        .with(Facts::OPEN, route!(meta::get_problem))
        .with(Facts::OPEN, route!(materials::get_materials))
        .with(Facts::OPEN, route!(meta::check_health))
        .with(Facts::READY, route!(meta::check_readiness))
        .with(Facts::METRICS, route!(metrics::metrics))
}
