//! What a connection is doing and since when, as its timers and the connection limiter need it.

use parking_lot::Mutex;
use tokio::time::Instant;

use super::ConnectionLimits;
use crate::server::connection_limits::{LARGE_REPLY_TIME, LEAST_PROGRESS};

/// What a connection is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// Waiting for the rest of a head, or for the first one.
    Head,
    /// Waiting for the next request.
    Idle,
    /// A request is under way, or its reply.
    Busy,
    /// It is being closed to free its place for another.
    Closing,
}

/// Written by the socket and the service of a connection, read by its timer and by the limiter.
#[derive(Debug)]
pub struct ConnectionActivity {
    // Locked for a moment, and never across an await.
    state: Mutex<State>,
}

#[derive(Debug)]
struct State {
    phase: Phase,
    since: Instant,
    /// When writing to the client began to block, if it does.
    blocked_since: Option<Instant>,
    /// Bytes written since then.
    written: usize,
    /// When a large reply that is under way must have been read.
    due: Option<Instant>,
}

/// What a client has taken too long for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Late {
    /// To send the head of a request, or to begin it.
    Head,
    /// To read a reply.
    Reply,
}

impl ConnectionActivity {
    /// The activity of a connection that has just been opened.
    pub fn new() -> ConnectionActivity {
        let (phase, since) = (Phase::Head, Instant::now());
        ConnectionActivity { state: Mutex::new(State { phase, since, blocked_since: None, written: 0, due: None }) }
    }

    /// Records that bytes were received.
    pub fn received(&self) {
        let mut state = self.state.lock();
        if state.phase == Phase::Idle {
            (state.phase, state.since) = (Phase::Head, Instant::now());
        }
    }

    /// The head that is being received has its time from now on, as the server stops.
    pub fn restart_head(&self) {
        let mut state = self.state.lock();
        if state.phase == Phase::Head {
            state.since = Instant::now();
        }
    }

    /// Records the start of a request. False if the connection is being closed already.
    pub fn begin_request(&self) -> bool {
        std::mem::replace(&mut self.state.lock().phase, Phase::Busy) != Phase::Closing
    }

    /// Records that a reply begins that holds much memory.
    pub fn begin_large_reply(&self) {
        self.state.lock().due = Some(Instant::now() + LARGE_REPLY_TIME);
    }

    /// Records that the reply has been handed to the socket.
    pub fn end_request(&self) {
        let mut state = self.state.lock();
        (state.phase, state.since, state.due) = (Phase::Idle, Instant::now(), None);
    }

    /// Records that a write blocked: the client reads nothing.
    pub fn write_blocked(&self) {
        let mut state = self.state.lock();
        if state.blocked_since.is_none() {
            (state.blocked_since, state.written) = (Some(Instant::now()), 0);
        }
    }

    /// Records bytes that the client has accepted.
    pub fn wrote(&self, bytes: usize) {
        self.state.lock().written += bytes;
    }

    /// Records that everything has been written.
    pub fn flushed(&self) {
        self.state.lock().blocked_since = None;
    }

    /// When to check the client next.
    ///
    /// # Errors
    /// [`Late`] if it has taken too long.
    pub fn next_check(&self, limits: &ConnectionLimits) -> Result<Instant, Late> {
        self.next_check_at(Instant::now(), limits)
    }

    fn next_check_at(&self, now: Instant, limits: &ConnectionLimits) -> Result<Instant, Late> {
        let mut state = self.state.lock();
        // The next phase may have a shorter limit.
        let soon = now + limits.shortest();
        let (due, late) = match (state.blocked_since, state.phase) {
            (Some(since), _) if now >= since + limits.stall && state.written >= LEAST_PROGRESS => {
                (state.blocked_since, state.written) = (Some(now), 0);
                (now + limits.stall, Late::Reply)
            }
            (Some(since), _) => (since + limits.stall, Late::Reply),
            (None, Phase::Head) => (state.since + limits.head, Late::Head),
            (None, Phase::Idle) => (state.since + limits.idle, Late::Head),
            (None, Phase::Busy) => (soon, Late::Reply),
            (None, Phase::Closing) => (now, Late::Head),
        };
        let due = state.due.map_or(due, |whole| whole.min(due));
        if due > now { Ok(due.min(soon)) } else { Err(late) }
    }

    /// Since when the connection has waited for its client; none while a request is being served.
    pub fn waiting_since(&self) -> Option<Instant> {
        let state = self.state.lock();
        matches!(state.phase, Phase::Head | Phase::Idle).then_some(state.since)
    }

    /// Marks the connection as closing unless a request has begun meanwhile, and returns whether it did.
    pub fn try_close(&self) -> bool {
        let mut state = self.state.lock();
        let waits = matches!(state.phase, Phase::Head | Phase::Idle);
        if waits {
            state.phase = Phase::Closing;
        }
        waits
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use tokio::time::Instant;

    use super::{ConnectionActivity, Late};
    use crate::server::ConnectionLimits;
    use crate::server::connection_limits::LEAST_PROGRESS;

    /// How long a client that takes so much in each second keeps a large reply, s.
    fn kept(rate: usize) -> Option<u64> {
        let (activity, limits) = (ConnectionActivity::new(), ConnectionLimits::default());
        assert!(activity.begin_request());
        activity.begin_large_reply();
        activity.write_blocked();
        let begin = Instant::now();
        (0..3_600).find(|second| {
            activity.wrote(rate);
            activity.next_check_at(begin + Duration::from_secs(*second), &limits).is_err()
        })
    }

    #[test]
    fn a_large_reply_is_kept_for_ten_minutes_at_most_and_a_slow_one_for_half_a_minute() {
        assert_eq!(kept(120_000), Some(600));
        assert_eq!(kept(LEAST_PROGRESS / 30 + 1), Some(600));
        assert_eq!(kept(LEAST_PROGRESS / 32), Some(30));
    }

    #[test]
    fn a_connection_without_a_request_is_kept_for_a_minute() {
        let (activity, limits) = (ConnectionActivity::new(), ConnectionLimits::default());
        assert!(activity.begin_request());
        activity.end_request();
        let end = Instant::now();
        assert!(activity.next_check_at(end + limits.idle - Duration::from_secs(1), &limits).is_ok());
        assert_eq!(activity.next_check_at(end + limits.idle, &limits), Err(Late::Head));
    }

    #[test]
    fn half_a_head_has_its_time_and_anew_when_the_server_stops() {
        let (activity, limits) = (ConnectionActivity::new(), ConnectionLimits::default());
        let late = || Instant::now() + limits.head;
        assert_eq!(activity.next_check_at(late(), &limits), Err(Late::Head));
        let before = late();
        activity.restart_head();
        assert!(activity.next_check_at(before, &limits).is_ok());
        assert_eq!(activity.next_check_at(late(), &limits), Err(Late::Head));
    }
}
