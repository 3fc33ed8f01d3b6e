//! Spans are sent by OTLP over HTTP. They wait in the bounded queue of a batch processor that has a thread of its own:
//! a span that finds the queue full is lost, so that a slow or unreachable collector costs spans, but neither requests
//! nor memory.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::time::Duration;

use bytes::Bytes;
use http::{HeaderMap, Request, Response};
use http_body_util::{BodyExt as _, Full, Limited};
use hyper_rustls::{HttpsConnector, HttpsConnectorBuilder};
use hyper_util::client::legacy::Client;
use hyper_util::client::legacy::connect::HttpConnector;
use hyper_util::rt::TokioExecutor;
use opentelemetry::Context;
use opentelemetry::propagation::TextMapPropagator as _;
use opentelemetry::trace::TracerProvider as _;
use opentelemetry_http::{HeaderExtractor, HttpClient, HttpError};
use opentelemetry_otlp::{Protocol, SpanExporter, WithExportConfig as _, WithHttpConfig as _};
use opentelemetry_sdk::Resource;
use opentelemetry_sdk::error::OTelSdkError;
use opentelemetry_sdk::propagation::TraceContextPropagator;
use opentelemetry_sdk::trace::{BatchConfigBuilder, BatchSpanProcessor, SdkTracerProvider};
use rustls::crypto::ring;
use rustls::{ClientConfig, RootCertStore};
use tokio::runtime::Handle;
use tokio::time::timeout;
use tracing::subscriber::Interest;
use tracing::{Metadata, Span, Subscriber};
use tracing_opentelemetry::OpenTelemetrySpanExt as _;
use tracing_subscriber::Layer;
use tracing_subscriber::filter::{LevelFilter, dynamic_filter_fn};
use tracing_subscriber::registry::LookupSpan;

use super::{REQUEST, SPANS};

/// Spans that may wait.
const QUEUE: usize = 8_192;
/// Spans that are sent together.
const BATCH: usize = 512;
/// How long spans wait to be sent together.
const PERIOD: Duration = Duration::from_secs(1);
/// How long a collector may take for a batch.
const PATIENCE: Duration = Duration::from_secs(5);
/// Bytes of an answer of a collector that are read.
const ANSWER: usize = 64 * 1024;

/// Where spans are sent from. It ends by [`Exporter::finish`].
pub struct Exporter(SdkTracerProvider);

/// A layer that sends spans to the collector at `endpoint`, such as `http://localhost:4318`, by way of `runtime`, and
/// the exporter that ends it.
///
/// # Errors
/// Why nothing can be sent to such an endpoint.
pub fn layer<S>(endpoint: &str, runtime: Handle) -> Result<(impl Layer<S> + use<S>, Exporter), String>
where
    S: Subscriber + for<'a> LookupSpan<'a>,
{
    let collector = Collector { http: client(endpoint)?, runtime, reached: Arc::new(AtomicBool::new(true)) };
    let exporter = SpanExporter::builder()
        .with_http()
        .with_http_client(collector)
        .with_protocol(Protocol::HttpJson)
        .with_endpoint(format!("{}/v1/traces", endpoint.trim_end_matches('/')))
        .with_timeout(PATIENCE)
        .build()
        .map_err(|error| error.to_string())?;
    let batches = BatchConfigBuilder::default()
        .with_max_queue_size(QUEUE)
        .with_max_export_batch_size(BATCH)
        .with_scheduled_delay(PERIOD);
    let processor = BatchSpanProcessor::builder(exporter).with_batch_config(batches.build()).build();
    let resource = Resource::builder()
        .with_service_name("stickslip")
        .with_attribute(opentelemetry::KeyValue::new("service.version", env!("CARGO_PKG_VERSION")));
    let provider = SdkTracerProvider::builder().with_span_processor(processor).with_resource(resource.build()).build();
    let layer = tracing_opentelemetry::layer()
        .with_tracer(provider.tracer("stickslip"))
        .with_context_activation(false)
        .with_location(false)
        .with_target(false)
        .with_threads(false)
        .with_tracked_inactivity(false);
    // Work outside requests, such as that of jobs, is not traced: its parts would each be a trace of their own.
    let traced = dynamic_filter_fn(|span, context| {
        is_ours(span) && (span.name() == REQUEST || context.lookup_current().is_some())
    });
    let traced = traced
        .with_callsite_filter(|site| if is_ours(site) { Interest::sometimes() } else { Interest::never() })
        .with_max_level_hint(LevelFilter::INFO);
    Ok((layer.with_filter(traced), Exporter(provider)))
}

fn is_ours(metadata: &Metadata<'_>) -> bool {
    metadata.is_span() && metadata.target() == SPANS
}

impl Exporter {
    /// Sends what waits, as long as that takes no longer than `patience`. It blocks the thread, which must be none
    /// of the runtime.
    pub fn finish(self, patience: Duration) {
        // An unreachable collector has been logged already.
        if let Err(OTelSdkError::Timeout(_)) = self.0.shutdown_with_timeout(patience) {
            tracing::warn!("the last traces were not sent in time");
        }
    }
}

type Http = Client<HttpsConnector<HttpConnector>, Full<Bytes>>;

fn client(endpoint: &str) -> Result<Http, String> {
    let mut roots = RootCertStore::empty();
    if endpoint.starts_with("https:") {
        let (added, _) = roots.add_parsable_certificates(rustls_native_certs::load_native_certs().certs);
        if added == 0 {
            return Err("no certificate authority was found to verify the collector".to_owned());
        }
    }
    let tls = ClientConfig::builder_with_provider(Arc::new(ring::default_provider()));
    let tls = tls.with_safe_default_protocol_versions().map_err(|error| error.to_string())?;
    let tls = tls.with_root_certificates(roots).with_no_client_auth();
    let connector = HttpsConnectorBuilder::new().with_tls_config(tls).https_or_http().enable_http1().build();
    Ok(Client::builder(TokioExecutor::new()).build(connector))
}

/// The HTTP client of a collector. The thread of the batches has no runtime, and HTTP needs one.
#[derive(Debug)]
struct Collector {
    http: Http,
    runtime: Handle,
    /// Whether the last batch arrived: only changes are logged.
    reached: Arc<AtomicBool>,
}

#[async_trait::async_trait]
impl HttpClient for Collector {
    async fn send_bytes(&self, request: Request<Bytes>) -> Result<Response<Bytes>, HttpError> {
        let http = self.http.clone();
        let sent = self.runtime.spawn(async move { timeout(PATIENCE, exchange(http, request)).await }).await;
        let sent = sent.map_err(HttpError::from).and_then(|sent| sent.map_err(HttpError::from)).flatten();
        let problem = match &sent {
            Ok(answer) if answer.status().is_success() => None,
            Ok(answer) => Some(format!("the collector answered {}", answer.status())),
            Err(error) => Some(error.to_string()),
        };
        match (self.reached.swap(problem.is_none(), Relaxed), problem) {
            (true, Some(error)) => tracing::warn!(error, "traces cannot be sent, and are dropped for now"),
            (false, None) => tracing::info!("traces are sent again"),
            _ => {}
        }
        sent
    }
}

async fn exchange(http: Http, request: Request<Bytes>) -> Result<Response<Bytes>, HttpError> {
    let (parts, body) = http.request(request.map(Full::new)).await?.into_parts();
    Ok(Response::from_parts(parts, Limited::new(body, ANSWER).collect().await?.to_bytes()))
}

/// Puts the span of a request below that of its caller, which `traceparent` names (W3C Trace Context); not if that is
/// malformed.
pub fn set_parent(span: &Span, headers: &HeaderMap) {
    if let Some(parent) = parent(headers) {
        // It fails where there is no trace.
        let _ = span.set_parent(parent);
    }
}

/// The span that a request belongs to, by its `traceparent`; none if that is malformed.
pub fn parent(headers: &HeaderMap) -> Option<Context> {
    let header = headers.get("traceparent")?.to_str().ok()?;
    // The library takes numbers of any length.
    let lengths = header.split('-').map(str::len).take(4);
    let sound = lengths.eq([2, 32, 16, 2]) && header.bytes().all(|byte| byte.is_ascii_graphic() && byte != b'+');
    let context =
        sound.then(|| TraceContextPropagator::new().extract_with_context(&Context::new(), &HeaderExtractor(headers)));
    context.filter(opentelemetry::trace::TraceContextExt::has_active_span)
}
