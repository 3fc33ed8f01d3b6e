//! Metrics of the sessions.

use prometheus::{Histogram, IntCounter, Opts};

use crate::metrics::{SECONDS, counter, histogram};
use crate::store::Commits;

/// Metrics that are counted as events happen.
pub struct SessionMetrics {
    /// Moves that have been made and stored.
    pub moves: IntCounter,
    /// How often a session that was asked for was cached.
    pub hits: IntCounter,
    /// Profiles with tables, curves or asperities that have been prepared.
    pub profiles_prepared: IntCounter,
    /// How often one that was needed was ready.
    pub profiles_shared: IntCounter,
    /// How long it took to load those sessions that were not, s.
    pub open: Histogram,
}

impl Default for SessionMetrics {
    fn default() -> SessionMetrics {
        let hits = "Times that a contact that was asked for was in memory.";
        let help = "Time to load a contact from the store: its snapshot, and the moves beyond it.";
        SessionMetrics {
            moves: counter(Opts::new("stickslip_moves_total", "Moves made and stored.")),
            hits: counter(Opts::new("stickslip_cache_hits_total", hits)),
            profiles_prepared: counter(Opts::new(
                "stickslip_profiles_prepared_total",
                "Profiles with tables, load curves or asperities that were prepared.",
            )),
            profiles_shared: counter(Opts::new(
                "stickslip_profiles_shared_total",
                "Times that such a profile was needed and already prepared.",
            )),
            open: histogram(Opts::new("stickslip_contact_open_seconds", help), SECONDS),
        }
    }
}

/// The metrics of the sessions.
pub struct Readings<'a> {
    /// What is counted as it happens.
    pub counted: &'a SessionMetrics,
    /// Cached sessions that no request uses.
    pub cached: usize,
    /// Bytes of their states, and of the profiles that are ready.
    pub bytes: usize,
    /// How many bytes there may be.
    pub capacity: usize,
    /// Clients that listen to events.
    pub streams: usize,
    /// What the store has committed, if it commits.
    pub commits: Option<&'a Commits>,
}
