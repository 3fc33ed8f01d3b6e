//! Metrics of the sessions.

use prometheus::{Histogram, IntCounter, Opts};

use crate::metrics::{SECONDS, counter, histogram};
use crate::store::Commits;

use super::Sessions;

/// Metrics that are counted as events happen.
pub(super) struct SessionMetrics {
    /// Moves that are stored.
    pub(super) moves: IntCounter,
    /// How long it took to load a session that was not cached, s.
    pub(super) open: Histogram,
}

impl Default for SessionMetrics {
    fn default() -> SessionMetrics {
        let help = "Time to load a contact from the store: its snapshot, and the moves beyond it.";
        SessionMetrics {
            moves: counter(Opts::new("stickslip_moves_total", "Moves made and stored.")),
            open: histogram(Opts::new("stickslip_contact_open_seconds", help), SECONDS),
        }
    }
}

/// The metrics of the sessions.
pub struct Readings<'a> {
    /// Moves that have been made and stored.
    pub moves: &'a IntCounter,
    /// How often a session that was asked for was cached.
    pub hits: &'a IntCounter,
    /// How long it took to load those that were not, s.
    pub open: &'a Histogram,
    /// Cached sessions that no request uses.
    pub cached: usize,
    /// Bytes of their states.
    pub bytes: usize,
    /// How many bytes there may be.
    pub capacity: usize,
    /// Clients that listen to events.
    pub streams: usize,
    /// What the store has committed, if it commits.
    pub commits: Option<&'a Commits>,
}

impl Sessions {
    /// The metrics of the sessions.
    #[must_use]
    pub fn readings(&self) -> Readings<'_> {
        let (bytes, cached) = self.common.cache.held();
        Readings {
            moves: &self.common.metrics.moves,
            hits: self.common.cache.hits(),
            open: &self.common.metrics.open,
            cached,
            bytes,
            capacity: self.common.cache.capacity(),
            streams: self.common.listeners.count(),
            commits: self.common.store.commits(),
        }
    }
}
