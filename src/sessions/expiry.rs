//! Periodic work: idle sessions expire, and old receipts are deleted.

use jiff::Timestamp;

use super::prelude::*;

/// The shortest and the longest period.
const PERIODS: (Duration, Duration) = (Duration::from_millis(100), Duration::from_secs(60));
/// An idle session outlives its time by at most this fraction of it, within [`PERIODS`].
const SHARE: u32 = 10;

/// Deletes sessions that have not moved for `expire_after`, if it is given, and replies past the time of retries:
/// periodically, and never ends.
pub async fn run_expiry_loop(store: Arc<dyn Store>, expire_after: Option<Duration>) {
    let (least, most) = PERIODS;
    let period = expire_after.map_or(most, |idle| (idle / SHARE).clamp(least, most));
    loop {
        let idle_since = expire_after.map(|idle| Timestamp::now().checked_sub(idle).unwrap_or(Timestamp::MIN));
        match store.purge_expired(idle_since).await {
            Ok(0) => {}
            Ok(expired) => tracing::info!(expired, "idle contacts have expired"),
            Err(error) => tracing::warn!(%error, "expired contacts could not be deleted; the server tries again"),
        }
        tokio::time::sleep(period).await;
    }
}
