//! Access control: the key that a request presents, and whether it has the role that the route requires.

use std::sync::Arc;
use std::time::Duration;

use axum::http::{HeaderMap, header};
use jiff::Timestamp;
use tokio::sync::watch;
use tokio::time::sleep;

use crate::access::{Holder, Keys, Role};
use crate::api::problem::{Code, Problem};

/// How long a wait for the end of a key lasts at most, so that any end can be waited for.
const LONGEST_WAIT: Duration = Duration::from_secs(24 * 60 * 60);

/// The holder of the key of a request, if it needs one with this role.
///
/// # Errors
/// A [`Problem`] if the key is not known, has ended, or does not have the required role.
pub fn identify(known: &Keys, headers: &HeaderMap, needed: Option<Role>) -> Result<Option<Arc<Holder>>, Problem> {
    let Some(role) = needed else { return Ok(None) };
    let holder = presented(headers).and_then(|key| known.holder(key));
    let Some(holder) = holder.filter(|holder| !holder.has_expired()) else {
        let detail = match holder {
            Some(_) => "the key has expired",
            None => "send a key of this service as `Authorization: Bearer KEY`",
        };
        return Err(Problem::new(Code::Unauthorized, detail));
    };
    if !holder.allows(role) {
        let detail = format!("this needs a key with the role `{}`", role.name());
        return Err(Problem::new(Code::Forbidden, detail));
    }
    tracing::debug!(key = &*holder.name, tenant = holder.tenant.name(), "a key was accepted");
    Ok(Some(Arc::clone(holder)))
}

/// Waits until the key of this holder counts no longer.
pub async fn revoked(mut keys: watch::Receiver<Arc<Keys>>, holder: Arc<Holder>) {
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
