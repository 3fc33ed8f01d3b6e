//! Traces for OpenTelemetry: a span for each request, sent to a collector by OTLP, as JSON over HTTP.
//!
//! The spans are made from the lines that the log has for requests, whatever of them the log shows. They wait in a bounded
//! queue: a collector that is slow or away costs spans, and neither requests nor memory.

use std::time::{Duration, SystemTime, UNIX_EPOCH};

use serde_json::{Value, json};
use tokio::sync::{mpsc, oneshot};
use tokio::task::JoinHandle;
use tokio::time::timeout;
use tracing::field::{Field, Visit};
use tracing::{Event, Level, Subscriber};
use tracing_subscriber::Layer;
use tracing_subscriber::filter::Targets;
use tracing_subscriber::layer::Context;
use tracing_subscriber::registry::LookupSpan;
use uuid::Uuid;

/// Spans that may wait.
const QUEUE: usize = 8_192;
/// Spans that are sent together.
const BATCH: usize = 512;
/// How long spans wait for others to go with.
const PERIOD: Duration = Duration::from_secs(1);
/// How long a collector may take.
const PATIENCE: Duration = Duration::from_secs(5);
/// What a collector takes for the kind of a span that answers a request, and for a status of failure.
const SERVER: u8 = 2;
const FAILED: u8 = 2;

/// A span as it is sent, but for the frame around it.
type Span = Value;

/// Where spans are made.
struct Spans(mpsc::Sender<Span>);

/// Where spans are sent from. It ends by [`Exporter::finish`].
pub struct Exporter {
    task: JoinHandle<()>,
    end: oneshot::Sender<()>,
}

/// A layer that makes spans out of log lines, and the exporter that sends them to the collector at `endpoint`, such as
/// `http://localhost:4318`. To be called within a runtime.
pub fn layer<S>(endpoint: &str) -> (impl Layer<S> + use<S>, Exporter)
where
    S: Subscriber + for<'a> LookupSpan<'a>,
{
    let (sender, spans) = mpsc::channel(QUEUE);
    let (end, ended) = oneshot::channel();
    let url = format!("{}/v1/traces", endpoint.trim_end_matches('/'));
    let task = tokio::spawn(export(url, spans, ended));
    let requests = Targets::new().with_target("stickslip::api", Level::INFO);
    (Spans(sender).with_filter(requests), Exporter { task, end })
}

impl Exporter {
    /// Sends what waits, as long as that takes no longer than a collector may.
    pub async fn finish(self) {
        // A task that has ended has nothing left to send.
        let _ = self.end.send(());
        if timeout(PATIENCE, self.task).await.is_err() {
            tracing::warn!("the last traces were not sent in time");
        }
    }
}

async fn export(url: String, mut spans: mpsc::Receiver<Span>, mut ended: oneshot::Receiver<()>) {
    let (http, mut reached, mut over) = (reqwest::Client::new(), true, false);
    while !over || !spans.is_empty() {
        let mut batch = Vec::new();
        while batch.len() < BATCH
            && let Ok(span) = spans.try_recv()
        {
            batch.push(span);
        }
        let full = batch.len() == BATCH;
        if !batch.is_empty() {
            let sent = http.post(&url).timeout(PATIENCE).json(&framed(batch)).send().await;
            let sent = sent.and_then(reqwest::Response::error_for_status);
            match &sent {
                Ok(_) if !reached => tracing::info!("traces are sent again"),
                Err(error) if reached => tracing::warn!(%error, "traces cannot be sent, and are lost until they can"),
                _ => {}
            }
            reached = sent.is_ok();
        }
        if !full && !over {
            over = timeout(PERIOD, &mut ended).await.is_ok();
        }
    }
}

/// Spans in the frame that says whose they are.
fn framed(spans: Vec<Span>) -> Value {
    let about = [text("service.name", "stickslip"), text("service.version", env!("CARGO_PKG_VERSION"))];
    let scope = json!({"scope": {"name": "stickslip"}, "spans": spans});
    json!({"resourceSpans": [{"resource": {"attributes": about}, "scopeSpans": [scope]}]})
}

fn text(key: &str, value: &str) -> Value {
    json!({"key": key, "value": {"stringValue": value}})
}

impl<S: Subscriber> Layer<S> for Spans {
    fn on_event(&self, event: &Event<'_>, _: Context<'_, S>) {
        let mut line = Line::default();
        event.record(&mut line);
        if let Some(span) = line.span(SystemTime::now()) {
            // A queue that is full loses the span.
            let _ = self.0.try_send(span);
        }
    }
}

/// The fields of a line in the log.
#[derive(Default)]
struct Line {
    method: String,
    route: Option<String>,
    status: u64,
    duration_ms: f64,
    request_id: String,
    code: Option<String>,
    cause: Option<String>,
    traceparent: Option<String>,
}

impl Visit for Line {
    fn record_str(&mut self, field: &Field, value: &str) {
        let value = value.to_owned();
        match field.name() {
            "route" => self.route = Some(value),
            "request_id" => self.request_id = value,
            "code" => self.code = Some(value),
            "cause" => self.cause = Some(value),
            "traceparent" => self.traceparent = Some(value),
            _ => {}
        }
    }

    fn record_u64(&mut self, field: &Field, value: u64) {
        if field.name() == "status" {
            self.status = value;
        }
    }

    fn record_f64(&mut self, field: &Field, value: f64) {
        if field.name() == "duration_ms" {
            self.duration_ms = value;
        }
    }

    fn record_debug(&mut self, field: &Field, value: &dyn std::fmt::Debug) {
        if field.name() == "method" {
            self.method = format!("{value:?}");
        }
    }
}

impl Line {
    /// The span of a request that ends now; none if the line is about something else, or the caller wants no trace.
    fn span(self, now: SystemTime) -> Option<Span> {
        let route = self.route?;
        let (trace, parent) = match self.traceparent.as_deref().and_then(parse) {
            Some(Parent { sampled: false, .. }) => return None,
            Some(Parent { trace, span, .. }) => (trace.to_owned(), span.to_owned()),
            None => (Uuid::now_v7().simple().to_string(), String::new()),
        };
        let end = now.duration_since(UNIX_EPOCH).unwrap_or_default();
        let start = end.saturating_sub(Duration::from_secs_f64(self.duration_ms / 1e3));
        let mut attributes = vec![
            text("http.request.method", &self.method),
            text("http.route", &route),
            json!({"key": "http.response.status_code", "value": {"intValue": self.status.to_string()}}),
            text("stickslip.request_id", &self.request_id),
        ];
        attributes.extend(self.code.as_deref().map(|code| text("error.type", code)));
        let failed = json!({"code": FAILED, "message": self.cause.unwrap_or_default()});
        Some(json!({
            "traceId": trace,
            "spanId": format!("{:016x}", Uuid::now_v7().as_u64_pair().1),
            "parentSpanId": parent,
            "name": format!("{} {route}", self.method),
            "kind": SERVER,
            "startTimeUnixNano": start.as_nanos().to_string(),
            "endTimeUnixNano": end.as_nanos().to_string(),
            "attributes": attributes,
            "status": if self.status >= 500 { failed } else { json!({}) },
        }))
    }
}

/// The span that a request belongs to, by its `traceparent` (W3C Trace Context).
struct Parent<'a> {
    trace: &'a str,
    span: &'a str,
    sampled: bool,
}

fn parse(header: &str) -> Option<Parent<'_>> {
    let hex = |text: &str, length: usize| {
        text.len() == length && text.bytes().all(|byte| matches!(byte, b'0'..=b'9' | b'a'..=b'f'))
    };
    let mut parts = header.split('-');
    let (version, trace, span, flags) = (parts.next()?, parts.next()?, parts.next()?, parts.next()?);
    let sound = hex(version, 2) && version != "ff" && hex(trace, 32) && hex(span, 16) && hex(flags, 2);
    let named = trace.bytes().any(|byte| byte != b'0') && span.bytes().any(|byte| byte != b'0');
    // Later versions may have more to say.
    let whole = version != "00" || parts.next().is_none();
    let sampled = u8::from_str_radix(flags, 16).ok()? & 1 == 1;
    (sound && named && whole).then_some(Parent { trace, span, sampled })
}

#[cfg(test)]
mod tests {
    use super::parse;

    #[test]
    fn a_parent_is_taken_as_the_standard_has_it() {
        let of = |header: &str| parse(header).map(|parent| (parent.span.to_owned(), parent.sampled));
        let trace = "0af7651916cd43dd8448eb211c80319c";
        assert_eq!(of(&format!("00-{trace}-b7ad6b7169203331-01")), Some(("b7ad6b7169203331".to_owned(), true)));
        assert_eq!(of(&format!("00-{trace}-b7ad6b7169203331-00")), Some(("b7ad6b7169203331".to_owned(), false)));
        assert_eq!(of(&format!("cc-{trace}-b7ad6b7169203331-01-more")), Some(("b7ad6b7169203331".to_owned(), true)));
        for wrong in [
            "",
            "00",
            &format!("00-{trace}-b7ad6b7169203331-01-more"),
            &format!("ff-{trace}-b7ad6b7169203331-01"),
            &format!("00-{trace}-0000000000000000-01"),
            &format!("00-{}-b7ad6b7169203331-01", "0".repeat(32)),
            &format!("00-{}-b7ad6b7169203331-01", trace.to_uppercase()),
            &format!("00-{trace}-b7ad6b71692033-01"),
        ] {
            assert_eq!(of(wrong), None, "{wrong}");
        }
    }
}
