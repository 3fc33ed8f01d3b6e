//! Staying in step with a store that other processes change too.
//!
//! What is in the cache has been true, and may have been overtaken. Whoever shows a state, or refuses a request because of
//! one, asks the store for the sequence first, and applies the moves that are missing. A move itself need not ask: the
//! store refuses it if it was computed from a state of the past.

use uuid::Uuid;

use crate::store::StoreError;

use super::{Guard, Live, SessionError, Sessions};

impl Sessions {
    /// The session behind a lock as the store knows it now.
    pub(super) async fn current<'a>(&self, id: Uuid, guard: &'a mut Guard) -> Result<&'a mut Live, SessionError> {
        if guard.is_some() && self.store.is_shared() {
            let found = self.store.sequence(id).await;
            if let Err(StoreError::NotFound | StoreError::Expired) = found {
                **guard = None;
            }
            self.catch_up(guard, found.map_err(|error| self.failed(id, error))?).await?;
        }
        self.present(id, guard).await
    }

    /// Applies what other processes have stored up to a sequence. A state from beyond it is dropped: the store has been
    /// put back to an earlier time.
    async fn catch_up(&self, guard: &mut Guard, to: u64) -> Result<(), SessionError> {
        if let Some(live) = guard.take_if(|live| live.session.sequence != to)
            && live.session.sequence < to
        {
            **guard = Some(self.follow(live, to).await?);
        }
        Ok(())
    }
}
