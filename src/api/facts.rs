//! What is known of a route beside its handler: the role that it needs, how it may be refused, and its events. The
//! facts stand in the router, at the route (`api/mod.rs`).

use std::sync::Arc;

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

/// The routes, and the facts of each method on a path.
pub struct Routes {
    pub router: OpenApiRouter<Arc<App>>,
    pub facts: Vec<(&'static str, String, Facts)>,
}

impl Routes {
    /// Adds operations with these facts.
    pub fn add(&mut self, facts: Facts, mut routes: UtoipaMethodRouter<Arc<App>>) {
        for (path, item) in &mut routes.1.paths {
            self.facts.extend(operations(item).map(|(method, _)| (method, path.clone(), facts)));
        }
        self.router = std::mem::take(&mut self.router).routes(routes);
    }

    /// With operations with these facts.
    pub fn with(mut self, facts: Facts, routes: UtoipaMethodRouter<Arc<App>>) -> Routes {
        self.add(facts, routes);
        self
    }
}
