//! Whether changes can be written, found out by writing one: at most once a second, however many ask.

use std::time::{Duration, Instant};

use tokio::sync::Mutex;
use tokio::time::timeout;

use super::{Result, StoreError};

/// How long the outcome of a probe counts.
const INTERVAL: Duration = Duration::from_secs(1);
/// How long a probe may take.
const LIMIT: Duration = Duration::from_secs(2);

/// The outcome of the last probe.
#[derive(Default)]
pub(super) struct Probe {
    // Held while a probe is under way: those who ask meanwhile get its outcome.
    last: Mutex<Option<(Instant, Result<()>)>>,
}

impl Probe {
    /// The outcome of `write`, or of an earlier one that has just been done.
    pub(super) async fn outcome(&self, write: impl Future<Output = Result<()>>) -> Result<()> {
        let mut last = self.last.lock().await;
        if last.as_ref().is_none_or(|(at, _)| at.elapsed() >= INTERVAL) {
            let outcome = match timeout(LIMIT, write).await {
                Ok(outcome @ (Ok(()) | Err(StoreError::Full(_)))) => outcome,
                Ok(Err(error)) => Err(StoreError::Unavailable(error.to_string())),
                Err(_) => Err(StoreError::Unavailable("no answer in time".to_owned())),
            };
            *last = Some((Instant::now(), outcome));
        }
        last.as_ref().map_or(Ok(()), |(_, outcome)| outcome.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::Probe;
    use crate::store::StoreError;
    use futures::future::join_all;
    use std::cell::Cell;

    #[tokio::test]
    async fn however_many_ask_one_change_is_written_and_all_get_its_outcome() {
        let (probe, written) = (Probe::default(), Cell::new(0));
        let write = async || {
            written.set(written.get() + 1);
            tokio::task::yield_now().await;
            Err(StoreError::Full("no room".to_owned()))
        };
        let outcomes = join_all((0..100).map(|_| probe.outcome(write()))).await;
        assert!(outcomes.iter().all(|outcome| matches!(outcome, Err(StoreError::Full(_)))));
        assert_eq!(written.get(), 1);
    }
}
