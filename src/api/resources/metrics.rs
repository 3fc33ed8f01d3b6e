//! `/metrics`: every number that the service counts. `docs/operation.md` says what to do about them.

use std::sync::Arc;

use axum::Extension;
use axum::extract::State;
use prometheus::{Gauge, IntCounter, Opts, Registry, TextEncoder};
use stickslip_mechanics::ENGINE;

use super::prelude::*;
use crate::sessions::Sessions;

use crate::api::request_metrics::RequestMetrics;

/// The text format of Prometheus that the library writes.
const MEDIA_TYPE: &str = "text/plain; version=0.0.4; charset=utf-8";

/// Get the metrics
///
/// Counters, gauges and histograms since the start, for Prometheus.
#[utoipa::path(
    get, path = "/metrics", operation_id = "get_metrics", tag = "service",
    responses((status = 200, description = "The text format of Prometheus, version 0.0.4", content_type = "text/plain",
        body = String))
)]
pub async fn metrics(
    State(app): State<Arc<App>>,
    Extension(traffic): Extension<Arc<RequestMetrics>>,
) -> Result<Response, Problem> {
    let text = page(&app, &traffic).map_err(|error| Problem::internal(error.to_string()))?;
    Ok(([(header::CONTENT_TYPE, MEDIA_TYPE)], text).into_response())
}

/// Puts metrics on a page.
macro_rules! show {
    ($page:expr, $($metric:expr),+) => {{ $($page.register(Box::new($metric.clone()))?;)+ }};
}

/// The current page: the registered counters, and gauges that are read at this request.
fn page(app: &App, traffic: &RequestMetrics) -> prometheus::Result<String> {
    let page = Registry::new();
    let counted = [app.sessions.metrics.collectors(), app.pool.meters().collectors(), app.jobs.meters().collectors()];
    for collector in counted.into_iter().flatten().chain(traffic.collectors()) {
        page.register(collector)?;
    }
    sessions(&page, &app.sessions)?;
    let threads = app.pool.capacity().threads.max(1);
    gauge(&page, Opts::new("stickslip_solver_threads", "Threads of the solver."), threads as f64)?;
    show!(page, app.pool.quotas().refused);
    let commits = app.sessions.commits();
    show!(page, commits.time, commits.size, commits.failed, commits.pending);
    this_program(&page)?;
    TextEncoder::new().encode_to_string(&page.gather())
}

fn gauge(page: &Registry, options: Opts, value: f64) -> prometheus::Result<()> {
    let gauge = Gauge::with_opts(options)?;
    gauge.set(value);
    show!(page, gauge);
    Ok(())
}

fn sessions(page: &Registry, sessions: &Sessions) -> prometheus::Result<()> {
    let (bytes, cached) = sessions.held();
    let misses =
        IntCounter::new("stickslip_cache_misses_total", "Requests for a contact that was loaded from the store.")?;
    misses.inc_by(sessions.metrics.open.get_sample_count());
    show!(page, misses);
    for (name, help, value) in [
        ("stickslip_cache_contacts", "Contacts in memory that no request uses.", cached),
        ("stickslip_cache_bytes", "Bytes of the states of these contacts, and of prepared profiles.", bytes),
        (
            "stickslip_cache_capacity_bytes",
            "Bytes that the states may take, as set by --cache-bytes.",
            sessions.capacity(),
        ),
        ("stickslip_event_streams", "Clients that follow events.", sessions.streams()),
    ] {
        gauge(page, Opts::new(name, help), value as f64)?;
    }
    Ok(())
}

fn this_program(page: &Registry) -> prometheus::Result<()> {
    let build = Opts::new("stickslip_build_info", "Always 1; the labels give the version and the build.")
        .const_label("version", env!("CARGO_PKG_VERSION"))
        .const_label("engine", ENGINE.to_string())
        .const_label("rustc", env!("BUILD_COMPILER"))
        .const_label("commit", env!("BUILD_COMMIT"));
    gauge(page, build, 1.0)?;
    #[cfg(target_os = "linux")]
    page.register(Box::new(prometheus::process_collector::ProcessCollector::for_self()))?;
    Ok(())
}
