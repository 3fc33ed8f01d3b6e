//! What the followers of a contact receive: each move is read, marked with the cycle that it closed, and written as
//! JSON once, however many follow. A follower that has fallen behind reads the moves between by itself.

use std::collections::VecDeque;
use std::ops::ControlFlow;

use tokio::sync::watch;

use stickslip_compute::Interrupted;
use stickslip_compute::simulation::{Cause, Failure};
use stickslip_mechanics::closed_cycles::CycleLog;
use stickslip_wire::{EndReason, HistoryPage, StateEvent};

use crate::admission::PoolError;

use super::entries::EntryRef;
use super::prelude::*;

/// Moves that are read at a time.
pub(super) const PAGE: usize = 80;
/// How long followers wait for the reply to the one who has moved the contact.
const AFTER_THE_REPLY: Duration = Duration::from_millis(1);
/// How long to wait before trying again what may succeed later, as where the store is unreachable.
pub(super) const RETRY_DELAY: Duration = Duration::from_secs(1);
/// Attempts in a row to mark the cycles of a page that may take as long as a request may.
const LONG_ATTEMPTS: u32 = 100;
/// Bytes of the newest events that are kept for followers, at most.
const KEPT: usize = 24 * 1024;
/// Bytes of the cycles that a feed knows, at most; a longer log is left with the cached contact.
const KNOWN: usize = 32 * 1024;

/// A move of a contact, for those who follow it.
#[derive(Debug, PartialEq, Eq)]
pub struct ContactEvent {
    /// The sequence of the contact after it.
    pub sequence: u64,
    /// A [`StateEvent`] as JSON.
    pub json: String,
}

/// What the followers of a contact receive.
pub(super) struct Feed(watch::Sender<Newest>);

/// The newest events of a contact, without a gap.
pub(super) struct Newest {
    events: VecDeque<Arc<ContactEvent>>,
    bytes: usize,
    /// The last move of which there has been an event.
    upto: u64,
    /// Why there will be no more of them.
    pub(super) end: Option<EndReason>,
}

impl Newest {
    /// The events after those that a follower has seen, unless some of them are kept no longer.
    pub(super) fn after(&self, seen: u64) -> Option<Vec<Arc<ContactEvent>>> {
        let missing = usize::try_from(self.upto.saturating_sub(seen)).unwrap_or(usize::MAX);
        let first = self.events.len().checked_sub(missing)?;
        Some(self.events.range(first..).cloned().collect())
    }

    fn push(&mut self, event: ContactEvent) {
        (self.upto, self.bytes) = (event.sequence, self.bytes + event.json.len());
        self.events.push_back(Arc::new(event));
        while self.bytes > KEPT
            && let Some(oldest) = self.events.pop_front()
        {
            self.bytes -= oldest.json.len();
        }
    }
}

/// What feeds the followers of a contact, while there are any.
struct Feeder {
    sessions: Sessions,
    entry: EntryRef,
    feed: Arc<Feed>,
    /// The contact before its first move, and the cycles up to the last move that has been read.
    known: Option<(Contact, Arc<CycleLog>)>,
    /// Attempts in a row that have failed.
    failures: u32,
}

impl Sessions {
    /// Joins the followers of a contact, which is at the sequence `found`.
    pub(super) fn join_feed(&self, id: Uuid, found: u64) -> watch::Receiver<Newest> {
        let entry = self.entries.enter(&self.tenant, id);
        let mut fed = entry.entry().feed.lock();
        if let Some(feed) = &*fed {
            return feed.0.subscribe();
        }
        let newest = Newest { events: VecDeque::new(), bytes: 0, upto: found, end: None };
        let (sender, receiver) = watch::channel(newest);
        let feed = Arc::new(Feed(sender));
        *fed = Some(Arc::clone(&feed));
        drop(fed);
        let feeder = Feeder { sessions: self.clone(), entry, feed, known: None, failures: 0 };
        // From now on, so that no change falls between the first read and the first wait.
        let changed = self.store.changes().subscribe(id);
        tokio::spawn(feeder.run(changed));
        receiver
    }

    /// Moves of a contact as events, after the move `after`.
    pub(super) async fn events_after(&self, id: Uuid, after: u64) -> Result<Vec<ContactEvent>, SessionError> {
        let mut page = self.own_history(id, after, PAGE).await?;
        self.mark_cycles(id, &mut page, &mut Reservation::default()).await?;
        events_of(id, page)
    }
}

/// The events of the moves of a page.
fn events_of(id: Uuid, page: HistoryPage) -> Result<Vec<ContactEvent>, SessionError> {
    let event = |item: stickslip_wire::HistoryItem| {
        let (sequence, step) = (item.sequence, Some(item.step));
        let (state, cycle, observation, at) = (item.state, item.cycle, item.observation, item.at);
        ContactEvent::new(&StateEvent { id, sequence, step, state, cycle, observation, at })
    };
    page.items.into_iter().map(event).collect()
}

impl ContactEvent {
    /// The event of a state.
    pub(super) fn new(event: &StateEvent) -> Result<ContactEvent, SessionError> {
        let json = serde_json::to_string(event).map_err(|error| SessionError::Broken(error.to_string()))?;
        Ok(ContactEvent { sequence: event.sequence, json })
    }
}

/// Why events end after an error, or whether the same attempt may succeed later, after so many of them.
pub(super) fn end_after(id: Uuid, error: &SessionError, failures: u32) -> ControlFlow<EndReason> {
    let may_succeed_later = match error {
        SessionError::NotFound(_) => return ControlFlow::Break(EndReason::Deleted),
        SessionError::Expired(_) => return ControlFlow::Break(EndReason::Expired),
        SessionError::Store(StoreError::Damaged { contact, what }) => {
            tracing::error!(%contact, what, "events end: the stored contact is damaged");
            return ControlFlow::Break(EndReason::Damaged);
        }
        SessionError::Store(error) => error.is_transient(),
        SessionError::Pool(error) => *error != PoolError::Panicked,
        SessionError::Loading { .. } => true,
        // The states that have been read for the cycles are kept, so that the next attempt comes farther.
        SessionError::Failure(Failure { cause: Cause::Interrupted(Interrupted::TimeLimit(_)), .. }) => {
            failures < LONG_ATTEMPTS
        }
        _ => false,
    };
    if !may_succeed_later {
        tracing::error!(contact = %id, %error, "events end: the next move cannot be read");
        return ControlFlow::Break(EndReason::Failed);
    }
    if failures == 0 {
        tracing::warn!(contact = %id, %error, "events are delayed: the store cannot be read");
    }
    ControlFlow::Continue(())
}

impl Feeder {
    /// Feeds the followers until there are none or there is nothing to follow.
    async fn run(mut self, mut changed: watch::Receiver<()>) {
        let id = self.entry.entry().key.1;
        while !self.is_over() {
            match self.page(id).await {
                Ok(events) if events.is_empty() => {
                    self.failures = 0;
                    tokio::select! {
                        // The sender stays while there is a receiver. The reply to the move goes first: the followers
                        // may be so many that they take all threads for a while.
                        _ = changed.changed() => tokio::time::sleep(AFTER_THE_REPLY).await,
                        () = self.feed.0.closed() => {}
                    }
                }
                Ok(events) => {
                    self.failures = 0;
                    self.feed.0.send_modify(|newest| events.into_iter().for_each(|event| newest.push(event)));
                }
                Err(error) => {
                    self.known = None;
                    if let ControlFlow::Break(reason) = end_after(id, &error, self.failures) {
                        // Before the followers know, so that one who follows the contact anew gets another feed.
                        *self.entry.entry().feed.lock() = None;
                        return self.feed.0.send_modify(|newest| newest.end = Some(reason));
                    }
                    self.failures += 1;
                    tokio::select! {
                        () = tokio::time::sleep(RETRY_DELAY) => {}
                        () = self.feed.0.closed() => {}
                    }
                }
            }
        }
    }

    /// Whether nobody follows. Then the feed is no longer that of the contact.
    fn is_over(&self) -> bool {
        let mut fed = self.entry.entry().feed.lock();
        let is_over = self.feed.0.receiver_count() == 0;
        if is_over {
            *fed = None;
        }
        is_over
    }

    /// The moves beyond those that have been read. The turn of the contact is taken for the first page alone, unless
    /// the contact has closed many cycles.
    async fn page(&mut self, id: Uuid) -> Result<Vec<ContactEvent>, SessionError> {
        let (sessions, upto) = (&self.sessions, self.feed.0.borrow().upto);
        let mut page = sessions.own_history(id, upto, PAGE).await?;
        if page.items.is_empty() {
            return Ok(Vec::new());
        }
        let (stop, _raised_at_the_end) = sessions.pool.deadline();
        let (virgin, log) = match self.known.take() {
            Some((virgin, log)) => (virgin, Some(log)),
            None => sessions.copies(id, &stop, |live| (live.contact.virgin(), live.log_for(upto))).await?,
        };
        let memory = &mut Reservation::default();
        let log = sessions.mark(id, &mut page, virgin.clone(), log, &stop, memory).await?;
        if log.memory_bytes() <= KNOWN {
            self.known = Some((virgin, log));
        } else {
            sessions.keep_log(id, &log).await?;
        }
        events_of(id, page)
    }
}
