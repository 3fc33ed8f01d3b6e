//! Events: every state of a session, in order and without a gap, to whoever listens.
//!
//! A listener pulls: it reads the history beyond what it has seen, a page at a time, and waits where there is nothing more. So
//! a slow one costs no more memory than a fast one, and moves that other processes make reach it in the same way.

use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Duration;

use futures::Stream;
use tokio::sync::{OwnedSemaphorePermit, Semaphore, watch};
use uuid::Uuid;

use stickslip_wire::{EndReason, StateEvent};

use super::{SessionError, Sessions};

/// Clients that may listen at a time.
pub const STREAMS: usize = 1_000;
/// Moves that a listener reads at a time.
const PAGE: usize = 100;
/// How long a listener waits for a store that is out of reach before it tries again.
const PAUSE: Duration = Duration::from_secs(1);

/// What happens to a session.
#[derive(Clone, Debug, PartialEq)]
pub enum Happening {
    /// It is in this state.
    State(StateEvent),
    /// Nothing more will be told.
    End(EndReason),
}

/// Who listens, and when that ends.
#[derive(Clone)]
pub(super) struct Streams {
    places: Arc<Semaphore>,
    ending: Arc<watch::Sender<bool>>,
}

impl Streams {
    pub(super) fn new() -> Streams {
        Streams { places: Arc::new(Semaphore::new(STREAMS)), ending: Arc::new(watch::Sender::new(false)) }
    }

    /// How many listen.
    pub(super) fn open(&self) -> usize {
        STREAMS - self.places.available_permits()
    }
}

/// A listener.
struct Listener {
    sessions: Sessions,
    id: Uuid,
    /// The last move that has been read.
    seen: u64,
    ready: VecDeque<StateEvent>,
    woken: watch::Receiver<()>,
    ending: watch::Receiver<bool>,
    over: bool,
    // Gives the place back when the listener goes, in whatever way.
    _place: OwnedSemaphorePermit,
}

impl Sessions {
    /// The states of a session: after each move beyond `after`, or, if that is left out, the present one and then each new
    /// one. It ends when the session is gone or [`Sessions::end_events`] is called.
    ///
    /// # Errors
    /// [`SessionError::NotFound`], [`SessionError::Expired`], [`SessionError::Ahead`], [`SessionError::TooManyStreams`], or a
    /// failure of the store.
    pub async fn events(
        &self,
        id: Uuid,
        after: Option<u64>,
    ) -> Result<impl Stream<Item = Happening> + Send + use<>, SessionError> {
        let place = self.common.streams.places.clone().try_acquire_owned().map_err(|_| SessionError::TooManyStreams)?;
        // From here on every change wakes the listener, so that none can fall between the first look and the first wait.
        let woken = self.common.store.changes().subscribe(id);
        let ending = self.common.streams.ending.subscribe();
        let session = self.get(id).await?;
        let found = session.sequence;
        let mut ready = VecDeque::new();
        let seen = match after {
            Some(after) if after > found => return Err(SessionError::Ahead { after, found }),
            Some(after) => after,
            // The present state is that of the last move, if there has been one.
            None if found > 0 => found - 1,
            None => {
                let (state, at) = (session.state, session.created_at);
                ready.push_back(StateEvent { id, sequence: 0, step: None, state, at });
                0
            }
        };
        let sessions = self.clone();
        let listener = Listener { sessions, id, seen, ready, woken, ending, over: false, _place: place };
        Ok(futures::stream::unfold(listener, Listener::next))
    }

    /// Ends all events, present and future: the process is about to stop.
    pub fn end_events(&self) {
        self.common.streams.ending.send_replace(true);
    }
}

impl Listener {
    async fn next(mut self) -> Option<(Happening, Listener)> {
        if self.over {
            return None;
        }
        let happening = loop {
            if *self.ending.borrow() {
                break Happening::End(EndReason::Stopping);
            }
            if let Some(event) = self.ready.pop_front() {
                break Happening::State(event);
            }
            match self.sessions.past(self.id, self.seen, PAGE).await {
                Ok(page) if page.items.is_empty() => self.wait().await,
                Ok(page) => {
                    self.seen = page.items.last().map_or(self.seen, |item| item.sequence);
                    let id = self.id;
                    self.ready.extend(page.items.into_iter().map(|item| StateEvent {
                        id,
                        sequence: item.sequence,
                        step: Some(item.step),
                        state: item.state,
                        at: item.at,
                    }));
                }
                Err(SessionError::NotFound(_)) => break Happening::End(EndReason::Deleted),
                Err(SessionError::Expired(_)) => break Happening::End(EndReason::Expired),
                Err(_) => self.pause().await,
            }
        };
        self.over = matches!(happening, Happening::End(_));
        Some((happening, self))
    }

    /// Until something may have happened.
    async fn wait(&mut self) {
        let changed = tokio::select! {
            changed = self.woken.changed() => changed.is_ok(),
            _ = self.ending.wait_for(|ending| *ending) => true,
        };
        if !changed {
            self.pause().await;
        }
    }

    /// A while, unless it ends before.
    async fn pause(&mut self) {
        tokio::select! {
            () = tokio::time::sleep(PAUSE) => {}
            _ = self.ending.wait_for(|ending| *ending) => {}
        }
    }
}
