//! Metrics of the sessions.

use prometheus::{Histogram, IntCounter};

use crate::metrics::{SECONDS, metrics};

metrics! {
    /// Metrics that are counted as events happen.
    pub struct SessionMetrics {
        /// Moves made and stored.
        moves: IntCounter = counter("stickslip_moves_total"),
        /// Times that a contact that was asked for was in memory.
        hits: IntCounter = counter("stickslip_cache_hits_total"),
        /// Profiles with tables, load curves or asperities that were prepared.
        profiles_prepared: IntCounter = counter("stickslip_profiles_prepared_total"),
        /// Times that such a profile was needed and already prepared.
        profiles_shared: IntCounter = counter("stickslip_profiles_shared_total"),
        /// Time to load a contact from the store: its snapshot, and the moves beyond it.
        open: Histogram = histogram("stickslip_contact_open_seconds", SECONDS),
    }
}
