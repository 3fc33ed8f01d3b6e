//! What is known of a route beside its handler: the role that it needs, how it may be refused, and its events. The
//! facts stand in the table of routes, at the route (`api/mod.rs`).

use std::sync::Arc;

use axum::extract::Request;
use axum::handler;
use axum::response::Response;
use futures::future::BoxFuture;
use utoipa_axum::router::{OpenApiRouter, UtoipaMethodRouter};

use super::openapi::operations;
use super::state::App;
use crate::access::Role;

/// A status, and why a route answers with it.
pub type Refusal = (&'static str, &'static str);

#[derive(Clone, Copy, Debug)]
pub struct Facts {
    /// The role that the key of a request needs, if it needs a key.
    pub role: Option<Role>,
    /// The refusals beyond those that follow from its key, its parameters and its body.
    pub refusals: &'static [Refusal],
    /// The schemas of the events that it sends.
    pub events: &'static [&'static str],
    /// Whether the body may be left out.
    pub optional_body: bool,
}

/// Of a computation that may begin from a stored contact.
const STORED: &[Refusal] = &[("404", "Not found"), ("409", "The state of the contact forbids this")];
/// Of the result of a job.
const UNFINISHED: &[Refusal] = &[("409", "The job has not ended, or has failed")];
/// Of a store that is not ready.
const NOT_READY: &[Refusal] =
    &[("503", "The server is busy; try again after Retry-After"), ("507", "The storage has no room left")];

impl Facts {
    const fn of(role: Option<Role>, refusals: &'static [Refusal]) -> Facts {
        Facts { role, refusals, events: &[], optional_body: false }
    }

    pub const OPEN: Facts = Facts::of(None, &[]);
    /// Whether the service is ready.
    pub const READY: Facts = Facts::of(None, NOT_READY);
    pub const METRICS: Facts = Facts::of(Some(Role::Metrics), &[]);
    /// Reads or computes something, and changes nothing.
    pub const READS: Facts = Facts::of(Some(Role::Read), &[]);
    /// Computes something that may begin from a stored contact.
    pub const READS_STORED: Facts = Facts::of(Some(Role::Read), STORED);
    /// Reads the result of a job.
    pub const READS_RESULT: Facts = Facts::of(Some(Role::Read), UNFINISHED);
    /// Makes or changes something, or ends a job.
    pub const WRITES: Facts = Facts::of(Some(Role::Write), &[]);
}

/// Answers a request.
pub type Handler = Arc<dyn Fn(Request, Arc<App>) -> BoxFuture<'static, Response> + Send + Sync>;

/// A function with extractors as a handler.
pub fn handler<H, T>(function: H) -> Handler
where
    H: handler::Handler<T, Arc<App>, Future = BoxFuture<'static, Response>>,
{
    Arc::new(move |request, app| function.clone().call(request, app))
}

/// A handler with its description, for [`Routes::with`].
macro_rules! route {
    ($($handler:ident)::+) => {
        (utoipa_axum::routes!($($handler)::+), $crate::api::facts::handler($($handler)::+))
    };
}
pub(super) use route;

/// A path, and its operations by their methods.
pub struct Route {
    pub path: String,
    pub operations: Vec<(&'static str, Handler, Facts)>,
}

impl Route {
    /// The operation of a method.
    pub fn operation(&self, method: &str) -> Option<&(&'static str, Handler, Facts)> {
        let method = if method == "HEAD" { "GET" } else { method };
        self.operations.iter().find(|(known, ..)| *known == method)
    }
}

/// The routes, and what the OpenAPI document says of them.
pub struct Routes {
    pub document: OpenApiRouter<Arc<App>>,
    pub table: Vec<Route>,
}

impl Routes {
    /// Adds an operation with these facts.
    pub fn add(&mut self, facts: Facts, mut described: UtoipaMethodRouter<Arc<App>>, handler: &Handler) {
        for (path, item) in &mut described.1.paths {
            for (method, _) in operations(item) {
                self.insert(path, (method, Arc::clone(handler), facts));
            }
        }
        self.document = std::mem::take(&mut self.document).routes(described);
    }

    /// Adds an operation to the table alone.
    pub fn insert(&mut self, path: &str, operation: (&'static str, Handler, Facts)) {
        match self.table.iter_mut().find(|route| route.path == path) {
            Some(route) => route.operations.push(operation),
            None => self.table.push(Route { path: path.to_owned(), operations: vec![operation] }),
        }
    }

    /// With an operation with these facts.
    pub fn with(mut self, facts: Facts, (described, handler): (UtoipaMethodRouter<Arc<App>>, Handler)) -> Routes {
        self.add(facts, described, &handler);
        self
    }
}
