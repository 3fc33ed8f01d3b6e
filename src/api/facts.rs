//! What is known of a route beside its handler: what it needs, how it may be refused, and how it replies. The facts
//! stand in the router, at the route (`api/mod.rs`).

use std::sync::Arc;

use utoipa_axum::router::{OpenApiRouter, UtoipaMethodRouter};

use super::openapi;
use super::state::App;
use crate::access::Role;
use stickslip_compute::formats::Format;

/// What a request needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Need {
    /// Nothing.
    Nothing,
    /// A key with this role.
    Key(Role),
}

/// A status, and why a route answers with it.
pub type Refusal = (&'static str, &'static str);

#[derive(Clone, Copy, Debug)]
pub struct Facts {
    /// What a request needs.
    pub need: Need,
    /// The refusals beyond those of its need and its body.
    pub refusals: &'static [&'static [Refusal]],
    /// The formats of the reply; none for one document.
    pub formats: &'static [Format],
    /// The schemas of the events that it sends.
    pub events: &'static [&'static str],
    /// Whether a client that has the current version gets 304.
    pub conditional: bool,
    /// Whether a reply says where the next page is.
    pub paged: bool,
    /// Whether the body may be left out.
    pub optional_body: bool,
}

/// Of what is computed or stored.
const LIMITED: &[Refusal] = &[
    ("429", "The quota of the client is used up; try again after Retry-After"),
    ("422", "The request is invalid, or the mechanics has no answer to it"),
    ("503", "The server is busy; try again after Retry-After"),
];
/// Of a stored contact.
const EXPIRED: &[Refusal] = &[("410", "The contact was idle for so long that it has expired")];
/// Of a change of a stored contact.
const CHANGES: &[Refusal] =
    &[FORBIDDEN, ("412", "The contact has another sequence, or another label, than If-Match gives")];
const FORBIDDEN: Refusal = ("409", "The state of the contact forbids this");
/// Of a computation that may begin from a stored contact.
const STORED: &[Refusal] = &[("404", "Not found"), FORBIDDEN];
/// Of the result of a job.
const UNFINISHED: &[Refusal] = &[("409", "The job has not ended, or has failed")];
/// Of a store that is not ready.
const NOT_READY: &[Refusal] =
    &[("503", "The server is busy; try again after Retry-After"), ("507", "The storage has no room left")];

impl Facts {
    const fn of(need: Need, refusals: &'static [&'static [Refusal]]) -> Facts {
        Facts { need, refusals, formats: &[], events: &[], conditional: false, paged: false, optional_body: false }
    }

    pub const OPEN: Facts = Facts::of(Need::Nothing, &[]);
    /// Whether the service is ready.
    pub const READY: Facts = Facts::of(Need::Nothing, &[NOT_READY]);
    pub const METRICS: Facts = Facts::of(Need::Key(Role::Metrics), &[]);
    /// Reads or computes something, and changes nothing.
    pub const READS: Facts = Facts::of(Need::Key(Role::Read), &[LIMITED]);
    /// Computes something that may begin from a stored contact.
    pub const READS_STORED: Facts = Facts::of(Need::Key(Role::Read), &[LIMITED, STORED]);
    /// Reads a contact.
    pub const READS_CONTACT: Facts = Facts::of(Need::Key(Role::Read), &[LIMITED, EXPIRED]);
    /// Reads the result of a job.
    pub const READS_RESULT: Facts = Facts::of(Need::Key(Role::Read), &[LIMITED, UNFINISHED]);
    /// Makes something new, or ends a job.
    pub const WRITES: Facts = Facts::of(Need::Key(Role::Write), &[LIMITED]);
    /// Copies a contact.
    pub const COPIES_CONTACT: Facts = Facts::of(Need::Key(Role::Write), &[LIMITED, EXPIRED]);
    /// Changes a contact.
    pub const CHANGES_CONTACT: Facts = Facts::of(Need::Key(Role::Write), &[LIMITED, EXPIRED, CHANGES]);
}

/// The routes with their facts.
pub struct Routes {
    /// The routes, and what their handlers say of them.
    pub router: OpenApiRouter<Arc<App>>,
    pub facts: FactsOfRoutes,
}

/// Method, path and facts of every operation.
#[derive(Clone, Debug, Default)]
pub struct FactsOfRoutes(Vec<(&'static str, String, Facts)>);

impl FactsOfRoutes {
    /// The facts of a method on a route; none of what is not listed.
    pub fn get(&self, method: &str, path: &str) -> Option<&Facts> {
        let method = if method == "HEAD" { "GET" } else { method };
        let mut found = self.0.iter().filter(|(listed, at, _)| *listed == method && at == path);
        found.next().map(|(.., facts)| facts)
    }

    /// Adds the facts of an operation.
    pub fn add(&mut self, method: &'static str, path: &str, facts: Facts) {
        self.0.push((method, path.to_owned(), facts));
    }
}

impl Routes {
    /// Adds operations with these facts.
    pub fn add(&mut self, facts: Facts, mut routes: UtoipaMethodRouter<Arc<App>>) {
        for (path, item) in &mut routes.1.paths {
            for (method, operation) in openapi::operations(item) {
                self.facts.add(method, path, facts);
                openapi::complete(path, operation, &facts);
            }
        }
        self.router = std::mem::take(&mut self.router).routes(routes);
    }

    /// With operations with these facts.
    pub fn with(mut self, facts: Facts, routes: UtoipaMethodRouter<Arc<App>>) -> Routes {
        self.add(facts, routes);
        self
    }
}
