//! Events: every state of a session, in order and without a gap, for each listener.
//!
//! A listener pulls: it reads the moves after those that it has seen, a page at a time, and waits if there are no
//! more. So a slow listener costs no more memory than a fast one, and moves that other processes make reach it in the
//! same way.

use std::collections::VecDeque;

use futures::Stream;

use crate::admission::{PoolError, Quota, Share};
use crate::store::{Listener, StreamEvent};
use stickslip_compute::Interrupted;
use stickslip_compute::simulation::{Cause, Failure};
use stickslip_wire::{EndReason, HistoryPage, StateEvent};

use super::prelude::*;

/// Moves that a listener reads at a time.
const PAGE: usize = 80;
/// How long a listener waits before it tries again what may succeed later, as where the store is unreachable.
const RETRY_DELAY: Duration = Duration::from_secs(1);

/// Attempts in a row to mark the cycles of a page that may take as long as a request may.
const LONG_ATTEMPTS: u32 = 100;

struct Follower {
    sessions: Sessions,
    id: Uuid,
    /// The sequence of the last move that has been read.
    seen: u64,
    ready: VecDeque<StateEvent>,
    listener: Listener,
    /// Attempts in a row that have failed.
    failures: u32,
    _share: Share,
}

/// The states of a session: after each move with a sequence greater than `after`, or, without it, the present state
/// and then each new one. It ends when the session is gone or [`Sessions::end_events`] is called.
///
/// # Errors
/// [`SessionError::NotFound`], [`SessionError::Expired`], [`SessionError::Ahead`],
/// [`SessionError::TooManyStreams`], or a failure of the store.
pub async fn events(
    sessions: &Sessions,
    id: Uuid,
    after: Option<u64>,
) -> Result<impl Stream<Item = StreamEvent<StateEvent>> + Send + use<>, SessionError> {
    let share = sessions.pool.share_of(Quota::Streams)?;
    // Every later change wakes the listener, so that none can fall between the first read and the first wait.
    let listener = sessions.listeners.listen(sessions.store.changes(), id);
    let listener = listener.ok_or(SessionError::TooManyStreams)?;
    let session = sessions.get(id).await?;
    let found = session.sequence;
    let mut ready = VecDeque::new();
    let seen = match after {
        Some(after) if after > found => return Err(SessionError::Ahead { after, found }),
        Some(after) => after,
        // The present state is that of the last move, if there has been one.
        None if found > 0 => found - 1,
        None => {
            let (state, at) = (session.state, session.created_at);
            ready.push_back(StateEvent { id, sequence: 0, step: None, state, cycle: None, observation: None, at });
            0
        }
    };
    let sessions = sessions.clone();
    let follower = Follower { sessions, id, seen, ready, listener, failures: 0, _share: share };
    Ok(futures::stream::unfold(Some(follower), async |follower| Some(follower?.next().await)))
}

impl Follower {
    /// The moves beyond those that have been read.
    async fn page(&self) -> Result<HistoryPage, SessionError> {
        let mut page = self.sessions.own_history(self.id, self.seen, PAGE).await?;
        self.sessions.mark_cycles(self.id, &mut page, &mut Reservation::default()).await?;
        Ok(page)
    }

    /// Whether the same attempt, after this error, may succeed later.
    fn may_succeed_later(&self, error: &SessionError) -> bool {
        match error {
            SessionError::Store(error) => error.is_transient(),
            SessionError::Pool(error) => *error != PoolError::Panicked,
            SessionError::Loading { .. } => true,
            // The states that have been read for the cycles are kept, so that the next attempt comes farther.
            SessionError::Failure(Failure { cause: Cause::Interrupted(Interrupted::TimeLimit(_)), .. }) => {
                self.failures < LONG_ATTEMPTS
            }
            _ => false,
        }
    }

    /// The next event, and what follows it unless it is the last.
    async fn next(mut self) -> (StreamEvent<StateEvent>, Option<Follower>) {
        let event = loop {
            if self.listener.is_ending() {
                break StreamEvent::End(EndReason::Stopping);
            }
            if let Some(event) = self.ready.pop_front() {
                break StreamEvent::State(event);
            }
            match self.page().await {
                Ok(page) if page.items.is_empty() => {
                    self.failures = 0;
                    self.listener.wait().await;
                }
                Ok(page) => {
                    self.failures = 0;
                    self.seen = page.items.last().map_or(self.seen, |item| item.sequence);
                    let id = self.id;
                    self.ready.extend(page.items.into_iter().map(|item| StateEvent {
                        id,
                        sequence: item.sequence,
                        step: Some(item.step),
                        state: item.state,
                        cycle: item.cycle,
                        observation: item.observation,
                        at: item.at,
                    }));
                }
                Err(SessionError::NotFound(_)) => break StreamEvent::End(EndReason::Deleted),
                Err(SessionError::Expired(_)) => break StreamEvent::End(EndReason::Expired),
                Err(SessionError::Store(StoreError::Damaged { contact, what })) => {
                    tracing::error!(%contact, what, "events end: the stored contact is damaged");
                    break StreamEvent::End(EndReason::Damaged);
                }
                Err(error) if self.may_succeed_later(&error) => {
                    if self.failures == 0 {
                        tracing::warn!(contact = %self.id, %error, "events are delayed: the store cannot be read");
                    }
                    self.failures += 1;
                    self.listener.pause(RETRY_DELAY).await;
                }
                Err(error) => {
                    tracing::error!(contact = %self.id, %error, "events end: the next move cannot be read");
                    break StreamEvent::End(EndReason::Failed);
                }
            }
        };
        let ended = matches!(event, StreamEvent::End(_));
        (event, (!ended).then_some(self))
    }
}
