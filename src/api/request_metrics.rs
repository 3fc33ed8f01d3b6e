//! Metrics of requests by route, method and status.
//!
//! The labels are bounded: the routes of the service and the methods of HTTP. Anything else is `none` or `other`.

use std::collections::HashMap;
use std::sync::Arc;
use std::time::Duration;

use axum::http::Method;
use prometheus::core::Collector;
use prometheus::{Histogram, HistogramOpts, HistogramVec, IntCounter, IntCounterVec, IntGauge, IntGaugeVec, Opts};
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
    /// The meters of the routes that the OpenAPI document describes, by their methods.
    routes: HashMap<String, Vec<Arc<EndpointMeters>>>,
}

/// The meters of a route and a method.
pub struct EndpointMeters {
    method: &'static str,
    /// Requests that have no answer yet.
    pub in_flight: IntGauge,
    duration: Histogram,
    /// By the statuses that are described.
    statuses: Vec<(u16, IntCounter)>,
    others: IntCounterVec,
    route: String,
}

impl EndpointMeters {
    /// Counts a request that has been answered, or abandoned.
    pub fn answered(&self, status: u16, time: Duration) {
        self.duration.observe(time.as_secs_f64());
        match self.statuses.iter().find(|(known, _)| *known == status) {
            Some((_, requests)) => requests.inc(),
            None => self.others.with_label_values(&[&*self.route, self.method, &status.to_string()]).inc(),
        }
    }
}

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
            routes: HashMap::new(),
        };
        for (route, item) in document["paths"].as_object().into_iter().flatten() {
            let described = METHODS.into_iter().filter_map(|method| {
                let answers = item[method.to_lowercase()]["responses"].as_object()?;
                Some(Arc::new(metrics.meters(route, method, answers.keys().filter_map(|status| status.parse().ok()))))
            });
            let described = described.collect();
            metrics.routes.insert(route.clone(), described);
        }
        metrics
    }

    fn meters(&self, route: &str, method: &'static str, statuses: impl Iterator<Item = u16>) -> EndpointMeters {
        let counter = |status: u16| (status, self.requests.with_label_values(&[route, method, &status.to_string()]));
        EndpointMeters {
            method,
            in_flight: self.in_flight.with_label_values(&[route, method]),
            duration: self.duration.with_label_values(&[route, method]),
            statuses: statuses.map(counter).collect(),
            others: self.requests.clone(),
            route: route.to_owned(),
        }
    }

    /// The meters of a request that matches a route.
    pub fn of_request(&self, route: Option<&str>, method: &Method) -> Arc<EndpointMeters> {
        let method = METHODS.into_iter().find(|known| *known == method.as_str()).unwrap_or(METHODS[METHODS.len() - 1]);
        let described = route.and_then(|route| self.routes.get(route));
        let known = described.into_iter().flatten().find(|meters| meters.method == method);
        known.map(Arc::clone).unwrap_or_else(|| {
            let known = route.filter(|_| described.is_some());
            let label = known.unwrap_or(if route.is_some() { OTHER } else { NONE });
            Arc::new(self.meters(label, method, std::iter::empty()))
        })
    }

    /// The metrics of all endpoints that are described or have been asked.
    pub fn collectors(&self) -> [Box<dyn Collector>; 3] {
        [Box::new(self.requests.clone()), Box::new(self.duration.clone()), Box::new(self.in_flight.clone())]
    }
}
