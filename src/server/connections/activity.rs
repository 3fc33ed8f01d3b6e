//! What a connection is doing and since when, as its timers and the connection limiter need it.

use parking_lot::Mutex;
use tokio::time::Instant;

use super::ConnectionLimits;
use crate::server::connection_limits::LEAST_PROGRESS;

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
    fault: Option<&'static str>,
}

impl ConnectionActivity {
    /// The activity of a connection that has just been opened.
    pub fn new() -> ConnectionActivity {
        let (phase, since) = (Phase::Head, Instant::now());
        ConnectionActivity { state: Mutex::new(State { phase, since, blocked_since: None, written: 0, fault: None }) }
    }

    /// Records that bytes of a head were received.
    pub fn received_head(&self) {
        let mut state = self.state.lock();
        if state.phase == Phase::Idle {
            (state.phase, state.since) = (Phase::Head, Instant::now());
        }
    }

    /// Whether the last reply has been handed to the socket, and nothing of another request to the HTTP library.
    pub fn is_idle(&self) -> bool {
        self.state.lock().phase == Phase::Idle
    }

    /// Marks the head that is being received as one that must not be served.
    pub fn reject_head(&self, fault: &'static str) {
        self.state.lock().fault = Some(fault);
    }

    /// Why the received head must not be served, if so. No other request follows on this connection then.
    pub fn head_fault(&self) -> Option<&'static str> {
        self.state.lock().fault
    }

    /// Records the start of a request. False if the connection is being closed already.
    pub fn begin_request(&self) -> bool {
        std::mem::replace(&mut self.state.lock().phase, Phase::Busy) != Phase::Closing
    }

    /// Records that the reply has been handed to the socket.
    pub fn end_request(&self) {
        let mut state = self.state.lock();
        (state.phase, state.since) = (Phase::Idle, Instant::now());
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

    /// When to check the client next; none if it has taken too long. The HTTP library times idle connections itself.
    pub fn next_check(&self, limits: &ConnectionLimits) -> Option<Instant> {
        let (mut state, now) = (self.state.lock(), Instant::now());
        // The next phase may have a shorter limit.
        let soon = now + limits.shortest();
        let due = match (state.blocked_since, state.phase) {
            (Some(since), _) if now >= since + limits.stall && state.written >= LEAST_PROGRESS => {
                (state.blocked_since, state.written) = (Some(now), 0);
                now + limits.stall
            }
            (Some(since), _) => since + limits.stall,
            (None, Phase::Head) => state.since + limits.head,
            (None, Phase::Idle | Phase::Busy) => soon,
            (None, Phase::Closing) => now,
        };
        (due > now).then(|| due.min(soon))
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
