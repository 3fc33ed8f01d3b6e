//! What a connection is doing and since when, as its timers and the connection limiter need it.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use tokio::time::Instant;

use super::ConnectionLimits;
use crate::server::limits::LEAST_PROGRESS;

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

/// Written by the socket and the service of a connection, read by its timer and by the limiter. No other memory is
/// published through it, so relaxed ordering suffices.
#[derive(Debug)]
pub struct ConnectionActivity {
    opened: Instant,
    /// The phase in the lowest two bits, the milliseconds after `opened` at which it began in the others.
    state: AtomicU64,
    /// Milliseconds after `opened` at which writing to the client began to block, plus one; zero if it does not block.
    blocked_since: AtomicU64,
    /// Bytes written since then.
    written: AtomicU64,
    fault: OnceLock<&'static str>,
}

impl ConnectionActivity {
    /// The activity of a connection that has just been opened.
    pub fn new() -> ConnectionActivity {
        let state = AtomicU64::new(packed(Phase::Head, 0));
        let (blocked_since, written) = (AtomicU64::new(0), AtomicU64::new(0));
        ConnectionActivity { opened: Instant::now(), state, blocked_since, written, fault: OnceLock::new() }
    }

    fn elapsed_ms(&self) -> u64 {
        self.opened.elapsed().as_millis() as u64
    }

    fn state(&self) -> (Phase, u64) {
        unpacked(self.state.load(Ordering::Relaxed))
    }

    /// Records that bytes of a head were received.
    pub fn received_head(&self) {
        let state = self.state.load(Ordering::Relaxed);
        if unpacked(state).0 == Phase::Idle {
            let head = packed(Phase::Head, self.elapsed_ms());
            // Unless it is being closed.
            let _ = self.state.compare_exchange(state, head, Ordering::Relaxed, Ordering::Relaxed);
        }
    }

    /// Whether the last reply has been handed to the socket, and nothing of another request to the HTTP library.
    pub fn is_idle(&self) -> bool {
        self.state().0 == Phase::Idle
    }

    /// Marks the head that is being received as one that must not be served.
    pub fn reject_head(&self, fault: &'static str) {
        // The first fault is as good as any.
        let _ = self.fault.set(fault);
    }

    /// Why the received head must not be served, if so. No other request follows on this connection then.
    pub fn head_fault(&self) -> Option<&'static str> {
        self.fault.get().copied()
    }

    /// Records the start of a request. False if the connection is being closed already.
    pub fn begin_request(&self) -> bool {
        unpacked(self.state.swap(packed(Phase::Busy, 0), Ordering::Relaxed)).0 != Phase::Closing
    }

    /// Records that the reply has been handed to the socket.
    pub fn end_request(&self) {
        self.state.store(packed(Phase::Idle, self.elapsed_ms()), Ordering::Relaxed);
    }

    /// Records that a write blocked: the client reads nothing.
    pub fn write_blocked(&self) {
        if self.blocked_since.load(Ordering::Relaxed) == 0 {
            self.written.store(0, Ordering::Relaxed);
            self.blocked_since.store(self.elapsed_ms() + 1, Ordering::Relaxed);
        }
    }

    /// Records bytes that the client has accepted.
    pub fn wrote(&self, bytes: usize) {
        if self.blocked_since.load(Ordering::Relaxed) != 0 {
            self.written.fetch_add(bytes as u64, Ordering::Relaxed);
        }
    }

    /// Records that everything has been written.
    pub fn flushed(&self) {
        if self.blocked_since.load(Ordering::Relaxed) != 0 {
            self.blocked_since.store(0, Ordering::Relaxed);
        }
    }

    /// When to check the client next; none if it has taken too long. The HTTP library times idle connections itself.
    pub fn next_check(&self, limits: &ConnectionLimits) -> Option<Instant> {
        let now = self.elapsed_ms();
        let after = |since: u64, allowed: Duration| since + allowed.as_millis() as u64;
        // The next phase may have a shorter limit.
        let soon = after(now, limits.shortest());
        let blocked = self.blocked_since.load(Ordering::Relaxed);
        let due = if blocked != 0 {
            if now >= after(blocked - 1, limits.stall)
                && self.written.swap(0, Ordering::Relaxed) >= LEAST_PROGRESS as u64
            {
                self.blocked_since.store(now + 1, Ordering::Relaxed);
                after(now, limits.stall)
            } else {
                after(blocked - 1, limits.stall)
            }
        } else {
            match self.state() {
                (Phase::Head, since) => after(since, limits.head),
                (Phase::Idle | Phase::Busy, _) => soon,
                (Phase::Closing, _) => 0,
            }
        };
        (due > now).then(|| self.opened + Duration::from_millis(due.min(soon)))
    }

    /// Since when the connection has waited for its client; none while a request is being served.
    pub fn waiting_since(&self) -> Option<Instant> {
        match self.state() {
            (Phase::Head | Phase::Idle, since) => Some(self.opened + Duration::from_millis(since)),
            (Phase::Busy | Phase::Closing, _) => None,
        }
    }

    /// Marks the connection as closing unless a request has begun meanwhile, and returns whether it did.
    pub fn try_close(&self) -> bool {
        let state = self.state.load(Ordering::Relaxed);
        matches!(unpacked(state).0, Phase::Head | Phase::Idle)
            && self
                .state
                .compare_exchange(state, packed(Phase::Closing, 0), Ordering::Relaxed, Ordering::Relaxed)
                .is_ok()
    }
}

fn packed(phase: Phase, since: u64) -> u64 {
    since << 2 | phase as u64
}

fn unpacked(state: u64) -> (Phase, u64) {
    let phase = match state & 3 {
        0 => Phase::Head,
        1 => Phase::Idle,
        2 => Phase::Busy,
        _ => Phase::Closing,
    };
    (phase, state >> 2)
}
