//! `/metrics`: every number that the service counts. `docs/operation.md` says what to do about them.

use std::sync::Arc;

use axum::extract::State;
use prometheus::{IntCounter, IntGauge, Opts, Registry, TextEncoder};
use stickslip_mechanics::ENGINE;

use super::prelude::*;
use crate::api::request_metrics::RequestMetrics;
use crate::metrics::process;
use crate::store::Commits;

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
pub async fn metrics(State(app): State<Arc<App>>, Context(context): Context) -> Result<Response, Problem> {
    let text = page(&app, &context.metrics).map_err(|error| Problem::internal(error.to_string()))?;
    Ok(([(header::CONTENT_TYPE, MEDIA_TYPE)], text).into_response())
}

/// The current page: the registered counters, and gauges that are read at this request.
fn page(app: &App, traffic: &RequestMetrics) -> prometheus::Result<String> {
    let App { sessions, jobs, pool, .. } = app;
    let page = Registry::new();
    let counted = [sessions.metrics.collectors(), pool.meters().collectors(), jobs.meters().collectors()];
    for collector in counted.into_iter().flatten().chain(traffic.collectors()) {
        page.register(collector)?;
    }
    page.register(Box::new(pool.quotas().refused.clone()))?;
    let Commits { time, size, failed, pending, .. } = sessions.commits();
    page.register(Box::new(time.clone()))?;
    page.register(Box::new(size.clone()))?;
    page.register(Box::new(failed.clone()))?;
    page.register(Box::new(pending.clone()))?;
    let help = "Requests for a contact that was loaded from the store.";
    let misses = IntCounter::new("stickslip_cache_misses_total", help)?;
    misses.inc_by(sessions.metrics.open.get_sample_count());
    page.register(Box::new(misses))?;
    let gauge = |options: Opts, value: usize| {
        let gauge = IntGauge::with_opts(options)?;
        gauge.set(i64::try_from(value).unwrap_or(i64::MAX));
        page.register(Box::new(gauge))
    };
    let (bytes, cached) = sessions.held();
    for (name, help, value) in [
        ("stickslip_solver_threads", "Threads of the solver.", pool.capacity().threads.max(1)),
        ("stickslip_cache_contacts", "Contacts in memory that no request uses.", cached),
        ("stickslip_cache_bytes", "Bytes of the states of these contacts, and of prepared profiles.", bytes),
        (
            "stickslip_cache_capacity_bytes",
            "Bytes that the states may take, as set by --cache-bytes.",
            sessions.capacity(),
        ),
        ("stickslip_event_streams", "Clients that follow events.", sessions.streams()),
    ] {
        gauge(Opts::new(name, help), value)?;
    }
    if let Some(bytes) = sessions.log_bytes() {
        let help =
            "Bytes of the write-ahead log of the file, which is kept on the disk when its changes have moved on.";
        gauge(Opts::new("stickslip_store_log_bytes", help), usize::try_from(bytes).unwrap_or(usize::MAX))?;
    }
    let build = Opts::new("stickslip_build_info", "Always 1; the labels give the version and the build.")
        .const_label("version", env!("CARGO_PKG_VERSION"))
        .const_label("engine", ENGINE.to_string())
        .const_label("rustc", env!("BUILD_COMPILER"))
        .const_label("commit", env!("BUILD_COMMIT"));
    gauge(build, 1)?;
    process::register(&page)?;
    TextEncoder::new().encode_to_string(&page.gather())
}
