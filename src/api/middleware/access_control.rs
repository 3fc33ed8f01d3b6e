//! Access control: the role that each route requires, and the key that a request presents.

use std::sync::Arc;

use axum::extract::{MatchedPath, Request, State};
use axum::http::{HeaderMap, Method, header};
use axum::middleware::Next;
use axum::response::{IntoResponse as _, Response};

use crate::access::{Keys, Role};

use crate::api::problem::{Code, Problem};
use crate::api::routes;

/// What a request needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Need {
    /// Nothing.
    Nothing,
    /// A key with this role.
    Key(Role),
}

use Need::{Key, Nothing};

/// The role that each route requires. A route that is not listed requires the highest role.
const ROUTE_ROLES: &[(&str, &str, Need)] = &[
    ("POST", "/accuracy", Key(Role::Read)),
    ("POST", "/simulate", Key(Role::Read)),
    ("POST", "/protocols", Key(Role::Read)),
    ("POST", "/cycle", Key(Role::Read)),
    ("POST", "/fretting", Key(Role::Read)),
    ("POST", "/profiles/fit", Key(Role::Read)),
    ("POST", "/sweep", Key(Role::Write)),
    ("GET", "/jobs/{id}", Key(Role::Read)),
    ("DELETE", "/jobs/{id}", Key(Role::Write)),
    ("GET", "/jobs/{id}/result", Key(Role::Read)),
    ("GET", "/jobs/{id}/events", Key(Role::Read)),
    ("GET", "/contacts", Key(Role::Read)),
    ("POST", "/contacts", Key(Role::Write)),
    ("GET", "/contacts/{id}", Key(Role::Read)),
    ("DELETE", "/contacts/{id}", Key(Role::Write)),
    ("GET", "/contacts/{id}/definition", Key(Role::Read)),
    ("POST", "/contacts/{id}/move", Key(Role::Write)),
    ("POST", "/contacts/{id}/path", Key(Role::Write)),
    ("POST", "/contacts/{id}/relax", Key(Role::Write)),
    ("POST", "/contacts/{id}/fork", Key(Role::Write)),
    ("GET", "/contacts/{id}/stress", Key(Role::Read)),
    ("GET", "/contacts/{id}/cycle", Key(Role::Read)),
    ("POST", "/contacts/{id}/subsurface", Key(Role::Read)),
    ("GET", "/contacts/{id}/history", Key(Role::Read)),
    ("GET", "/contacts/{id}/loop", Key(Role::Read)),
    ("GET", "/contacts/{id}/cycles", Key(Role::Read)),
    ("GET", "/contacts/{id}/events", Key(Role::Read)),
    ("GET", routes::METRICS, Key(Role::Metrics)),
    ("GET", "/healthz", Nothing),
    ("GET", "/readyz", Nothing),
    ("GET", "/openapi.json", Nothing),
    ("GET", "/problems/{code}", Nothing),
    ("GET", routes::PAGE, Nothing),
    ("GET", routes::PAGE_FILES, Nothing),
    ("GET", "/docs", Nothing),
    ("GET", "/docs/{*rest}", Nothing),
];

/// What a method on a route needs.
pub fn need(method: &str, route: &str) -> Need {
    let method = if method == "HEAD" { "GET" } else { method };
    // With the slash that a folder may have.
    let route = if route == "/docs/" { "/docs" } else { route };
    let listed = ROUTE_ROLES.iter().find(|(listed, at, _)| *listed == method && *at == route);
    listed.map_or(Key(Role::Write), |(.., need)| *need)
}

/// Admits a request whose key has the required role, and restricts it to the tenant of that key.
pub async fn admit(State(keys): State<Arc<Keys>>, mut request: Request, next: Next) -> Response {
    let route = request.extensions().get::<MatchedPath>().map_or("", MatchedPath::as_str);
    let Key(role) = need(request.method().as_str(), route) else {
        return next.run(request).await;
    };
    let Some(holder) = presented(request.headers()).and_then(|key| keys.holder(key)) else {
        let detail = "send a key of this service as `Authorization: Bearer KEY`";
        return Problem::new(Code::Unauthorized, detail).into_response();
    };
    if !holder.allows(role) {
        let detail = format!("this needs a key with the role `{}`", role.name());
        return Problem::new(Code::Forbidden, detail).into_response();
    }
    tracing::debug!(key = &*holder.name, tenant = holder.tenant.name(), "a key was accepted");
    request.extensions_mut().insert(holder.tenant.clone());
    next.run(request).await
}

/// The key in `Authorization: Bearer KEY`, given once.
fn presented(headers: &HeaderMap) -> Option<&[u8]> {
    let mut values = headers.get_all(header::AUTHORIZATION).iter();
    let (Some(value), None) = (values.next(), values.next()) else {
        return None;
    };
    let (scheme, key) = value.as_bytes().split_at_checked(b"bearer ".len())?;
    scheme.eq_ignore_ascii_case(b"bearer ").then(|| key.trim_ascii())
}

/// The methods of all routes.
pub const METHODS: [Method; 3] = [Method::GET, Method::POST, Method::DELETE];
