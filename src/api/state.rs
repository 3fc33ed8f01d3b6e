//! What the handlers work with.

use std::sync::Arc;

use axum::extract::FromRequestParts;
use axum::http::HeaderValue;
use axum::http::request::Parts;

use crate::access::Keys;
use crate::admission::Pool;
use crate::jobs::Jobs;
use crate::sessions::Sessions;
use crate::store::Tenant;

/// What the handlers work with. Clones are handles on the same.
#[derive(Clone)]
pub struct App {
    /// The sessions.
    pub sessions: Sessions,
    /// The jobs.
    pub jobs: Jobs,
    /// Where long work is done.
    pub pool: Pool,
    /// Who may use it.
    pub access: Access,
}

/// Who may use the service, and from where. Clones share it.
#[derive(Clone, Debug, Default)]
pub struct Access {
    /// The keys; without any, everything is open to everybody.
    pub keys: Option<Arc<Keys>>,
    /// The origins whose pages a browser may let in, such as `https://lab.example`.
    pub origins: Arc<[HeaderValue]>,
}

/// The application as the tenant of the request sees it.
pub struct TenantApp(pub App);

impl FromRequestParts<App> for TenantApp {
    type Rejection = std::convert::Infallible;

    async fn from_request_parts(parts: &mut Parts, app: &App) -> Result<Self, Self::Rejection> {
        let mut scoped = app.clone();
        if let Some(tenant) = parts.extensions.get::<Tenant>() {
            scoped.sessions = app.sessions.for_tenant(tenant.clone());
            scoped.jobs = app.jobs.for_tenant(tenant.clone());
        }
        Ok(TenantApp(scoped))
    }
}
