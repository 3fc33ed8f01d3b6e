//! What passes through the service, by route, method and status.
//!
//! The labels are bounded: routes are our own, methods those of HTTP. Whatever else a client makes up is `none` or `other`.

use std::collections::HashMap;
use std::sync::OnceLock;
use std::time::{Duration, SystemTime};

use axum::http::{Method, StatusCode};
use serde_json::Value;

use crate::metrics::{Counter, Gauge, Histogram, SECONDS};

/// The methods that are told apart; the last stands for all others.
const METHODS: [&str; 8] = ["GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "OPTIONS", "other"];
/// The route of what we serve without describing it: the page at `/docs`.
const OTHER: &str = "other";
/// The route of what is nowhere.
const NONE: &str = "none";
/// The status of a request whose client did not wait for the answer. It is never sent.
pub const ABANDONED: u16 = 499;
/// The lowest status, and how many there may be.
const STATUSES: (u16, usize) = (100, 500);

/// All requests since the start.
pub struct RequestMetrics {
    /// When that was.
    pub since: SystemTime,
    routes: HashMap<String, Route>,
    other: Route,
    none: Route,
}

/// One method of one route.
pub struct Endpoint {
    /// Requests that have no answer yet.
    pub in_flight: Gauge,
    /// How long the answers took, s.
    pub duration: Histogram,
    /// How many there were, by status.
    statuses: Vec<Counter>,
    /// Statuses that are shown even if they have not come.
    promised: Vec<u16>,
}

#[derive(Default)]
struct Route([OnceLock<Endpoint>; METHODS.len()]);

impl RequestMetrics {
    /// Nothing has passed yet. What the OpenAPI document describes is shown from the beginning: a rate needs a nought to rise
    /// from.
    pub fn of(document: &Value) -> RequestMetrics {
        let mut routes = HashMap::new();
        for (path, item) in document["paths"].as_object().into_iter().flatten() {
            let route = Route::default();
            for (place, method) in route.0.iter().zip(METHODS) {
                if let Some(answers) = item[method.to_lowercase()]["responses"].as_object() {
                    place.get_or_init(|| Endpoint::new(answers.keys().filter_map(|key| key.parse().ok()).collect()));
                }
            }
            routes.insert(path.clone(), route);
        }
        RequestMetrics { since: SystemTime::now(), routes, other: Route::default(), none: Route::default() }
    }

    /// Where a request that matches a route is counted.
    pub fn endpoint(&self, route: Option<&str>, method: &Method) -> &Endpoint {
        let route = route.map_or(&self.none, |route| self.routes.get(route).unwrap_or(&self.other));
        let name = method.as_str();
        let place = METHODS.iter().position(|known| *known == name).unwrap_or(METHODS.len() - 1);
        route.0[place].get_or_init(|| Endpoint::new(Vec::new()))
    }

    /// Every endpoint that is described or has been asked, with its route and method.
    pub fn endpoints(&self) -> Vec<(&str, &'static str, &Endpoint)> {
        let routes = self.routes.iter().map(|(name, route)| (name.as_str(), route));
        let mut all = Vec::new();
        for (name, Route(places)) in routes.chain([(OTHER, &self.other), (NONE, &self.none)]) {
            let asked = places.iter().zip(METHODS).filter_map(|(place, method)| Some((name, method, place.get()?)));
            all.extend(asked);
        }
        all.sort_by_key(|(route, method, _)| (*route, *method));
        all
    }
}

impl Endpoint {
    fn new(promised: Vec<u16>) -> Endpoint {
        let statuses = (0..STATUSES.1).map(|_| Counter::default()).collect();
        Endpoint { in_flight: Gauge::default(), duration: Histogram::new(SECONDS), statuses, promised }
    }

    /// Counts a request that has been answered, or abandoned.
    pub fn answered(&self, status: u16, time: Duration) {
        self.duration.observe_time(time);
        if let Some(counter) = status.checked_sub(STATUSES.0).and_then(|place| self.statuses.get(usize::from(place))) {
            counter.add(1);
        }
    }

    /// How many requests got each status.
    pub fn counts(&self) -> impl Iterator<Item = (StatusCode, u64)> {
        let all = (STATUSES.0..).zip(&self.statuses).map(|(status, counter)| (status, counter.get()));
        let shown = all.filter(|(status, count)| *count > 0 || self.promised.contains(status));
        shown.filter_map(|(status, count)| Some((StatusCode::from_u16(status).ok()?, count)))
    }
}

#[cfg(test)]
mod tests {
    use super::{ABANDONED, NONE, RequestMetrics};
    use crate::api::document;
    use axum::http::Method;
    use std::time::Duration;

    fn metrics() -> RequestMetrics {
        RequestMetrics::of(&serde_json::from_str(document()).unwrap())
    }

    #[test]
    fn what_clients_make_up_adds_no_labels() {
        let traffic = metrics();
        let before = traffic.endpoints().len();
        for number in 0..1_000 {
            let method = Method::from_bytes(format!("M{number}").as_bytes()).unwrap();
            traffic.endpoint(None, &method).answered(404, Duration::ZERO);
        }
        let endpoints = traffic.endpoints();
        assert_eq!(endpoints.len(), before + 1);
        let (.., endpoint) = endpoints.iter().find(|(route, method, _)| (*route, *method) == (NONE, "other")).unwrap();
        assert_eq!(
            endpoint.counts().map(|(status, count)| (status.as_u16(), count)).collect::<Vec<_>>(),
            [(404, 1_000)]
        );
        assert_eq!(endpoint.duration.count(), 1_000);
    }

    #[test]
    fn a_described_endpoint_is_shown_at_nought_and_a_status_when_it_comes() {
        let traffic = metrics();
        let endpoint = traffic.endpoint(Some("/contacts/{id}/move"), &Method::POST);
        let shown = |wanted: u16| {
            let found: Vec<u64> =
                endpoint.counts().filter(|(status, _)| *status == wanted).map(|(_, count)| count).collect();
            found
        };
        assert_eq!((shown(200), shown(503), shown(ABANDONED)), (vec![0], vec![0], vec![]));
        endpoint.answered(ABANDONED, Duration::ZERO);
        assert_eq!(shown(ABANDONED), [1]);
    }
}
