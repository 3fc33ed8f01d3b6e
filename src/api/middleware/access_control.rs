//! Access control: the key that a request presents, and whether it has the role that the route requires.

use std::sync::{Arc, OnceLock};
use std::time::Duration;

use axum::body::Body;
use axum::extract::{MatchedPath, Request, State};
use axum::http::{HeaderMap, header};
use axum::middleware::Next;
use axum::response::{IntoResponse as _, Response};
use futures::StreamExt as _;
use jiff::Timestamp;
use tokio::sync::watch;
use tokio::time::sleep;

use crate::access::{Holder, Keys};
use crate::admission::{Client, Pool, Quota};
use crate::api;
use crate::api::problem::{Code, Problem};

/// Where the holder of the key of a request is found, once the key has been accepted.
pub type Caller = Arc<OnceLock<Arc<Holder>>>;

/// How long a wait for the end of a key lasts at most, so that any end can be waited for.
const LONGEST_WAIT: Duration = Duration::from_secs(24 * 60 * 60);

/// Admits a request whose key has the required role, and restricts it to the tenant of that key, within its quotas.
/// Events end with the key.
pub async fn admit(
    State((mut keys, pool)): State<(watch::Receiver<Arc<Keys>>, Pool)>,
    mut request: Request,
    next: Next,
) -> Response {
    let route = request.extensions().get::<MatchedPath>().map_or("", MatchedPath::as_str);
    let Some(role) = api::need(request.method().as_str(), route) else {
        return next.run(request).await;
    };
    let known = Arc::clone(&keys.borrow_and_update());
    let holder = presented(request.headers()).and_then(|key| known.holder(key));
    let Some(holder) = holder.filter(|holder| !holder.has_expired()) else {
        let detail = match holder {
            Some(_) => "the key has expired",
            None => "send a key of this service as `Authorization: Bearer KEY`",
        };
        return Problem::new(Code::Unauthorized, detail).into_response();
    };
    if !holder.allows(role) {
        let detail = format!("this needs a key with the role `{}`", role.name());
        return Problem::new(Code::Forbidden, detail).into_response();
    }
    tracing::debug!(key = &*holder.name, tenant = holder.tenant.name(), "a key was accepted");
    if let Some(caller) = request.extensions().get::<Caller>() {
        // Only set here.
        let _ = caller.set(Arc::clone(holder));
    }
    request.extensions_mut().insert(Arc::clone(holder));
    let client = Client::Tenant(holder.tenant.clone());
    let share = client.within(|| pool.share_of(Quota::Requests)).map_err(Problem::from);
    let mut response = match &share {
        Ok(_) => client.clone().serve(next.run(request)).await,
        Err(exceeded) => exceeded.clone().into_response(),
    };
    response.extensions_mut().insert(client);
    let kind = response.headers().get(header::CONTENT_TYPE);
    if kind.is_some_and(|kind| kind.as_bytes().starts_with(b"text/event-stream")) {
        let end = Box::pin(revoked(keys, Arc::clone(holder)));
        return response.map(|body| Body::from_stream(body.into_data_stream().take_until(end)));
    }
    response
}

/// Waits until the key of this holder counts no longer.
async fn revoked(mut keys: watch::Receiver<Arc<Keys>>, holder: Arc<Holder>) {
    while keys.borrow_and_update().holds(&holder) {
        let left = holder.expires_at.map(|end| Duration::try_from(end.duration_since(Timestamp::now())));
        let left = left.map_or(LONGEST_WAIT, Result::unwrap_or_default).min(LONGEST_WAIT);
        tokio::select! {
            // No other keys will come once the service stops.
            changed = keys.changed() => if changed.is_err() { return },
            () = sleep(left) => {}
        }
    }
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
