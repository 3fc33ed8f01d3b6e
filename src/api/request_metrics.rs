//! Metrics of requests by route, method and status.
//!
//! The labels are bounded: the routes of the service and the methods of HTTP. Anything else is `none` or `other`.

use std::collections::HashSet;
use std::time::Duration;

use axum::http::Method;
use prometheus::core::Collector;
use prometheus::{HistogramOpts, HistogramVec, IntCounterVec, IntGauge, IntGaugeVec, Opts};
use serde_json::Value;

use crate::metrics::{OWN_NAME, SECONDS};

/// The methods that are distinguished; the last is for all others.
const METHODS: [&str; 8] = ["GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "OPTIONS", "other"];
/// The route label of pages that the OpenAPI document does not describe, such as `/docs`.
const OTHER: &str = "other";
/// The route label of requests that match no route.
pub const NONE: &str = "none";
/// The status of a request whose client did not wait for the answer. It is never sent.
pub const ABANDONED: u16 = 499;

/// All requests since the start.
pub struct RequestMetrics {
    requests: IntCounterVec,
    duration: HistogramVec,
    in_flight: IntGaugeVec,
    /// The routes that the OpenAPI document describes.
    routes: HashSet<String>,
}

/// The route and the method of a request.
pub type Endpoint<'a> = [&'a str; 2];

impl RequestMetrics {
    /// Nothing has passed yet. What the OpenAPI document describes is shown from the beginning: a rate needs a zero to
    /// rise from.
    pub fn of(document: &Value) -> RequestMetrics {
        let help = "Requests answered, by route, method and status; 499 where the client disconnected first.";
        let requests = Opts::new("stickslip_http_requests_total", help);
        let help = "Time from the head of a request to the head of its response.";
        let duration = HistogramOpts::new("stickslip_http_request_duration_seconds", help).buckets(SECONDS.to_vec());
        let in_flight = Opts::new("stickslip_http_requests_in_flight", "Requests in progress.");
        let mut metrics = RequestMetrics {
            requests: IntCounterVec::new(requests, &["route", "method", "status"]).expect(OWN_NAME),
            duration: HistogramVec::new(duration, &["route", "method"]).expect(OWN_NAME),
            in_flight: IntGaugeVec::new(in_flight, &["route", "method"]).expect(OWN_NAME),
            routes: HashSet::new(),
        };
        for (route, item) in document["paths"].as_object().into_iter().flatten() {
            for method in METHODS {
                let Some(answers) = item[method.to_lowercase()]["responses"].as_object() else { continue };
                metrics.duration.with_label_values(&[route, method]);
                metrics.in_flight.with_label_values(&[route, method]);
                for status in answers.keys() {
                    metrics.requests.with_label_values(&[route, method, status]);
                }
            }
            metrics.routes.insert(route.clone());
        }
        metrics
    }

    /// The labels of a request that matches a route.
    pub fn endpoint<'a>(&self, route: Option<&'a str>, method: &Method) -> Endpoint<'a> {
        let route = route.map_or(NONE, |route| if self.routes.contains(route) { route } else { OTHER });
        let method = METHODS.into_iter().find(|known| *known == method.as_str()).unwrap_or(METHODS[METHODS.len() - 1]);
        [route, method]
    }

    /// How many requests of an endpoint have no answer yet.
    pub fn in_flight(&self, endpoint: Endpoint<'_>) -> IntGauge {
        self.in_flight.with_label_values(&endpoint)
    }

    /// Counts a request that has been answered, or abandoned.
    pub fn answered(&self, [route, method]: Endpoint<'_>, status: u16, time: Duration) {
        self.duration.with_label_values(&[route, method]).observe(time.as_secs_f64());
        self.requests.with_label_values(&[route, method, &status.to_string()]).inc();
    }

    /// The metrics of all endpoints that are described or have been asked.
    pub fn collectors(&self) -> [Box<dyn Collector>; 3] {
        [Box::new(self.requests.clone()), Box::new(self.duration.clone()), Box::new(self.in_flight.clone())]
    }
}
