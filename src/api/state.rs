//! The state of the application, and the part of it that a tenant sees.

use std::sync::Arc;

use axum::extract::FromRequestParts;
use axum::http::HeaderValue;
use axum::http::request::Parts;
use tokio::sync::watch;

use super::request_context::RequestContext;
use crate::access::{Holder, Keys};
use crate::admission::Pool;
use crate::jobs::Jobs;
use crate::server::OwnHosts;
use crate::sessions::Sessions;

/// The state that all handlers share.
pub struct App {
    /// The contacts.
    pub sessions: Sessions,
    /// The jobs.
    pub jobs: Jobs,
    /// The threads and memory for requests.
    pub pool: Pool,
    /// Keys and origins.
    pub access: Access,
}

/// Who may use the service, and from where.
#[derive(Clone, Debug, Default)]
pub struct Access {
    /// The keys, which may be replaced; if there are none, everybody has access.
    pub keys: Option<watch::Receiver<Arc<Keys>>>,
    /// The names by which a service without keys may be called; any if none.
    pub hosts: Option<OwnHosts>,
    /// The origins whose pages may call the service from a browser, such as `https://lab.example`.
    pub origins: Arc<[HeaderValue]>,
}

/// The state restricted to the tenant of the request.
pub struct TenantApp(pub Arc<App>);

impl FromRequestParts<Arc<App>> for TenantApp {
    type Rejection = std::convert::Infallible;

    async fn from_request_parts(parts: &mut Parts, app: &Arc<App>) -> Result<Self, Self::Rejection> {
        let scoped =
            parts.extensions.get::<Arc<RequestContext>>().and_then(|context| context.holder.as_ref()).map(|holder| {
                let Holder { name, tenant, .. } = &**holder;
                let sessions = app.sessions.for_tenant(tenant.clone(), Arc::clone(name));
                let jobs = app.jobs.for_tenant(tenant.clone());
                Arc::new(App { sessions, jobs, pool: app.pool.clone(), access: app.access.clone() })
            });
        Ok(TenantApp(scoped.unwrap_or_else(|| Arc::clone(app))))
    }
}
