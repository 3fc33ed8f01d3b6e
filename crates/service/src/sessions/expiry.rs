//! Periodic work: idle sessions expire, and old receipts are deleted.

use crate::store::Clock;

use super::prelude::*;

/// The shortest and the longest period.
const PERIODS: (Duration, Duration) = (Duration::from_millis(100), Duration::from_secs(60));
/// An idle session outlives its time by at most this fraction of it, within [`PERIODS`].
const SHARE: u32 = 10;

/// Deletes sessions that have not moved for `expire_after`, if it is given, and replies past the time of retries:
/// periodically, and never ends. The time is that of the store, and a jump of it deletes nothing; nor is anything
/// deleted in the first period.
pub async fn run_expiry_loop(store: Arc<dyn Store>, expire_after: Option<Duration>) {
    let (least, most) = PERIODS;
    let period = expire_after.map_or(most, |idle| (idle / SHARE).clamp(least, most));
    let mut clock = None;
    loop {
        match purge(&*store, expire_after, &mut clock).await {
            Ok(0) => {}
            Ok(expired) => tracing::info!(expired, "idle contacts have expired"),
            Err(error) => tracing::warn!(%error, "expired contacts could not be deleted; the server tries again"),
        }
        tokio::time::sleep(period).await;
    }
}

/// Deletes what is too old by a clock, or starts the clock; returns how many sessions have expired.
async fn purge(
    store: &dyn Store,
    expire_after: Option<Duration>,
    clock: &mut Option<Clock>,
) -> Result<u64, StoreError> {
    let now = store.now().await?;
    let Some(clock) = clock else {
        *clock = Some(Clock::starting_at(now));
        return Ok(0);
    };
    let now = clock.bounded(now);
    store.purge_expired(expire_after.and_then(|idle| now.checked_sub(idle).ok())).await
}
