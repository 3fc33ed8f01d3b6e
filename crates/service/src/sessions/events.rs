//! Events: every state of a session, in order and without a gap, for each listener.
//!
//! A listener takes what the feed of its session has, and reads by itself the moves that the feed has no longer, a page
//! at a time. So a slow listener costs no more memory than a fast one.

use std::collections::VecDeque;
use std::ops::ControlFlow;

use futures::Stream;

use crate::admission::{Quota, Share};
use crate::store::{Listener, StreamEvent};
use stickslip_wire::{EndReason, StateEvent};

use super::feed::{ContactEvent, Newest, RETRY_DELAY, end_after};
use super::prelude::*;

struct Follower {
    sessions: Sessions,
    id: Uuid,
    /// The sequence of the last move that has been read.
    seen: u64,
    ready: VecDeque<Arc<ContactEvent>>,
    listener: Listener<Newest>,
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
) -> Result<impl Stream<Item = StreamEvent<Arc<ContactEvent>>> + Send + use<>, SessionError> {
    let share = sessions.pool.share_of(Quota::Streams)?;
    let place = sessions.listeners.place().ok_or(SessionError::TooManyStreams)?;
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
            let first = StateEvent { id, sequence: 0, step: None, state, cycle: None, observation: None, at };
            ready.push_back(Arc::new(ContactEvent::new(&first)?));
            0
        }
    };
    let listener = sessions.listeners.listen(place, sessions.join_feed(id, found));
    let sessions = sessions.clone();
    let follower = Follower { sessions, id, seen, ready, listener, failures: 0, _share: share };
    Ok(futures::stream::unfold(Some(follower), async |follower| Some(follower?.next().await)))
}

impl Follower {
    /// The next event, and what follows it unless it is the last.
    async fn next(mut self) -> (StreamEvent<Arc<ContactEvent>>, Option<Follower>) {
        loop {
            if self.listener.is_ending() {
                return (StreamEvent::End(EndReason::Stopping), None);
            }
            if let Some(event) = self.ready.pop_front() {
                self.seen = self.seen.max(event.sequence);
                return (StreamEvent::State(event), Some(self));
            }
            let (fed, end) = {
                let newest = self.listener.newest();
                (newest.after(self.seen), newest.end)
            };
            match (fed, end) {
                (Some(events), _) if !events.is_empty() => self.ready.extend(events),
                (_, Some(reason)) => return (StreamEvent::End(reason), None),
                (Some(_), None) => self.listener.wait().await,
                (None, None) => match self.sessions.events_after(self.id, self.seen).await {
                    Ok(events) => {
                        self.failures = 0;
                        self.ready.extend(events.into_iter().map(Arc::new));
                    }
                    Err(error) => match end_after(self.id, &error, self.failures) {
                        ControlFlow::Break(reason) => return (StreamEvent::End(reason), None),
                        ControlFlow::Continue(()) => {
                            self.failures += 1;
                            self.listener.pause(RETRY_DELAY).await;
                        }
                    },
                },
            }
        }
    }
}
