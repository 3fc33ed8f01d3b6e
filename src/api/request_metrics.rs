//! Metrics of requests by route, method and status.
//!
//! The labels are bounded: the routes of the service and the methods of HTTP. Anything else is `none` or `other`.

use std::collections::HashMap;
use std::sync::OnceLock;
use std::time::{Duration, SystemTime};

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
const NONE: &str = "none";
/// The status of a request whose client did not wait for the answer. It is never sent.
pub const ABANDONED: u16 = 499;
/// The lowest status, and how many there may be.
const STATUSES: (u16, usize) = (100, 500);

/// All requests since the start.
pub struct RequestMetrics {
    /// When that was.
    pub since: SystemTime,
    families: Families,
    routes: HashMap<String, Route>,
    other: Route,
    none: Route,
}

/// What Prometheus reads of all endpoints.
#[derive(Clone)]
struct Families {
    requests: IntCounterVec,
    duration: HistogramVec,
    in_flight: IntGaugeVec,
}

/// One method of one route: handles on its metrics, so that counting looks nothing up.
pub struct Endpoint {
    /// Requests that have no answer yet.
    pub in_flight: IntGauge,
    /// How long the answers took, s.
    duration: Histogram,
    /// How many there were, by status; the metric of a status is made when it first comes.
    statuses: Vec<OnceLock<IntCounter>>,
    requests: IntCounterVec,
    route: String,
    method: &'static str,
}

#[derive(Default)]
struct Route([OnceLock<Endpoint>; METHODS.len()]);

impl RequestMetrics {
    /// Nothing has passed yet. What the OpenAPI document describes is shown from the beginning: a rate needs a zero to
    /// rise from.
    pub fn of(document: &Value) -> RequestMetrics {
        let (families, mut routes) = (Families::new(), HashMap::new());
        for (path, item) in document["paths"].as_object().into_iter().flatten() {
            let route = Route::default();
            for (place, method) in route.0.iter().zip(METHODS) {
                if let Some(answers) = item[method.to_lowercase()]["responses"].as_object() {
                    let endpoint = place.get_or_init(|| families.endpoint(path, method));
                    answers.keys().filter_map(|key| key.parse().ok()).for_each(|status| {
                        endpoint.counter(status);
                    });
                }
            }
            routes.insert(path.clone(), route);
        }
        RequestMetrics { since: SystemTime::now(), families, routes, other: Route::default(), none: Route::default() }
    }

    /// Where a request that matches a route is counted.
    pub fn endpoint(&self, route: Option<&str>, method: &Method) -> &Endpoint {
        let (name, route) = match route {
            None => (NONE, &self.none),
            Some(name) => self.routes.get(name).map_or((OTHER, &self.other), |route| (name, route)),
        };
        let known = METHODS.iter().position(|known| *known == method.as_str()).unwrap_or(METHODS.len() - 1);
        route.0[known].get_or_init(|| self.families.endpoint(name, METHODS[known]))
    }

    /// The metrics of all endpoints that are described or have been asked.
    pub fn collectors(&self) -> [Box<dyn Collector>; 3] {
        let Families { requests, duration, in_flight } = self.families.clone();
        [Box::new(requests), Box::new(duration), Box::new(in_flight)]
    }
}

impl Families {
    fn new() -> Families {
        let help = "Requests answered, by route, method and status; 499 where the client left before.";
        let requests = Opts::new("stickslip_http_requests_total", help);
        let help = "Time from the head of a request to that of its answer.";
        let duration = HistogramOpts::new("stickslip_http_request_duration_seconds", help).buckets(SECONDS.to_vec());
        let in_flight = Opts::new("stickslip_http_requests_in_flight", "Requests without an answer yet.");
        Families {
            requests: IntCounterVec::new(requests, &["route", "method", "status"]).expect(OWN_NAME),
            duration: HistogramVec::new(duration, &["route", "method"]).expect(OWN_NAME),
            in_flight: IntGaugeVec::new(in_flight, &["route", "method"]).expect(OWN_NAME),
        }
    }

    fn endpoint(&self, route: &str, method: &'static str) -> Endpoint {
        Endpoint {
            in_flight: self.in_flight.with_label_values(&[route, method]),
            duration: self.duration.with_label_values(&[route, method]),
            statuses: vec![OnceLock::new(); STATUSES.1],
            requests: self.requests.clone(),
            route: route.to_owned(),
            method,
        }
    }
}

impl Endpoint {
    /// Counts a request that has been answered, or abandoned.
    pub fn answered(&self, status: u16, time: Duration) {
        self.duration.observe(time.as_secs_f64());
        if let Some(counter) = self.counter(status) {
            counter.inc();
        }
    }

    /// How many requests got a status; none for a number that is no status.
    fn counter(&self, status: u16) -> Option<&IntCounter> {
        let counter = self.statuses.get(usize::from(status.checked_sub(STATUSES.0)?))?;
        let labels = || [self.route.as_str(), self.method, &status.to_string()].map(str::to_owned);
        Some(counter.get_or_init(|| self.requests.with_label_values(&labels())))
    }
}

#[cfg(test)]
mod tests {
    use super::{ABANDONED, NONE, RequestMetrics};
    use crate::api::document;
    use axum::http::Method;
    use prometheus::proto::MetricFamily;
    use std::time::Duration;

    fn metrics() -> RequestMetrics {
        RequestMetrics::of(&serde_json::from_str(document()).unwrap())
    }

    fn families(traffic: &RequestMetrics) -> Vec<MetricFamily> {
        traffic.collectors().iter().flat_map(|collector| collector.collect()).collect()
    }

    /// The number of requests with a status, if it is shown.
    fn shown(traffic: &RequestMetrics, route: &str, method: &str, status: &str) -> Option<f64> {
        let families = families(traffic);
        let mut found = families[0].get_metric().iter().filter(|metric| {
            let labels: Vec<&str> = metric.get_label().iter().map(|label| label.value()).collect();
            labels == [method, route, status]
        });
        found.next().map(|metric| metric.get_counter().get_value())
    }

    #[test]
    fn what_clients_make_up_adds_no_labels() {
        let traffic = metrics();
        let before: Vec<usize> = families(&traffic).iter().map(|family| family.get_metric().len()).collect();
        for number in 0..1_000 {
            let method = Method::from_bytes(format!("M{number}").as_bytes()).unwrap();
            traffic.endpoint(None, &method).answered(404, Duration::ZERO);
        }
        let after: Vec<usize> = families(&traffic).iter().map(|family| family.get_metric().len()).collect();
        assert_eq!(after, before.iter().map(|count| count + 1).collect::<Vec<_>>());
        assert_eq!(shown(&traffic, NONE, "other", "404"), Some(1_000.0));
        assert_eq!(traffic.endpoint(None, &Method::from_bytes(b"BREW").unwrap()).duration.get_sample_count(), 1_000);
    }

    #[test]
    fn a_described_endpoint_is_shown_at_zero_and_a_status_when_it_comes() {
        let traffic = metrics();
        let route = "/contacts/{id}/move";
        let abandoned = ABANDONED.to_string();
        let of = |status: &str| shown(&traffic, route, "POST", status);
        assert_eq!((of("200"), of("503"), of(&abandoned)), (Some(0.0), Some(0.0), None));
        traffic.endpoint(Some(route), &Method::POST).answered(ABANDONED, Duration::ZERO);
        assert_eq!(of(&abandoned), Some(1.0));
    }
}
