//! `/metrics`: every number that the service counts, with its name. `docs/operation.md` says what to do about them.

use std::sync::Arc;
use std::time::UNIX_EPOCH;

use axum::Extension;
use axum::extract::State;
use axum::http::header;
use axum::response::{IntoResponse as _, Response};

use crate::admission::PoolMeters;
use crate::jobs::JobMeters;
use crate::metrics::page::{MEDIA_TYPE, Page};
use crate::metrics::process::Process;
use crate::sessions::Readings;
use crate::store::Commits;
use stickslip_mechanics::ENGINE;

use crate::api::middleware::request_metrics::RequestMetrics;
use crate::api::state::App;

/// Where the numbers are.
pub const ROUTE: &str = "/metrics";

/// How is it doing?
///
/// Counters, gauges and histograms since the start, for Prometheus.
#[utoipa::path(
    get, path = "/metrics", operation_id = "get_metrics", tag = "service",
    responses((status = 200, description = "The text format of Prometheus, version 0.0.4", content_type = "text/plain",
        body = String))
)]
pub async fn metrics(State(app): State<App>, Extension(traffic): Extension<Arc<RequestMetrics>>) -> Response {
    let mut page = Page::default();
    requests(&mut page, &traffic);
    let readings = app.sessions.readings();
    sessions(&mut page, &readings);
    solver(&mut page, app.pool.meters());
    jobs(&mut page, app.jobs.meters());
    if let Some(store) = readings.commits {
        commits(&mut page, store);
    }
    process(&mut page, &traffic);
    ([(header::CONTENT_TYPE, MEDIA_TYPE)], page.finish()).into_response()
}

fn requests(page: &mut Page, traffic: &RequestMetrics) {
    let endpoints = traffic.endpoints();
    let name = "stickslip_http_requests_total";
    page.family(name, "counter", "Requests answered, by route, method and status; 499 where the client left before.");
    for (route, method, endpoint) in &endpoints {
        for (status, count) in endpoint.counts() {
            page.sample(name, &[("route", route), ("method", method), ("status", status.as_str())], count);
        }
    }
    let name = "stickslip_http_request_duration_seconds";
    page.family(name, "histogram", "Time from the head of a request to that of its answer.");
    for (route, method, endpoint) in &endpoints {
        page.histogram(name, &[("route", route), ("method", method)], &endpoint.duration);
    }
    let name = "stickslip_http_requests_in_flight";
    page.family(name, "gauge", "Requests without an answer yet.");
    for (route, method, endpoint) in &endpoints {
        page.sample(name, &[("route", route), ("method", method)], endpoint.in_flight.get());
    }
}

fn sessions(page: &mut Page, readings: &Readings<'_>) {
    page.single("stickslip_moves_total", "counter", "Moves made and stored.", readings.moves);
    let help = "Times that a contact that was asked for was in memory.";
    page.single("stickslip_cache_hits_total", "counter", help, readings.hits);
    let help = "Times that it was not, and was brought from the store.";
    page.single("stickslip_cache_misses_total", "counter", help, readings.open.count());
    page.single("stickslip_cache_contacts", "gauge", "Contacts in memory that nobody works on.", readings.at_hand);
    page.single("stickslip_cache_bytes", "gauge", "Bytes of their states.", readings.bytes);
    let help = "Bytes that the states may take, as set by --cache-bytes.";
    page.single("stickslip_cache_capacity_bytes", "gauge", help, readings.capacity);
    let name = "stickslip_contact_open_seconds";
    page.family(name, "histogram", "Time to bring a contact from the store: its snapshot, and the moves beyond it.");
    page.histogram(name, &[], readings.open);
    page.single("stickslip_event_streams", "gauge", "Clients that listen to events.", readings.streams);
}

fn solver(page: &mut Page, meters: &PoolMeters) {
    let name = "stickslip_solver_seconds";
    page.family(name, "histogram", "Time of a piece of work of the solver: moves, replays, stresses, simulations.");
    page.histogram(name, &[], &meters.work);
    page.single("stickslip_solver_threads", "gauge", "Threads for long work.", meters.threads);
    page.single("stickslip_solver_running", "gauge", "Long work on a thread.", meters.running.get());
    page.single("stickslip_solver_waiting", "gauge", "Long work that waits for a thread.", meters.waiting.get());
    let name = "stickslip_solver_wait_seconds";
    page.family(name, "histogram", "How long work waited for its thread.");
    page.histogram(name, &[], &meters.wait);
    let help = "Work for which no thread became free in time.";
    page.single("stickslip_solver_refused_total", "counter", help, meters.refused.get());
}

fn jobs(page: &mut Page, meters: &JobMeters) {
    let help = "Points of sweeps computed by this process, at once or for jobs.";
    page.single("stickslip_sweep_points_total", "counter", help, meters.points.get());
    let help = "Chunks of jobs that this process has computed and stored.";
    page.single("stickslip_job_chunks_total", "counter", help, meters.chunks.get());
    let help = "Chunks that this process gave back undone.";
    page.single("stickslip_job_chunks_returned_total", "counter", help, meters.returned.get());
    page.single("stickslip_job_chunks_running", "gauge", "Chunks under way in this process.", meters.running.get());
    let help = "Jobs that this process gave up; the log says why.";
    page.single("stickslip_jobs_failed_total", "counter", help, meters.failed.get());
}

fn commits(page: &mut Page, commits: &Commits) {
    let store = [("store", commits.store)];
    let name = "stickslip_commit_seconds";
    page.family(name, "histogram", "Time of a transaction of the store, until it is durable.");
    page.histogram(name, &store, &commits.time);
    let name = "stickslip_commit_changes";
    page.family(name, "histogram", "Changes in a transaction.");
    page.histogram(name, &store, &commits.size);
    let name = "stickslip_commit_failures_total";
    page.family(name, "counter", "Transactions that failed.");
    page.sample(name, &store, commits.failed.get());
    let name = "stickslip_store_pending_changes";
    page.family(name, "gauge", "Changes that wait for their transaction, or are in it.");
    page.sample(name, &store, commits.pending.get());
}

fn process(page: &mut Page, traffic: &RequestMetrics) {
    let name = "stickslip_build_info";
    page.family(name, "gauge", "1, with what this program was built from.");
    let commit = option_env!("BUILD_COMMIT").unwrap_or("unknown");
    let (version, engine) = (env!("CARGO_PKG_VERSION"), ENGINE.to_string());
    let labels = [("version", version), ("engine", &engine), ("rustc", env!("BUILD_COMPILER")), ("commit", commit)];
    page.sample(name, &labels, 1);

    let since = traffic.since.duration_since(UNIX_EPOCH).unwrap_or_default().as_secs_f64();
    page.single("process_start_time_seconds", "gauge", "Start of the service, in seconds since 1970.", since);
    let now = Process::now();
    let mut show = |name: &str, kind: &str, help: &str, value: Option<f64>| {
        if let Some(value) = value {
            page.single(name, kind, help, value);
        }
    };
    let count = |value: Option<u64>| value.map(|value| value as f64);
    show("process_cpu_seconds_total", "counter", "Processor time used.", now.processor_seconds);
    show("process_resident_memory_bytes", "gauge", "Memory in use.", count(now.resident_bytes));
    show("process_threads", "gauge", "Threads.", count(now.threads));
    show("process_open_fds", "gauge", "Open files and sockets.", count(now.open_files));
    show("process_max_fds", "gauge", "How many may be open.", count(now.most_open_files));
}
