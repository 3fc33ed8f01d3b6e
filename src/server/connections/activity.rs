//! What a connection is doing, and since when.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use tokio::time::Instant;

use super::ConnectionLimits;
use crate::server::limits::PROGRESS;

/// What a connection is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// Waiting for the rest of a head, or for the first one.
    Head,
    /// Waiting for the next request.
    Idle,
    /// A request is under way, or its reply.
    Busy,
    /// It has to make room for another.
    Closing,
}

/// Noted by the socket and the service of a connection, and looked at by its alarm and by whoever needs room. Nothing is
/// published through it, so that no ordering is needed.
#[derive(Debug)]
pub struct ConnectionActivity {
    opened: Instant,
    /// The phase in the lowest two bits, the milliseconds after `opened` at which it began in the others.
    state: AtomicU64,
    /// Milliseconds after `opened` since when the client has been taking nothing, plus one; nought if it is taking.
    stalled: AtomicU64,
    /// What it has taken since then all the same.
    taken: AtomicU64,
    fault: OnceLock<&'static str>,
}

/// What something that has been read belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Heard {
    /// The beginning of a head.
    First,
    /// The rest of it.
    More,
    /// A request that is being served already.
    Body,
}

impl ConnectionActivity {
    /// Of a connection that has just been opened.
    pub fn new() -> ConnectionActivity {
        let state = AtomicU64::new(packed(Phase::Head, 0));
        let (stalled, taken) = (AtomicU64::new(0), AtomicU64::new(0));
        ConnectionActivity { opened: Instant::now(), state, stalled, taken, fault: OnceLock::new() }
    }

    fn now(&self) -> u64 {
        self.opened.elapsed().as_millis() as u64
    }

    fn state(&self) -> (Phase, u64) {
        unpacked(self.state.load(Ordering::Relaxed))
    }

    /// Something has been read; says what it belongs to.
    pub fn heard(&self) -> Heard {
        let state = self.state.load(Ordering::Relaxed);
        match unpacked(state).0 {
            Phase::Idle => {
                let heard = packed(Phase::Head, self.now());
                // Unless it is being closed.
                let _ = self.state.compare_exchange(state, heard, Ordering::Relaxed, Ordering::Relaxed);
                Heard::First
            }
            Phase::Head => Heard::More,
            Phase::Busy | Phase::Closing => Heard::Body,
        }
    }

    /// The head that is coming is not to be served.
    pub fn object(&self, fault: &'static str) {
        // The first fault is as good as any.
        let _ = self.fault.set(fault);
    }

    /// Why the head that has come is not to be served. There is no other on this connection then.
    pub fn fault(&self) -> Option<&'static str> {
        self.fault.get().copied()
    }

    /// A request is there. False if it is too late for one.
    pub fn begin(&self) -> bool {
        unpacked(self.state.swap(packed(Phase::Busy, 0), Ordering::Relaxed)).0 != Phase::Closing
    }

    /// The reply to it has been handed on.
    pub fn end(&self) {
        self.state.store(packed(Phase::Idle, self.now()), Ordering::Relaxed);
    }

    /// The client takes nothing.
    pub fn blocked(&self) {
        if self.stalled.load(Ordering::Relaxed) == 0 {
            self.taken.store(0, Ordering::Relaxed);
            self.stalled.store(self.now() + 1, Ordering::Relaxed);
        }
    }

    /// The client takes something.
    pub fn took(&self, bytes: usize) {
        if self.stalled.load(Ordering::Relaxed) != 0 {
            self.taken.fetch_add(bytes as u64, Ordering::Relaxed);
        }
    }

    /// The client has taken everything.
    pub fn flushed(&self) {
        if self.stalled.load(Ordering::Relaxed) != 0 {
            self.stalled.store(0, Ordering::Relaxed);
        }
    }

    /// When to look again; none if the client has kept the server waiting for too long.
    pub fn next_look(&self, limits: &ConnectionLimits) -> Option<Instant> {
        let now = self.now();
        let after = |since: u64, allowed: Duration| since + allowed.as_millis() as u64;
        // What comes next may have a shorter time.
        let soon = after(now, limits.shortest());
        let stalled = self.stalled.load(Ordering::Relaxed);
        let due = if stalled != 0 {
            if now >= after(stalled - 1, limits.stall) && self.taken.swap(0, Ordering::Relaxed) >= PROGRESS as u64 {
                self.stalled.store(now + 1, Ordering::Relaxed);
                after(now, limits.stall)
            } else {
                after(stalled - 1, limits.stall)
            }
        } else {
            match self.state() {
                (Phase::Head, since) => after(since, limits.head),
                (Phase::Idle, since) => after(since, limits.idle),
                (Phase::Busy, _) => soon,
                (Phase::Closing, _) => 0,
            }
        };
        (due > now).then(|| self.opened + Duration::from_millis(due.min(soon)))
    }

    /// Since when it has been waiting for its client, if it is and no request is under way.
    pub fn waiting_since(&self) -> Option<Instant> {
        match self.state() {
            (Phase::Head | Phase::Idle, since) => Some(self.opened + Duration::from_millis(since)),
            (Phase::Busy | Phase::Closing, _) => None,
        }
    }

    /// Closes it unless a request has come meanwhile; says whether it did.
    pub fn close(&self) -> bool {
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
